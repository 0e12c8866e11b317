use dla::SeededMechanics;
use lagrangian::{Gradients, Scalar, Seeded, from_fn};

/// `q' = W xi + v_b` and `xi'`.
pub(super) type Slope<const N: usize> = [[Seeded; N]; 2];

/// The reduced equations with derivatives in eight directions; an object, so that what uses it is compiled once.
pub(super) trait ReducedFlow<const N: usize, const M: usize> {
    /// The slopes at a point; none where the system has no basis, or its equations are degenerate.
    fn slope(&self, t: f64, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<Slope<N>>;
}

/// The reduced equations of a system: by hand where it knows them, else from its Lagrangian.
#[derive(Debug)]
pub(super) struct Flow<'a, const N: usize, const M: usize>(pub(super) &'a dyn SeededMechanics<N, M>);

impl<const N: usize, const M: usize> ReducedFlow<N, M> for Flow<'_, N, M> {
    fn slope(&self, t: f64, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<Slope<N>> {
        let t = Seeded::constant(t);
        let velocity = self.0.velocity_seeded(t, q, xi)?;
        let rate = match self.0.reduced_motion_seeded(t, q, xi) {
            Some(rate) => from_fn(|a| if a < N - M { rate[a] } else { Seeded::zero() }),
            None => implicit(&*self.0.gradients(), t, q, xi)?,
        };
        Some([velocity, rate])
    }
}

/// The rates `xi'` that solve `w_a . (d/dt L_v - L_q - F) = 0` along `v' = W xi' + (W' xi + v_b')`, in which they are linear.
fn implicit<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    t: Seeded,
    q: &[Seeded; N],
    xi: &[Seeded; N],
) -> Option<[Seeded; N]> {
    let basis = model.basis(t, q)?;
    let residual = |rate: &[Seeded; N]| -> Option<[Seeded; N]> {
        let (v, acceleration) = model.turned(t, q, xi, rate)?;
        let (forces, _) = model.motion(t, q, &v, &acceleration, &[Seeded::zero(); M]);
        let along = |w: &[Seeded; N]| (0..N).fold(Seeded::zero(), |sum, i| sum + w[i] * forces[i]);
        Some(from_fn(|a| basis.vectors().get(a).map_or(Seeded::zero(), along)))
    };
    let free = residual(&[Seeded::zero(); N])?;
    let mut mass = [[Seeded::zero(); N]; N];
    for b in 0..N - M {
        let unit = from_fn(|a| Seeded::constant(if a == b { 1.0 } else { 0.0 }));
        let moved = residual(&unit)?;
        for a in 0..N - M {
            mass[a][b] = moved[a] - free[a];
        }
    }
    // The reduced mass matrix is symmetric and positive: no pivots are needed.
    let mut rate = free.map(|f| -f);
    for k in 0..N - M {
        for l in k + 1..N - M {
            let factor = mass[l][k] / mass[k][k];
            for m in k..N - M {
                mass[l][m] -= factor * mass[k][m];
            }
            rate[l] -= factor * rate[k];
        }
    }
    for k in (0..N - M).rev() {
        for l in k + 1..N - M {
            rate[k] -= mass[k][l] * rate[l];
        }
        rate[k] = rate[k] / mass[k][k];
    }
    Some(rate)
}

/// The divergence of the reduced equations in the coordinates `(q, xi)` (1/s): the rate at which the flow makes volumes grow;
/// and the rates `xi'`.
pub(super) fn divergence<const N: usize, const M: usize>(
    flow: &dyn ReducedFlow<N, M>,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Option<(f64, [f64; N])> {
    let [velocity, rate] = flow.slope(t, &seeded(q, 0), &seeded(&admissible::<N, M>(xi), N))?;
    let of_q: f64 = (0..N).map(|i| velocity[i].eps[i]).sum();
    let of_xi: f64 = (0..N - M).map(|a| rate[a].eps[N + a]).sum();
    Some((of_q + of_xi, from_fn(|a| if a < N - M { rate[a].re } else { 0.0 })))
}

/// Variables that are seeded in the directions from `first` on, as far as there are directions.
pub(super) fn seeded<const N: usize>(x: &[f64; N], first: usize) -> [Seeded; N] {
    from_fn(|i| {
        let mut number = Seeded::constant(x[i]);
        if let Some(eps) = number.eps.get_mut(first + i) {
            *eps = 1.0;
        }
        number
    })
}

/// Quasi-velocities with zeros in the places that do not count.
pub(super) fn admissible<const N: usize, const M: usize>(xi: &[f64; N]) -> [f64; N] {
    from_fn(|a| if a < N - M { xi[a] } else { 0.0 })
}
