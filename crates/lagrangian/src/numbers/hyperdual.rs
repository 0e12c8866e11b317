use crate::numbers::derived::{Derived, derived_functions, linear_operators};
use crate::{Scalar, ScalarFunction, from_fn};
use scalar::mapped;
use std::ops::{Add, Div, Mul};

/// A second-order dual number with two groups of infinitesimals, `P` of the first and `Q` of the second.
///
/// One evaluation gives the value, both gradients and the mixed block `d^2 f / da_i db_j`. For a discrete Lagrangian
/// with the first group on `q0` and the second on `q1` that is all a step needs, without the two blocks
/// `d^2 f / da da` and `d^2 f / db db` that it does not. (Fike and Alonso 2011, AIAA 2011-886, for `P = Q = 1`.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperDual<S, const P: usize, const Q: usize> {
    /// The value.
    pub re: S,
    /// Derivatives in the first group.
    pub e1: [S; P],
    /// Derivatives in the second group.
    pub e2: [S; Q],
    /// Mixed second derivatives, `e12[i][j] = d^2 f / da_i db_j`.
    pub e12: [[S; Q]; P],
}

impl<S: Scalar, const P: usize, const Q: usize> HyperDual<S, P, Q> {
    /// A value that does not depend on the variables.
    #[must_use]
    #[inline(always)]
    pub fn fixed(re: S) -> Self {
        Self { re, e1: [S::zero(); P], e2: [S::zero(); Q], e12: [[S::zero(); Q]; P] }
    }

    /// A value that depends linearly on the variables, with the given gradients.
    #[must_use]
    #[inline(always)]
    pub fn linear(re: S, e1: [S; P], e2: [S; Q]) -> Self {
        Self { re, e1, e2, e12: [[S::zero(); Q]; P] }
    }

    /// `f(self)`, given the value `f` and the derivatives `df`, `ddf` at [`HyperDual::re`].
    #[must_use]
    #[inline(always)]
    pub fn chain(self, f: S, df: S, ddf: S) -> Self {
        Self {
            re: f,
            e1: mapped(&self.e1, |e| df * e),
            e2: mapped(&self.e2, |e| df * e),
            e12: from_fn(|i| {
                let ddf_i = ddf * self.e1[i];
                from_fn(|j| df * self.e12[i][j] + ddf_i * self.e2[j])
            }),
        }
    }
}

impl<S: Scalar, const P: usize, const Q: usize> Add for HyperDual<S, P, Q> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self {
            re: self.re + o.re,
            e1: from_fn(|i| self.e1[i] + o.e1[i]),
            e2: from_fn(|j| self.e2[j] + o.e2[j]),
            e12: from_fn(|i| from_fn(|j| self.e12[i][j] + o.e12[i][j])),
        }
    }
}
impl<S: Scalar, const P: usize, const Q: usize> Mul for HyperDual<S, P, Q> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self {
            re: self.re * o.re,
            e1: from_fn(|i| self.re * o.e1[i] + self.e1[i] * o.re),
            e2: from_fn(|j| self.re * o.e2[j] + self.e2[j] * o.re),
            e12: from_fn(|i| {
                from_fn(|j| self.re * o.e12[i][j] + self.e1[i] * o.e2[j] + self.e2[j] * o.e1[i] + self.e12[i][j] * o.re)
            }),
        }
    }
}
impl<S: Scalar, const P: usize, const Q: usize> Div for HyperDual<S, P, Q> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let re = self.re / o.re;
        let e1: [S; P] = from_fn(|i| (self.e1[i] - re * o.e1[i]) / o.re);
        let e2: [S; Q] = from_fn(|j| (self.e2[j] - re * o.e2[j]) / o.re);
        let e12 =
            from_fn(|i| from_fn(|j| (self.e12[i][j] - re * o.e12[i][j] - e1[i] * o.e2[j] - e2[j] * o.e1[i]) / o.re));
        Self { re, e1, e2, e12 }
    }
}
linear_operators!([S: Scalar, const P: usize, const Q: usize] HyperDual<S, P, Q>);

impl<S: Scalar, const P: usize, const Q: usize> Scalar for HyperDual<S, P, Q> {
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        let chosen = |a: S, b: S| self.re.where_positive(a, b);
        Self {
            re: chosen(then.re, otherwise.re),
            e1: from_fn(|i| chosen(then.e1[i], otherwise.e1[i])),
            e2: from_fn(|j| chosen(then.e2[j], otherwise.e2[j])),
            e12: from_fn(|i| from_fn(|j| chosen(then.e12[i][j], otherwise.e12[i][j]))),
        }
    }
    derived_functions!();
    #[inline(always)]
    fn is_zero(&self) -> bool {
        let first = self.re.is_zero() && self.e1.iter().chain(&self.e2).all(S::is_zero);
        first && self.e12.iter().flatten().all(S::is_zero)
    }
}

impl<S: Scalar, const P: usize, const Q: usize> Derived for HyperDual<S, P, Q> {
    type Base = S;
    const SECOND: bool = true;
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
        Self {
            re,
            e1: mapped(&self.e1, &by),
            e2: mapped(&self.e2, &by),
            e12: mapped(&self.e12, |row| mapped(&row, &by)),
        }
    }
    #[inline(always)]
    fn function(self, f: S, df: S, ddf: impl FnOnce() -> S) -> Self {
        self.chain(f, df, ddf())
    }
}
