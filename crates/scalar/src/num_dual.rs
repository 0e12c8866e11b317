//! The number types of `num-dual` as scalars of a model: the oracle of the derivative tests.

use crate::{Scalar, ScalarFunction};
use num_dual::{Dual2_64, Dual64, DualNum, HyperDual64};

macro_rules! oracle {
    ($($number:ty: $($part:ident)+),+) => { $(
        impl Scalar for $number {
            fn constant(x: f64) -> Self {
                Self::from(x)
            }
            fn sin_cos(self) -> (Self, Self) {
                DualNum::sin_cos(&self)
            }
            fn exp(self) -> Self {
                DualNum::exp(&self)
            }
            fn ln(self) -> Self {
                DualNum::ln(&self)
            }
            fn sqrt(self) -> Self {
                DualNum::sqrt(&self)
            }
            fn powi(self, n: i32) -> Self {
                DualNum::powi(&self, n)
            }
            fn recip(self) -> Self {
                DualNum::recip(&self)
            }
            /// What the library does not know, by its series about the value.
            fn apply<F: ScalarFunction>(self, function: F) -> Self {
                let f = function.value(self.re);
                let slope = function.slope(self.re, f);
                let curvature = function.curvature(self.re, f, slope);
                let step = self - self.re;
                step * (step * (0.5 * curvature) + slope) + f
            }
            fn where_positive(self, then: Self, otherwise: Self) -> Self {
                if self.re > 0.0 { then } else { otherwise }
            }
            fn length<const K: usize>(components: &[Self; K]) -> Self {
                DualNum::sqrt(&components.iter().fold(Self::from(0.0), |sum, x| sum + *x * *x))
            }
            fn atan2(self, x: Self) -> Self {
                DualNum::atan2(&self, x)
            }
            fn tan(self) -> Self {
                DualNum::tan(&self)
            }
            fn asin(self) -> Self {
                DualNum::asin(&self)
            }
            fn acos(self) -> Self {
                DualNum::acos(&self)
            }
            fn atan(self) -> Self {
                DualNum::atan(&self)
            }
            fn sinh(self) -> Self {
                DualNum::sinh(&self)
            }
            fn cosh(self) -> Self {
                DualNum::cosh(&self)
            }
            fn tanh(self) -> Self {
                DualNum::tanh(&self)
            }
            fn powf(self, p: f64) -> Self {
                DualNum::powf(&self, p)
            }
            fn abs(self) -> Self {
                if self.re < 0.0 { -self } else { self }
            }
            fn is_zero(&self) -> bool {
                $(self.$part == 0.0)&&+
            }
        }
    )+ };
}
oracle!(Dual64: re eps, Dual2_64: re v1 v2, HyperDual64: re eps1 eps2 eps1eps2);
