use crate::numbers::derived::derived_operators;
use crate::{Scalar, mapped};
use scalar::ScalarFunction;
use std::ops::{Add, Div, Mul, Neg};

/// A number with a bound on its round-off: a running error analysis.
///
/// `size` is the sum of the sizes of all intermediate results, each times the derivative of the value in that result. To first
/// order the value differs from that in exact arithmetic by at most `size` times the unit of rounding, `2^-53`. A sum that
/// cancels keeps the size of its terms, so that a residual can be told from the rounding of the terms that make it up.
///
/// The operations are calls, never inlined: they are for rare steps, and models on them compile sooner.
///
/// A function on `Dual<Rounded, N>` gives derivatives with such bounds. (Wilkinson 1986, SIAM Rev. 28, 547-568; Higham 2002,
/// Accuracy and Stability of Numerical Algorithms, section 3.3.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounded {
    /// The value.
    pub value: f64,
    /// The bound on its round-off, in units of `2^-53`.
    pub size: f64,
}

impl Rounded {
    /// A number that is known exactly.
    #[must_use]
    #[inline]
    pub fn exact(value: f64) -> Self {
        Self { value, size: 0.0 }
    }

    /// A number that has been rounded once.
    #[must_use]
    #[inline]
    pub fn once(value: f64) -> Self {
        Self { value, size: value.abs() }
    }

    /// The value in units of the round-off of its terms; infinite where that is NaN. Below the smallest normal number round-off no longer
    /// shrinks with the terms, and every number is round-off.
    #[must_use]
    #[inline]
    pub fn roundings(&self) -> f64 {
        let unit = 0.5 * f64::EPSILON * self.size + f64::MIN_POSITIVE;
        let count = self.value.abs() / unit;
        if count.is_nan() || self.size.is_infinite() { f64::INFINITY } else { count }
    }

    /// A result whose own rounding is `units` of the last place, with the round-off of its operand.
    #[inline]
    fn result(value: f64, brought: f64, units: f64) -> Self {
        // An exact operand brings no round-off, however steep the function is.
        Self { value, size: brought + units * value.abs() }
    }

    /// `f(self)`, with the slope of `f` there. Functions of the standard library are good to a unit in the last place, which is
    /// two units of rounding.
    #[inline]
    fn function(self, value: f64, slope: f64) -> Self {
        let brought = if self.size > 0.0 { slope.abs() * self.size } else { 0.0 };
        Self::result(value, brought, 2.0)
    }
}

impl Add for Rounded {
    type Output = Self;
    #[inline(never)]
    fn add(self, o: Self) -> Self {
        Self::result(self.value + o.value, self.size + o.size, 1.0)
    }
}
impl Mul for Rounded {
    type Output = Self;
    #[inline(never)]
    fn mul(self, o: Self) -> Self {
        Self::result(self.value * o.value, self.value.abs() * o.size + self.size * o.value.abs(), 1.0)
    }
}
impl Div for Rounded {
    type Output = Self;
    #[inline(never)]
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        Self::result(value, (self.size + value.abs() * o.size) / o.value.abs(), 1.0)
    }
}
impl Neg for Rounded {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}
impl Add<f64> for Rounded {
    type Output = Self;
    #[inline(never)]
    fn add(self, o: f64) -> Self {
        Self::result(self.value + o, self.size, 1.0)
    }
}
impl Mul<f64> for Rounded {
    type Output = Self;
    #[inline(never)]
    fn mul(self, o: f64) -> Self {
        Self::result(self.value * o, self.size * o.abs(), 1.0)
    }
}
impl Div<f64> for Rounded {
    type Output = Self;
    #[inline(never)]
    fn div(self, o: f64) -> Self {
        Self::result(self.value / o, self.size / o.abs(), 1.0)
    }
}
derived_operators!([] Rounded);

impl Scalar for Rounded {
    #[inline]
    fn constant(x: f64) -> Self {
        Self::exact(x)
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Scalar::sin_cos(self.value);
        (self.function(sin, cos), self.function(cos, sin))
    }
    #[inline(never)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.function(value, value)
    }
    #[inline(never)]
    fn ln(self) -> Self {
        self.function(self.value.ln(), self.value.recip())
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.function(value, 0.5 / value)
    }
    #[inline(never)]
    fn powi(self, n: i32) -> Self {
        let slope = if n == 0 { 0.0 } else { f64::from(n) * self.value.powi(n - 1) };
        let brought = if self.size > 0.0 { slope.abs() * self.size } else { 0.0 };
        Self::result(self.value.powi(n), brought, f64::from(n.unsigned_abs()).max(1.0))
    }
    #[inline(never)]
    fn recip(self) -> Self {
        let value = self.value.recip();
        Self::result(value, value * value * self.size, 1.0)
    }
    #[inline(never)]
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        let value = f.value(self.value);
        self.function(value, f.slope(self.value, value))
    }
    #[inline(never)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        if self.value > 0.0 { then } else { otherwise }
    }
    /// The slopes of the length are at most one, in sum of squares too.
    #[inline(never)]
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        let brought = f64::length(&mapped(components, |x| x.size));
        Self::result(f64::length(&mapped(components, |x| x.value)), brought, 2.0)
    }
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let moved = (x.value * self.size).abs() + (self.value * x.size).abs();
        let brought = if moved > 0.0 { moved / square } else { 0.0 };
        Self::result(self.value.atan2(x.value), brought, 2.0)
    }
    #[inline]
    fn is_zero(&self) -> bool {
        self.value == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;
    use proptest::prelude::*;

    /// The slope of two springs about the place `x` of a body, `k (x - a) + k (x - b)`, times minus one.
    fn springs<S: Scalar>(x: S, k: f64, [a, b]: [f64; 2]) -> S {
        (x - a).squared() * (-0.5 * k) - (x - b).squared() * (0.5 * k)
    }

    #[test]
    fn a_sum_that_cancels_keeps_the_size_of_its_terms() {
        let x = Dual::variable(Rounded::once(0.4), 0);
        let [force]: [Rounded; 1] = springs(x, 1e6, [0.1, 0.7]).eps;
        // The force of one spring is 3e5 N; the two cancel but for the rounding of the place and of the products.
        assert!(force.value.abs() < 1e-9 && force.size > 6e5 && force.size < 1e7, "{force:?}");
        assert!(force.roundings() <= 1.0);
        // Off the balance by more than rounding.
        let [force]: [Rounded; 1] = springs(Dual::variable(Rounded::once(0.4 + 1e-12), 0), 1e6, [0.1, 0.7]).eps;
        assert!(force.roundings() > 100.0, "{force:?}");
    }

    #[test]
    fn an_exact_zero_has_no_rounding() {
        let root = Rounded::exact(0.0).sqrt();
        assert_eq!((root.value, root.size, root.roundings()), (0.0, 0.0, 0.0));
        assert!(Rounded::exact(1e-320).roundings() < 1.0);
        assert!(Rounded { value: f64::NAN, size: 1.0 }.roundings().is_infinite());
        assert!(Rounded { value: 1.0, size: f64::INFINITY }.roundings().is_infinite());
    }

    /// A function with most of the operations.
    fn mixture<S: Scalar>(x: S, y: S) -> S {
        let (sin, cos) = (x * y).sin_cos();
        let inner = (sin * 3.0 - cos / (y.squared() + 1.5)).exp() - (x.squared() + 0.1).ln();
        inner.powi(3) / (x.squared() + y.squared() + 0.3).sqrt() - (y + 4.0).recip() * x
    }

    /// A number and what rounding left out of it, in twice the digits: `x` is exact in `f64`.
    fn in_single(x: f64) -> f64 {
        f64::from(x as f32)
    }

    proptest! {
        /// Evaluated with numbers that are each moved by up to a unit of rounding, a function moves by no more than its bound.
        #[test]
        fn the_bound_holds(x in -2.0..2.0f64, y in -2.0..2.0f64, by in prop::array::uniform2(-1.0..1.0f64)) {
            let (x, y) = (in_single(x), in_single(y));
            // In units of single precision, far above the rounding of the evaluations themselves.
            let unit = f64::from(f32::EPSILON) * 0.5;
            let bound = mixture(Rounded::once(x), Rounded::once(y));
            let moved = mixture(x * (1.0 + by[0] * unit), y * (1.0 + by[1] * unit));
            // To first order; the second is a ten thousandth of it.
            prop_assert!((moved - mixture(x, y)).abs() <= bound.size * unit * 1.001 + 1e-13);
        }
    }
}
