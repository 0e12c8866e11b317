use super::{Differentiable, SensitivityError, StepEquations, StepStart};
use crate::Composition;
use lagrangian::{Gradients, Seeded};

/// By the chain rule through the sub-steps.
impl<Base, const N: usize, const M: usize> Differentiable<N, M> for Composition<Base>
where
    Base: Differentiable<N, M>,
{
    fn fractions(&self) -> Vec<f64> {
        let inner = self.base.fractions();
        self.weights().iter().flat_map(|weight| inner.iter().map(move |fraction| weight * fraction)).collect()
    }

    fn carries_every_class(&self) -> bool {
        self.base.carries_every_class()
    }

    fn guess(&self, v: &[f64; N]) -> Vec<f64> {
        self.base.guess(v)
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        self.base.equations(model, start, z)
    }
}
