use crate::numbers::derived::derived_operators;
use crate::{Scalar, ScalarFunction, from_fn};
use scalar::sincos;
use std::ops::{Add, Div, Mul, Neg};

/// Eight numbers that go through the same arithmetic at once: eight stages of one step, or eight trajectories.
///
/// Plain loops over an array, which the compiler turns into whatever vector instructions it may use; wrap the outermost
/// call in [`vectorized`] to let it use those that the machine has. Every lane gets
/// the bits that the same operation on `f64` gives, but for [`Scalar::sin_cos`], which is within an ulp of the truth for
/// `|x| <= 1e6` and has the same bits on every machine.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; Lanes::COUNT]);

impl Lanes {
    /// How many lanes there are.
    pub const COUNT: usize = 8;

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(from_fn(|i| f(self.0[i])))
    }
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(from_fn(|i| f(self.0[i], o.0[i])))
    }
}

/// Runs `f` compiled for the widest vector instructions of the machine, found at run time.
///
/// Functions that `f` calls use these instructions only where they are inlined into `f`; mark closures and kernels
/// `#[inline(always)]`. So a build for any machine is as quick as a native one. The bits of the result do not depend on the choice.
// A build for a machine with AVX2 has one version: all of them would take three times as long to compile.
#[cfg_attr(
    not(target_feature = "avx2"),
    multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2", "aarch64+neon"))
)]
pub fn vectorized<R, F: FnOnce() -> R>(f: F) -> R {
    f()
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}
impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}
impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.zip(o, |a, b| a / b)
    }
}
impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}
impl Add<f64> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        self.map(|a| a + o)
    }
}
impl Mul<f64> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        self.map(|a| a * o)
    }
}
impl Div<f64> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: f64) -> Self {
        self.map(|a| a / o)
    }
}
derived_operators!([] Lanes);

impl Scalar for Lanes {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self([x; Self::COUNT])
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = sincos::sin_cos(&self.0);
        (Self(sin), Self(cos))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(scalar::exponential)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(f64::ln)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        self.map(|a| a.powi(n))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        self.map(f64::recip)
    }
    #[inline(always)]
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        self.map(|a| f.value(a))
    }
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        Self(from_fn(|i| if self.0[i] > 0.0 { then.0[i] } else { otherwise.0[i] }))
    }
    #[inline(always)]
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        Self(from_fn(|i| f64::length::<K>(&from_fn(|k| components[k].0[i]))))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        self.zip(x, f64::atan2)
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0.iter().all(Scalar::is_zero)
    }
}
