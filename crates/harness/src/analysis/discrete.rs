use super::Equilibrium;
use super::linear_map::{AllowedDirections, with_family};
use super::manifold::positions;
use super::root::nearest_root;
use super::spectrum::{Spectrum, size};
use crate::stepper::composed;
use crate::{Method, MethodKind, Rk4, Rk4Reduced};
use dla::{Differentiable, Dla, SeededMechanics, Sensitivity, SensitivityError, State, StepReport};
use lagrangian::from_fn;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// A method as an object whose steps can be differentiated; none for the methods that this is not done for.
///
/// The family of `dla`, and `rk4` and `rk4-reduced` beside it: every further one would be compiled for every shape of system.
#[must_use]
#[inline(never)]
pub fn differentiable<const N: usize, const M: usize>(method: &Method) -> Option<Box<dyn Differentiable<N, M>>> {
    Some(match method.info().kind {
        MethodKind::Dla => Box::new(Dla::midpoint()),
        MethodKind::DlaTrapezoid | MethodKind::DlaAlpha => Box::new(Dla::new(method.rule(), method.rule())),
        MethodKind::Composed(order) => Box::new(composed(order, Dla::midpoint())),
        MethodKind::Rk4 => Box::new(Rk4),
        MethodKind::Rk4Reduced => Box::new(Rk4Reduced),
        _ => return None,
    })
}

/// A step of a method on a system: by length and start, the end of it; none where it fails.
pub type Step<'a, const N: usize> = dyn FnMut(f64, &State<N>) -> Option<State<N>> + 'a;

/// The map of one step about an equilibrium of the flow.
pub struct DiscreteMap<'a, const N: usize, const M: usize> {
    system: &'a dyn SeededMechanics<N, M>,
    /// How many coordinates and quasi-velocities are its own.
    own: (usize, usize),
    method: &'a dyn Differentiable<N, M>,
    step: &'a mut Step<'a, N>,
}

/// Why there is no map about an equilibrium.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MapError {
    /// The steps of the method have no derivative there.
    #[error("the derivative of a step: {0}")]
    Derivative(SensitivityError),
    /// A step has no solution, or none that stays near the motion.
    #[error("no step stays near")]
    NoStep,
}

/// The longest step with which a stable motion stays stable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepLimit {
    /// With steps up to this (s) the map was computed, and is stable: no limit was found.
    Beyond(f64),
    /// An eigenvalue of the map leaves the unit circle (s): up to here it is stable, and beyond it was computed and is not.
    Unstable(f64),
    /// With steps up to this (s) the map was computed, and is stable; with longer ones it could not be.
    Ends(f64, MapError),
    /// With the shortest steps it could not be computed.
    Unknown(MapError),
}

impl StepLimit {
    /// The limit (s), where there is one.
    #[must_use]
    pub fn step(self) -> Option<f64> {
        match self {
            Self::Unstable(step) => Some(step),
            Self::Beyond(_) | Self::Ends(..) | Self::Unknown(_) => None,
        }
    }

    /// What ends there.
    #[must_use]
    pub fn reason(self) -> &'static str {
        match self {
            Self::Beyond(_) => "none",
            Self::Unstable(_) => "unstable",
            Self::Ends(..) => "no step",
            Self::Unknown(_) => "unknown",
        }
    }

    /// Up to which step the map was computed, and is stable (s).
    #[must_use]
    pub fn stable_up_to(self) -> Option<f64> {
        match self {
            Self::Beyond(step) | Self::Unstable(step) | Self::Ends(step, _) => Some(step),
            Self::Unknown(_) => None,
        }
    }
}

/// A root of the map minus one: what it moves at most, relative to one plus its size.
const ROOT: f64 = 1e-11;
/// How far from the equilibrium of the flow that of the map may lie, relative to the same.
const NEAR: f64 = 0.5;
/// Entries of the derivative of a step are rounded to this, those of the identity with them.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// The limit is searched for on steps from a thousandth of the given one to 9500 times that, `1.25^72 = 9.5e6` in all.
const FIRST: f64 = 1e-3;
const FACTOR: f64 = 1.25;
const RUNGS: i32 = 72;
const BISECTIONS: usize = 45;

impl<const N: usize, const M: usize> std::fmt::Debug for DiscreteMap<'_, N, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DiscreteMap").finish_non_exhaustive()
    }
}

impl<'a, const N: usize, const M: usize> DiscreteMap<'a, N, M> {
    /// The map of a method whose steps `step` makes, from time zero, on a system of which so many coordinates and constraints are its own.
    pub fn new(
        (system, (n, m)): (&'a dyn SeededMechanics<N, M>, (usize, usize)),
        method: &'a dyn Differentiable<N, M>,
        step: &'a mut Step<'a, N>,
    ) -> Self {
        Self { system, own: (n, n - m), method, step }
    }

    /// The eigenvalues of the map with the step `h` (s) in shape and quasi-velocities, along the directions that the constraints on
    /// positions leave, at its own equilibrium near that of the flow, the largest first.
    ///
    /// # Errors
    /// [`MapError`] where it has none.
    #[inline(never)]
    pub fn spectrum(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> Result<Vec<[f64; 2]>, MapError> {
        self.at_rest(h, equilibrium).map(|spectrum| spectrum.values)
    }

    fn at_rest(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> Result<Spectrum, MapError> {
        let mut outcome = None;
        // What rests does so in every basis; a motion is steady in that of the start.
        let system = self.system;
        if equilibrium.is_rest() {
            let q = &equilibrium.q;
            system.near_seeded(0.0, q, 0, &mut |_, near| outcome = Some(self.on(near, h, equilibrium)));
        }
        outcome.unwrap_or_else(|| self.on(system, h, equilibrium))
    }

    fn on(&mut self, system: &dyn SeededMechanics<N, M>, h: f64, near: &Equilibrium<N>) -> Result<Spectrum, MapError> {
        let (own, start) = (self.own, near.point(self.own));
        let mut map = StepMap { system, own, method: self.method, step: &mut *self.step, h, near, failure: None };
        let scale = 1.0 + start.norm();
        let root = nearest_root(&mut |z| map.moved(z), start.clone(), ROOT * scale);
        let root = root.filter(|z| (z - start).norm() <= NEAR * scale);
        root.and_then(|z| map.linearised(&z)).ok_or_else(|| map.failure.map_or(MapError::NoStep, MapError::Derivative))
    }

    /// The longest step with which a stable equilibrium of the flow is one of the map, looked for about the step `h` (s).
    #[inline(never)]
    pub fn limit(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> StepLimit {
        let (mut good, mut tried) = (None, h * FIRST);
        for _ in 0..RUNGS {
            match (self.is_stable(tried, equilibrium), good) {
                (Ok(true), _) => (good, tried) = (Some(tried), tried * FACTOR),
                (Ok(false), _) => return self.bisected(good.unwrap_or(0.0), tried, equilibrium),
                (Err(error), Some(good)) => return StepLimit::Ends(good, error),
                (Err(error), None) => return StepLimit::Unknown(error),
            }
        }
        StepLimit::Beyond(good.unwrap_or(0.0))
    }

    fn is_stable(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> Result<bool, MapError> {
        self.at_rest(h, equilibrium).map(|spectrum| spectrum.is_stable_map())
    }

    /// Between a step with which the map is stable and one with which it was found not to be.
    fn bisected(&mut self, mut good: f64, mut bad: f64, equilibrium: &Equilibrium<N>) -> StepLimit {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (good + bad);
            match self.is_stable(middle, equilibrium) {
                Ok(true) => good = middle,
                Ok(false) => bad = middle,
                Err(error) => return StepLimit::Ends(good, error),
            }
        }
        StepLimit::Unstable(good)
    }
}

/// The steps of one length about an equilibrium.
struct StepMap<'m, 's, const N: usize, const M: usize> {
    system: &'m dyn SeededMechanics<N, M>,
    own: (usize, usize),
    method: &'m dyn Differentiable<N, M>,
    step: &'m mut Step<'s, N>,
    h: f64,
    near: &'m Equilibrium<N>,
    /// Why a step had no derivative.
    failure: Option<SensitivityError>,
}

impl<const N: usize, const M: usize> StepMap<'_, '_, N, M> {
    /// What a step changes in shape and quasi-velocities, and what its start misses of the constraints on positions, with the derivatives in
    /// all coordinates and quasi-velocities.
    fn moved(&mut self, z: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (n, free) = self.own;
        let mut q = self.near.q;
        q[..n].copy_from_slice(&z.as_slice()[..n]);
        let xi: [f64; N] = from_fn(|a| if a < free { z[n + a] } else { 0.0 });
        let v = self.system.velocity_of(0.0, &q, &xi).ok()?;
        let start = State::new(q, v, self.system.angles());
        let end = (self.step)(self.h, &start)?;
        let sensitivity = Sensitivity::<N, M, 0>::of(self.system);
        let derivative = sensitivity.between(self.method, (0.0, self.h), &start, &end, StepReport::of(0));
        let derivative = derivative.map_err(|failure| self.failure = Some(failure)).ok()?.reduced?;
        let (moved, after) = (end.moved_since(&start), self.system.quasi_velocities(self.h, end.q(), end.v()).ok()?);
        let (misses, gradients) = positions(self.system, n, 0.0, &q);
        let shape = &self.near.shape;
        let rows: Vec<usize> = shape.iter().copied().chain(N..N + free).collect();
        let columns: Vec<usize> = (0..n).chain(N..N + free).collect();
        let value = |row: usize| if row < N { moved[row] } else { after[row - N] - xi[row - N] };
        let entry = |row: usize, column: usize| {
            let column = if column < N { &derivative.from_q[column] } else { &derivative.from_xi[column - N] };
            if row < N { column.q[row] } else { column.xi[row - N] }
        };
        let all = rows.len() + misses.len();
        let values = rows.iter().map(|row| value(*row)).chain(misses.iter().copied());
        let values = DVector::from_iterator(all, values);
        let slope = DMatrix::from_fn(all, columns.len(), |i, j| match rows.get(i) {
            Some(&row) => entry(row, columns[j]) - f64::from(u8::from(row == columns[j])),
            None => {
                if j < n {
                    gradients[(i - rows.len(), j)]
                } else {
                    0.0
                }
            }
        });
        Some((values, slope))
    }

    fn linearised(&mut self, z: &DVector<f64>) -> Option<Spectrum> {
        let (n, free) = self.own;
        let (_, slope) = self.moved(z)?;
        let shape = &self.near.shape;
        let rows = shape.len() + free;
        let gradients = slope.view((rows, 0), (slope.nrows() - rows, n)).into_owned();
        let along = AllowedDirections::new(&gradients, shape, free)?;
        let slope = along.restrict(&slope.rows(0, rows).into_owned());
        Some(with_family(slope, 1.0, ROUNDING, size)?.1)
    }
}
