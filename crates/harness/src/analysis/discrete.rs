use super::Equilibrium;
use super::flow::{filled, own_counts};
use super::linear_map::{AllowedDirections, with_family};
use super::manifold::{positions, with_rows};
use super::root::nearest_root;
use super::spectrum::{Spectrum, size};
use crate::Run;
use crate::{Method, MethodKind};
use dla::{AnyState, Mechanism, Report, Schedule, SensitivityError, Size};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Whether the steps of a method have a [`DiscreteMap`]: only the family of `dla` and `rk4` have one.
#[must_use]
pub fn has_map(method: &Method) -> bool {
    use MethodKind::{Composed, Dla, DlaAlpha, DlaTrapezoid, Rk4};
    matches!(method.info().kind, Dla | DlaTrapezoid | DlaAlpha | Composed(_) | Rk4)
}

/// The map of one step of a method about an equilibrium of the flow.
#[derive(Debug)]
pub struct DiscreteMap<'a> {
    system: &'a dyn Mechanism,
    /// The numbers of its own coordinates and own quasi-velocities.
    own: (usize, usize),
    method: &'a Method,
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
    /// The map was computed with steps up to this (s), and is stable: no limit was found.
    Beyond(f64),
    /// Up to this step (s) the map is stable; with longer steps an eigenvalue leaves the unit circle.
    Unstable(f64),
    /// Up to this step (s) the map is stable; with longer steps it could not be computed.
    Ends(f64, MapError),
    /// The map could not be computed with the shortest steps.
    Unknown(MapError),
}

impl StepLimit {
    /// The limit (s); `None` if none was found.
    #[must_use]
    pub fn step(self) -> Option<f64> {
        match self {
            Self::Unstable(step) => Some(step),
            Self::Beyond(_) | Self::Ends(..) | Self::Unknown(_) => None,
        }
    }

    /// The kind of the limit.
    #[must_use]
    pub fn reason(self) -> &'static str {
        match self {
            Self::Beyond(_) => "none",
            Self::Unstable(_) => "unstable",
            Self::Ends(..) => "no step",
            Self::Unknown(_) => "unknown",
        }
    }

    /// The longest step with which the map was computed and is stable (s).
    #[must_use]
    pub fn stable_up_to(self) -> Option<f64> {
        match self {
            Self::Beyond(step) | Self::Unstable(step) | Self::Ends(step, _) => Some(step),
            Self::Unknown(_) => None,
        }
    }
}

/// Tolerance of a root of the map minus one: its largest change, relative to one plus the size of the point.
const ROOT: f64 = 1e-11;
/// Largest distance between the equilibria of the flow and of the map, relative to one plus the size of the former.
const NEAR: f64 = 0.5;
/// The rounding of the entries of the derivative of a step, also after the identity is subtracted.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// The limit is searched for on steps from a thousandth of the given one to 9500 times that, `1.25^72 = 9.5e6` in all.
const FIRST: f64 = 1e-3;
const FACTOR: f64 = 1.25;
const RUNGS: i32 = 72;
const BISECTIONS: usize = 45;

impl<'a> DiscreteMap<'a> {
    /// The map of a method's steps from time zero. The first coordinates and constraints of the system, in the numbers `own`, are its own.
    #[must_use]
    pub fn new(system: &'a dyn Mechanism, own: (usize, usize), method: &'a Method) -> Self {
        Self { system, own: own_counts(system, own), method }
    }

    /// The eigenvalues of the map with the step `h` (s), the largest first, at its own equilibrium near the equilibrium of the flow: in
    /// shape and quasi-velocities, along the directions that the constraints on positions leave.
    ///
    /// # Errors
    /// [`MapError`] if the map has no such equilibrium or no derivative.
    pub fn spectrum(&self, h: f64, equilibrium: &Equilibrium) -> Result<Vec<[f64; 2]>, MapError> {
        self.at_rest(h, equilibrium).map(|spectrum| spectrum.values)
    }

    fn at_rest(&self, h: f64, equilibrium: &Equilibrium) -> Result<Spectrum, MapError> {
        let mut outcome = None;
        // A system at rest is at rest in every basis; a motion is steady in the basis of the start.
        if equilibrium.is_rest() {
            let q = &equilibrium.q;
            self.system.near(0.0, q, 0, &mut |_, near| outcome = Some(self.on(near, h, equilibrium)));
        }
        outcome.unwrap_or_else(|| self.on(self.system, h, equilibrium))
    }

    fn on(&self, system: &dyn Mechanism, h: f64, near: &Equilibrium) -> Result<Spectrum, MapError> {
        let mut failure = None;
        let mut moved = |z: &DVector<f64>| self.moved(system, h, (near, z), &mut failure);
        let start = near.point(self.own);
        let scale = 1.0 + start.norm();
        let root = nearest_root(&mut moved, start.clone(), ROOT * scale);
        let root = root.filter(|z| (z - start).norm() <= NEAR * scale);
        let found = root.and_then(|z| moved(&z)).and_then(|(_, slope)| self.linearised(&slope, &near.shape));
        found.ok_or_else(|| failure.map_or(MapError::NoStep, MapError::Derivative))
    }

    /// The longest step with which a stable equilibrium of the flow is stable in the map, searched for about the step `h` (s).
    pub fn limit(&self, h: f64, equilibrium: &Equilibrium) -> StepLimit {
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

    fn is_stable(&self, h: f64, equilibrium: &Equilibrium) -> Result<bool, MapError> {
        self.at_rest(h, equilibrium).map(|spectrum| spectrum.is_stable_map())
    }

    /// The limit between a step with which the map is stable and one with which it is not.
    fn bisected(&self, mut good: f64, mut bad: f64, equilibrium: &Equilibrium) -> StepLimit {
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

    /// The changes of shape and quasi-velocities in a step, and the misses of the constraints on positions at its start, with the
    /// derivatives in all coordinates and quasi-velocities. `failure` receives the reason if the step has no derivative.
    fn moved(
        &self,
        system: &dyn Mechanism,
        h: f64,
        (near, z): (&Equilibrium, &DVector<f64>),
        failure: &mut Option<SensitivityError>,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let ((n, free), Size { n: all, m }) = (self.own, system.size());
        let (mut q, mut xi) = (filled(all, &near.q), vec![0.0; all]);
        q[..n].copy_from_slice(&z.as_slice()[..n]);
        xi[..free].copy_from_slice(&z.as_slice()[n..]);
        let start = system.state(&q, &system.velocity_of(0.0, &q, &xi).ok()?);
        let end = self.stepped(h, &start)?;
        let derivative = system.step_derivative(self.method, (0.0, h), [&start, &end], &Report::of(m));
        let derivative = derivative.map_err(|reason| *failure = Some(reason)).ok()?;
        let after = system.quasi_velocities(h, end.q(), end.v()).ok()?;
        let change = after.iter().zip(&xi).map(|(after, before)| after - before);
        let change: Vec<f64> = end.moved_since(&start).into_iter().chain(change).collect();
        let (misses, gradients) = positions(system, n, 0.0, &q);
        let rows: Vec<usize> = near.shape.iter().copied().chain(all..all + free).collect();
        let columns: Vec<usize> = (0..n).chain(all..all + free).collect();
        let values = rows.iter().map(|row| change[*row]).chain(misses.iter().copied()).collect::<Vec<_>>().into();
        let identity = DMatrix::identity(all + all - m, all + all - m);
        let slope = (derivative - identity).select_rows(&rows).select_columns(&columns);
        Some((values, with_rows(slope, &gradients)))
    }

    fn stepped(&self, h: f64, start: &AnyState) -> Option<AnyState> {
        let (mut end, schedule) = (start.clone(), Schedule { t0: 0.0, step: h, steps: 1 });
        (Run::of(self.system, self.method).moves(&schedule, &mut end) == Ok(1)).then_some(end)
    }

    fn linearised(&self, slope: &DMatrix<f64>, shape: &[usize]) -> Option<Spectrum> {
        let (n, free) = self.own;
        let rows = shape.len() + free;
        let gradients = slope.view((rows, 0), (slope.nrows() - rows, n)).into_owned();
        let along = AllowedDirections::new(&gradients, shape, free)?;
        let slope = along.restrict(&slope.rows(0, rows).into_owned());
        Some(with_family(slope, 1.0, ROUNDING, size)?.1)
    }
}
