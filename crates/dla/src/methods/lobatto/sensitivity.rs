use super::Lobatto;
use super::tables::LobattoTables;
use crate::sensitivity::{
    Differentiable, SensitivityError, StepEquations, StepStart, StepUnknowns, advanced, constrained, difference,
};
use lagrangian::{Gradients, Scalar, Seeded, from_fn, mapped};

/// In the velocities of the stages, the impulses `l_j = h Lambda_j` of all stages but the last, and `(v1, mu)`.
impl<const S: usize, const N: usize, const M: usize> Differentiable<N, M> for Lobatto<S> {
    fn guess(&self, v: &[f64; N]) -> Vec<f64> {
        [v.repeat(S), vec![0.0; (S - 1) * M], v.to_vec(), vec![0.0; M]].concat()
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let LobattoTables { c, b, a, a_hat, .. } = &self.tables;
        let StepStart { t, h, q: q0, v: v0 } = *start;
        let mut unknowns = StepUnknowns(z);
        let velocities: [[Seeded; N]; S] = from_fn(|_| unknowns.take());
        let impulses: [[Seeded; M]; S] = from_fn(|j| if j + 1 < S { unknowns.take() } else { [Seeded::zero(); M] });
        let (v1, mu): ([Seeded; N], [Seeded; M]) = (unknowns.take(), unknowns.take());

        let one = Seeded::constant(1.0);
        let times = mapped(c, |c| t + h * c);
        let places: [[Seeded; N]; S] = from_fn(|i| advanced(&q0, h, &a[i], &velocities));
        let gains: [[Seeded; N]; S] = from_fn(|j| {
            let push = mapped(&model.push(times[j], &places[j], &velocities[j]), |f| h * f);
            constrained(&push, &model.constraint(times[j], &places[j]).0, &impulses[j])
        });
        let p0 = model.momentum(t, &q0, &v0);
        let mut residual = Vec::new();
        for i in 0..S {
            let p = advanced(&p0, one, &a_hat[i], &gains);
            residual.extend(difference(&model.momentum(times[i], &places[i], &velocities[i]), &p));
        }
        let slips: [[Seeded; M]; S] = from_fn(|j| model.slip(times[j], &places[j], &velocities[j]));
        for i in 1..S {
            residual.extend(advanced(&[Seeded::zero(); M], one, &a[i], &slips));
        }

        let increment = advanced(&[Seeded::zero(); N], h, b, &velocities);
        let (t1, q1) = (t + h, from_fn(|i| q0[i] + increment[i]));
        let p1 = constrained(&advanced(&p0, one, b, &gains), &model.constraint(t1, &q1).0, &mu);
        residual.extend(difference(&model.momentum(t1, &q1, &v1), &p1));
        residual.extend(model.slip(t1, &q1, &v1));
        Ok(StepEquations { residual, increment, velocity: v1 })
    }
}
