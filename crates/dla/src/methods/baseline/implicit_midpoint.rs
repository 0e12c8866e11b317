use super::shifted;
use crate::convergence::FixedPoint;
use crate::convergence::tolerances::HALF_A_UNIT;
use crate::{Mechanics, OneStep, StackUse, Stage, State, StepError, StepReport};

/// The implicit midpoint rule in full coordinates, the multiplier eliminated as in [`Rk4`](crate::Rk4).
///
/// With the acceleration `a` in the middle of the step as the unknown,
///
/// ```text
/// v1 = v0 + h a,   q1 = q0 + h v_m,   v_m = v0 + h a / 2,   a = v'(t0 + h/2, q0 + h v_m / 2, v_m).
/// ```
///
/// Symmetric and of order 2, with one stage of Gauss (Hairer, Lubich and Wanner 2006, section II.1.2). It keeps quadratic
/// integrals, which the residual `A v + b` is not in general: the blade slips, by what a method of order 2 leaves.
/// The acceleration is found by fixed-point iteration, which converges for steps below the time constants of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImplicitMidpoint {
    /// Iterations after which the step fails.
    pub max_iterations: u32,
}

impl Default for ImplicitMidpoint {
    fn default() -> Self {
        Self { max_iterations: 100 }
    }
}

impl ImplicitMidpoint {
    /// The acceleration in the middle, to the rounding of every component by itself, and the iterations.
    #[inline]
    fn acceleration<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        state: &State<N>,
    ) -> Result<([f64; N], u32), StepError> {
        let (q0, v0) = (state.q(), state.v());
        let motion = |t: f64, q: &[f64; N], v: &[f64; N]| {
            system.motion(t, q, v).map(|motion| motion.acceleration).map_err(StepError::Motion)
        };
        let mut a = motion(t0, q0, v0)?;
        let mut convergence = FixedPoint::<1, N>::new(self.max_iterations).to(HALF_A_UNIT);
        loop {
            let v = shifted(v0, 0.5 * h, &a);
            let next = motion(t0 + 0.5 * h, &shifted(q0, 0.5 * h, &v), &v)?;
            let seen = lagrangian::from_fn(|i| ((next[i] - a[i]).abs(), next[i].abs()));
            a = next;
            let noise = || [system.motion_rounding(t0, q0, v0).map_or([0.0; N], |rounding| rounding.acceleration)];
            let settled = convergence.see([seen], noise);
            let settled = settled.map_err(|source| StepError::Newton { stage: Stage::Collocation, source })?;
            if let Some(iterations) = settled {
                return Ok((a, iterations));
            }
        }
    }
}

const USE: StackUse = StackUse { squares: 14, rows: 20 };

impl<const N: usize, const M: usize> OneStep<N, M> for ImplicitMidpoint {
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
        let (a, iterations) = self.acceleration(system, (t, h), state)?;
        let v0 = *state.v();
        let increment = shifted(&v0, 0.5 * h, &a).map(|v| h * v);
        let report = super::rk4::explicit(state, &increment, shifted(&v0, h, &a), None)?;
        Ok(StepReport { iterations, ..report })
    }
}
