//! The derivatives of the baselines: explicit methods by equations for the accelerations of their stages.

use super::{Dop853, ImplicitMidpoint, Rk4, Rk4Projected, Rk4Reduced, STAGES};
use crate::{Differentiable, SensitivityError, StepEquations, StepStart, StepUnknowns};
use lagrangian::{AdmissibleBasis, Gradients, Scalar, Seeded, from_fn};

/// `x + h k`.
fn shifted<const N: usize>(x: &[Seeded; N], h: Seeded, k: &[Seeded; N]) -> [Seeded; N] {
    from_fn(|i| x[i] + h * k[i])
}

/// The increment `h/6 (k1 + 2 k2 + 2 k3 + k4)`.
fn weighted<const N: usize>(h: Seeded, k: &[[Seeded; N]; 4]) -> [Seeded; N] {
    from_fn(|i| h * (k[0][i] + (k[1][i] + k[2][i]) * 2.0 + k[3][i]) / 6.0)
}

/// The residual and the increments of `q` and `v` of [`Rk4`], in the accelerations and multipliers of the stages.
fn full<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    start: &StepStart<N>,
    unknowns: &mut StepUnknowns<'_>,
) -> (Vec<Seeded>, [Seeded; N], [Seeded; N]) {
    let StepStart { t, h, q: q0, v: v0 } = start;
    let (mut velocities, mut accelerations) = ([[Seeded::zero(); N]; 4], [[Seeded::zero(); N]; 4]);
    let (mut q, mut v) = (*q0, *v0);
    let mut residual = Vec::new();
    for (i, stage) in STAGES.iter().enumerate() {
        if i > 0 {
            q = shifted(q0, *h * *stage, &velocities[i - 1]);
            v = shifted(v0, *h * *stage, &accelerations[i - 1]);
        }
        (velocities[i], accelerations[i]) = (v, unknowns.take());
        let (forces, slips) = model.motion(*t + *h * *stage, &q, &v, &accelerations[i], &unknowns.take());
        residual.extend(forces.iter().chain(&slips));
    }
    (residual, weighted(*h, &velocities), weighted(*h, &accelerations))
}

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
        let (residual, increment, gain) = full(model, start, &mut StepUnknowns(z));
        Ok(StepEquations { residual, increment, velocity: from_fn(|i| start.v[i] + gain[i]) })
    }
}

/// With the projection `L_vv (w - v) = A' mu`, `A w + b = 0`.
impl<const N: usize, const M: usize> Differentiable<N, M> for Rk4Projected {
    fn guess(&self, _v: &[f64; N]) -> Vec<f64> {
        vec![0.0; 5 * (N + M)]
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let mut unknowns = StepUnknowns(z);
        let (mut residual, increment, gain) = full(model, start, &mut unknowns);
        let (correction, mu): ([Seeded; N], [Seeded; M]) = (unknowns.take(), unknowns.take());
        let (t1, q1) = (start.t + start.h, from_fn(|i| start.q[i] + increment[i]));
        let v = from_fn(|i| start.v[i] + gain[i]);
        let velocity = from_fn(|i| v[i] + correction[i]);
        // The rate of the momenta is linear in the acceleration, with the matrix L_vv.
        let (moved, still) =
            (model.momentum_rate(t1, &q1, &v, &correction), model.momentum_rate(t1, &q1, &v, &[Seeded::zero(); N]));
        let (a, _) = model.constraint(t1, &q1);
        residual.extend((0..N).map(|i| (0..M).fold(moved[i] - still[i], |sum, k| sum - a[k][i] * mu[k])));
        residual.extend(model.slip(t1, &q1, &velocity));
        Ok(StepEquations { residual, increment, velocity })
    }
}

/// In the rates `xi'` of the stages, after the quasi-velocities `xi0` with `v0 = W xi0 + v_b + A' eta`.
impl<const N: usize, const M: usize> Differentiable<N, M> for Rk4Reduced {
    fn guess(&self, _v: &[f64; N]) -> Vec<f64> {
        vec![0.0; N + 4 * AdmissibleBasis::<f64, N, M>::DIMENSION]
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, h, q: q0, v: v0 } = *start;
        let dimension = AdmissibleBasis::<f64, N, M>::DIMENSION;
        let mut unknowns = StepUnknowns(z);
        let (xi0, eta): ([Seeded; N], [Seeded; M]) = (unknowns.take_some(dimension), unknowns.take());
        let admissible = model.velocity(t, &q0, &xi0).ok_or(NO_BASIS)?;
        let (a0, _) = model.constraint(t, &q0);
        let mut residual: Vec<Seeded> =
            (0..N).map(|i| (0..M).fold(admissible[i] - v0[i], |sum, k| sum + a0[k][i] * eta[k])).collect();

        let (mut velocities, mut rates) = ([[Seeded::zero(); N]; 4], [[Seeded::zero(); N]; 4]);
        let (mut q, mut xi) = (q0, xi0);
        for (i, stage) in STAGES.iter().enumerate() {
            if i > 0 {
                q = shifted(&q0, h * *stage, &velocities[i - 1]);
                xi = shifted(&xi0, h * *stage, &rates[i - 1]);
            }
            let t = t + h * *stage;
            rates[i] = unknowns.take_some(dimension);
            let (v, acceleration) = model.turned(t, &q, &xi, &rates[i]).ok_or(NO_BASIS)?;
            velocities[i] = v;
            let (forces, _) = model.motion(t, &q, &v, &acceleration, &[Seeded::zero(); M]);
            let basis = model.basis(t, &q).ok_or(NO_BASIS)?;
            residual
                .extend(basis.vectors().iter().map(|w| (0..N).fold(Seeded::zero(), |sum, i| sum + w[i] * forces[i])));
        }
        let increment = weighted(h, &velocities);
        let xi1 = shifted(&xi0, Seeded::constant(1.0), &weighted(h, &rates));
        let velocity = model.velocity(t + h, &from_fn(|i| q0[i] + increment[i]), &xi1).ok_or(NO_BASIS)?;
        Ok(StepEquations { residual, increment, velocity })
    }
}

const NO_BASIS: SensitivityError =
    SensitivityError::Unsupported { reason: "the reduced equations need a basis, and the system has no basis" };

/// In the acceleration and the multipliers in the middle.
impl<const N: usize, const M: usize> Differentiable<N, M> for ImplicitMidpoint {
    fn guess(&self, _v: &[f64; N]) -> Vec<f64> {
        vec![0.0; N + M]
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, h, q: q0, v: v0 } = *start;
        let (half, mut unknowns) = (h * 0.5, StepUnknowns(z));
        let (a, lambda): ([Seeded; N], [Seeded; M]) = (unknowns.take(), unknowns.take());
        let v = shifted(&v0, half, &a);
        let (forces, slips) = model.motion(t + half, &shifted(&q0, half, &v), &v, &a, &lambda);
        let residual = [&forces[..], &slips].concat();
        Ok(StepEquations { residual, increment: v.map(|v| h * v), velocity: shifted(&v0, h, &a) })
    }
}

/// Refused: the steps within an interval change by jumps.
impl<const N: usize, const M: usize> Differentiable<N, M> for Dop853<N, M> {
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
            reason: "an adaptive method chooses its steps from the state, so the number of steps jumps where the \
                state changes",
        })
    }
}
