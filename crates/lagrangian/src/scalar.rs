use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// What a number must do to carry a model.
///
/// A model is one function generic in its scalar. On `f64` it gives values; on [`Dual`](crate::Dual) and
/// [`HyperDual`](crate::HyperDual) exact first and second derivatives; on [`Lanes`](crate::Lanes) eight
/// evaluations at once. There are no comparisons: eight lanes have no common branch.
pub trait Scalar:
    Copy
    + Debug
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign<f64>
{
    /// The constant `x`, all of its derivatives zero.
    fn constant(x: f64) -> Self;
    /// Sine and cosine together (rad).
    fn sin_cos(self) -> (Self, Self);
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Integer power.
    fn powi(self, n: i32) -> Self;
    /// Reciprocal.
    fn recip(self) -> Self;

    /// Whether the number and all of its derivatives vanish.
    fn is_zero(&self) -> bool;

    /// An array by its places. Numbers in vector registers inline it and what it calls, since in a function that remains a call
    /// the registers are not known; so `f` is to be marked `#[inline(always)]`.
    #[must_use]
    #[inline(always)]
    fn array<const N: usize>(f: impl Fn(usize) -> Self) -> [Self; N] {
        crate::from_fn(f)
    }
    /// `f(.. f(f(start, items[0]), items[1]) ..)`, inlined as [`array`](Self::array) is.
    #[must_use]
    #[inline(always)]
    fn over<I, T>(items: &[I], start: T, f: impl Fn(T, &I) -> T) -> T {
        items.iter().fold(start, f)
    }

    /// `f()`, inlined as [`array`](Self::array) is: else it may stay a function, which is compiled once for all that call it.
    #[must_use]
    fn apart<T>(f: impl FnOnce() -> T) -> T {
        f()
    }

    /// The same number, carried as the other is. Numbers in vector registers are told apart, when a model is compiled, from those
    /// that all eight have in common; where a run decides which of the two a number is, every operation after it would be there
    /// for both.
    #[must_use]
    #[inline(always)]
    fn carried_as(self, _other: Self) -> Self {
        self
    }
    /// Zero.
    #[must_use]
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// Sine (rad).
    #[must_use]
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine (rad).
    #[must_use]
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// The square.
    #[must_use]
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    /// Of an angle within half a turn no call, between the parts of which nothing could be done.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        crate::sin_cos_wrapped(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        f64::powi(self, n)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        f64::recip(self)
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
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
        impl<$($generics)*> std::ops::AddAssign for $number {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl<$($generics)*> std::ops::SubAssign for $number {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
        impl<$($generics)*> std::ops::MulAssign<f64> for $number {
            #[inline(always)]
            fn mul_assign(&mut self, factor: f64) {
                *self = *self * factor;
            }
        }
    };
}

pub(crate) use derived_operators;
