use super::{Differentiable, SensitivityError, StepEquations, StepStart};
use crate::Gni;
use lagrangian::{Gradients, Seeded};

/// Refused: the step is no map of configuration and velocity.
impl<D, const N: usize, const M: usize> Differentiable<N, M> for Gni<N, D> {
    fn guess(&self, _v: &[f64; N]) -> Vec<f64> {
        Vec::new()
    }

    fn equations(
        &self,
        _model: &dyn Gradients<N, M>,
        _start: &StepStart<N>,
        _z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        Err(SensitivityError::Unsupported {
            reason: "the step of gni is not a map of configuration and velocity: gni carries a momentum across the \
                constraint from step to step",
        })
    }
}
