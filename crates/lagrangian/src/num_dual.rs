//! The number types of `num-dual` as scalars of a model: the oracle of the derivative tests.

use crate::Scalar;
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
            fn is_zero(&self) -> bool {
                $(self.$part == 0.0)&&+
            }
        }
    )+ };
}
oracle!(Dual64: re eps, Dual2_64: re v1 v2, HyperDual64: re eps1 eps2 eps1eps2);
