use super::equations::{StepUnknowns, constrained, difference};
use super::{Differentiable, Sensitivity, SensitivityError, StepEquations, StepStart, Tangent};
use crate::{State, StepReport, onto_constraint};
use lagrangian::{Gradients, Scalar, Seeded};

/// The impulse of the constraints on a velocity that does not meet them, as a step without duration:
/// `L_v(q, v1) = L_v(q, v0) + A' mu`, `A v1 + b = 0`, or `phi(q, v1) = 0` with its reaction along `d phi / dv1`.
struct Impulse;

impl<const N: usize, const M: usize> Differentiable<N, M> for Impulse {
    fn carries_every_class(&self) -> bool {
        true
    }

    fn guess(&self, v: &[f64; N]) -> Vec<f64> {
        [&v[..], &[0.0; M]].concat()
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, q, v: v0, .. } = *start;
        let mut unknowns = StepUnknowns(z);
        let (v1, mu): ([Seeded; N], [Seeded; M]) = (unknowns.take(), unknowns.take());
        let a = model.reaction_rows(t, &q, &v1);
        let p1 = constrained(&model.momentum(t, &q, &v0), &a, &mu);
        let residual = [&difference(&model.momentum(t, &q, &v1), &p1)[..], &model.slip(t, &q, &v1)].concat();
        Ok(StepEquations { residual, increment: [Seeded::zero(); N], velocity: v1 })
    }
}

impl<const N: usize, const M: usize, const P: usize> Sensitivity<'_, N, M, P> {
    /// Brings a velocity onto the constraints as [`onto_constraint`] does, and tangents with it: what happens between two
    /// smooth pieces of a run, at a node that is fixed in time.
    ///
    /// # Errors
    /// As [`Sensitivity::step`]; state and tangents are then unchanged.
    pub fn onto_constraint(
        &self,
        t: f64,
        state: &mut State<N>,
        tangents: &mut [Tangent<N, P>],
    ) -> Result<(), SensitivityError> {
        let mut end = *state;
        onto_constraint(self.system(), t, &mut end)?;
        let derivative = self.between(&Impulse, (t, 0.0), state, &end, StepReport::of(0))?;
        *state = end;
        for tangent in tangents {
            *tangent = derivative.apply(tangent);
        }
        Ok(())
    }
}
