use super::{STAGES, shifted, weighted};
use dla::{OneStep, State, StepError, StepReport};
use lagrangian::{MotionError, System, quasi_velocities, reduced_acceleration};

/// The classical Runge-Kutta method on the reduced equations.
///
/// The unknowns are the coordinates and the quasi-velocities `xi` in the system's basis of admissible velocities, so that
/// the constraint cannot be violated; the price is that such a basis must be known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rk4Reduced;

impl<Sys: System<N, M>, const N: usize, const M: usize> OneStep<Sys, N, M> for Rk4Reduced {
    #[inline]
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        let q0 = state.q();
        let (_, b) = system.constraint(t, q0);
        if b.iter().any(|b| *b != 0.0) {
            return Err(StepError::Unsupported {
                reason: "the reduced equations are those of a constraint with b = 0",
            });
        }
        let basis = |t: f64, q: &[f64; N]| {
            system.admissible_basis(t, q).ok_or(StepError::Unsupported {
                reason: "the reduced equations need a basis of the admissible velocities, and the system gives none",
            })
        };
        let singular = |t| move |source| StepError::Motion(MotionError { time: t, source });
        let xi0 = match state.xi() {
            Some(xi) => xi,
            None => quasi_velocities(system, t, q0, state.v(), &basis(t, q0)?).map_err(singular(t))?,
        };
        let (mut velocities, mut rates) = ([[0.0; N]; 4], [[0.0; N]; 4]);
        let (mut q, mut xi) = (*q0, xi0);
        for (i, stage) in STAGES.iter().enumerate() {
            let t = t + stage * h;
            if i > 0 {
                q = shifted(q0, stage * h, &velocities[i - 1]);
                xi = shifted(&xi0, stage * h, &rates[i - 1]);
            }
            velocities[i] = basis(t, &q)?.combine(&xi);
            rates[i] = match system.reduced_motion(t, &q, &xi) {
                Some(rate) => rate,
                None => reduced_acceleration(system, t, &q, &xi).map_err(StepError::Motion)?,
            };
        }
        let increment = weighted(h, &velocities);
        let xi1 = shifted(&xi0, 1.0, &weighted(h, &rates));
        let v1 = basis(t + h, &state.ahead(&increment))?.combine(&xi1);
        super::rk4::explicit(state, &increment, v1, Some(xi1))
    }
}
