use super::equations::{StepUnknowns, constrained, difference};
use super::{Differentiable, SensitivityError, StepEquations, StepStart};
use crate::Dla;
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
