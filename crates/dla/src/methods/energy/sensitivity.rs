use super::Energy;
use super::rule::MOST;
use crate::sensitivity::{
    Differentiable, NO_BASIS, SensitivityError, StepEquations, StepStart, StepUnknowns, advanced, constrained,
    difference, dimension, product,
};
use lagrangian::{Dual, Gradients, Lanes, Scalar, Seeded, from_fn, mapped};

/// In the rates of the path at the collocation nodes and the quasi-velocities at all of its points, which belong to its
/// quasi-momenta, `W_a . L_v(q, W xi) = pi_a`.
impl<const N: usize, const M: usize> Differentiable<N, M> for Energy {
    fn guess(&self, v: &[f64; N]) -> Vec<f64> {
        // The start, then rates of q and of pi, then the quasi-velocities at nodes, points and end.
        let rates = [&v[..], &[0.0; N][..dimension::<N, M>()]].concat().repeat(self.rule.stages);
        [vec![0.0; N], rates, vec![0.0; (Lanes::COUNT + self.rule.stages + 1) * dimension::<N, M>()]].concat()
    }

    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError> {
        let StepStart { t, h, q: q0, v: v0 } = *start;
        let (mut unknowns, dimension) = (StepUnknowns(z), dimension::<N, M>());
        let (xi0, eta): ([Seeded; N], [Seeded; M]) = (unknowns.take_some(dimension), unknowns.take());
        let stages = self.rule.stages;
        let (q_rates, pi_rates): (Vec<[Seeded; N]>, Vec<[Seeded; N]>) =
            (0..stages).map(|_| (unknowns.take(), unknowns.take_some(dimension))).unzip();

        let (a0, _) = model.constraint(t, &q0);
        let first = EnergyPoint::at(model, t, &q0, &xi0)?;
        let mut residual = difference(&constrained(&first.velocity, &a0, &eta), &v0).to_vec();
        let pi0 = first.quasi_momenta();

        // The point of the path at `tau`; `weights` are the integrals of the Lagrange polynomials to `tau`.
        let mut on_path = |tau: f64, weights: &[f64]| -> Result<EnergyPoint<N, M>, SensitivityError> {
            let q = advanced(&q0, h, weights, &q_rates);
            let point = EnergyPoint::at(model, t + h * tau, &q, &unknowns.take_some(dimension))?;
            let missing = difference(&point.quasi_momenta(), &advanced(&pi0, h, weights, &pi_rates));
            residual.extend(&missing[..dimension]);
            Ok(point)
        };
        let (mut h_q, mut h_pi) = ([[Seeded::zero(); N]; MOST], [[Seeded::zero(); N]; MOST]);
        for k in 0..Lanes::COUNT {
            let weights: Vec<f64> = self.rule.integrals_to_nodes().iter().map(|weights| weights.rounded(k)).collect();
            let point = on_path(self.rule.nodes.0[k], &weights)?;
            let slope = point.energy_slope(model)?;
            for i in 0..stages {
                let share = self.rule.averages()[i].rounded(k);
                h_q[i] = from_fn(|x| h_q[i][x] + slope[x] * share);
                h_pi[i] = from_fn(|x| h_pi[i][x] + point.xi[x] * share);
            }
        }
        let mut points = Vec::with_capacity(stages);
        for i in 0..stages {
            let weights: Vec<f64> = self.rule.integrals_to_points().iter().map(|weights| weights.rounded(i)).collect();
            points.push(on_path(self.rule.points.0[i], &weights)?);
        }
        let b: Vec<f64> = self.rule.b().iter().map(|b| b.hi).collect();
        let end = on_path(1.0, &b)?;

        for (i, point) in points.iter().enumerate() {
            let q_rate = point.basis_combined(&h_pi[i]);
            residual.extend(difference(&q_rates[i], &q_rate));
            let pi_rate = point.momentum_rates(model, &h_q[i], &h_pi[i], &q_rates[i])?;
            residual.extend(&difference(&pi_rates[i], &pi_rate)[..dimension]);
        }
        let increment = advanced(&[Seeded::zero(); N], h, &b, &q_rates);
        Ok(StepEquations { residual, increment, velocity: end.velocity })
    }
}

/// A point of `D*` with what the bracket there is made of.
#[derive(Debug, Clone)]
struct EnergyPoint<const N: usize, const M: usize> {
    t: Seeded,
    q: [Seeded; N],
    xi: [Seeded; N],
    basis: Vec<[Seeded; N]>,
    velocity: [Seeded; N],
    momentum: [Seeded; N],
}

impl<const N: usize, const M: usize> EnergyPoint<N, M> {
    fn at(model: &dyn Gradients<N, M>, t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Result<Self, SensitivityError> {
        let basis = model.basis(t, q).ok_or(NO_BASIS)?;
        let velocity = basis.combine(xi);
        let momentum = model.momentum(t, q, &velocity);
        Ok(Self { t, q: *q, xi: *xi, basis: basis.vectors().to_vec(), velocity, momentum })
    }

    fn along_basis(&self, f: &[Seeded; N]) -> [Seeded; N] {
        from_fn(|a| self.basis.get(a).map_or(Seeded::zero(), |w| product(w, f)))
    }

    fn basis_combined(&self, xi: &[Seeded; N]) -> [Seeded; N] {
        from_fn(|i| self.basis.iter().zip(xi).fold(Seeded::zero(), |sum, (w, xi)| sum + w[i] * *xi))
    }

    fn quasi_momenta(&self) -> [Seeded; N] {
        self.along_basis(&self.momentum)
    }

    /// `p . DW_b` along `direction`, for every `b`.
    fn turning(&self, model: &dyn Gradients<N, M>, direction: &[Seeded; N]) -> Result<[Seeded; N], SensitivityError> {
        let q = from_fn(|i| Dual { re: self.q[i], eps: [direction[i]] });
        let basis = model.basis_along(Dual::fixed(self.t), &q).ok_or(NO_BASIS)?;
        Ok(from_fn(|b| {
            basis.vectors().get(b).map_or(Seeded::zero(), |w| product(&mapped(w, |w| w.eps[0]), &self.momentum))
        }))
    }

    /// `H_q = -L_q - p . DW xi`.
    fn energy_slope(&self, model: &dyn Gradients<N, M>) -> Result<[Seeded; N], SensitivityError> {
        let mut h_q = mapped(&model.slope(self.t, &self.q, &self.velocity), |l_q| -l_q);
        for j in 0..N {
            let unit = from_fn(|i| Seeded::constant(f64::from(u8::from(i == j))));
            h_q[j] -= product(&self.turning(model, &unit)?, &self.xi);
        }
        Ok(h_q)
    }

    /// `-W_a . h_q - <p, [W_a, W_b]> h_pi_b + W_a . F`, the force at the velocity of the path.
    fn momentum_rates(
        &self,
        model: &dyn Gradients<N, M>,
        h_q: &[Seeded; N],
        h_pi: &[Seeded; N],
        q_rate: &[Seeded; N],
    ) -> Result<[Seeded; N], SensitivityError> {
        let mut rates = mapped(&self.along_basis(h_q), |f| -f);
        if let Some(force) = model.force(self.t, &self.q, q_rate) {
            let along = self.along_basis(&force);
            rates = from_fn(|a| rates[a] + along[a]);
        }
        // along[a][b] = p . DW_b W_a.
        let mut along = Vec::with_capacity(self.basis.len());
        for w in &self.basis {
            along.push(self.turning(model, w)?);
        }
        for a in 0..self.basis.len() {
            for b in 0..self.basis.len() {
                rates[a] -= (along[a][b] - along[b][a]) * h_pi[b];
            }
        }
        Ok(rates)
    }
}
