use super::Variation;
use super::equations::dimension;
use super::implicit::{Seeder, blocks, seeded, variable};
use lagrangian::linear::Lu;
use lagrangian::{Scalar, Seeded, from_fn, mapped};

/// A variation of a configuration and of its quasi-velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReducedVariation<const N: usize> {
    /// The variation of the configuration.
    pub q: [f64; N],
    /// The variation of the quasi-velocities; the last `M` entries are zero.
    pub xi: [f64; N],
}

/// The derivative of one step `(q0, xi0) -> (q1, xi1)` in the `2 N - M` coordinates of the distribution.
///
/// `v = W xi + v_b` as for [`velocity_of`](lagrangian::velocity_of), so that every column is an admissible variation, also the columns in
/// the parameters and in time: there `xi0` is fixed and `v0` goes along with the constraint.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedDerivative<const N: usize, const P: usize> {
    /// The number of quasi-velocities, `N - M`.
    pub dimension: usize,
    /// In every component of `q0`.
    pub from_q: [ReducedVariation<N>; N],
    /// In every quasi-velocity at the start; the last `M` columns are zero.
    pub from_xi: [ReducedVariation<N>; N],
    /// In every parameter.
    pub from_parameters: [ReducedVariation<N>; P],
    /// In the time of the start (per s).
    pub from_time: ReducedVariation<N>,
    /// In the length of the step (per s).
    pub from_step: ReducedVariation<N>,
}

impl<const N: usize, const P: usize> ReducedDerivative<N, P> {
    /// The matrix `d(q1, xi1)/d(q0, xi0)` by rows, `2 N - M` of them.
    #[must_use]
    pub fn matrix(&self) -> Vec<Vec<f64>> {
        let columns: Vec<&ReducedVariation<N>> = self.from_q.iter().chain(&self.from_xi[..self.dimension]).collect();
        let row = |entry: &dyn Fn(&ReducedVariation<N>) -> f64| columns.iter().map(|column| entry(column)).collect();
        let of_q = (0..N).map(|i| row(&|column| column.q[i]));
        let of_xi = (0..self.dimension).map(|a| row(&|column| column.xi[a]));
        of_q.chain(of_xi).collect()
    }
}

/// Basis and `W xi + v_b` at one end of a step, with their derivatives at fixed `xi`.
pub(super) struct BasisFrame<const N: usize, const P: usize> {
    /// The basis vectors; the last `M` are zero.
    pub(super) basis: [[f64; N]; N],
    pub(super) in_q: [[f64; N]; N],
    pub(super) in_time: [f64; N],
    pub(super) in_parameters: [[f64; N]; P],
    /// `[W A']`.
    split: Lu<N>,
    dimension: usize,
}

impl<const N: usize, const P: usize> BasisFrame<N, P> {
    /// `None` if the system has no basis, or one that does not span the distribution.
    pub(super) fn new<const M: usize>(
        seeder: &Seeder<'_, N, M>,
        parameters: &[f64; P],
        t: f64,
        q: &[f64; N],
        v: &[f64; N],
    ) -> Option<Self> {
        let at = |block: usize| {
            let p: [Seeded; P] = from_fn(|k| seeded(parameters[k], N + 1 + k, block));
            (seeder(&p), seeded(t, N, block), from_fn::<_, N, _>(|i| seeded(q[i], i, block)))
        };
        let (model, time, place) = at(0);
        let vectors = model.basis(time, &place)?;
        let (a, _) = model.constraint(time, &place);
        let mut columns = [[0.0; N]; N];
        for (column, w) in columns.iter_mut().zip(vectors.vectors().iter().chain(&a)) {
            *column = mapped(w, |w| w.re);
        }
        let split = Lu::new(from_fn(|i| from_fn(|j| columns[j][i]))).ok()?;
        let mut basis = columns;
        basis[dimension::<N, M>()..].fill([0.0; N]);

        let shift = model.velocity(time, &place, &[Seeded::zero(); N])?;
        let mut xi = split.solve(from_fn(|i| v[i] - shift[i].re));
        xi[dimension::<N, M>()..].fill(0.0);
        let mut derivatives = vec![[0.0; N]; N + 1 + P];
        for block in 0..blocks(N + 1 + P) {
            let (model, time, place) = at(block);
            let velocity = model.velocity(time, &place, &mapped(&xi, Seeded::constant))?;
            for (k, column) in derivatives.iter_mut().skip(variable(block, 0)).take(8).enumerate() {
                *column = mapped(&velocity, |v| v.eps[k]);
            }
        }
        Some(Self {
            basis,
            in_q: from_fn(|j| derivatives[j]),
            in_time: derivatives[N],
            in_parameters: from_fn(|k| derivatives[N + 1 + k]),
            split,
            dimension: dimension::<N, M>(),
        })
    }

    /// The quasi-velocities of a variation at this end; `explicit` is the change of `W xi + v_b` that is not caused by `dq`.
    fn reduced(&self, end: &Variation<N>, explicit: &[f64; N]) -> ReducedVariation<N> {
        let rest = from_fn(|i| end.v[i] - explicit[i] - (0..N).map(|j| self.in_q[j][i] * end.q[j]).sum::<f64>());
        let mut xi = self.split.solve(rest);
        xi[self.dimension..].fill(0.0);
        ReducedVariation { q: end.q, xi }
    }
}

/// The columns of a derivative, in `(q0, v0, p)`, then in time and step.
pub(super) struct BasisColumns<'a, const N: usize, const P: usize> {
    pub(super) from_q: &'a [Variation<N>; N],
    pub(super) from_v: &'a [Variation<N>; N],
    pub(super) from_parameters: &'a [Variation<N>; P],
    pub(super) from_time: &'a Variation<N>,
    pub(super) from_step: &'a Variation<N>,
}

impl<const N: usize, const P: usize> BasisColumns<'_, N, P> {
    /// The same columns with the quasi-velocities of `start` and `end`.
    pub(super) fn reduced(&self, start: &BasisFrame<N, P>, end: &BasisFrame<N, P>) -> ReducedDerivative<N, P> {
        // The effect of a change of `v0` alone.
        let through = |v: &[f64; N]| (0..N).fold(Variation::ZERO, |sum, i| sum.plus(v[i], &self.from_v[i]));
        let none = [0.0; N];
        ReducedDerivative {
            dimension: start.dimension,
            from_q: from_fn(|j| end.reduced(&self.from_q[j].plus(1.0, &through(&start.in_q[j])), &none)),
            from_xi: from_fn(|a| end.reduced(&through(&start.basis[a]), &none)),
            from_parameters: from_fn(|k| {
                let column = self.from_parameters[k].plus(1.0, &through(&start.in_parameters[k]));
                end.reduced(&column, &end.in_parameters[k])
            }),
            from_time: end.reduced(&self.from_time.plus(1.0, &through(&start.in_time)), &end.in_time),
            from_step: end.reduced(self.from_step, &end.in_time),
        }
    }
}
