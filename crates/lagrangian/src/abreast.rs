use crate::scalar::{derived_operators, functions_of_each_lane};
use crate::sincos::near;
use crate::{Scalar, array};
use std::ops::{Add, Div, Mul, Neg};

/// The number of one lane in a loop over lanes, `for lane in 0..W { .. }`, whose body the compiler then turns into vector
/// instructions for as many trajectories.
///
/// Unlike [`Lanes`](crate::Lanes) it leaves the lanes to the loop, so that a long body keeps them together. Nothing in it
/// branches: an angle beyond 10^6 rad has no sine, but NaN. An angle may carry its sine and cosine, found before
/// ([`turned`](Self::turned)); what is computed from it carries none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Abreast {
    /// The number.
    pub of: f64,
    sin_cos: Option<(f64, f64)>,
}

impl Abreast {
    /// The number, as it is.
    #[must_use]
    #[inline(always)]
    pub fn new(of: f64) -> Self {
        Self { of, sin_cos: None }
    }

    /// An angle (rad) that carries its sine and cosine.
    #[must_use]
    #[inline(always)]
    pub fn turned(angle: f64, sin: f64, cos: f64) -> Self {
        Self { of: angle, sin_cos: Some((sin, cos)) }
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self::new(f(self.of))
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator for Abreast {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Self::new(self.of.$method(o.of))
            }
        }
        impl $operator<f64> for Abreast {
            type Output = Self;
            #[inline(always)]
            fn $method(self, x: f64) -> Self {
                Self::new(self.of.$method(x))
            }
        }
    )*};
}
operators!(Add add, Mul mul, Div div);
impl Neg for Abreast {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.of)
    }
}
derived_operators!([] Abreast);

impl Scalar for Abreast {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::new(x)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.sin_cos.unwrap_or_else(|| near(self.of));
        (Self::new(sin), Self::new(cos))
    }
    #[inline(always)]
    fn array<const N: usize>(f: impl Fn(usize) -> Self) -> [Self; N] {
        array(Self::new(0.0), f)
    }
    functions_of_each_lane!();
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.of == 0.0
    }
}
