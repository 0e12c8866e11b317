//! Which of several solutions of a step continues the motion.

use crate::{Equations, Newton};
use lagrangian::linear::{Singular, largest};

/// Equations that remember how large the first two corrections of a search were.
pub(crate) struct Search<E> {
    pub(crate) equations: E,
    sizes: [f64; 2],
    made: usize,
}

/// What turns by less than this in a step (rad) is near its start.
pub(crate) const NEAR: f64 = 1.0;

impl<E> Search<E> {
    /// Where the second correction is below this part of the first, the bound of Newton and Kantorovich, `h0 <= 1/2` with
    /// `h0 = 2 theta` to first order, gives one solution near the start. (Deuflhard 2004, Newton Methods for Nonlinear
    /// Problems, sections 2.1 and 3.3.)
    const CONTRACTION: f64 = 0.25;

    #[inline(always)]
    pub(crate) fn new(equations: E) -> Self {
        Self { equations, sizes: [0.0; 2], made: 0 }
    }

    /// Whether the solution `x` is the one near the start of the search.
    #[inline(always)]
    pub(crate) fn is_certain<const U: usize>(&self, x: &[f64; U]) -> bool {
        let [first, second] = self.sizes;
        second <= Self::CONTRACTION * first || second <= Newton::ROUNDING * largest(x)
    }
}

impl<E: Equations<U>, const U: usize> Equations<U> for Search<E> {
    #[inline(always)]
    fn correction(&mut self, x: &[f64; U]) -> Result<[f64; U], Singular> {
        let correction = self.equations.correction(x)?;
        if self.made < 2 {
            self.sizes[self.made] = largest(&correction);
            self.made += 1;
        }
        Ok(correction)
    }
}

/// The solution at the end of the branch that begins with `start` at length zero, where `solve` finds the solution near a
/// guess for a part of the length, or shows that it is not certain to be that one; by parts of no more than `longest`.
pub(crate) fn followed<const U: usize>(
    start: &[f64; U],
    longest: f64,
    mut solve: impl FnMut(f64, &mut [f64; U]) -> Option<()>,
) -> Option<[f64; U]> {
    /// A branch that needs shorter parts is taken to end.
    const SHORTEST: f64 = 1.0 / 1024.0;
    let (mut x, mut reached, mut part) = (*start, 0.0, longest.min(0.25));
    while reached < 1.0 {
        let (mut guess, next) = (x, f64::min(1.0, reached + part));
        if solve(next, &mut guess).is_some() {
            (x, reached, part) = (guess, next, longest.min(2.0 * part));
        } else if part > SHORTEST {
            part *= 0.5;
        } else {
            return None;
        }
    }
    Some(x)
}
