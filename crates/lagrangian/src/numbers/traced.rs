use crate::Scalar;
use crate::numbers::derived::derived_operators;
use scalar::ScalarFunction;
use std::ops::{Add, Div, Mul, Neg};

/// Whether a number is zero everywhere, and whether it depends on time or has a corner. It carries no value.
///
/// A model has no comparisons of its scalars, so the operations that it makes are the same for all numbers: evaluated once on these, it says
/// of itself what holds everywhere. An infinite number times zero counts as zero.
///
/// The operations are calls, never inlined: models on them compile sooner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Traced {
    /// Whether it is zero, wherever the model is evaluated.
    pub zero: bool,
    /// Whether it is made of the time, and may change with it.
    pub of_time: bool,
    /// Whether a function with a corner or a jump has a part in it.
    pub corner: bool,
    /// Whether it may change with the time or the state.
    pub varies: bool,
    /// Whether a function of something that varies has a part in it that may change within a narrow interval, such as `tanh`, `exp` or a
    /// quotient: all but polynomials, sines and cosines.
    pub narrow: bool,
}

impl Traced {
    /// The time itself.
    pub const TIME: Self = Self { zero: false, of_time: true, corner: false, varies: true, narrow: false };
    /// A coordinate or a velocity.
    pub const STATE: Self = Self { zero: false, of_time: false, corner: false, varies: true, narrow: false };

    /// The result of an operation on both operands that may be nonzero.
    fn with(self, other: Self) -> Self {
        Self {
            zero: false,
            of_time: self.of_time || other.of_time,
            corner: self.corner || other.corner,
            varies: self.varies || other.varies,
            narrow: self.narrow || other.narrow,
        }
    }

    /// A function of `self` that may be nonzero even if `self` is zero, as the cosine.
    fn changed(self) -> Self {
        Self { zero: false, ..self }
    }

    /// A function of `self` that may change within a narrow interval.
    fn narrowed(self) -> Self {
        Self { narrow: self.narrow || self.varies, ..self }
    }
}

impl Add for Traced {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        match (self.zero, other.zero) {
            (true, _) => other,
            (_, true) => self,
            _ => self.with(other),
        }
    }
}
impl Mul for Traced {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        if self.zero || other.zero { Self::zero() } else { self.with(other) }
    }
}
impl Div for Traced {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        if self.zero { self } else { self.with(other.narrowed()) }
    }
}
impl Neg for Traced {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self
    }
}
impl Add<f64> for Traced {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: f64) -> Self {
        self + Self::constant(other)
    }
}
impl Mul<f64> for Traced {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: f64) -> Self {
        self * Self::constant(other)
    }
}
impl Div<f64> for Traced {
    type Output = Self;
    #[inline(always)]
    fn div(self, _other: f64) -> Self {
        self
    }
}
derived_operators!([] Traced);

impl Scalar for Traced {
    #[inline]
    fn constant(x: f64) -> Self {
        Self { zero: x == 0.0, of_time: false, corner: false, varies: false, narrow: false }
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        (self, self.changed())
    }
    fn exp(self) -> Self {
        self.narrowed().changed()
    }
    fn ln(self) -> Self {
        self.narrowed().changed()
    }
    fn sqrt(self) -> Self {
        self.narrowed()
    }
    fn powi(self, n: i32) -> Self {
        if n > 0 { self } else { self.narrowed().changed() }
    }
    fn recip(self) -> Self {
        self.narrowed().changed()
    }
    fn apply<F: ScalarFunction>(self, _f: F) -> Self {
        Self { corner: self.corner || !F::SMOOTH, ..self.narrowed().changed() }
    }
    #[inline(never)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        let either = then.with(otherwise).with(self);
        Self { zero: then.zero && otherwise.zero, corner: true, ..either }
    }
    #[inline(never)]
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        components.iter().fold(Self::zero(), |sum, x| sum + x.narrowed())
    }
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        self.with(x).narrowed()
    }
    /// Whether it is known to be zero.
    #[inline]
    fn is_zero(&self) -> bool {
        self.zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Terms with the time, without it, and some that vanish.
    fn terms<S: Scalar>(t: S, q: S) -> [S; 8] {
        let nothing = S::zero();
        [
            q.sin() * 3.0 + q.squared() / 2.0,
            (q + t * 0.0).cos(),
            q.where_positive(q, t),
            nothing * t + nothing.sin() * q,
            S::length(&[nothing, nothing]) - nothing.powi(2),
            (t - q).exp().sqrt(),
            nothing.cos() * t,
            q.where_positive(nothing, nothing).abs() + q.atan2(q),
        ]
    }

    #[test]
    fn time_and_zeros_are_traced() {
        let made = terms(Traced::TIME, Traced::STATE);
        assert_eq!(made.map(|x| x.of_time), [false, false, true, false, false, true, true, false]);
        assert_eq!(made.map(|x| x.corner), [false, false, true, false, false, false, false, true]);
        assert_eq!(made.map(|x| x.narrow), [false, false, false, false, false, true, false, true]);
        assert_eq!(made.map(|x| x.zero), [false, false, false, true, true, false, false, false]);
        // What is said to be zero is, and what is said not to change with time does not; of the others some do.
        for q in [-1.3, 0.4] {
            let [now, later] = [0.7, 1.9].map(|t| terms(t, q));
            for k in 0..8 {
                assert!(!made[k].zero || now[k] == 0.0, "{k}");
                assert!(made[k].of_time || now[k].to_bits() == later[k].to_bits(), "{k}");
            }
            assert!(now[5].to_bits() != later[5].to_bits());
        }
    }
}
