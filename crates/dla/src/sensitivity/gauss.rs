use super::equations::{NO_BASIS, StepUnknowns, advanced, constrained, difference, dimension, product};
use super::{Differentiable, SensitivityError, StepEquations, StepStart};
use crate::Gauss;
use lagrangian::{Gradients, Scalar, Seeded, from_fn};

/// In the velocities `V_i` and the accelerations `Xi'_i` of the stages, after the quasi-velocities `xi0` of the start:
///
/// ```text
/// v0 = W(q0) xi0 + v_b + A' eta,
/// V_i = W(Q_i) Xi_i + v_b,      W_a . (d/dt L_v - L_q - F) = 0      along v' = W Xi'_i + W' Xi_i + v_b'.
/// ```
impl<const N: usize, const M: usize> Differentiable<N, M> for Gauss {
    fn guess(&self, v: &[f64; N]) -> Vec<f64> {
        let stage = [&v[..], &[0.0; N][..dimension::<N, M>()]].concat();
        [vec![0.0; N], stage.repeat(self.stages())].concat()
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, h, q: q0, v: v0 } = *start;
        let mut unknowns = StepUnknowns(z);
        let (xi0, eta): ([Seeded; N], [Seeded; M]) = (unknowns.take_some(dimension::<N, M>()), unknowns.take());
        let count = self.stages();
        let (velocities, accelerations): (Vec<[Seeded; N]>, Vec<[Seeded; N]>) =
            (0..count).map(|_| (unknowns.take(), unknowns.take_some(dimension::<N, M>()))).unzip();

        let (a0, _) = model.constraint(t, &q0);
        let admissible = model.velocity(t, &q0, &xi0).ok_or(NO_BASIS)?;
        let mut residual = difference(&constrained(&admissible, &a0, &eta), &v0).to_vec();
        for i in 0..count {
            let t = t + h * self.rule.nodes[i];
            let coefficients: [f64; 8] = from_fn(|j| self.rule.columns[j][i]);
            let (q, v) = (advanced(&q0, h, &coefficients, &velocities), velocities[i]);
            let xi = advanced(&xi0, h, &coefficients, &accelerations);

            let (carried, acceleration) = model.turned(t, &q, &xi, &accelerations[i]).ok_or(NO_BASIS)?;
            residual.extend(difference(&v, &carried));
            let (forces, _) = model.motion(t, &q, &v, &acceleration, &[Seeded::zero(); M]);
            let basis = model.basis(t, &q).ok_or(NO_BASIS)?;
            residual.extend(basis.vectors().iter().map(|w| product(w, &forces)));
        }
        let increment = advanced(&[Seeded::zero(); N], h, &self.rule.weights, &velocities);
        let xi1 = advanced(&xi0, h, &self.rule.weights, &accelerations);
        let q1 = from_fn(|i| q0[i] + increment[i]);
        let velocity = model.velocity(t + h, &q1, &xi1).ok_or(NO_BASIS)?;
        Ok(StepEquations { residual, increment, velocity })
    }
}
