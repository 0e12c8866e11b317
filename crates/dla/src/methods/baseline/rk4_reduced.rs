use super::{STAGES, moving, shifted, weighted};
use crate::{Mechanics, OneStep, StackUse, State, StepError, StepReport};

/// The classical Runge-Kutta method on the reduced equations.
///
/// The unknowns are the coordinates and the quasi-velocities `xi` in the system's basis of admissible velocities, so that
/// the constraint cannot be violated; the price is that such a basis must be known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rk4Reduced;

const USE: StackUse = StackUse { squares: 28, rows: 20 };

impl<const N: usize, const M: usize> OneStep<N, M> for Rk4Reduced {
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
        let q0 = state.q();
        let xi0 = state.quasi_velocities(system, t)?;
        let (mut velocities, mut rates) = ([[0.0; N]; 4], [[0.0; N]; 4]);
        let (mut q, mut xi) = (*q0, xi0);
        for (i, stage) in STAGES.iter().enumerate() {
            if i > 0 {
                q = shifted(q0, stage * h, &velocities[i - 1]);
                xi = shifted(&xi0, stage * h, &rates[i - 1]);
            }
            let slope = system.reduced_slope(t + stage * h, &q, &xi)?;
            (velocities[i], rates[i]) = (slope.velocity, slope.acceleration);
        }
        moving(system, t, q0, &velocities)?;
        let increment = weighted(h, &velocities);
        let xi1 = shifted(&xi0, 1.0, &weighted(h, &rates));
        let v1 = system.velocity_of(t + h, &state.ahead(&increment), &xi1)?;
        super::rk4::explicit(state, &increment, v1, Some(xi1))
    }
}
