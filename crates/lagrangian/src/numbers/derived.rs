//! What numbers with derivatives have alike: operators, and the length of a vector and the angle of one in the plane, with derivatives
//! that are finite where the vector vanishes.
//!
//! By the chain rule the derivative of `sqrt(x^2 + y^2)` at zero is infinity times zero. Both functions are written here as what
//! they are near a vector that is not zero, in the direction `u` of it and across: `|x| = p + |x - u p|^2/(2 p)` and
//! `angle + c/p`, to second order, with `p` the part along `u` and `c` that across. No square of a small number is divided by one.

use crate::{Scalar, array};

/// A number with derivatives, over the numbers that it is made of.
pub(crate) trait Derived: Scalar {
    /// What value and derivatives are.
    type Base: Scalar;
    /// Whether it has second derivatives.
    const SECOND: bool;
    /// A number without derivatives.
    fn lifted(value: Self::Base) -> Self;
    /// The value.
    fn value(self) -> Self::Base;
    /// The same derivatives with another value.
    fn at(self, value: Self::Base) -> Self;
    /// Another value, and every derivative by a function of it that is linear.
    fn linear_in(self, value: Self::Base, by: impl Fn(Self::Base) -> Self::Base) -> Self;
    /// A function of this number with the value `f`, the derivative `df` and the second derivative `ddf`, which only numbers with second
    /// derivatives call.
    fn function(self, f: Self::Base, df: Self::Base, ddf: impl FnOnce() -> Self::Base) -> Self;
    /// Value and derivatives times a factor that has none.
    #[inline(always)]
    fn times(self, factor: Self::Base) -> Self {
        self.linear_in(self.value() * factor, |e| e * factor)
    }
}

/// The length of a vector. All derivatives of a zero vector's length are zero.
#[inline(always)]
pub(crate) fn derived_length<D: Derived, const K: usize>(x: &[D; K]) -> D {
    let zero = D::Base::zero();
    let values: [D::Base; K] = array(zero, |k| x[k].value());
    let r = D::Base::length(&values);
    let direction: [D::Base; K] = array(zero, |k| r.where_positive(values[k] / r, zero));
    let mut along = D::lifted(zero);
    for k in 0..K {
        along += x[k].times(direction[k]);
    }
    if !D::SECOND {
        return along.at(r);
    }
    // Below the smallest normal number 1/r may be infinite: there as at zero.
    let half = (r - f64::MIN_POSITIVE).where_positive(r.recip() * 0.5, zero);
    let mut squares = D::lifted(zero);
    for k in 0..K {
        let across = (x[k] - along.times(direction[k])).at(zero);
        squares += across * across;
    }
    (along + squares.times(half)).at(r)
}

/// The angle of the vector `(x, y)`. All derivatives of a zero vector's angle are zero.
#[inline(always)]
pub(crate) fn derived_angle<D: Derived>(y: D, x: D) -> D {
    let (x0, y0) = (x.value(), y.value());
    let (r, angle) = (D::Base::length(&[x0, y0]), y0.atan2(x0));
    let (cos, sin) = (x0 / r, y0 / r);
    let across = (y.times(cos) - x.times(sin)).at(D::Base::zero());
    let along = (x.times(cos) + y.times(sin)).at(r);
    D::lifted(r).where_positive((across / along).at(angle), D::lifted(angle))
}

/// The functions of a number with derivatives, for its implementation of `Scalar`.
macro_rules! derived_functions {
    () => {
        #[inline(always)]
        fn constant(x: f64) -> Self {
            Self::lifted(Scalar::constant(x))
        }
        #[inline(always)]
        fn sin_cos(self) -> (Self, Self) {
            let (sin, cos) = self.re.sin_cos();
            (self.function(sin, cos, || -sin), self.function(cos, -sin, || -cos))
        }
        #[inline(always)]
        fn exp(self) -> Self {
            let f = self.re.exp();
            self.function(f, f, || f)
        }
        #[inline(always)]
        fn ln(self) -> Self {
            let df = self.re.recip();
            self.function(self.re.ln(), df, || -(df * df))
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            let f = self.re.sqrt();
            let df = f.recip() * 0.5;
            self.function(f, df, || -(df / self.re * 0.5))
        }
        #[inline(always)]
        fn powi(self, n: i32) -> Self {
            match n {
                0 => Self::constant(1.0),
                1 => self,
                _ => self.function(self.re.powi(n), self.re.powi(n - 1) * f64::from(n), || {
                    self.re.powi(n - 2) * (f64::from(n) * f64::from(n - 1))
                }),
            }
        }
        #[inline(always)]
        fn recip(self) -> Self {
            let f = self.re.recip();
            let df = -(f * f);
            self.function(f, df, || -(df * f) * 2.0)
        }
        #[inline(always)]
        fn apply<F: ScalarFunction>(self, function: F) -> Self {
            let f = self.re.apply(function);
            let slope = function.slope(self.re, f);
            self.function(f, slope, || function.curvature(self.re, f, slope))
        }
        #[inline(always)]
        fn length<const K: usize>(components: &[Self; K]) -> Self {
            crate::numbers::derived::derived_length(components)
        }
        #[inline(always)]
        fn atan2(self, x: Self) -> Self {
            crate::numbers::derived::derived_angle(self, x)
        }
    };
}
/// The operators of a number with derivatives that are linear in them.
macro_rules! linear_operators {
    ([$($generics:tt)*] $number:ty) => {
        impl<$($generics)*> std::ops::Neg for $number {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                self.linear_in(-self.re, |e| -e)
            }
        }
        impl<$($generics)*> std::ops::Add<f64> for $number {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: f64) -> Self {
                self.at(self.re + o)
            }
        }
        impl<$($generics)*> std::ops::Mul<f64> for $number {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: f64) -> Self {
                self.linear_in(self.re * o, |e| e * o)
            }
        }
        impl<$($generics)*> std::ops::Div<f64> for $number {
            type Output = Self;
            #[inline(always)]
            fn div(self, o: f64) -> Self {
                self.linear_in(self.re / o, |e| e / o)
            }
        }
        crate::numbers::derived::derived_operators!([$($generics)*] $number);
    };
}
/// Operators that follow from addition, negation and multiplication, for the number types of this crate.
macro_rules! derived_operators {
    ([$($generics:tt)*] $number:ty) => {
        impl<$($generics)*> std::ops::Sub for $number {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                self + (-other)
            }
        }
        impl<$($generics)*> std::ops::Sub<f64> for $number {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: f64) -> Self {
                self + (-other)
            }
        }
        scalar::assigning_operators!([$($generics)*] $number);
    };
}

pub(crate) use {derived_functions, derived_operators, linear_operators};
