use crate::History;
use crate::convergence::tolerances::SETTLED;
use crate::convergence::{Convergence, CorrectionKind, Demand};
use lagrangian::linear::Singular;
use thiserror::Error;

/// Equations whose Newton correction can be computed.
pub trait Equations<const U: usize> {
    /// The correction `-F'(x)^-1 F(x)` at `x`.
    ///
    /// # Errors
    /// [`Singular`] if `F'(x)` has no inverse.
    fn correction(&mut self, x: &[f64; U]) -> Result<[f64; U], Singular>;

    /// The largest residual at `x`, from which the last correction was made, in units of the round-off of its terms
    /// ([`Rounded::roundings`](lagrangian::Rounded::roundings)); `None` if it is not known. Called only if corrections stall.
    fn roundings(&self, _x: &[f64; U]) -> Option<f64> {
        None
    }

    /// Makes later solutions of the linear equations with less round-off. Returns false if that is not possible. Called if corrections
    /// stall although the residuals are not round-off.
    fn refine(&mut self) -> bool {
        false
    }

    /// A correction below this leads to no other solution; zero if no such bound is known.
    #[inline(always)]
    fn near(&self) -> f64 {
        0.0
    }

    /// Whether the last correction was simplified, `-F'(y)^-1 F(x)` with an earlier point `y` in place of `x`. Such corrections
    /// shrink by about the same factor from each to the next.
    #[inline(always)]
    fn is_simplified(&self) -> bool {
        false
    }
}

/// Equations in `S` blocks of `U` unknowns each.
pub(crate) trait BlockEquations<const U: usize, const S: usize> {
    /// The correction `-F'(x)^-1 F(x)` at `x`.
    fn correction(&mut self, x: &[[f64; U]; S]) -> Result<[[f64; U]; S], Singular>;

    /// The largest residual at `x`, from which the last correction was made, in units of the round-off of its terms.
    fn roundings(&self, x: &[[f64; U]; S]) -> Option<f64>;

    /// Makes later solutions of the linear equations with less round-off. Returns false if that is not possible.
    fn refine(&mut self) -> bool {
        false
    }

    /// A correction below this leads to no other solution; zero if no such bound is known.
    #[inline(always)]
    fn near(&self) -> f64 {
        0.0
    }

    /// How the last correction was made.
    #[inline(always)]
    fn kind(&self) -> CorrectionKind {
        CorrectionKind::Newton
    }

    /// Whether the equations are met at the point of the last correction, to the round-off of their terms: that correction ends the search.
    /// The correction is added all the same: what a frozen Jacobian leaves out has one sign in every step, and would add up.
    #[inline(always)]
    fn is_met(&self) -> bool {
        false
    }
}

/// One block.
struct Single<'a, E>(&'a mut E);

impl<E: Equations<U>, const U: usize> BlockEquations<U, 1> for Single<'_, E> {
    #[inline(always)]
    fn correction(&mut self, [x]: &[[f64; U]; 1]) -> Result<[[f64; U]; 1], Singular> {
        self.0.correction(x).map(|correction| [correction])
    }

    #[inline(always)]
    fn roundings(&self, [x]: &[[f64; U]; 1]) -> Option<f64> {
        self.0.roundings(x)
    }

    #[inline(always)]
    fn refine(&mut self) -> bool {
        self.0.refine()
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        self.0.near()
    }

    #[inline(always)]
    fn kind(&self) -> CorrectionKind {
        if self.0.is_simplified() { CorrectionKind::Simplified } else { CorrectionKind::Newton }
    }
}

/// Newton's method with an exact Jacobian and a test for every component by itself: [`Convergence`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newton {
    /// Relative tolerance of every component. The default, `4 * 2^-52`, asks for all digits.
    pub tolerance: f64,
    /// Iterations after which the method fails.
    pub max_iterations: u32,
}

impl Default for Newton {
    fn default() -> Self {
        Self { tolerance: SETTLED, max_iterations: 30 }
    }
}

/// Why Newton's method found no solution.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NewtonError {
    /// The Jacobian has no inverse.
    #[error("{source} at iteration {iteration}")]
    Singular {
        /// The iteration, from 1.
        iteration: u32,
        /// The matrix's defect.
        source: Singular,
        /// The corrections before.
        history: History,
    },
    /// The corrections grow.
    #[error("Newton's corrections grow: {correction:.2e} after {before:.2e}, relative, at iteration {iteration}")]
    Diverged {
        /// The iteration, from 1.
        iteration: u32,
        /// The largest correction, relative to the largest component there was.
        correction: f64,
        /// The one before it.
        before: f64,
        /// The last corrections, relative.
        history: History,
    },
    /// The iteration limit is reached.
    #[error("no convergence in {iterations} iterations; the last relative correction is {correction:.2e}")]
    IterationLimit {
        /// The number of iterations made.
        iterations: u32,
        /// The largest correction, relative to the largest component there was.
        correction: f64,
        /// The last corrections, relative.
        history: History,
    },
    /// An unknown is infinite or not a number.
    #[error("the unknowns are no longer finite at iteration {iteration}")]
    NotFinite {
        /// The iteration, from 1.
        iteration: u32,
        /// The corrections before, relative.
        history: History,
    },
}

impl NewtonError {
    /// The equations are singular from the start.
    pub(crate) fn singular(source: Singular) -> Self {
        Self::Singular { iteration: 1, source, history: History::new() }
    }
}

impl Newton {
    /// Corrects `x` until every component has converged; returns the number of iterations.
    ///
    /// # Errors
    /// [`NewtonError`]; `x` is then the last iterate.
    #[inline]
    pub fn solve<const U: usize>(
        &self,
        equations: &mut impl Equations<U>,
        x: &mut [f64; U],
    ) -> Result<u32, NewtonError> {
        self.search(equations, x).map(|found| found.iterations)
    }

    /// As [`Self::solve`], and tells how the solution was found.
    #[inline]
    pub(crate) fn search<const U: usize>(
        &self,
        equations: &mut impl Equations<U>,
        x: &mut [f64; U],
    ) -> Result<NewtonRoot, NewtonError> {
        self.search_blocks(&mut Single(equations), std::array::from_mut(x))
    }

    /// As [`Self::search`], for unknowns in blocks.
    #[inline]
    pub(crate) fn search_blocks<const U: usize, const S: usize>(
        &self,
        equations: &mut impl BlockEquations<U, S>,
        x: &mut [[f64; U]; S],
    ) -> Result<NewtonRoot, NewtonError> {
        let (start, mut last, mut rounding) = (*x, [[0.0; U]; S], [[false; U]; S]);
        let flat = (last.as_flattened_mut(), rounding.as_flattened_mut());
        let mut convergence = Convergence::new(flat.0, flat.1, start.as_flattened());
        let (mut refinable, near) = (true, equations.near());
        loop {
            let correction = equations.correction(x).map_err(|source| NewtonError::Singular {
                iteration: convergence.made() + 1,
                source,
                history: convergence.history(),
            })?;
            let root = |convergence: &Convergence<'_>| NewtonRoot {
                iterations: convergence.made(),
                first: convergence.first(),
                certain: convergence.is_certain(),
            };
            let at = *x;
            for (x, d) in x.as_flattened_mut().iter_mut().zip(correction.as_flattened()) {
                *x += d;
            }
            if equations.is_met() {
                return Ok(root(&convergence));
            }
            let (kind, tolerance, limit) = (equations.kind(), self.tolerance, self.max_iterations);
            let demand = Demand { kind, tolerance, limit, refinable, near };
            let (x, correction) = (x.as_flattened(), correction.as_flattened());
            if convergence.check(demand, x, correction, || equations.roundings(&at))? {
                return Ok(root(&convergence));
            }
            if refinable && convergence.is_unmet() {
                refinable = equations.refine();
            }
        }
    }
}

/// How Newton's method found a solution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NewtonRoot {
    pub(crate) iterations: u32,
    /// The size of the first correction.
    pub(crate) first: f64,
    /// Whether the corrections contracted from the start, so that the solution is the one near there: the bound of Newton and
    /// Kantorovich, `h0 <= 1/2` with `h0 = 2 theta` to first order, gives one solution near the start; and the Jacobian has an
    /// inverse all the way there, so that its determinant keeps its sign. (Deuflhard 2004, Newton Methods for Nonlinear
    /// Problems, sections 2.1 and 3.3.)
    pub(crate) certain: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 4.0 * f64::EPSILON;

    /// `x = 1` and `y = 1e-3` with a frozen Jacobian: corrections shrink by `1 - rate`.
    struct Frozen {
        rate: f64,
    }

    impl BlockEquations<2, 1> for Frozen {
        fn correction(&mut self, [x]: &[[f64; 2]; 1]) -> Result<[[f64; 2]; 1], Singular> {
            Ok([[self.rate * (1.0 - x[0]), self.rate * (1e-3 - x[1])]])
        }

        fn roundings(&self, _x: &[[f64; 2]; 1]) -> Option<f64> {
            Some(f64::INFINITY)
        }

        fn kind(&self) -> CorrectionKind {
            CorrectionKind::Frozen
        }
    }

    /// The number of corrections, and the error relative to the solution.
    fn search(rate: f64) -> Option<(u32, f64)> {
        let mut x = [[0.9, 0.9e-3]];
        let found =
            Newton { tolerance: TOLERANCE, max_iterations: 9 }.search_blocks(&mut Frozen { rate }, &mut x).ok()?;
        Some((found.iterations, f64::max((x[0][0] - 1.0).abs(), (1e3 * x[0][1] - 1.0).abs())))
    }

    #[test]
    fn a_good_frozen_jacobian_serves() {
        for rate in [1.0, 0.999, 0.99] {
            let (made, error) = search(rate).unwrap();
            println!("rate {rate}: {made} corrections, error {error:e}");
            assert!(error <= 4.0 * TOLERANCE);
        }
        assert!(search(0.99).unwrap().0 > search(1.0).unwrap().0);
    }

    /// Corrections that shrink slowly, corrections that shrink by enough but are too many, and NaN.
    #[test]
    fn a_poor_one_is_given_up() {
        assert_eq!([0.8, 0.9, f64::NAN].map(search), [None; 3]);
    }
}
