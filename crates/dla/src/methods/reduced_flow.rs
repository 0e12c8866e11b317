use crate::SeededMechanics;
use lagrangian::{Gradients, Scalar, Seeded, from_fn};

/// The reduced equations `q' = W xi + v_b` and `xi'` with derivatives in eight directions: by hand if the system knows them, else from its
/// Lagrangian; `None` if the system has no basis, or if its equations are degenerate.
pub(crate) fn reduced_flow<const N: usize, const M: usize>(
    system: &dyn SeededMechanics<N, M>,
    t: f64,
    q: &[Seeded; N],
    xi: &[Seeded; N],
) -> Option<[[Seeded; N]; 2]> {
    let t = Seeded::constant(t);
    let velocity = system.velocity_seeded(t, q, xi)?;
    let rate = match system.reduced_motion_seeded(t, q, xi) {
        Some(rate) => from_fn(|a| if a < N - M { rate[a] } else { Seeded::zero() }),
        None => implicit(&*system.gradients(), t, q, xi)?,
    };
    Some([velocity, rate])
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
