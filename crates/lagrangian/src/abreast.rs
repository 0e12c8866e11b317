use crate::scalar::{derived_operators, functions_of_each_lane};
use crate::sincos::near;
use crate::{Scalar, array};
use std::ops::{Add, Div, Mul, Neg};

/// `R` numbers of one lane each, side by side in a loop over lanes: `for i in 0..8 { .. }`, whose body the compiler then turns
/// into vector instructions for `8 R` trajectories, `R` of them interleaved.
///
/// Unlike [`Lanes`](crate::Lanes) it leaves the lanes to the loop, so that a long body keeps them together. Nothing in it
/// branches: an angle beyond 10^6 rad has no sine, but NaN. An angle may carry its sine and cosine, found before
/// ([`turned`](Self::turned)); what is computed from it carries none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Abreast<const R: usize> {
    /// The numbers.
    pub of: [f64; R],
    sin_cos: Option<([f64; R], [f64; R])>,
}

impl<const R: usize> Abreast<R> {
    /// The numbers, as they are.
    #[must_use]
    #[inline(always)]
    pub fn new(of: [f64; R]) -> Self {
        Self { of, sin_cos: None }
    }

    /// Angles (rad) that carry their sine and cosine.
    #[must_use]
    #[inline(always)]
    pub fn turned(angle: [f64; R], sin: [f64; R], cos: [f64; R]) -> Self {
        Self { of: angle, sin_cos: Some((sin, cos)) }
    }

    /// Absolute values.
    #[must_use]
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self::new(array(
            0.0,
            #[inline(always)]
            |r| f(self.of[r]),
        ))
    }

    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self::new(array(
            0.0,
            #[inline(always)]
            |r| f(self.of[r], o.of[r]),
        ))
    }
}

impl<const R: usize> Add for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(
            o,
            #[inline(always)]
            |a, b| a + b,
        )
    }
}
impl<const R: usize> Mul for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(
            o,
            #[inline(always)]
            |a, b| a * b,
        )
    }
}
impl<const R: usize> Div for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.zip(
            o,
            #[inline(always)]
            |a, b| a / b,
        )
    }
}
impl<const R: usize> Neg for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(
            #[inline(always)]
            |a| -a,
        )
    }
}
impl<const R: usize> Add<f64> for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        self.map(
            #[inline(always)]
            |a| a + o,
        )
    }
}
impl<const R: usize> Mul<f64> for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        self.map(
            #[inline(always)]
            |a| a * o,
        )
    }
}
impl<const R: usize> Div<f64> for Abreast<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: f64) -> Self {
        self.map(
            #[inline(always)]
            |a| a / o,
        )
    }
}
derived_operators!([const R: usize] Abreast<R>);

impl<const R: usize> Scalar for Abreast<R> {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::new([x; R])
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = match self.sin_cos {
            Some(known) => known,
            None => {
                let (mut sin, mut cos) = ([0.0; R], [0.0; R]);
                for r in 0..R {
                    (sin[r], cos[r]) = near(self.of[r]);
                }
                (sin, cos)
            }
        };
        (Self::new(sin), Self::new(cos))
    }
    #[inline(always)]
    fn array<const N: usize>(f: impl Fn(usize) -> Self) -> [Self; N] {
        array(Self::new([0.0; R]), f)
    }
    functions_of_each_lane!();
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.of.iter().all(Scalar::is_zero)
    }
}
