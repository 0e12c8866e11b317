//! The equations of the methods whose steps have derivatives.

use super::equations::{NO_BASIS, StepUnknowns, advanced, constrained, difference, dimension, product};
use super::{Differentiable, SensitivityError, StepEquations, StepStart};
use crate::baseline::STAGES;
use crate::{Composition, Dla, Gauss, Rk4};
use lagrangian::{Gradients, Scalar, Seeded, from_fn, mapped};

/// With multipliers, in the unknowns `(v, lambda, v1, mu)`: [`Dla`] solves the same equations in whichever form.
///
/// For a quadrature rule with nodes `alpha_i` and weights `w_i`, at `q_i = q0 + alpha_i h v`,
///
/// ```text
/// D1 L_d + f_d^- = sum_i w_i [h (1 - alpha_i) (L_q + F) - L_v],      D2 L_d + f_d^+ = sum_i w_i [h alpha_i (L_q + F) + L_v].
/// ```
///
/// (Marsden and West 2001, section 2.3.) A constraint on positions takes the place of its discrete one, and one that is not
/// affine reacts along `d phi / dv` at the two nodes. A discrete Lagrangian that is written by hand has no such form, and no derivative
/// here.
impl<const N: usize, const M: usize> Differentiable<N, M> for Dla {
    fn carries_every_class(&self) -> bool {
        true
    }

    fn guess(&self, v: &[f64; N]) -> Vec<f64> {
        [&v[..], &[0.0; M], v, &[0.0; M]].concat()
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, h, q, v: v0 } = *start;
        let mut unknowns = StepUnknowns(z);
        let (v, lambda): ([Seeded; N], [Seeded; M]) = (unknowns.take(), unknowns.take());
        let (v1, mu): ([Seeded; N], [Seeded; M]) = (unknowns.take(), unknowns.take());
        let increment = mapped(&v, |v| h * v);
        let along = |alpha: f64| (t + h * alpha, from_fn(|i| q[i] + increment[i] * alpha));

        // p0 + D1 L_d + f_d^-, and D2 L_d + f_d^+.
        let (mut leaving, mut arriving) = (model.momentum(t, &q, &v0), [Seeded::zero(); N]);
        for node in self.rules.lagrangian.nodes() {
            let (t, q) = along(node.alpha);
            let (p, push) = (model.momentum(t, &q, &v), model.push(t, &q, &v));
            for i in 0..N {
                leaving[i] += (h * push[i] * (1.0 - node.alpha) - p[i]) * node.weight;
                arriving[i] += (h * push[i] * node.alpha + p[i]) * node.weight;
            }
        }
        let mut chord = [Seeded::zero(); M];
        for node in self.rules.constraint.nodes() {
            let (t, q) = along(node.alpha);
            let slip = model.slip(t, &q, &v);
            chord = from_fn(|k| chord[k] + slip[k] * node.weight);
        }

        let (t1, q1) = along(1.0);
        if let Some(positions) = model.holonomic(t1, &q1) {
            chord = from_fn(|k| positions[k].map_or(chord[k], |g| g / h));
        }
        let (a0, a1) = (model.reaction_rows(t, &q, &v0), model.reaction_rows(t1, &q1, &v1));
        let projected = constrained(&arriving, &a1, &mu);
        let residual = [
            &constrained(&leaving, &a0, &lambda)[..],
            &chord,
            &difference(&model.momentum(t1, &q1, &v1), &projected),
            &model.slip(t1, &q1, &v1),
        ]
        .concat();
        Ok(StepEquations { residual, increment, velocity: v1 })
    }
}

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

/// In the accelerations and multipliers of the stages.
impl<const N: usize, const M: usize> Differentiable<N, M> for Rk4 {
    fn guess(&self, _v: &[f64; N]) -> Vec<f64> {
        vec![0.0; 4 * (N + M)]
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, h, q: q0, v: v0 } = *start;
        let mut unknowns = StepUnknowns(z);
        let (mut velocities, mut accelerations) = ([[Seeded::zero(); N]; 4], [[Seeded::zero(); N]; 4]);
        let (mut q, mut v) = (q0, v0);
        let mut residual = Vec::new();
        for (i, stage) in STAGES.into_iter().enumerate() {
            if i > 0 {
                q = advanced(&q0, h, &[stage], &velocities[i - 1..i]);
                v = advanced(&v0, h, &[stage], &accelerations[i - 1..i]);
            }
            (velocities[i], accelerations[i]) = (v, unknowns.take());
            let (forces, slips) = model.motion(t + h * stage, &q, &v, &accelerations[i], &unknowns.take());
            residual.extend(forces.iter().chain(&slips));
        }
        let weights = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
        let increment = advanced(&[Seeded::zero(); N], h, &weights, &velocities);
        Ok(StepEquations { residual, increment, velocity: advanced(&v0, h, &weights, &accelerations) })
    }
}

/// The impulse of the constraints on a velocity that does not meet them, as a step without duration:
/// `L_v(q, v1) = L_v(q, v0) + A' mu`, `A v1 + b = 0`, or `phi(q, v1) = 0` with its reaction along `d phi / dv1`.
pub(super) struct Impulse;

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
