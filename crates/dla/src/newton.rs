use crate::History;
use lagrangian::linear::{Singular, largest};
use thiserror::Error;

/// Equations whose Newton correction can be computed.
pub trait Equations<const U: usize> {
    /// The correction `-F'(x)^-1 F(x)` at `x`.
    ///
    /// # Errors
    /// [`Singular`] where `F'(x)` has no inverse.
    fn correction(&mut self, x: &[f64; U]) -> Result<[f64; U], Singular>;

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

    /// Whether the last correction was simplified.
    #[inline(always)]
    fn is_simplified(&self) -> bool {
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
    fn is_simplified(&self) -> bool {
        self.0.is_simplified()
    }
}

/// Newton's method with an exact Jacobian and a stopping rule for every component by itself.
///
/// A component is settled when its correction `d` is below `tolerance` relative to it; or when quadratic convergence
/// predicts that the next one, `d (d / d_before)^2`, will be, or after a simplified correction `2 d (d / d_before)`; or when
/// all corrections are below [`Newton::ROUNDING`] of the largest component there was and its own no longer shrinks, so that
/// it is rounding; or when simplified corrections take it to zero. A tolerance on all components
/// together would freeze those that are small (a spin that dies out exponentially, for one).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newton {
    /// Relative tolerance of every component. The default, `4 * 2^-52`, asks for all digits.
    pub tolerance: f64,
    /// Iterations after which the search is given up.
    pub max_iterations: u32,
}

impl Default for Newton {
    fn default() -> Self {
        Self { tolerance: 4.0 * f64::EPSILON, max_iterations: 30 }
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
    #[error("corrections grow: relative {correction:e} after {before:e} at iteration {iteration}")]
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
    #[error("no convergence in {iterations} iterations, last relative correction {correction:e}")]
    IterationLimit {
        /// How many were made.
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
    /// Where all corrections are below this part of the largest component, those that do not shrink are rounding.
    pub const ROUNDING: f64 = 1e-11;
    /// With derivatives of another point an unknown that goes to zero shrinks by the same factor for ever. It is zero where it
    /// has lost all digits of its start twice.
    const GONE: f64 = f64::EPSILON * f64::EPSILON;
    /// So many times in all the largest correction may grow.
    const GROWTHS: u32 = 3;

    /// Where all corrections are below this, with a largest component of this size, those that do not shrink are rounding:
    /// [`Self::ROUNDING`] of it, and below the smallest normal number everything, since what comes to rest ends there.
    #[must_use]
    #[inline(always)]
    pub fn rounding(size: f64) -> f64 {
        (Self::ROUNDING * size).max(f64::MIN_POSITIVE)
    }

    /// Improves `x` until every component is settled, and says in how many iterations.
    ///
    /// # Errors
    /// [`NewtonError`]; `x` is then where the search ended.
    #[inline]
    pub fn solve<const U: usize>(
        &self,
        equations: &mut impl Equations<U>,
        x: &mut [f64; U],
    ) -> Result<u32, NewtonError> {
        self.solve_blocks(&mut Single(equations), std::array::from_mut(x))
    }

    /// The same for unknowns in blocks.
    #[inline]
    pub(crate) fn solve_blocks<const U: usize, const S: usize>(
        &self,
        equations: &mut impl BlockEquations<U, S>,
        x: &mut [[f64; U]; S],
    ) -> Result<u32, NewtonError> {
        let start = *x;
        let mut last = [[f64::INFINITY; U]; S];
        let mut rounding = [[false; U]; S];
        let mut before = f64::INFINITY;
        let mut growths = 0;
        let mut history = History::new();
        // The largest component so far, the start's too: a solution of zeros only has no size of its own.
        let mut size = largest(x.as_flattened());
        for iteration in 1..=self.max_iterations {
            let correction = equations.correction(x).map_err(|source| NewtonError::Singular {
                iteration,
                source,
                history: history.relative_to(size),
            })?;
            for (x, d) in x.as_flattened_mut().iter_mut().zip(correction.as_flattened()) {
                *x += d;
            }
            let now = largest(x.as_flattened());
            if !now.is_finite() {
                return Err(NewtonError::NotFinite { iteration, history: history.relative_to(size) });
            }
            size = size.max(now);
            let step = largest(correction.as_flattened());
            history.push(step);
            let converged = step <= Self::rounding(size);
            let mut settled = true;
            let simplified = equations.is_simplified();
            for b in 0..S {
                for i in 0..U {
                    let (d, shrink) = (correction[b][i].abs(), correction[b][i].abs() / last[b][i]);
                    // Once a component has been seen to move by rounding only, it stays so.
                    rounding[b][i] |= converged && shrink >= 0.25;
                    // A correction larger than what it leaves brings rounding of its own, and predicts nothing.
                    let predicts = last[b][i].is_finite() && d <= x[b][i].abs();
                    // With w the bound on the curvature, the first simplified correction is d = w d_before^2/2, and leaves
                    // w d_before d; the first of Newton's own leaves w d^2/2.
                    let factor = if simplified { 2.0 * shrink } else { shrink * shrink };
                    let next = if predicts { d * factor } else { d };
                    let gone =
                        simplified && d <= Self::GONE * (if start[b][i] == 0.0 { size } else { start[b][i].abs() });
                    settled &= rounding[b][i] || gone || next.min(d) <= self.tolerance * x[b][i].abs();
                    last[b][i] = d;
                }
            }
            if settled {
                return Ok(iteration);
            }
            // The corrections themselves are compared: relative to unknowns that shrink they may grow and yet converge.
            if step > before && !converged {
                growths += 1;
                if growths == Self::GROWTHS {
                    let (correction, before) = (step / size, before / size);
                    let history = history.relative_to(size);
                    return Err(NewtonError::Diverged { iteration, correction, before, history });
                }
            }
            before = step;
        }
        let (iterations, correction) = (self.max_iterations, before / size);
        Err(NewtonError::IterationLimit { iterations, correction, history: history.relative_to(size) })
    }
}
