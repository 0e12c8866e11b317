use lagrangian::linear::{Lu, Singular};
use lagrangian::{Gradients, Scalar, Seeded, from_fn};
use nalgebra::DMatrix;

/// The reduced equations `q' = W xi + v_b`, `xi' = f(t, q, xi)` at one point, with their derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedField {
    /// The velocity `q'`.
    pub velocity: Vec<f64>,
    /// The accelerations `xi'`; only the first `N - M` places count.
    pub acceleration: Vec<f64>,
    /// The derivatives of `(q', xi')` in `(q, xi, t)`: `2 N - M` rows, one more column.
    pub derivative: DMatrix<f64>,
}

/// Number of directions that a [`Seeded`] number carries.
const SEEDS: usize = 8;

/// The reduced equations of a system at one point; `None` if it has no basis of admissible velocities.
///
/// The equations of motion `d/dt L_v - L_q - F = A' lambda` are linear in `(xi', lambda)`; they are solved for these, and
/// differentiated implicitly, on the numbers of [`Gradients`]: one code for every system.
///
/// # Errors
/// [`Singular`] if the mass matrix or the constraint is degenerate.
pub fn reduced_field<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Option<Result<ReducedField, Singular>> {
    // The variables: N unknowns (xi', lambda), then q, xi, t.
    let dimension = N - M;
    let count = 2 * N + dimension + 1;
    let values = |unknowns: &[f64; N]| -> Vec<f64> {
        unknowns.iter().chain(q).chain(&xi[..dimension]).copied().chain([t]).collect()
    };
    let first = differentiated(model, &values(&[0.0; N]))?;
    let solved = match Lu::new(from_fn(|i| from_fn(|j| first[(i, j)]))) {
        Ok(lu) => lu.solve(from_fn(|i| -first[(i, count)])),
        Err(singular) => return Some(Err(singular)),
    };
    let there = differentiated(model, &values(&solved))?;
    let lu = match Lu::new(from_fn(|i| from_fn(|j| there[(i, j)]))) {
        Ok(lu) => lu,
        Err(singular) => return Some(Err(singular)),
    };
    let mut derivative = DMatrix::zeros(N + dimension, count - N);
    for column in 0..count - N {
        let change: [f64; N] = lu.solve(from_fn(|i| -there[(i, N + column)]));
        for i in 0..N {
            derivative[(i, column)] = there[(N + i, N + column)];
        }
        for a in 0..dimension {
            derivative[(N + a, column)] = change[a];
        }
    }
    Some(Ok(ReducedField {
        velocity: (0..N).map(|i| there[(N + i, count)]).collect(),
        acceleration: (0..N).map(|a| if a < dimension { solved[a] } else { 0.0 }).collect(),
        derivative,
    }))
}

/// The residual of the equations of motion and the velocity, `N` rows each, with their derivatives in the variables; the values
/// are the last column.
fn differentiated<const N: usize, const M: usize>(model: &dyn Gradients<N, M>, values: &[f64]) -> Option<DMatrix<f64>> {
    let dimension = N - M;
    let mut all = DMatrix::zeros(2 * N, values.len() + 1);
    for block in 0..values.len().div_ceil(SEEDS) {
        let variable = |index: usize| {
            let mut number = Seeded::constant(values[index]);
            if let Some(eps) = index.checked_sub(block * SEEDS).and_then(|k| number.eps.get_mut(k)) {
                *eps = 1.0;
            }
            number
        };
        let rate = from_fn(|a| if a < dimension { variable(a) } else { Seeded::zero() });
        let lambda: [Seeded; M] = from_fn(|k| variable(dimension + k));
        let q: [Seeded; N] = from_fn(|i| variable(N + i));
        let xi = from_fn(|a| if a < dimension { variable(2 * N + a) } else { Seeded::zero() });
        let t = variable(2 * N + dimension);
        let (v, acceleration) = model.turned(t, &q, &xi, &rate)?;
        let (forces, _) = model.motion(t, &q, &v, &acceleration, &lambda);
        for (i, number) in forces.iter().chain(&v).enumerate() {
            all[(i, values.len())] = number.re;
            for (k, eps) in number.eps.iter().enumerate().filter(|(k, _)| block * SEEDS + k < values.len()) {
                all[(i, block * SEEDS + k)] = *eps;
            }
        }
    }
    Some(all)
}
