mod dense;
mod point;
mod stages;
mod tables;

use crate::branch;
use crate::convergence::tolerances::NEAR_ROUNDINGS;
use crate::dependent::{named_along, named_at};
use crate::newton::{BlockEquations, NewtonRoot};
use crate::positions::affine_only;
use crate::projection::{Projected, Projection};
use crate::{MeanPower, Mechanics, Newton, NewtonError, OneStep, StackUse, Stage, State, StepError, StepReport, power};
use lagrangian::linear::{Lu, Singular, largest};
use lagrangian::{PowerSources, from_fn, mapped};
use stages::LobattoStages;
use std::f64::consts::PI;

pub use point::{LinearisedStage, StagePoint};
pub use tables::LobattoTables;

/// The variational partitioned Runge-Kutta method of the Lobatto pair IIIA and IIIB with `S >= 2` stages, as a one-step map
/// on the distribution: order `2 S - 2`, self-adjoint.
///
/// Given `q0` and an admissible `v0` it finds the velocities `V_i` and the multipliers `Lambda_i` of the stages,
///
/// ```text
/// Q_i = q0 + h sum_j a_ij V_j,                    W_i = L_q(Q_i, V_i) + F_i + A(Q_i)' Lambda_i,
/// L_v(Q_i, V_i) = L_v(q0, v0) + h sum_j a^_ij W_j,
/// sum_j a_ij (A(Q_j) V_j + b_j) = 0               for i = 2 .. S,
/// ```
///
/// and then `q1 = q0 + h sum_j b_j V_j` and `v1` from
///
/// ```text
/// L_v(q1, v1) = L_v(q0, v0) + h sum_j b_j W_j,    A(q1) v1 + b(q1) = 0.
/// ```
///
/// The last column of `a^` is zero: the multiplier of the last stage acts in `v1` only, so that there are as many equations
/// as unknowns, and nothing but `(q, v)` is carried from step to step. With two stages and a constant mass matrix it is the
/// trapezoidal [`Dla`](crate::Dla). (Jay 2003, BIT 43, 93-106; the book, (4.3) to
/// (4.5).)
///
/// The stages meet a constraint on positions itself, `g(Q_i) = 0` for `i = 2 .. S`, in place of its rate in the equations above; the last
/// stage is the node (Jay 1996, SIAM J. Numer. Anal. 33, 368-387).
///
/// All stages are solved for together by Newton's method with the exact Jacobian, on the stack. The equations of a long step may have
/// several solutions. A solution is accepted if Newton's method contracts to it from its first correction, ends not far from its start, and
/// the constraint turns by less than a radian. Otherwise the solution is followed from a step of length zero, in parts that meet these
/// conditions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobatto<const S: usize> {
    tables: LobattoTables<S>,
    /// The sources whose work is reported.
    sources: PowerSources,
    /// The solver.
    pub newton: Newton,
}

impl<const S: usize> Default for Lobatto<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const S: usize> Lobatto<S> {
    /// The equations of all stages have `2 S N` unknowns at most.
    const USE: StackUse = StackUse { squares: 4 * S * S + 50, rows: 30 };

    /// The method, with its coefficients computed to rounding.
    #[must_use]
    pub fn new() -> Self {
        Self { tables: LobattoTables::new(), sources: PowerSources::NONE, newton: Newton::default() }
    }

    /// Runs Newton's method from `v`; returns the number of iterations, and whether the stages are the solution near the start: the
    /// iteration contracted, and started within `part` of its end, or the two differ by the round-off of the place or of the equations.
    #[inline(always)]
    fn found_near<const N: usize, const M: usize>(
        &self,
        part: f64,
        stages: &mut LobattoStages<'_, N, M, S>,
        v: &mut [[f64; N]; S],
    ) -> Result<(u32, bool), NewtonError> {
        let begun = *stages;
        let NewtonRoot { iterations, first, certain } = self.newton.search_blocks(stages, v)?;
        let near = first <= part * largest(v.as_flattened())
            || first <= begun.near()
            || first <= NEAR_ROUNDINGS * largest(&begun.velocity_rounding());
        Ok((iterations, certain && near))
    }

    /// The stages at the end of the branch of solutions that begins with a step of length zero.
    #[cold]
    #[inline(never)]
    fn followed<const N: usize, const M: usize>(
        &self,
        whole: &LobattoStages<'_, N, M, S>,
        turn: f64,
        v0: [f64; N],
    ) -> Option<[[f64; N]; S]> {
        branch::followed(&[v0; S], 0.5 * branch::NEAR / turn, |part, guess| {
            let mut stages = LobattoStages { h: part * whole.h, ..*whole };
            let near = self.found_near(0.1, &mut stages, guess).ok()?.1;
            (near && stages.turn(guess) < PI).then_some(())
        })
    }
}

impl<const N: usize, const M: usize, const S: usize> OneStep<N, M> for Lobatto<S> {
    /// The report has the impulses of all stages, each shared between the two ends as a lever would.
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { Self::USE.exceeds::<N, M>() } {
            return Err(Self::USE.refusal::<N, M>());
        }
        affine_only(system, t0, state)?;
        self.made(system, (t0, h), state).map_err(|error| light(system, t0, state, error))
    }

    fn measure_work(&mut self, sources: PowerSources) {
        // Up to order 6 the work is measured well enough from node to node.
        self.sources = if S > 4 { sources } else { PowerSources::NONE };
    }
}

/// The error of a step. It names the mass matrix if that is singular or nearly so: the momenta of the stages, one fewer than their
/// velocities, then leave a velocity open.
#[cold]
#[inline(never)]
fn light<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t0: f64,
    start: &State<N>,
    error: StepError,
) -> StepError {
    /// The stages lose as many digits as a pivot has zeros; with fewer left Newton's method is not seen to converge.
    const LIGHT: f64 = 1e-8;
    let of_solution = matches!(error, StepError::Newton { .. } | StepError::Branch);
    let (_, mass) = system.mass_matrix(t0, start.q(), start.v());
    match Lu::above(mass, LIGHT) {
        Err(Singular { pivot, .. }) if of_solution && pivot.is_finite() => StepError::LightMass { pivot },
        _ => error,
    }
}

impl<const S: usize> Lobatto<S> {
    #[inline]
    fn made<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let LobattoTables { c, b, .. } = &self.tables;
        let (q0, v0) = (*state.q(), *state.v());
        branch::tells_turn(system, (t0, h), &q0, &v0)?;
        let p0 = system.momentum(t0, &q0, &v0);

        // Start from uniform acceleration, if the equations of motion give one.
        let (mut v, mut impulse) = ([v0; S], [0.0; M]);
        if let Ok(motion) = system.motion(t0, &q0, &v0) {
            v = mapped(c, |c| from_fn(|i| v0[i] + c * h * motion.acceleration[i]));
            impulse = mapped(&motion.multiplier, |lambda| h * lambda);
        }
        let mut impulses = [impulse; S];
        impulses[S - 1] = [0.0; M];
        let first = LobattoStages { tables: &self.tables, system, t0, h, start: state, p0, impulses, before: impulses };
        let mut stages = first;
        let (mut iterations, near) = self
            .found_near(0.3, &mut stages, &mut v)
            .map_err(|source| named_along(system, (t0, h), *state, v0, source))?;
        let turn = stages.turn(&v);
        if !(near && turn <= branch::NEAR) {
            v = self.followed(&first, turn, v0).ok_or_else(|| first.unfollowed(&v, v0))?;
            stages = first;
            iterations += self
                .newton
                .search_blocks(&mut stages, &mut v)
                .map_err(|source| named_along(system, (t0, h), *state, v0, source))?
                .iterations;
        }

        let (mut p1, mut mean) = (p0, MeanPower::default());
        for (point, &weight) in stages.points(&v).iter().zip(b) {
            if self.sources.any() {
                mean.add(weight, power(system, self.sources, point.t, (&point.q, &point.v)));
            }
            let gain = point.gain(system, h);
            p1 = from_fn(|i| p1[i] + weight * gain[i]);
        }
        let increment = stages.increment(b, 1.0, &v);
        let impulses = stages.impulses;
        let (t1, q1) = (t0 + h, state.ahead(&increment));
        let Projected { v1, mu: last, .. } = Projection::new(system, t1, q1, p1, system.basis(t1, &q1))
            .solve(&self.newton, v[S - 1])
            .map_err(|source| named_at(system, t1, &q1, &v0, Stage::Projection, source))?;

        let mut ends = [[0.0; M], last];
        for j in 0..S - 1 {
            for k in 0..M {
                ends[0][k] += b[j] * (1.0 - c[j]) * impulses[j][k];
                ends[1][k] += b[j] * c[j] * impulses[j][k];
            }
        }
        state.stays_finite(&increment, &v1)?;
        state.advance(&increment, v1, None);
        let work = self.sources.any().then(|| h * mean.mean());
        Ok(StepReport { impulses: ends, work, ..StepReport::of(iterations) })
    }
}
