use super::flow::{Variables, admissible, divergence, single};
use super::manifold::{DEPENDENT, Split, positions};
use super::stages::Stages;
use crate::{Method, MethodKind};
use dla::{AnyState, Mechanism, Report, SensitivityError, Size};
use lagrangian::{ReducedError, Scalar, Seeded};
use nalgebra::DMatrix;
use std::cell::{Cell, RefCell};

/// The derivative of a step.
#[derive(Debug)]
pub(super) struct Stepped {
    /// `d(q1, xi1)/d(q0, xi0)` along the directions; `xi1` are quasi-velocities for the next step.
    pub(super) matrix: DMatrix<f64>,
    /// The logarithm of the factor by which a change of the basis at the end of the step changes volumes.
    pub(super) change: f64,
    /// The divergence of the continuous equations at the end, in the basis of the step (1/s).
    pub(super) divergence: f64,
    /// The continuous equations there, in the basis of the next step.
    pub(super) next: Local,
}

/// The continuous equations at a state.
#[derive(Debug, Clone)]
pub(super) struct Local {
    /// Their divergence (1/s).
    pub(super) divergence: f64,
    /// The quasi-velocities and their rates; zero in the places that do not count.
    pub(super) xi: Vec<f64>,
    pub(super) rate: Vec<f64>,
}

/// The derivatives of single steps of a run of a method on a system, in the coordinates `(q, xi)` of the distribution, along the directions
/// that keep the constraints on positions, in an orthonormal basis of these at each node.
pub(super) struct Steps<'a> {
    system: &'a dyn Mechanism,
    method: &'a Method,
    /// The stages of a collocation on the reduced equations, which is differentiated on numbers with derivatives; `None` for any other method, which is differentiated by the implicit function theorem.
    stages: Option<Stages>,
    variables: Variables,
    /// The number of directions; and the directions at the last node, as columns, if positions are constrained.
    count: usize,
    directions: RefCell<Option<DMatrix<f64>>>,
    /// The number of the present basis, if bases of the system are local.
    basis: Cell<u64>,
}

impl<'a> Steps<'a> {
    /// The steps of a system with `own` coordinates and constraints, whose motion begins at the time `t` (s) and the configuration `q`.
    pub(super) fn of(
        system: &'a dyn Mechanism,
        own: (usize, usize),
        method: &'a Method,
        (t, q): (f64, &[f64]),
    ) -> Result<Self, SensitivityError> {
        system.has_tangents(method)?;
        let stages = match method.info().kind {
            MethodKind::Gauss(stages) => Some(Stages::gauss(stages)),
            _ => None,
        };
        let variables = Variables::new(system, own);
        let (basis, directions) = (Cell::new(0), RefCell::new(None));
        let mut steps = Self { system, method, stages, count: variables.count(), variables, directions, basis };
        if let Some(normals) = steps.normals(t, q) {
            steps.count -= normals.ncols();
        }
        Ok(steps)
    }

    /// The number of directions.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Orthonormal directions across the constraints on positions, in the coordinates; `None` if there are no such constraints.
    fn normals(&self, t: f64, q: &[f64]) -> Option<DMatrix<f64>> {
        let (_, rows) = positions(self.system, self.variables.coordinates, t, q);
        if rows.nrows() == 0 { None } else { Some(Split::by(&rows, DEPENDENT)?.row_space) }
    }

    /// Orthonormal directions along the constraints on positions, in the variables; `None` if there are no such constraints.
    fn along(&self, t: f64, q: &[f64]) -> Option<DMatrix<f64>> {
        let normals = self.normals(t, q)?;
        let rows = normals.transpose().resize_horizontally(self.variables.count(), 0.0);
        Some(Split::by(&rows, DEPENDENT)?.kernel)
    }

    /// Restricts a matrix to map the directions at the last node to the directions at a place, which becomes the last node.
    fn restrict(&self, matrix: DMatrix<f64>, t: f64, q: &[f64]) -> DMatrix<f64> {
        let Some(after) = self.along(t, q) else { return matrix };
        let before = self.directions.replace(Some(after.clone())).unwrap_or_else(|| after.clone());
        after.tr_mul(&matrix) * before
    }

    /// Does something with the system in the basis that holds at a place. If its bases are local, the present basis is kept, unless another
    /// is better by far.
    fn near<T>(&self, t: f64, q: &[f64], mut then: impl FnMut(Based<'_>) -> T) -> T {
        let known = self.basis.get();
        let mut outcome = None;
        self.system.near(t, q, known, &mut |number, system| outcome = Some(then(Based { number, system })));
        outcome.unwrap_or_else(|| then(Based { number: 0, system: self.system }))
    }

    /// The derivative of a step in the basis of one system.
    fn matrix(
        &self,
        based: Based<'_>,
        time: (f64, f64),
        [start, end]: [&AnyState; 2],
        report: &Report,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        match &self.stages {
            Some(stages) => {
                let z = [start.q(), &based.quasi_velocities(time.0, start)?].concat();
                of_stages(stages, based.system, &self.variables, time, (start, &z), end)
            }
            None => {
                let whole = based.system.step_derivative(self.method, time, [start, end], report)?;
                let numbers = self.variables.numbers();
                Ok(whole.select_rows(numbers).select_columns(numbers))
            }
        }
    }

    fn local(&self, based: Based<'_>, t: f64, state: &AnyState) -> Result<Local, SensitivityError> {
        let xi = based.quasi_velocities(t, state)?;
        let normals = self.normals(t, state.q());
        let found = divergence(based.system, (&self.variables, normals.as_ref()), t, (state.q(), &xi));
        let (divergence, rate) = found.ok_or(NO_BASIS)?;
        Ok(Local { divergence, xi, rate })
    }

    /// The derivative of the change from the coordinates `(q, xi)` of one basis to the coordinates of another: `q` stays, and so does the
    /// velocity.
    fn change(&self, [from, to]: [Based<'_>; 2], t: f64, state: &AnyState) -> Result<DMatrix<f64>, SensitivityError> {
        let q = state.q();
        let z = [q, &from.quasi_velocities(t, state)?].concat();
        let next: Vec<Seeded> = to.quasi_velocities(t, state)?.into_iter().map(Seeded::constant).collect();
        let [from, to] = [from.system, to.system];
        let at_rest = to.velocity_of(t, q, &vec![0.0; q.len()]).map_err(refused)?;
        let count = self.variables.count();
        let mut matrix = DMatrix::identity(count, count);
        for block in self.variables.blocks() {
            let seeded = block.seeded(&z);
            let (places, xi) = seeded.split_at(q.len());
            let moved = from.velocity_seeded(t, places, xi).ok_or(NO_BASIS)?;
            let kept = to.velocity_seeded(t, places, &next).ok_or(NO_BASIS)?;
            for (direction, _) in block.all() {
                // Along the basis: the change of the velocity, minus its change with constant quasi-velocities.
                let apart = moved.iter().zip(&kept).map(|(moved, kept)| (moved.eps[direction], kept.eps[direction]));
                let off: Vec<f64> =
                    at_rest.iter().zip(apart).map(|(rest, (moved, kept))| rest + moved - kept).collect();
                let rates = to.quasi_velocities(t, q, &off).map_err(refused)?;
                for (place, rate) in (self.variables.coordinates..count).zip(rates) {
                    matrix[(place, block.first + direction)] = rate;
                }
            }
        }
        Ok(matrix)
    }

    /// The continuous equations at the first node of a run.
    pub(super) fn begin(&self, t: f64, state: &AnyState) -> Result<Local, SensitivityError> {
        self.directions.replace(self.along(t, state.q()));
        self.near(t, state.q(), |based| {
            self.basis.set(based.number);
            self.local(based, t, state)
        })
    }

    /// The derivative of the step from `start` to `end`; `time` is its start and its length (s). Steps must be asked for one after the
    /// other.
    pub(super) fn step(
        &self,
        (t, h): (f64, f64),
        [start, end]: [&AnyState; 2],
        report: &Report,
    ) -> Result<Stepped, SensitivityError> {
        self.near(t, start.q(), |based| {
            let matrix = self.matrix(based, (t, h), [start, end], report)?;
            let matrix = self.restrict(matrix, t + h, end.q());
            let local = self.local(based, t + h, end)?;
            let same = Stepped { matrix, change: 0.0, divergence: local.divergence, next: local };
            let mut changed = None;
            based.system.near(t + h, end.q(), based.number, &mut |number, system| {
                let other = Based { number, system };
                if number != based.number {
                    let change = self.change([based, other], t + h, end);
                    changed = Some((number, change.and_then(|change| Ok((change, self.local(other, t + h, end)?)))));
                }
            });
            let Some((next, made)) = changed else { return Ok(same) };
            let (change, local) = made?;
            // Configurations stay, and with them the directions.
            let change = self.restrict(change, t + h, end.q());
            self.basis.set(next);
            let volume = change.determinant().abs().ln();
            Ok(Stepped { matrix: change * same.matrix, change: volume, next: local, ..same })
        })
    }

    /// The roots of twice the kinetic energies of the basis vectors at a place, by which quasi-velocities of different units are compared;
    /// one for a vector without kinetic energy.
    pub(super) fn weights(&self, t: f64, state: &AnyState) -> Vec<f64> {
        self.near(t, state.q(), |based| weights(based.system, t, state))
    }
}

/// A system in a basis, with the number of the basis; zero if the basis holds everywhere.
#[derive(Clone, Copy)]
struct Based<'a> {
    number: u64,
    system: &'a dyn Mechanism,
}

impl Based<'_> {
    /// The quasi-velocities of a state; zero in the places that do not count.
    fn quasi_velocities(&self, t: f64, state: &AnyState) -> Result<Vec<f64>, SensitivityError> {
        let found = match self.number {
            0 => self.system.quasi_velocities_of(t, state),
            // The quasi-velocities in the memory of a state may belong to another basis.
            _ => self.system.quasi_velocities(t, state.q(), state.v()),
        };
        let Size { n, m } = self.system.size();
        found.map(|xi| admissible(xi, n - m)).map_err(refused)
    }
}

fn refused(error: ReducedError) -> SensitivityError {
    SensitivityError::Step(error.into())
}

/// Steps that differ by more, relative, are different solutions; rounding is far below.
const AGREEMENT: f64 = 1e-9;

fn weights(system: &dyn Mechanism, t: f64, state: &AnyState) -> Vec<f64> {
    let Size { n, m } = system.size();
    let of = |xi: &[f64]| {
        let velocity = system.velocity_of(t, state.q(), xi).ok();
        velocity.map_or(f64::NAN, |v| system.energy(t, state.q(), &v))
    };
    let rest = of(&vec![0.0; n]);
    let weight = |a: usize| {
        let unit = |sign: f64| of(&single(n, a, sign));
        // Both signs: a moving constraint adds odd terms.
        let twice = unit(1.0) - rest + (unit(-1.0) - rest);
        if twice > 0.0 && twice.is_finite() { twice.sqrt() } else { 1.0 }
    };
    (0..n).map(|a| if a < n - m { weight(a) } else { 1.0 }).collect()
}

const NO_BASIS: SensitivityError = SensitivityError::Unsupported {
    reason: "exponents need a basis of the admissible velocities, and the system has no basis",
};

/// The matrix of a step by stages, after a check that the stages end where the step did; `z` are configuration and quasi-velocities of the
/// start.
fn of_stages(
    stages: &Stages,
    system: &dyn Mechanism,
    variables: &Variables,
    time: (f64, f64),
    (start, z): (&AnyState, &[f64]),
    end: &AnyState,
) -> Result<DMatrix<f64>, SensitivityError> {
    let count = variables.count();
    let mut matrix = DMatrix::identity(count, count);
    let (moved, place) = (end.moved_since(start), end.unwrapped());
    for block in variables.blocks() {
        let increments = stages.increments(system, time, z, block)?;
        let (mut off, mut size) = (0.0f64, 0.0f64);
        for ((moved, place), increment) in moved.iter().zip(&place).zip(&increments) {
            off = off.max((moved - increment.re).abs());
            size = size.max(place.abs()).max(moved.abs());
        }
        let defect = if off == 0.0 { 0.0 } else { off / size };
        if defect > AGREEMENT || defect.is_nan() {
            return Err(SensitivityError::OtherSolution { defect });
        }
        for (direction, _) in block.all() {
            for (place, variable) in variables.numbers().iter().enumerate() {
                matrix[(place, block.first + direction)] += increments[*variable].eps[direction];
            }
        }
    }
    Ok(matrix)
}
