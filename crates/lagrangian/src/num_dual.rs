//! The number types of `num-dual` as scalars of a model: the oracle of the derivative tests.

use crate::Scalar;
use num_dual::{Dual2_64, Dual64, DualNum, HyperDual64};

macro_rules! oracle {
    ($($number:ty),+) => { $(
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
        }
    )+ };
}
oracle!(Dual64, Dual2_64, HyperDual64);
