use lagrangian::{Scalar, ScalarFunction, array};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that may be an angle with known sine and cosine: code for any number then gets them from it at no cost.
///
/// The result of arithmetic has no known sine and cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownAngle<T = f64> {
    /// The number.
    pub re: T,
    sin_cos: Option<(T, T)>,
}

impl<T> KnownAngle<T> {
    /// An angle (rad) with its sine and cosine.
    #[must_use]
    #[inline(always)]
    pub fn new(re: T, sin: T, cos: T) -> Self {
        Self { re, sin_cos: Some((sin, cos)) }
    }
}

impl<T> From<T> for KnownAngle<T> {
    /// A number without known sine and cosine.
    #[inline(always)]
    fn from(re: T) -> Self {
        Self { re, sin_cos: None }
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {$(
        impl<T: Scalar> $operator for KnownAngle<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Self::from(self.re.$method(o.re))
            }
        }
        impl<T: Scalar> $operator<f64> for KnownAngle<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: f64) -> Self {
                Self::from(self.re.$method(o))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl<T: Scalar> Neg for KnownAngle<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from(-self.re)
    }
}
lagrangian::assigning_operators!([T: Scalar] KnownAngle<T>);

impl<T: Scalar> Scalar for KnownAngle<T> {
    const IN_REGISTERS: bool = T::IN_REGISTERS;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::from(T::constant(x))
    }
    #[inline(always)]
    fn zero() -> Self {
        Self::from(T::zero())
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = match self.sin_cos {
            Some(known) => known,
            // Called: inlined in a model, this rare case would appear as often as a known angle is asked.
            None => self.re.sin_cos_called(),
        };
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
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        Self::from(self.re.apply(f))
    }
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        Self::from(self.re.where_positive(then.re, otherwise.re))
    }
    #[inline(always)]
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        let numbers: [T; K] = array(
            T::zero(),
            #[inline(always)]
            |k| components[k].re,
        );
        Self::from(T::length(&numbers))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self::from(self.re.atan2(x.re))
    }
    #[inline(always)]
    fn array<const N: usize>(f: impl Fn(usize) -> Self) -> [Self; N] {
        array(Self::zero(), f)
    }
    #[inline(always)]
    fn apart<U>(f: impl FnOnce() -> U) -> U {
        T::apart(f)
    }
    #[inline(always)]
    fn over<I, U>(items: &[I], start: U, f: impl Fn(U, &I) -> U) -> U {
        T::over(items, start, f)
    }
    #[inline(always)]
    fn carried_as(self, other: Self) -> Self {
        Self { re: self.re.carried_as(other.re), ..self }
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.re.is_zero()
    }
}
