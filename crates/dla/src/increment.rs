use crate::branch::{self, Search};
use crate::{Equations, Newton, NewtonError, Stage, StepError};
use lagrangian::linear::{Singular, larger};
use lagrangian::{AdmissibleBasis, DiscreteConstraint, DiscreteLagrangian, Dual, Saddle, System};
use std::array::from_fn;
use std::f64::consts::PI;

/// The equations for the mean velocity `v` of a step, with the multiplier at its beginning.
pub(crate) struct Increment<'a, Sys, L, C, const N: usize, const M: usize> {
    /// The discrete Lagrangian and the discrete constraint.
    pub(crate) rules: (&'a L, &'a C),
    pub(crate) system: &'a Sys,
    pub(crate) t0: f64,
    pub(crate) h: f64,
    pub(crate) q0: [f64; N],
    pub(crate) p0: [f64; N],
    pub(crate) a0: [[f64; N]; M],
    pub(crate) basis: Option<AdmissibleBasis<f64, N, M>>,
    pub(crate) lambda: [f64; M],
    /// Whether the determinant of the last correction was positive.
    pub(crate) positive: bool,
}

/// The mean velocity of a step, and the impulse of the constraints at its beginning.
pub(crate) struct Mean<const N: usize, const M: usize> {
    pub(crate) v: [f64; N],
    pub(crate) lambda: [f64; M],
    pub(crate) iterations: u32,
}

impl<Sys, L, C, const N: usize, const M: usize> Increment<'_, Sys, L, C, N, M>
where
    Sys: System<N, M>,
    L: DiscreteLagrangian<Sys, N, M>,
    C: DiscreteConstraint<Sys, N, M>,
{
    /// The solution that continues the motion, from the velocity `v0` at the beginning.
    ///
    /// # Errors
    /// [`StepError::Newton`] where none is found, [`StepError::Branch`] where what is found belongs to another motion.
    #[inline]
    pub(crate) fn solve(self, newton: &Newton, v0: [f64; N]) -> Result<Mean<N, M>, StepError> {
        let fail = |source| StepError::Newton { stage: Stage::Increment, source };
        let at_rest = Saddle::is_positive_at_rest(&self.a0, self.basis.as_ref());
        let positive = at_rest.map_err(|source| fail(NewtonError::singular(source)))?;
        let (mut search, mut v) = (Search::new(self), v0);
        let mut iterations = newton.solve(&mut search, &mut v).map_err(fail)?;
        let turn = search.equations.turn(&v);
        let certain = search.equations.positive == positive && turn <= branch::NEAR && search.is_certain(&v);
        if !certain {
            v = self.followed(newton, positive, turn, &v0).ok_or(StepError::Branch)?;
            search = Search::new(self);
            iterations += newton.solve(&mut search, &mut v).map_err(fail)?;
        }
        Ok(Mean { v, lambda: search.equations.lambda, iterations })
    }

    /// The solution at the end of the branch that begins with a step of length zero.
    #[cold]
    #[inline(never)]
    fn followed(&self, newton: &Newton, positive: bool, turn: f64, v0: &[f64; N]) -> Option<[f64; N]> {
        branch::followed(v0, 0.5 * branch::NEAR / turn, |part, guess| {
            let mut search = Search::new(Self { h: part * self.h, ..*self });
            newton.solve(&mut search, guess).ok()?;
            let continues = search.equations.positive == positive && search.equations.turn(guess) < PI;
            (continues && search.is_certain(guess)).then_some(())
        })
    }

    /// By how much a step with this mean velocity turns the constraint that turns most (rad): a rate times the step, which
    /// shows what the two ends do not, whole turns. Zero where no angle turns by as much as is near.
    #[inline(always)]
    fn turn(&self, v: &[f64; N]) -> f64 {
        let angles = self.system.angles();
        let far = (0..N).any(|i| angles[i] && (self.h * v[i]).abs() > branch::NEAR);
        if far { self.turned(v) } else { 0.0 }
    }

    #[cold]
    #[inline(never)]
    fn turned(&self, v: &[f64; N]) -> f64 {
        // Along the motion: of the derivatives that the equations need anyway, the first.
        let along = |re: f64, rate: f64| Dual { re, eps: from_fn::<f64, N, _>(|j| if j == 0 { rate } else { 0.0 }) };
        let (a, _) = self.system.constraint(along(self.t0, self.h), &from_fn(|i| along(self.q0[i], self.h * v[i])));
        let size = |row: [f64; N]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turns = a.map(|row| size(row.map(|x| x.eps[0])) / size(row.map(|x| x.re)));
        turns.iter().fold(0.0, |most, turn| larger(most, *turn))
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
    #[inline]
    fn correction(&mut self, v: &[f64; N]) -> Result<[f64; N], Singular> {
        let Self { rules: (lagrangian, constraint), system, t0, h, q0, .. } = *self;
        let l_d = lagrangian.derivatives(system, t0, h, &q0, v);
        let mut residual: [f64; N] = from_fn(|i| self.p0[i] + l_d.d1[i]);
        let mut block = l_d.d1d2.map(|row| row.map(|x| h * x));

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

        let saddle = Saddle {
            block,
            transposed: self.a0,
            rows: w_d.map(|w| w.eps),
            right: residual.map(|r| -r),
            level: w_d.map(|w| -w.re),
        };
        let (correction, lambda, positive) = saddle.solve_oriented(self.basis.as_ref())?;
        (self.lambda, self.positive) = (lambda, positive);
        Ok(correction)
    }
}
