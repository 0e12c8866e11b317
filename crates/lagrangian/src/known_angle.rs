use crate::Scalar;
use crate::scalar::derived_operators;
use std::ops::{Add, Div, Mul, Neg};

/// A number that may be an angle whose sine and cosine are known already: what is computed from it as from any other then
/// asks for them again at no cost.
///
/// Any result of arithmetic is an unknown one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownAngle {
    /// The number.
    pub re: f64,
    sin_cos: Option<(f64, f64)>,
}

impl KnownAngle {
    /// An angle (rad) with its sine and cosine.
    #[must_use]
    #[inline(always)]
    pub fn new(re: f64, sin: f64, cos: f64) -> Self {
        Self { re, sin_cos: Some((sin, cos)) }
    }
}

impl From<f64> for KnownAngle {
    /// A number of which nothing more is known.
    #[inline(always)]
    fn from(re: f64) -> Self {
        Self { re, sin_cos: None }
    }
}

impl Add for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::from(self.re + o.re)
    }
}
impl Mul for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self::from(self.re * o.re)
    }
}
impl Div for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self::from(self.re / o.re)
    }
}
impl Neg for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from(-self.re)
    }
}
impl Add<f64> for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        Self::from(self.re + o)
    }
}
impl Mul<f64> for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        Self::from(self.re * o)
    }
}
impl Div<f64> for KnownAngle {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: f64) -> Self {
        Self::from(self.re / o)
    }
}
derived_operators!([] KnownAngle);

impl Scalar for KnownAngle {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::from(x)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.sin_cos.unwrap_or_else(|| self.re.sin_cos());
        (Self::from(sin), Self::from(cos))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Self::from(self.re.exp())
    }
    #[inline(always)]
    fn ln(self) -> Self {
        Self::from(self.re.ln())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::from(self.re.sqrt())
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        Self::from(self.re.powi(n))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Self::from(self.re.recip())
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.re == 0.0
    }
}
