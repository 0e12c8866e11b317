use lagrangian::linear::Singular;
use thiserror::Error;

/// Equations whose Newton correction can be computed.
pub trait Equations<const U: usize> {
    /// The correction `-F'(x)^-1 F(x)` at `x`.
    ///
    /// # Errors
    /// [`Singular`] where `F'(x)` has no inverse.
    fn correction(&mut self, x: &[f64; U]) -> Result<[f64; U], Singular>;
}

/// Newton's method with an exact Jacobian and a stopping rule for every component by itself.
///
/// A component is settled when its correction `d` is below `tolerance` relative to it; or when quadratic convergence
/// predicts that the next one, `d (d / d_before)^2`, will be; or when its corrections are below [`Newton::ROUNDING`] of
/// the largest component and no longer shrink, so that they are rounding. A tolerance on all components together would
/// freeze those that are small (a spin that dies out exponentially, for one).
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
    },
    /// The corrections grow.
    #[error("corrections grow: relative {correction:e} after {before:e} at iteration {iteration}")]
    Diverged {
        /// The iteration, from 1.
        iteration: u32,
        /// The largest correction, relative to the largest component.
        correction: f64,
        /// The one before it.
        before: f64,
    },
    /// The iteration limit is reached.
    #[error("no convergence in {iterations} iterations, last relative correction {correction:e}")]
    IterationLimit {
        /// How many were made.
        iterations: u32,
        /// The largest correction, relative to the largest component.
        correction: f64,
    },
    /// An unknown is infinite or not a number.
    #[error("the unknowns are no longer finite at iteration {iteration}")]
    NotFinite {
        /// The iteration, from 1.
        iteration: u32,
    },
}

impl Newton {
    /// Corrections below this part of the largest component may be taken for rounding, if they do not shrink.
    pub const ROUNDING: f64 = 1e-11;
    /// So many times in all the largest correction may grow.
    const GROWTHS: u32 = 3;

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
        let mut last = [f64::INFINITY; U];
        let mut rounding = [false; U];
        let mut before = f64::INFINITY;
        let mut growths = 0;
        for iteration in 1..=self.max_iterations {
            let correction = equations.correction(x).map_err(|source| NewtonError::Singular { iteration, source })?;
            for i in 0..U {
                x[i] += correction[i];
            }
            let size = largest(x);
            let relative = largest(&correction) / size;
            if !size.is_finite() || (relative.is_nan() && size > 0.0) {
                return Err(NewtonError::NotFinite { iteration });
            }
            let mut settled = true;
            for i in 0..U {
                let (d, shrink) = (correction[i].abs(), correction[i].abs() / last[i]);
                // Once a component has been seen to move by rounding only, it stays so.
                rounding[i] |= shrink >= 0.25 && d <= Self::ROUNDING * size;
                let next = if last[i].is_finite() { d * shrink * shrink } else { f64::INFINITY };
                settled &= rounding[i] || d.min(next) <= self.tolerance * x[i].abs();
                last[i] = d;
            }
            if settled {
                return Ok(iteration);
            }
            if relative > before && relative > Self::ROUNDING {
                growths += 1;
                if growths == Self::GROWTHS {
                    return Err(NewtonError::Diverged { iteration, correction: relative, before });
                }
            }
            before = relative;
        }
        Err(NewtonError::IterationLimit { iterations: self.max_iterations, correction: before })
    }
}

#[inline(always)]
fn largest<const U: usize>(x: &[f64; U]) -> f64 {
    // `f64::max` drops what is not a number; here it has to come through.
    x.iter().fold(0.0, |m: f64, x| if x.abs() > m || x.is_nan() { x.abs() } else { m })
}
