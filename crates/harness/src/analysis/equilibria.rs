use super::reduced_field;
use super::root::nearest_root;
use super::spectrum::spectrum;
use dla::SeededMechanics;
use lagrangian::linear::Singular;
use lagrangian::{Gradients, ReducedError, from_fn};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// A motion that looks the same at all times but for where it is: steady quasi-velocities, and no change of the coordinates
/// that the equations depend on.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium<const N: usize> {
    /// Configuration at time zero.
    pub q: [f64; N],
    /// Velocity.
    pub v: [f64; N],
    /// Quasi-velocities; only the first `N - M` count.
    pub xi: [f64; N],
    /// The coordinates that the equations depend on, the shape; the others are cyclic.
    pub shape: Vec<usize>,
    /// How many directions the linear equations leave at rest: the parameters of the family that it belongs to; 0 where it
    /// stands alone.
    pub family: usize,
    /// The eigenvalues of the flow in shape and quasi-velocities, real and imaginary parts (1/s), the largest real part first.
    pub flow: Vec<[f64; 2]>,
    /// Whether no eigenvalue of the flow has a positive real part, but for rounding.
    pub stable: bool,
}

impl<const N: usize> Equilibrium<N> {
    /// Shape and quasi-velocities.
    pub(super) fn reduced(&self, dimension: usize) -> DVector<f64> {
        let numbers = self.shape.iter().map(|i| self.q[*i]).chain(self.xi[..dimension].iter().copied());
        DVector::from_vec(numbers.collect())
    }
}

/// Why there are no relative equilibria.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum EquilibriumError {
    /// There are no reduced equations.
    #[error(transparent)]
    Reduced(#[from] ReducedError),
    /// They are degenerate.
    #[error("the equations of motion are degenerate: {0}")]
    Singular(#[from] Singular),
    /// The constraints leave no velocity free.
    #[error("every velocity is imposed: the scene has no free motion that could be steady")]
    NothingFree,
    /// Something acts that depends on time.
    #[error("forces or constraints depend on time: a scene that depends on time has no steady motion")]
    TimeDependent,
    /// The search found no equilibrium.
    #[error("no relative equilibrium was found from {guesses} first guesses: there may be none")]
    NoneFound {
        /// How many.
        guesses: usize,
    },
}

/// Rates below this are none, relative to one plus the size of the point.
const ROOT: f64 = 1e-12;
/// A derivative below this, relative to the largest, is round-off.
const CYCLIC: f64 = 1e-10;
/// A singular value below this, relative to the largest, is a direction of the family.
const FAMILY: f64 = 1e-9;

/// How far from a first guess the search goes on where it ends there (m, rad), and at which points and times (s) it is asked
/// what the equations depend on: in general position.
const OFFSETS: [f64; 5] = [0.0, 0.37, -0.61, 0.83, 1.9];

/// Relative equilibria of a system: steady motions near its start, and near motions of its energy.
///
/// The coordinates that the reduced equations `xi' = f(q, xi)` do not depend on are cyclic, and free to change; the roots of
/// `f` and of the rates of the others are searched from the start, from rest, and from motions along each basis vector with the
/// kinetic energy of the start. Motions that are steady only with respect to a symmetry that is none of the coordinates, as
/// circles about the middle of a round bowl, are not among them. (Bloch 2003, Nonholonomic Mechanics and Control, section 5.)
///
/// # Errors
/// [`EquilibriumError`].
#[inline(never)]
pub fn relative_equilibria<const N: usize, const M: usize>(
    system: &dyn SeededMechanics<N, M>,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<Vec<Equilibrium<N>>, EquilibriumError> {
    if N == M {
        return Err(EquilibriumError::NothingFree);
    }
    let xi = system.quasi_velocities(0.0, q, v)?;
    let rest = system.velocity_of(0.0, q, &[0.0; N])?;
    let kinetic = |v: &[f64; N]| system.energy(0.0, q, v) - system.energy(0.0, q, &rest);
    let available = kinetic(v);
    // Rest first: it is exact, where what comes to rest from elsewhere is not.
    let mut guesses = vec![[0.0; N]];
    for axis in 0..N - M {
        let unit = from_fn(|k| f64::from(u8::from(k == axis)));
        let speed = (available / kinetic(&system.velocity_of(0.0, q, &unit)?)).max(0.0).sqrt();
        if speed.is_finite() && speed > 0.0 {
            guesses.extend([speed, -speed].map(|speed| unit.map(|unit| unit * speed)));
        }
    }
    guesses.push(xi);
    search(&*system.gradients(), q, &guesses)
}

fn search<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    q: &[f64; N],
    guesses: &[[f64; N]],
) -> Result<Vec<Equilibrium<N>>, EquilibriumError> {
    let dimension = N - M;
    let shape = shape(model, q, guesses)?;
    let placed = |z: &DVector<f64>| {
        let mut place = *q;
        shape.iter().enumerate().for_each(|(k, i)| place[*i] = z[k]);
        (place, from_fn(|a| if a < dimension { z[shape.len() + a] } else { 0.0 }))
    };
    let mut found: Vec<Equilibrium<N>> = Vec::new();
    for guess in guesses {
        let mut rates = |z: &DVector<f64>| {
            let (place, xi) = placed(z);
            rates(model, &place, &xi, &shape)
        };
        // From a symmetric start the search may get stuck: then it starts beside it.
        let offsets = if shape.is_empty() { &OFFSETS[..1] } else { &OFFSETS };
        let from = |offset: &f64| {
            let place = shape.iter().map(|i| q[*i] + offset * (0.5 + *i as f64).cos());
            DVector::from_vec(place.chain(guess[..dimension].iter().copied()).collect())
        };
        let mut starts = offsets.iter().map(from);
        let root = starts.find_map(|start| {
            let tolerance = ROOT * (1.0 + start.norm());
            nearest_root(&mut rates, start, tolerance)
        });
        let Some(z) = root else { continue };
        let Some((_, slope)) = rates(&z) else { continue };
        let Some(flow) = spectrum(&slope, |[re, _]| re) else { continue };
        let (place, xi) = placed(&z);
        let Some(Ok(field)) = reduced_field(model, 0.0, &place, &xi) else { continue };
        let singular = slope.singular_values();
        let family = singular.iter().filter(|s| **s <= FAMILY * singular.max()).count();
        let (stable, flow) = (flow.is_stable_flow(), flow.values);
        let equilibrium = Equilibrium { q: place, v: field.velocity, xi, shape: shape.clone(), family, flow, stable };
        if !found.iter().any(|other| alike(other, &equilibrium)) {
            found.push(equilibrium);
        }
    }
    // The fastest first, rest last.
    let speed = |e: &Equilibrium<N>| e.xi.iter().map(|x| x * x).sum::<f64>();
    found.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
    if found.is_empty() { Err(EquilibriumError::NoneFound { guesses: guesses.len() }) } else { Ok(found) }
}

/// Whether two equilibria are the same, or of one family and with quasi-velocities of the same signs.
fn alike<const N: usize>(a: &Equilibrium<N>, b: &Equilibrium<N>) -> bool {
    let near = |x: f64, y: f64| (x - y).abs() <= 1e-8 * (1.0 + x.abs().max(y.abs()));
    let sign = |x: f64| if x.abs() <= 1e-8 { 0.0 } else { x.signum() };
    let same_shape = a.shape.iter().all(|i| near(a.q[*i], b.q[*i]));
    let same = same_shape && (0..N).all(|k| near(a.xi[k], b.xi[k]));
    same || a.family > 0 && a.family == b.family && (0..N).all(|k| near(sign(a.xi[k]), sign(b.xi[k])))
}

/// The rates of shape and quasi-velocities, with their derivatives in these.
fn rates<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    q: &[f64; N],
    xi: &[f64; N],
    shape: &[usize],
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let field = reduced_field(model, 0.0, q, xi)?.ok()?;
    let rows: Vec<usize> = shape.iter().copied().chain(N..2 * N - M).collect();
    let value = |row: usize| if row < N { field.velocity[row] } else { field.acceleration[row - N] };
    let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| value(*row)));
    let slope = DMatrix::from_fn(rows.len(), rows.len(), |i, j| field.derivative[(rows[i], rows[j])]);
    Some((values, slope))
}

/// The coordinates that the reduced equations depend on, and those whose rates these depend on by them.
fn shape<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    q: &[f64; N],
    guesses: &[[f64; N]],
) -> Result<Vec<usize>, EquilibriumError> {
    let dimension = N - M;
    let (xi_rows, time) = (N..N + dimension, N + dimension);
    let mut sizes = DMatrix::zeros(N + dimension, N + dimension + 1);
    // Points in general position: what vanishes at all of them is taken to vanish.
    let points = OFFSETS.iter().zip(guesses.iter().cycle());
    for (offset, guess) in points {
        let near = |x: &[f64; N], turn: f64| from_fn(|i| x[i] + offset * (turn + i as f64).cos());
        let field = reduced_field(model, offset.abs(), &near(q, 0.5), &near(guess, 1.7));
        let field = field.ok_or(ReducedError::NoBasis)??;
        let sum = &sizes + field.derivative.abs();
        sizes = sum;
    }
    let largest = sizes.max();
    let matters = |row: usize, column: usize| sizes[(row, column)] > CYCLIC * largest;
    let mut shape: Vec<usize> = Vec::new();
    let mut rows: Vec<usize> = xi_rows.collect();
    while let Some(next) = (0..N).find(|j| !shape.contains(j) && rows.iter().any(|row| matters(*row, *j))) {
        shape.push(next);
        rows.push(next);
    }
    if rows.iter().any(|row| matters(*row, time)) {
        return Err(EquilibriumError::TimeDependent);
    }
    shape.sort_unstable();
    Ok(shape)
}
