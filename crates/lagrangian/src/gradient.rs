use crate::derived::{Derived, derived_functions, derived_operators};
use crate::{Scalar, ScalarFunction, array};
use std::ops::{Add, Div, Mul, Neg};

/// A number with its gradient in `N` variables, or a number that depends on none of them; which of the two is known when a model is
/// compiled, after inlining.
///
/// If a Lagrangian is differentiated in its velocities, functions of the configuration are then computed in plain numbers, for which
/// [`Dual`](crate::Dual) would carry zeros. Functions of the variables cost the same in both. (A missing gradient hides an infinity or a
/// NaN that zeros would be multiplied by.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradient<S, const N: usize> {
    /// The value.
    pub re: S,
    /// The derivatives; none of a number that does not depend on the variables.
    parts: Option<[S; N]>,
}

/// Calls a function of systems of `N` coordinates whose last parameter is the length of gradients: of five to eight coordinates it is
/// eight, padded with zeros, which fills whole vector registers.
macro_rules! by_places {
    ($by:ident::<$($parameter:ident),+>$arguments:tt) => {
        match N {
            5..=8 => $by::<$($parameter,)+ 8>$arguments,
            _ => $by::<$($parameter,)+ N>$arguments,
        }
    };
}
pub(crate) use by_places;

impl<S: Scalar, const N: usize> Gradient<S, N> {
    /// A value that does not depend on the variables.
    #[must_use]
    #[inline(always)]
    pub fn fixed(re: S) -> Self {
        Self { re, parts: None }
    }

    /// The `i`-th variable, at the value `re`.
    #[must_use]
    #[inline(always)]
    pub fn variable(re: S, i: usize) -> Self {
        let part = |k| S::constant(if k == i { 1.0 } else { 0.0 });
        Self { re, parts: Some(array(S::zero(), part)) }
    }

    /// Values that do not depend on the variables.
    #[must_use]
    #[inline(always)]
    pub fn all_fixed<const K: usize>(x: &[S; K]) -> [Self; K] {
        array(
            Self::fixed(S::zero()),
            #[inline(always)]
            |i| Self::fixed(x[i]),
        )
    }

    /// The point `x`, each of its components a variable.
    #[must_use]
    #[inline(always)]
    pub fn variables<const K: usize>(x: &[S; K]) -> [Self; K] {
        array(
            Self::fixed(S::zero()),
            #[inline(always)]
            |i| Self::variable(x[i], i),
        )
    }

    /// The point `x`, its components from number `from` on the variables, and the others numbers that do not depend on them.
    #[must_use]
    #[inline(always)]
    pub fn some_variables<const K: usize>(x: &[S; K], from: usize) -> [Self; K] {
        array(
            Self::fixed(S::zero()),
            #[inline(always)]
            |i| if (from..from + N).contains(&i) { Self::variable(x[i], i - from) } else { Self::fixed(x[i]) },
        )
    }

    /// The derivatives in the first `K` variables; zero in those that there are not.
    #[must_use]
    #[inline(always)]
    pub fn gradient<const K: usize>(&self) -> [S; K] {
        let parts = self.parts.unwrap_or([S::zero(); N]);
        array(
            S::zero(),
            #[inline(always)]
            |i| if i < N { parts[i] } else { S::zero() },
        )
    }

    #[inline(always)]
    fn chain(self, f: S, df: S) -> Self {
        self.scaled(
            f,
            #[inline(always)]
            |e| df * e,
        )
    }

    #[inline(always)]
    fn scaled(self, re: S, by: impl Fn(S) -> S) -> Self {
        let parts = self.parts.map(
            #[inline(always)]
            |e| {
                array(
                    S::zero(),
                    #[inline(always)]
                    |i| by(e[i]),
                )
            },
        );
        Self { re, parts }
    }

    #[inline(always)]
    fn with(self, o: Self, re: S, one: impl Fn(S) -> S, other: impl Fn(S) -> S) -> Self {
        let parts = match (self.parts, o.parts) {
            (None, None) => None,
            (Some(a), None) => Some(array(
                S::zero(),
                #[inline(always)]
                |i| one(a[i]),
            )),
            (None, Some(b)) => Some(array(
                S::zero(),
                #[inline(always)]
                |i| other(b[i]),
            )),
            (Some(a), Some(b)) => Some(array(
                S::zero(),
                #[inline(always)]
                |i| one(a[i]) + other(b[i]),
            )),
        };
        Self { re, parts }
    }
}

impl<S: Scalar, const N: usize> Add for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.with(
            o,
            self.re + o.re,
            #[inline(always)]
            |a| a,
            #[inline(always)]
            |b| b,
        )
    }
}
impl<S: Scalar, const N: usize> Mul for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.with(
            o,
            self.re * o.re,
            #[inline(always)]
            |a| a * o.re,
            #[inline(always)]
            |b| self.re * b,
        )
    }
}
impl<S: Scalar, const N: usize> Div for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let re = self.re / o.re;
        self.with(
            o,
            re,
            #[inline(always)]
            |a| a / o.re,
            #[inline(always)]
            |b| -(re * b) / o.re,
        )
    }
}
impl<S: Scalar, const N: usize> Neg for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.scaled(
            -self.re,
            #[inline(always)]
            |e| -e,
        )
    }
}
impl<S: Scalar, const N: usize> Add<f64> for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        Self { re: self.re + o, ..self }
    }
}
impl<S: Scalar, const N: usize> Mul<f64> for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        self.scaled(
            self.re * o,
            #[inline(always)]
            |e| e * o,
        )
    }
}
impl<S: Scalar, const N: usize> Div<f64> for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: f64) -> Self {
        self.scaled(
            self.re / o,
            #[inline(always)]
            |e| e / o,
        )
    }
}
derived_operators!([S: Scalar, const N: usize] Gradient<S, N>);

impl<S: Scalar, const N: usize> Scalar for Gradient<S, N> {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::fixed(S::constant(x))
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.re.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let f = self.re.exp();
        self.chain(f, f)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.re.ln(), self.re.recip())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let f = self.re.sqrt();
        self.chain(f, f.recip() * 0.5)
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::constant(1.0);
        }
        self.chain(self.re.powi(n), self.re.powi(n - 1) * f64::from(n))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let f = self.re.recip();
        self.chain(f, -(f * f))
    }
    #[inline(always)]
    fn apply<F: ScalarFunction>(self, function: F) -> Self {
        let f = self.re.apply(function);
        self.chain(f, function.slope(self.re, f))
    }
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        then.with(
            otherwise,
            self.re.where_positive(then.re, otherwise.re),
            #[inline(always)]
            |a| self.re.where_positive(a, S::zero()),
            #[inline(always)]
            |b| self.re.where_positive(S::zero(), b),
        )
    }
    derived_functions!();
    #[inline(always)]
    fn array<const K: usize>(f: impl Fn(usize) -> Self) -> [Self; K] {
        array(Self::fixed(S::zero()), f)
    }
    #[inline(always)]
    fn apart<T>(f: impl FnOnce() -> T) -> T {
        f()
    }
    #[inline(always)]
    fn over<I, T>(items: &[I], mut start: T, f: impl Fn(T, &I) -> T) -> T {
        for item in items {
            start = f(start, item);
        }
        start
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.re.is_zero() && self.parts.iter().flatten().all(S::is_zero)
    }
}

impl<S: Scalar, const N: usize> Derived for Gradient<S, N> {
    type Base = S;
    const SECOND: bool = false;
    #[inline(always)]
    fn lifted(value: S) -> Self {
        Self::fixed(value)
    }
    #[inline(always)]
    fn value(self) -> S {
        self.re
    }
    #[inline(always)]
    fn at(self, re: S) -> Self {
        Self { re, ..self }
    }
    #[inline(always)]
    fn times(self, factor: S) -> Self {
        self.chain(self.re * factor, factor)
    }
}
