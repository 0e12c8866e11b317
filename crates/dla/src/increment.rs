use crate::branch::{self, Search};
use crate::dependent::named_along;
use crate::{Equations, Newton, State, StepError};
use lagrangian::linear::Singular;
use lagrangian::{
    AdmissibleBasis, DiscreteConstraint, DiscreteLagrangian, Dual, Rows, Saddle, System, position_misses,
    redundant_rows,
};
use std::array::from_fn;
use std::f64::consts::PI;

/// The equations for the mean velocity `v` of a step, with the multiplier at its beginning.
pub(crate) struct Increment<'a, Sys, L, C, const N: usize, const M: usize> {
    /// The discrete Lagrangian and the discrete constraint.
    pub(crate) rules: (&'a L, &'a C),
    pub(crate) system: &'a Sys,
    pub(crate) t0: f64,
    pub(crate) h: f64,
    pub(crate) state: &'a State<N>,
    pub(crate) q0: [f64; N],
    pub(crate) p0: [f64; N],
    pub(crate) a0: [[f64; N]; M],
    pub(crate) basis: Option<AdmissibleBasis<f64, N, M>>,
    /// The rows that are solved for, where they depend on one another and agree.
    pub(crate) some: Option<Rows>,
    pub(crate) lambda: [f64; M],
    /// Whether the determinant of the last correction was positive; none of one with some of the rows.
    pub(crate) positive: Option<bool>,
}

/// The mean velocity of a step, and the impulse of the constraints at its beginning.
pub(crate) struct Mean<const N: usize, const M: usize> {
    pub(crate) v: [f64; N],
    pub(crate) lambda: [f64; M],
    pub(crate) iterations: u32,
    /// The rows that were solved for, where not all.
    pub(crate) some: Option<Rows>,
}

impl<Sys, L, C, const N: usize, const M: usize> Increment<'_, Sys, L, C, N, M>
where
    Sys: System<N, M>,
    L: DiscreteLagrangian<Sys, N, M>,
    C: DiscreteConstraint<Sys, N, M>,
{
    /// The solution that continues the motion, from the velocity `v0` at the beginning; first looked for near a
    /// guess where there is one.
    ///
    /// # Errors
    /// [`StepError::Newton`] where none is found, [`StepError::Branch`] where what is found belongs to another motion.
    #[inline]
    pub(crate) fn solve(self, newton: &Newton, v0: [f64; N], guess: Option<[f64; N]>) -> Result<Mean<N, M>, StepError> {
        // Of rows that depend on one another there is none, and then it is not looked at.
        let positive = Saddle::is_positive_at_rest(&self.a0, self.basis.as_ref());
        let time = (self.t0, self.h);
        let (mut search, mut v) = (Search::new(self), guess.unwrap_or(v0));
        let mut found = newton.solve(&mut search, &mut v);
        if found.is_err() && guess.is_some() {
            (search, v) = (Search::new(self), v0);
            found = newton.solve(&mut search, &mut v);
        }
        let mut iterations = found.map_err(|source| named_along(self.system, time, *self.state, v, source))?;
        let turn = search.equations.turn(&v);
        let certain = search.equations.continues(positive) && turn <= branch::NEAR && search.is_certain(&v);
        if !certain {
            v = self.followed(newton, positive, turn, &v0).ok_or(StepError::Branch)?;
            search = Search::new(self);
            iterations += newton
                .solve(&mut search, &mut v)
                .map_err(|source| named_along(self.system, time, *self.state, v, source))?;
        }
        let Increment { lambda, some, .. } = search.equations;
        Ok(Mean { v, lambda, iterations, some })
    }

    /// Whether the determinant has the sign that it has in a step of length zero, as far as both are known.
    #[inline(always)]
    fn continues(&self, positive: Option<bool>) -> bool {
        self.positive.zip(positive).is_none_or(|(here, at_rest)| here == at_rest)
    }

    /// The solution at the end of the branch that begins with a step of length zero.
    #[cold]
    #[inline(never)]
    fn followed(&self, newton: &Newton, positive: Option<bool>, turn: f64, v0: &[f64; N]) -> Option<[f64; N]> {
        branch::followed(v0, 0.5 * branch::NEAR / turn, |part, guess| {
            let mut search = Search::new(Self { h: part * self.h, ..*self });
            newton.solve(&mut search, guess).ok()?;
            let continues = search.equations.continues(positive) && search.equations.turn(guess) < PI;
            (continues && search.is_certain(guess)).then_some(())
        })
    }

    #[inline(always)]
    fn turn(&self, v: &[f64; N]) -> f64 {
        branch::turn(self.system, (self.t0, self.h), &self.q0, v)
    }
}

impl<Sys, L, C, const N: usize, const M: usize> Clone for Increment<'_, Sys, L, C, N, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Sys, L, C, const N: usize, const M: usize> Copy for Increment<'_, Sys, L, C, N, M> {}

impl<Sys, L, C, const N: usize, const M: usize> Equations<N> for Increment<'_, Sys, L, C, N, M>
where
    Sys: System<N, M>,
    L: DiscreteLagrangian<Sys, N, M>,
    C: DiscreteConstraint<Sys, N, M>,
{
    /// Not inlined: it is called from each of the searches that a step may make, and is long.
    #[inline(never)]
    fn correction(&mut self, v: &[f64; N]) -> Result<[f64; N], Singular> {
        let Self { rules: (lagrangian, constraint), system, t0, h, state, q0, .. } = *self;
        let l_d = lagrangian.derivatives(system, t0, h, &q0, v);
        let mut residual: [f64; N] = from_fn(|i| self.p0[i] + l_d.d1[i]);
        let mut block = l_d.d1d2.map(|row| row.map(|x| h * x));

        // Where it constrains positions, in place of the discrete constraint.
        let positions = position_misses(system, t0 + h, &state.ahead(&v.map(|v| h * v)));

        // Forces and constraint with their derivatives in v.
        let (t, step) = (Dual::fixed(t0), Dual::fixed(h));
        let (q, v) = (q0.map(Dual::fixed), Dual::variables(v));
        if let Some((minus, _)) = lagrangian.forces(system, t, step, &q, &v) {
            for i in 0..N {
                residual[i] += minus[i].re;
                for j in 0..N {
                    block[i][j] += minus[i].eps[j];
                }
            }
        }
        let w_d = constraint.residual(system, t, step, &q, &v);
        let (mut rows, mut level) = (w_d.map(|w| w.eps), w_d.map(|w| -w.re));
        if let Some(positions) = positions {
            for k in 0..M {
                if let Some(g) = positions[k] {
                    (rows[k], level[k]) = (g.eps, -g.re / h);
                }
            }
        }

        let saddle = Saddle { block, transposed: self.a0, rows, right: residual.map(|r| -r), level };
        match saddle.solve_oriented(self.basis.as_ref()) {
            Ok((correction, lambda, positive)) => {
                (self.lambda, self.positive) = (lambda, Some(positive));
                Ok(correction)
            }
            Err(source) => {
                // By value, so that nothing of a step that succeeds must stay in memory.
                let rows = independent(system, t0, *state, self.some).ok_or(source)?;
                let (correction, lambda) = { saddle }.solve_some(rows)?;
                (self.some, self.lambda, self.positive) = (Some(rows), lambda, None);
                Ok(correction)
            }
        }
    }
}

/// The rows found before, or those that imply the others at the beginning of the step.
#[cold]
#[inline(never)]
fn independent<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t0: f64,
    start: State<N>,
    found: Option<Rows>,
) -> Option<Rows> {
    found.or_else(|| redundant_rows(system, t0, start.q(), start.v()))
}
