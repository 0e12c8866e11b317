//! The mean velocity of a step: the solution of its equations.

use crate::branch;
use crate::corrections::Corrections;
use crate::dependent::named_along;
use crate::increment::Increment;
use crate::newton::NewtonRoot;
use crate::{Discretisation, Newton, NewtonError, StepError};
use lagrangian::{Rows, Saddle};
use std::f64::consts::PI;

/// The mean velocity of a step, the impulse of the constraints at its beginning, and the momenta with which it ends.
pub(crate) struct Mean<const N: usize, const M: usize> {
    pub(crate) v: [f64; N],
    pub(crate) p1: [f64; N],
    pub(crate) lambda: [f64; M],
    pub(crate) iterations: u32,
    /// The rows that were solved for, if not all.
    pub(crate) some: Option<Rows>,
    /// The last Jacobian of the momenta at the beginning.
    pub(crate) block: Option<[[f64; N]; N]>,
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Increment<'_, D, N, M> {
    /// The solution that continues the motion, from the velocity `v0` at the beginning. Newton's method starts at the predictor `guess` if
    /// there is one, and again at `v0` if it fails from there.
    ///
    /// # Errors
    /// [`StepError::Newton`] if no solution is found, [`StepError::Branch`] if the solution belongs to another motion, [`StepError::Stiff`]
    /// if the equations have no other branch.
    #[inline]
    pub(crate) fn solve(
        &self,
        newton: &Newton,
        v0: [f64; N],
        guess: Option<[f64; N]>,
    ) -> Result<Mean<N, M>, StepError> {
        // Dependent rows have no sign to compare.
        let positive = Saddle::is_positive_at_rest(&self.a0, self.basis.as_ref());
        let time = (self.t0, self.h);
        let (mut search, mut v) = (Corrections::new(self), guess.unwrap_or(v0));
        let mut found = newton.search(&mut search, &mut v);
        if found.is_err() && guess.is_some() {
            (search, v) = (Corrections::new(self), v0);
            found = newton.search(&mut search, &mut v);
        }
        let NewtonRoot { mut iterations, certain, .. } =
            found.map_err(|source| named_along(self.system, time, *self.state, v, source))?;
        let turn = self.turn(&v);
        if !(certain && search.continues(positive) && turn <= branch::NEAR) {
            v = self.followed(newton, positive, turn, &v0).ok_or_else(|| self.unfollowed(&v, &v0))?;
            search = Corrections::new(self);
            iterations += newton
                .solve(&mut search, &mut v)
                .map_err(|source| named_along(self.system, time, *self.state, v, source))?;
        }
        let some = search.some;
        let (p1, lambda) = search.ends(&v).map_err(|source| {
            let source = NewtonError::singular(source);
            named_along(self.system, time, *self.state, v, source)
        })?;
        Ok(Mean { v, p1, lambda, iterations, some, block: search.block() })
    }

    /// The error that refuses the solution `v`, which is not found from the velocity `v0`.
    #[cold]
    #[inline(never)]
    fn unfollowed(&self, v: &[f64; N], v0: &[f64; N]) -> StepError {
        let derivatives = |v: &[f64; N]| {
            let (block, rows) = (self.linearised(v).1, self.rows(v).0);
            [block.as_flattened(), rows.as_flattened()].concat()
        };
        branch::unfollowed([&derivatives(v), &derivatives(v0)])
    }

    /// The solution at the end of the branch that begins with a step of length zero.
    #[cold]
    #[inline(never)]
    fn followed(&self, newton: &Newton, positive: Option<bool>, turn: f64, v0: &[f64; N]) -> Option<[f64; N]> {
        branch::followed(v0, 0.5 * branch::NEAR / turn, |part, guess| {
            let within = Self { h: part * self.h, ..*self };
            let mut search = Corrections::new(&within);
            let found = newton.search(&mut search, guess).ok()?;
            (found.certain && search.continues(positive) && within.turn(guess) < PI).then_some(())
        })
    }

    #[inline(always)]
    fn turn(&self, v: &[f64; N]) -> f64 {
        branch::turn_of(self.system, (self.t0, self.h), &self.q0, v)
    }
}
