use crate::functions::{Abs, Acos, Asin, Atan, Cosh, Power, ScalarFunction, Sign, Sinh, Tan, Tanh};
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// What a number must do to carry a model.
///
/// A model is one function generic in its scalar. On `f64` it gives values; on dual and hyper-dual
/// numbers exact first and second derivatives; on lanes eight
/// evaluations at once. There are no comparisons, for eight lanes have no common branch:
/// [`where_positive`](Self::where_positive) chooses for each of them, [`min`](Self::min), [`max`](Self::max) and
/// [`abs`](Self::abs) with it.
///
/// # At corners
/// A step needs finite derivatives wherever the motion leads. [`abs`](Self::abs), [`sign`](Self::sign), [`min`](Self::min),
/// [`max`](Self::max), [`length`](Self::length) and [`atan2`](Self::atan2) have none in some places, and say there the one that their
/// documentation states: a mean of those on the two sides, or zero. What is infinite stays so: [`sqrt`](Self::sqrt) and
/// [`ln`](Self::ln) at 0, [`asin`](Self::asin) and [`acos`](Self::acos) at 1 and -1, [`powf`](Self::powf) at 0 for small exponents.
/// A drag `-k v |v|` is therefore to be written with [`length`](Self::length) and not with a root of squares, which has no derivative
/// at rest.
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

    /// A function given by its value and first two derivatives.
    #[must_use]
    fn apply<F: ScalarFunction>(self, f: F) -> Self;
    /// `then` if this number is positive, `otherwise` if it is zero, negative or NaN; each with its derivatives. The number that is not
    /// chosen may be anything.
    #[must_use]
    fn where_positive(self, then: Self, otherwise: Self) -> Self;
    /// The length `sqrt(x_0^2 + x_1^2 + ..)` of a vector, without overflow or underflow of the squares.
    ///
    /// The derivative in `x_i` is `x_i/|x|`, the second `(delta_ij - x_i x_j/|x|^2)/|x|`. At a zero vector both count as zero: zero is
    /// the shortest of all slopes of planes that touch the cone from below (the subgradient of least norm). So `v |v|` has the
    /// derivative zero at rest, which is the true one. The second derivative counts as zero below the smallest normal number too.
    #[must_use]
    fn length<const K: usize>(components: &[Self; K]) -> Self;
    /// The angle of the vector `(x, self)` from the first axis (rad), from `-pi` to `pi`.
    ///
    /// The derivatives of the angle are finite across the half-axis at which it jumps by `2 pi`. A zero vector has no angle, and all
    /// derivatives count as zero.
    #[must_use]
    fn atan2(self, x: Self) -> Self;

    /// Whether the number and all its derivatives are zero.
    fn is_zero(&self) -> bool;

    /// Whether the type is a number in vector registers.
    const IN_REGISTERS: bool = false;

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

    /// `f()`, inlined as [`array`](Self::array) is. Other numbers may keep it as a function, compiled once for all callers.
    #[must_use]
    fn apart<T>(f: impl FnOnce() -> T) -> T {
        f()
    }

    /// `f(self)` as a function compiled once for all callers, in vector registers too, for which a call costs some nanoseconds. The
    /// caller then does not know how the result is [carried](Self::carried_as).
    #[must_use]
    #[inline(always)]
    fn called<T>(self, f: impl FnOnce(Self) -> T) -> T {
        Self::apart(
            #[inline(always)]
            || f(self),
        )
    }

    /// `f(self, vectors)` as a function, as by [`called`](Self::called). Numbers in vector registers are all carried as eight, in the
    /// result too.
    #[must_use]
    #[inline(always)]
    fn called_on<const N: usize, const K: usize>(
        self,
        vectors: [[Self; N]; K],
        f: impl FnOnce(Self, [[Self; N]; K]) -> Option<[Self; N]>,
    ) -> Option<[Self; N]> {
        Self::apart(
            #[inline(always)]
            || f(self, vectors),
        )
    }

    /// Sine and cosine as a function, as by [`called`](Self::called).
    #[must_use]
    #[inline(always)]
    fn sin_cos_called(self) -> (Self, Self) {
        self.sin_cos()
    }

    /// This number, carried in the form of `_other`. A model compiles numbers in vector registers in two forms: eight numbers, or one
    /// number common to all eight. If only a run could decide the form, every later operation would be compiled for both.
    #[must_use]
    #[inline(always)]
    fn carried_as(self, _other: Self) -> Self {
        self
    }
    /// `self factor + term`, rounded once where the build is for machines with such an instruction.
    #[must_use]
    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        self * factor + term
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
    /// Tangent (rad). No finite one at odd multiples of `pi/2`, none of which is a number.
    #[must_use]
    #[inline(always)]
    fn tan(self) -> Self {
        self.apply(Tan)
    }
    /// Arc sine (rad). At -1 and 1 the derivative is infinite, and beyond the value is not a number.
    #[must_use]
    #[inline(always)]
    fn asin(self) -> Self {
        self.apply(Asin)
    }
    /// Arc cosine (rad). At -1 and 1 the derivative is infinite, and beyond the value is not a number.
    #[must_use]
    #[inline(always)]
    fn acos(self) -> Self {
        self.apply(Acos)
    }
    /// Arc tangent (rad), smooth everywhere.
    #[must_use]
    #[inline(always)]
    fn atan(self) -> Self {
        self.apply(Atan)
    }
    /// Hyperbolic sine.
    #[must_use]
    #[inline(always)]
    fn sinh(self) -> Self {
        self.apply(Sinh)
    }
    /// Hyperbolic cosine.
    #[must_use]
    #[inline(always)]
    fn cosh(self) -> Self {
        self.apply(Cosh)
    }
    /// Hyperbolic tangent: with a large factor before its argument a smooth [`sign`](Self::sign).
    #[must_use]
    #[inline(always)]
    fn tanh(self) -> Self {
        self.apply(Tanh)
    }
    /// The absolute value. The derivative is the [`sign`](Self::sign), at the corner zero, the mean of -1 and 1; the second is zero.
    #[must_use]
    #[inline(always)]
    fn abs(self) -> Self {
        self.apply(Abs)
    }
    /// The sign: -1, 0 of zero, or 1. All derivatives are zero, at the jump too.
    #[must_use]
    #[inline(always)]
    fn sign(self) -> Self {
        self.apply(Sign)
    }
    /// `x^p` with a constant exponent; NaN for `x < 0` unless `p` is whole.
    ///
    /// The derivative is `p x^(p - 1)`, the second `p (p - 1) x^(p - 2)`. At `x = 0` each is 0 if its power of `x` is positive, and
    /// infinite if its power is negative. So the derivative at zero is finite for `p >= 1` and `p = 0`, the second for `p >= 2`, `p = 1`
    /// and `p = 0`.
    #[must_use]
    #[inline(always)]
    fn powf(self, p: f64) -> Self {
        self.apply(Power(p))
    }
    /// The smaller of two numbers with its derivatives; NaN if either is NaN. Equal numbers give the mean of their derivatives.
    #[must_use]
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        let mean = self * 0.5 + other * 0.5;
        (other - self).where_positive(self, (self - other).where_positive(other, mean))
    }
    /// The larger of two numbers with its derivatives; NaN if either is NaN. Equal numbers give the mean of their derivatives.
    #[must_use]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let mean = self * 0.5 + other * 0.5;
        (self - other).where_positive(self, (other - self).where_positive(other, mean))
    }
}

/// The exponential. An `x` whose exponential rounds to zero skips the mathematics library: reporting the underflow would take the time
/// of ten exponentials, for hills everywhere but near them.
#[inline(always)]
pub fn exponential(x: f64) -> f64 {
    // Half of the least number there is lies at -745.13.
    if x < -746.0 { 0.0 } else { x.exp() }
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    /// Inlined for an angle within half a turn: operations can then be interleaved, which a call would prevent.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        crate::sin_cos_wrapped(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
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
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        f.value(self)
    }
    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        mul_add(self, factor, term)
    }
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        if self > 0.0 { then } else { otherwise }
    }
    #[inline(always)]
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        length(components)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
}

/// The length of a vector of numbers, without overflow or underflow in its squares.
#[inline(always)]
fn length<const K: usize>(x: &[f64; K]) -> f64 {
    /// Squares that add up to less may have lost digits: `2^53` times the smallest normal number.
    const LEAST: f64 = f64::MIN_POSITIVE / f64::EPSILON * 2.0;
    let sum = sum_of_squares(x, 1.0);
    if (LEAST..=f64::MAX).contains(&sum) { sum.sqrt() } else { scaled(x, sum) }
}

#[inline(always)]
fn sum_of_squares<const K: usize>(x: &[f64; K], scale: f64) -> f64 {
    let mut sum = 0.0;
    for x in x {
        let part = x / scale;
        sum += part * part;
    }
    sum
}

/// The length if the sum of the squares overflows or underflows: computed in units of the power of two below the largest component.
#[cold]
#[inline(never)]
fn scaled<const K: usize>(x: &[f64; K], sum: f64) -> f64 {
    let largest = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if sum.is_nan() || largest == 0.0 || largest.is_infinite() {
        return sum;
    }
    let scale = power_of_two_below(largest);
    sum_of_squares(x, scale).sqrt() * scale
}

/// The largest power of two that is not above a positive number, and at least the smallest normal number.
#[must_use]
pub fn power_of_two_below(x: f64) -> f64 {
    const EXPONENT: u64 = f64::INFINITY.to_bits();
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & EXPONENT)
}

/// `a b + c`: with one rounding where the build is for machines with a fused instruction, else with two. Without the instruction
/// `f64::mul_add` would be a call.
#[must_use]
#[inline(always)]
pub fn mul_add(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// The operators `+=`, `-=` and `*=` (by a plain number) of a [`Scalar`](crate::Scalar), from `+`, `-` and `*`:
/// `assigning_operators!([S: Scalar] Number<S>);`
#[macro_export]
macro_rules! assigning_operators {
    ([$($generics:tt)*] $number:ty) => {
        impl<$($generics)*> ::core::ops::AddAssign for $number {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl<$($generics)*> ::core::ops::SubAssign for $number {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
        impl<$($generics)*> ::core::ops::MulAssign<f64> for $number {
            #[inline(always)]
            fn mul_assign(&mut self, factor: f64) {
                *self = *self * factor;
            }
        }
    };
}
