use crate::numbers::derived::{Derived, derived_functions, linear_operators};
use crate::{Scalar, ScalarFunction, array};
use std::ops::{Add, Div, Mul};

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

impl<S: Scalar> Gradient<S, 1> {
    /// A number that changes at the given rate along the one direction.
    #[must_use]
    pub fn moving(re: S, rate: S) -> Self {
        Self { re, parts: Some([rate]) }
    }
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
        array(Self::fixed(S::zero()), |i| Self::fixed(x[i]))
    }

    /// The point `x`, each of its components a variable.
    #[must_use]
    #[inline(always)]
    pub fn variables<const K: usize>(x: &[S; K]) -> [Self; K] {
        array(Self::fixed(S::zero()), |i| Self::variable(x[i], i))
    }

    /// The point `x`, its components from number `from` on the variables, and the others numbers that do not depend on them.
    #[must_use]
    #[inline(always)]
    pub fn some_variables<const K: usize>(x: &[S; K], from: usize) -> [Self; K] {
        array(Self::fixed(S::zero()), |i| {
            if (from..from + N).contains(&i) { Self::variable(x[i], i - from) } else { Self::fixed(x[i]) }
        })
    }

    /// The derivatives in the first `K` variables; zero in those that there are not.
    #[must_use]
    #[inline(always)]
    pub fn gradient<const K: usize>(&self) -> [S; K] {
        let parts = self.parts.unwrap_or([S::zero(); N]);
        array(S::zero(), |i| if i < N { parts[i] } else { S::zero() })
    }

    #[inline(always)]
    fn with(self, o: Self, re: S, one: impl Fn(S) -> S, other: impl Fn(S) -> S) -> Self {
        let parts = match (self.parts, o.parts) {
            (None, None) => None,
            (Some(a), None) => Some(array(S::zero(), |i| one(a[i]))),
            (None, Some(b)) => Some(array(S::zero(), |i| other(b[i]))),
            (Some(a), Some(b)) => Some(array(S::zero(), |i| one(a[i]) + other(b[i]))),
        };
        Self { re, parts }
    }
}

impl<S: Scalar, const N: usize> Add for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.with(o, self.re + o.re, |a| a, |b| b)
    }
}
impl<S: Scalar, const N: usize> Mul for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.with(o, self.re * o.re, |a| a * o.re, |b| self.re * b)
    }
}
impl<S: Scalar, const N: usize> Div for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let re = self.re / o.re;
        self.with(o, re, |a| a / o.re, |b| -(re * b) / o.re)
    }
}
linear_operators!([S: Scalar, const N: usize] Gradient<S, N>);

impl<S: Scalar, const N: usize> Scalar for Gradient<S, N> {
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        then.with(
            otherwise,
            self.re.where_positive(then.re, otherwise.re),
            |a| self.re.where_positive(a, S::zero()),
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
    fn linear_in(self, re: S, by: impl Fn(S) -> S) -> Self {
        let parts = self.parts.map(|e| array(S::zero(), |i| by(e[i])));
        Self { re, parts }
    }
    #[inline(always)]
    fn function(self, f: S, df: S, _ddf: impl FnOnce() -> S) -> Self {
        self.linear_in(f, |e| df * e)
    }
}
