//! The numbers that the equations are carried on: values, and values with one derivative for implicit methods.

use std::ops::{Add, Mul, Sub};

/// What the equations ask of a number.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
    /// A constant.
    fn constant(x: f64) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// The exponential.
    fn exp(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.exp()
    }
}

/// `value + slope epsilon` with `epsilon^2 = 0`.
#[derive(Debug, Clone, Copy)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// The derivative.
    pub slope: f64,
}

impl Add for Dual {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, slope: self.slope + o.slope }
    }
}
impl Sub for Dual {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, slope: self.slope - o.slope }
    }
}
impl Mul for Dual {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { value: self.value * o.value, slope: self.slope * o.value + self.value * o.slope }
    }
}
impl Mul<f64> for Dual {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        Self { value: self.value * o, slope: self.slope * o }
    }
}

impl Number for Dual {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self { value: x, slope: 0.0 }
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (Self { value: s, slope: c * self.slope }, Self { value: c, slope: -s * self.slope })
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = self.value.exp();
        Self { value: e, slope: e * self.slope }
    }
}
