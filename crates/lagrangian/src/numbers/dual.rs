use crate::numbers::derived::{Derived, derived_functions, linear_operators};
use crate::{Scalar, ScalarFunction, from_fn};
use scalar::mapped;
use std::ops::{Add, Div, Mul};

/// A first-order dual number with `N` independent infinitesimals: a value and its gradient.
///
/// `f(re + sum_i eps_i E_i) = f(re) + f'(re) sum_i eps_i E_i`, with `E_i E_j = 0`. The base `S` may itself be a
/// dual number or eight lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<S, const N: usize> {
    /// The value.
    pub re: S,
    /// The derivatives.
    pub eps: [S; N],
}

impl<S: Scalar, const N: usize> Dual<S, N> {
    /// The `i`-th independent variable, at the value `re`.
    #[must_use]
    #[inline(always)]
    pub fn variable(re: S, i: usize) -> Self {
        Self { re, eps: from_fn(|k| S::constant(if k == i { 1.0 } else { 0.0 })) }
    }

    /// The point `x`, each of its components an independent variable.
    #[must_use]
    #[inline(always)]
    pub fn variables(x: &[S; N]) -> [Self; N] {
        from_fn(|i| Self::variable(x[i], i))
    }

    /// A value that does not depend on the variables.
    #[must_use]
    #[inline(always)]
    pub fn fixed(re: S) -> Self {
        Self { re, eps: [S::zero(); N] }
    }

    /// `f(self)`, given the value `f` and the derivative `df` at [`Dual::re`].
    #[must_use]
    #[inline(always)]
    pub fn chain(self, f: S, df: S) -> Self {
        Self { re: f, eps: mapped(&self.eps, |e| df * e) }
    }
}

impl<S: Scalar, const N: usize> Add for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { re: self.re + o.re, eps: from_fn(|i| self.eps[i] + o.eps[i]) }
    }
}
impl<S: Scalar, const N: usize> Mul for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { re: self.re * o.re, eps: from_fn(|i| self.re * o.eps[i] + self.eps[i] * o.re) }
    }
}
impl<S: Scalar, const N: usize> Div for Dual<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let re = self.re / o.re;
        Self { re, eps: from_fn(|i| (self.eps[i] - re * o.eps[i]) / o.re) }
    }
}
linear_operators!([S: Scalar, const N: usize] Dual<S, N>);

impl<S: Scalar, const N: usize> Scalar for Dual<S, N> {
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        let chosen = |a: S, b: S| self.re.where_positive(a, b);
        Self { re: chosen(then.re, otherwise.re), eps: from_fn(|i| chosen(then.eps[i], otherwise.eps[i])) }
    }
    derived_functions!();
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.re.is_zero() && self.eps.iter().all(S::is_zero)
    }
}

impl<S: Scalar, const N: usize> Derived for Dual<S, N> {
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
        Self { re, eps: mapped(&self.eps, by) }
    }
    #[inline(always)]
    fn function(self, f: S, df: S, _ddf: impl FnOnce() -> S) -> Self {
        self.chain(f, df)
    }
}
