use crate::positions::onto_positions;
use crate::projection::project;
use crate::{Equations, Mechanics, Newton, StackUse, Stage, State, StepError};
use lagrangian::linear::Singular;
use lagrangian::{RowSpace, Saddle, from_fn, mapped};

const USE: StackUse = StackUse { squares: 18, rows: 24 };

/// A start that meets every constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start<const N: usize> {
    /// Configuration.
    pub q: [f64; N],
    /// Velocity.
    pub v: [f64; N],
    /// How far the configuration was moved, `sqrt(dq' M dq)`; zero if it was consistent to rounding.
    pub moved: f64,
    /// How far the velocity was changed, `sqrt(dv' M dv)`.
    pub changed: f64,
}

/// The start that meets all constraints and is nearest to a given one in the kinetic metric.
///
/// The configuration is the stationary point of `(q1 - q)' M(q) (q1 - q)` on `g(q1, t) = 0`, found from the given one by Newton's method.
/// The velocity solves `L_v(q1, v1) = L_v(q1, v) + A' mu` with `A v1 + b = 0`, and is the nearest if the Lagrangian is quadratic in
/// velocities. Rows may be dependent if they are consistent.
///
/// # Errors
/// [`StepError::Newton`] if there is none nearby, or positions contradict one another; [`StepError::Dependent`] if the rank of the
/// constraints drops there, or their velocities contradict one another.
pub fn consistent_start<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Result<Start<N>, StepError> {
    if const { USE.exceeds::<N, M>() } {
        return Err(USE.refusal::<N, M>());
    }
    let given = State::new(*q, *v, [false; N]);
    // Somewhere on the positions first, then along them to the nearest place.
    let guess = onto_positions(system, t, &given, [0.0; N], v)?;
    let mut nearest = Nearest { system, t, given: &given, mass: system.mass_matrix(t, q, v).1, nu: [0.0; M] };
    let mut way = guess;
    if guess.iter().any(|d| *d != 0.0) {
        Newton::default()
            .solve(&mut nearest, &mut way)
            .map_err(|source| StepError::Newton { stage: Stage::Positions, source })?;
        way = onto_positions(system, t, &given, way, v)?;
    }
    let q1 = given.ahead(&way);
    let v1 = project(system, t, &q1, v)?;
    let length = |d: &[f64; N]| {
        let (_, mass) = system.mass_matrix(t, &q1, &v1);
        (0..N).map(|i| (0..N).map(|j| d[i] * mass[i][j] * d[j]).sum::<f64>()).sum::<f64>().max(0.0).sqrt()
    };
    Ok(Start { q: q1, v: v1, moved: length(&way), changed: length(&from_fn(|i| v1[i] - v[i])) })
}

/// A row misses by more than this fraction of its terms only if the start is not meant to obey it: numbers that were typed have fewer
/// digits than computed ones.
const SLIP: f64 = 1e-6;

/// The first constraint that the velocity at the start of a run does not obey, as [`StepError::Slips`].
#[must_use]
pub fn slip<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    state: &State<N>,
) -> Option<StepError> {
    let (q, v) = (state.q(), state.v());
    let (residuals, rows, (_, b)) = (system.residual(t, q, v), system.reaction_rows(t, q, v), system.constraint(t, q));
    (0..M).find_map(|row| {
        let terms = (0..N).map(|i| (rows[row][i] * v[i]).abs()).sum::<f64>() + b[row].abs();
        let residual = residuals[row];
        (residual.abs() > SLIP * terms).then_some(StepError::Slips { row, residual })
    })
}

/// The equations for the move `d` to the nearest place: `M d + A(q + d)' nu = 0`, `g(q + d) = 0`.
struct Nearest<'a, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    t: f64,
    given: &'a State<N>,
    mass: [[f64; N]; N],
    nu: [f64; M],
}

impl<const N: usize, const M: usize> Equations<N> for Nearest<'_, N, M> {
    fn correction(&mut self, d: &[f64; N]) -> Result<[f64; N], Singular> {
        let q = self.given.ahead(d);
        let misses = self.system.position_misses(self.t, &q).unwrap_or([None; M]);
        let rows = mapped(&misses, |g| g.map_or([0.0; N], |g| g.eps));
        let mut block = self.mass;
        self.system.add_position_curvature(self.t, &q, &self.nu, &mut block);
        let some = RowSpace::new(&rows, &self.mass, RowSpace::<N, M>::ROUNDING).dependence().independent;
        let saddle = Saddle {
            block,
            transposed: rows,
            rows,
            right: from_fn(|i| -(0..N).map(|j| self.mass[i][j] * d[j]).sum::<f64>()),
            level: mapped(&misses, |g| g.map_or(0.0, |g| -g.re)),
        };
        let (correction, nu) = saddle.solve_some(some)?;
        self.nu = nu;
        Ok(correction)
    }
}
