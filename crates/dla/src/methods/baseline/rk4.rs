use super::{STAGES, moving, shifted, weighted};
use crate::dropping::even_accelerations;
use crate::{Mechanics, OneStep, StackUse, State, StepError, StepReport, on_branch};
use lagrangian::{Saddle, from_fn};

/// The classical Runge-Kutta method in full coordinates.
///
/// The multiplier is eliminated by differentiating the constraint (index reduction; the book, (1.4)), so that the equations
/// are ordinary ones for `(q, v)`. They conserve the residual `A v + b` only up to the error of the method: the blade begins
/// to slip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rk4;

/// [`Rk4`], with the velocity projected onto the constraint after every step, orthogonally in the kinetic energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rk4Projected;

/// The increments of `q` and `v` over one step.
#[inline(always)]
fn increments<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    h: f64,
    state: &State<N>,
) -> Result<([f64; N], [f64; N]), StepError> {
    let (q0, v0) = (state.q(), state.v());
    let (mut velocities, mut accelerations) = ([[0.0; N]; 4], [[0.0; N]; 4]);
    let (mut q, mut v) = (*q0, *v0);
    for (i, stage) in STAGES.iter().enumerate() {
        if i > 0 {
            q = shifted(q0, stage * h, &velocities[i - 1]);
            v = shifted(v0, stage * h, &accelerations[i - 1]);
        }
        velocities[i] = v;
        accelerations[i] = system.motion(t + stage * h, &q, &v).map_err(StepError::Motion)?.acceleration;
    }
    moving(system, t, q0, &velocities)?;
    even_accelerations(system, (t, h), state, &accelerations)?;
    Ok((weighted(h, &velocities), weighted(h, &accelerations)))
}

/// Moves the state by what an explicit step found, if it is finite.
pub(super) fn explicit<const N: usize, const M: usize>(
    state: &mut State<N>,
    increment: &[f64; N],
    v: [f64; N],
    xi: Option<[f64; N]>,
) -> Result<StepReport<M>, StepError> {
    state.stays_finite(increment, &v)?;
    state.advance(increment, v, xi);
    Ok(StepReport::of(0))
}

const USE: StackUse = StackUse { squares: 14, rows: 20 };

impl<const N: usize, const M: usize> OneStep<N, M> for Rk4 {
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>());
        }
        let (dq, dv) = increments(system, t, h, state)?;
        let v = from_fn(|i| state.v()[i] + dv[i]);
        on_branch(system, (t, h), state, &v, |state| explicit(state, &dq, v, None))
    }
}

impl<const N: usize, const M: usize> OneStep<N, M> for Rk4Projected {
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>());
        }
        let (dq, dv) = increments(system, t, h, state)?;
        let v = from_fn(|i| state.v()[i] + dv[i]);
        let v = projected(system, t + h, &state.ahead(&dq), &v)?;
        on_branch(system, (t, h), state, &v, |state| explicit(state, &dq, v, None))
    }
}

/// The admissible velocity nearest to `v` in the kinetic energy: `M (w - v) = A' mu`, `A w + b = 0`.
fn projected<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<[f64; N], StepError> {
    let (_, mass) = system.mass_matrix(t, q, v);
    let (a, _) = system.constraint(t, q);
    let level = system.residual(t, q, v).map(|r| -r);
    let saddle = Saddle { block: mass, transposed: a, rows: a, right: [0.0; N], level };
    let (correction, _) = saddle
        .solve(system.basis(t, q).as_ref())
        .map_err(|source| StepError::Motion(lagrangian::MotionError { time: t, source }))?;
    Ok(from_fn(|i| v[i] + correction[i]))
}
