use super::discrete::differentiable;
use super::flow::{Flow, ReducedFlow, Variables, admissible, divergence, entry};
use super::manifold::{DEPENDENT, Split, positions};
use super::stages::Stages;
use crate::stepper::energy;
use crate::{Method, MethodKind};
use dla::{Differentiable, Lobatto, SeededMechanics, Sensitivity, SensitivityError, State, StepReport};
use lagrangian::{Scalar, Seeded, from_fn};
use nalgebra::DMatrix;
use std::cell::{Cell, RefCell};

/// The derivatives of single steps of a run, in the coordinates `(q, xi)` of the distribution, along the directions that keep the constraints
/// on positions, in an orthonormal basis of these at each node; an object, so that what uses it is compiled once.
pub(super) trait StepTangent<const N: usize, const M: usize> {
    /// How many such directions there are.
    fn count(&self) -> usize;

    /// What the continuous equations are at the first node of a run.
    fn begin(&self, t: f64, state: &State<N>) -> Result<Local<N>, SensitivityError>;

    /// The step that was made from `start` to `end`; `time` is its start and its length (s). Steps are to be asked for one after the other.
    fn step(
        &self,
        time: (f64, f64),
        start: &State<N>,
        end: &State<N>,
        report: StepReport<M>,
    ) -> Result<Stepped<N>, SensitivityError>;

    /// The roots of twice the kinetic energies of the basis vectors at a place, by which quasi-velocities of different units are compared;
    /// one where a vector has none.
    fn weights(&self, t: f64, state: &State<N>) -> [f64; N];
}

/// The derivative of a step.
#[derive(Debug)]
pub(super) struct Stepped<const N: usize> {
    /// `d(q1, xi1)/d(q0, xi0)` along the directions, where `xi1` are quasi-velocities for the next step.
    pub(super) matrix: DMatrix<f64>,
    /// The logarithm of the volume that a change of the basis at the end of the step makes of one.
    pub(super) change: f64,
    /// The continuous equations at the end, in the basis of the step, and in that of the next.
    pub(super) end: Local<N>,
    pub(super) next: Local<N>,
}

/// The continuous equations at a state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local<const N: usize> {
    /// Their divergence (1/s).
    pub(super) divergence: f64,
    /// The quasi-velocities and their rates; zero in the places that do not count.
    pub(super) xi: [f64; N],
    pub(super) rate: [f64; N],
}

/// How the steps of a method are differentiated.
enum TangentRule<const N: usize, const M: usize> {
    /// A Runge-Kutta method on the reduced equations: on numbers with derivatives.
    Stages(Stages),
    /// Any other: by the implicit function theorem.
    Equations(Box<dyn Differentiable<N, M>>),
}

/// The steps of a method on a system.
pub(super) struct Steps<'a, const N: usize, const M: usize> {
    system: &'a dyn SeededMechanics<N, M>,
    rule: TangentRule<N, M>,
    variables: Variables,
    /// The number of directions, and those of the last node as columns, where positions are constrained.
    count: usize,
    directions: RefCell<Option<DMatrix<f64>>>,
    /// The number of the basis that holds now, of a system whose bases are local.
    basis: Cell<u64>,
}

/// Whether [`lyapunov`](fn@super::lyapunov) has the derivatives of this method.
///
/// # Errors
/// [`SensitivityError::Unsupported`] with the reason, where it has not.
pub fn has_tangents(method: &Method) -> Result<(), SensitivityError> {
    rule::<3, 1>(method).map(drop)
}

const TOO_LARGE: SensitivityError = SensitivityError::Unsupported {
    reason: "derivatives of the steps of this method are available for systems of up to four coordinates: take gauss8",
};

fn rule<const N: usize, const M: usize>(method: &Method) -> Result<TangentRule<N, M>, SensitivityError> {
    let info = method.info();
    info.tangent.map_err(|reason| SensitivityError::Unsupported { reason })?;
    Ok(match info.kind {
        MethodKind::Gauss(stages) => TangentRule::Stages(Stages::gauss(stages)),
        MethodKind::Rk4Reduced => TangentRule::Stages(Stages::rk4()),
        kind => {
            // Each is compiled for every shape: for those of sleighs, and no larger ones.
            let more: Option<Box<dyn Differentiable<N, M>>> = if const { N <= 4 } { of_four(kind) } else { None };
            TangentRule::Equations(more.or_else(|| differentiable(method)).ok_or(TOO_LARGE)?)
        }
    })
}

fn of_four<const N: usize, const M: usize>(kind: MethodKind) -> Option<Box<dyn Differentiable<N, M>>> {
    Some(match kind {
        MethodKind::Lobatto(3) => Box::new(Lobatto::<3>::new()),
        MethodKind::Lobatto(4) => Box::new(Lobatto::<4>::new()),
        MethodKind::Energy(stages) => Box::new(energy(stages)),
        _ => return None,
    })
}

impl<'a, const N: usize, const M: usize> Steps<'a, N, M> {
    /// Of a system of which so many coordinates and constraints are its own, whose motion begins at that time (s) and configuration.
    pub(super) fn of(
        system: &'a dyn SeededMechanics<N, M>,
        own: (usize, usize),
        method: &Method,
        (t, q): (f64, &[f64; N]),
    ) -> Result<Self, SensitivityError> {
        let variables = Variables::new::<N>(own);
        let (basis, directions) = (Cell::new(0), RefCell::new(None));
        let mut steps = Self { system, rule: rule(method)?, count: variables.count(), variables, directions, basis };
        if let Some(normals) = steps.normals(t, q) {
            steps.count -= normals.ncols();
        }
        Ok(steps)
    }

    /// Orthonormal directions across the constraints on positions, in the coordinates; none where there are no such.
    fn normals(&self, t: f64, q: &[f64; N]) -> Option<DMatrix<f64>> {
        let (_, rows) = positions(self.system, self.variables.coordinates::<N>(), t, q);
        if rows.nrows() == 0 { None } else { Some(Split::by(&rows, DEPENDENT)?.seen) }
    }

    /// Orthonormal directions along the constraints on positions, in the variables; none where there are no such.
    fn along(&self, t: f64, q: &[f64; N]) -> Option<DMatrix<f64>> {
        let normals = self.normals(t, q)?;
        let rows = normals.transpose().resize_horizontally(self.variables.count(), 0.0);
        Some(Split::by(&rows, DEPENDENT)?.unseen)
    }

    /// A matrix from the directions of the last node to those of a place, which are the last from then on.
    fn restrict(&self, matrix: DMatrix<f64>, t: f64, q: &[f64; N]) -> DMatrix<f64> {
        let Some(after) = self.along(t, q) else { return matrix };
        let before = self.directions.replace(Some(after.clone())).unwrap_or_else(|| after.clone());
        after.tr_mul(&matrix) * before
    }

    /// Does something with the system in the basis that holds at a place: of a system whose bases are local in that of this number, unless
    /// another is better by far.
    fn near<T>(&self, t: f64, q: &[f64; N], mut then: impl FnMut(Based<'_, N, M>) -> T) -> T {
        let known = self.basis.get();
        let mut outcome = None;
        self.system.near_seeded(t, q, known, &mut |number, system| outcome = Some(then(Based { number, system })));
        outcome.unwrap_or_else(|| then(Based { number: 0, system: self.system }))
    }

    /// The derivative of a step in the basis of one system.
    fn matrix(
        &self,
        based: Based<'_, N, M>,
        time: (f64, f64),
        (start, end): (&State<N>, &State<N>),
        report: StepReport<M>,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        match &self.rule {
            TangentRule::Stages(stages) => {
                let flow: &dyn ReducedFlow<N, M> = &Flow(based.system);
                let xi = based.quasi_velocities(time.0, start)?;
                of_stages(stages, flow, &self.variables, time, (start, &xi), end)
            }
            TangentRule::Equations(method) => {
                let derivative =
                    Sensitivity::<N, M, 0>::of(based.system).between(&**method, time, start, end, report)?;
                let rows = derivative.reduced.ok_or(NO_BASIS)?.matrix();
                let (count, at) = (self.variables.count(), |place| self.variables.at(place));
                Ok(DMatrix::from_fn(count, count, |i, j| rows[at(i)][at(j)]))
            }
        }
    }

    fn local(&self, based: Based<'_, N, M>, t: f64, state: &State<N>) -> Result<Local<N>, SensitivityError> {
        let xi = admissible::<N, M>(&based.quasi_velocities(t, state)?);
        let normals = self.normals(t, state.q());
        let found = divergence(&Flow(based.system), (&self.variables, normals.as_ref()), t, state.q(), &xi);
        let (divergence, rate) = found.ok_or(NO_BASIS)?;
        Ok(Local { divergence, xi, rate })
    }

    /// The derivative of the change from the coordinates `(q, xi)` of one basis to those of another: `q` stays, and so does the velocity.
    fn change(
        &self,
        [from, to]: [Based<'_, N, M>; 2],
        t: f64,
        state: &State<N>,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        let q = state.q();
        let [xi, next] = [from.quasi_velocities(t, state)?, to.quasi_velocities(t, state)?];
        let [from, to] = [from.system, to.system];
        let at_rest = to.velocity_of(t, q, &[0.0; N]).map_err(|error| SensitivityError::Step(error.into()))?;
        let count = self.variables.count();
        let mut matrix = DMatrix::identity(count, count);
        for block in self.variables.blocks() {
            let (time, places) = (Seeded::constant(t), block.seeded(q, 0));
            let moved =
                from.velocity_seeded(time, &places, &block.seeded(&admissible::<N, M>(&xi), N)).ok_or(NO_BASIS)?;
            let kept = to.velocity_seeded(time, &places, &next.map(Seeded::constant)).ok_or(NO_BASIS)?;
            for (direction, _) in block.all() {
                // Along the basis: what the velocity changes by beyond what it does where the quasi-velocities stay.
                let off = from_fn(|i| at_rest[i] + moved[i].eps[direction] - kept[i].eps[direction]);
                let rates = to.quasi_velocities(t, q, &off).map_err(|error| SensitivityError::Step(error.into()))?;
                for place in 0..count {
                    if let Some(a) = self.variables.at(place).checked_sub(N) {
                        matrix[(place, block.first + direction)] = rates[a];
                    }
                }
            }
        }
        Ok(matrix)
    }
}

/// A system in a basis, with the number of that; zero where the basis holds everywhere.
#[derive(Clone, Copy)]
struct Based<'a, const N: usize, const M: usize> {
    number: u64,
    system: &'a dyn SeededMechanics<N, M>,
}

impl<const N: usize, const M: usize> Based<'_, N, M> {
    fn quasi_velocities(&self, t: f64, state: &State<N>) -> Result<[f64; N], SensitivityError> {
        let found = match self.number {
            0 => state.quasi_velocities(self.system, t),
            // Those that a state remembers may be of another basis.
            _ => self.system.quasi_velocities(t, state.q(), state.v()),
        };
        found.map_err(|error| SensitivityError::Step(error.into()))
    }
}

/// Steps that differ by more, relative, are different solutions; rounding is far below.
const AGREEMENT: f64 = 1e-9;

impl<const N: usize, const M: usize> StepTangent<N, M> for Steps<'_, N, M> {
    fn count(&self) -> usize {
        self.count
    }

    fn begin(&self, t: f64, state: &State<N>) -> Result<Local<N>, SensitivityError> {
        self.directions.replace(self.along(t, state.q()));
        self.near(t, state.q(), |based| {
            self.basis.set(based.number);
            self.local(based, t, state)
        })
    }

    fn step(
        &self,
        (t, h): (f64, f64),
        start: &State<N>,
        end: &State<N>,
        report: StepReport<M>,
    ) -> Result<Stepped<N>, SensitivityError> {
        self.near(t, start.q(), |based| {
            let matrix = self.matrix(based, (t, h), (start, end), report)?;
            let matrix = self.restrict(matrix, t + h, end.q());
            let local = self.local(based, t + h, end)?;
            let same = Stepped { matrix, change: 0.0, end: local, next: local };
            let mut changed = None;
            based.system.near_seeded(t + h, end.q(), based.number, &mut |number, system| {
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

    fn weights(&self, t: f64, state: &State<N>) -> [f64; N] {
        self.near(t, state.q(), |based| weights(based.system, t, state))
    }
}

fn weights<const N: usize, const M: usize>(system: &dyn SeededMechanics<N, M>, t: f64, state: &State<N>) -> [f64; N] {
    let of = |xi: &[f64; N]| {
        let velocity = system.velocity_of(t, state.q(), xi).ok();
        velocity.map_or(f64::NAN, |v| system.energy(t, state.q(), &v))
    };
    let rest = of(&[0.0; N]);
    from_fn(|a| {
        let unit = |sign: f64| of(&from_fn(|b| if a == b && a < N - M { sign } else { 0.0 }));
        // Both signs: a constraint that moves adds what is odd.
        let twice = unit(1.0) - rest + (unit(-1.0) - rest);
        if twice > 0.0 && twice.is_finite() { twice.sqrt() } else { 1.0 }
    })
}

const NO_BASIS: SensitivityError = SensitivityError::Unsupported {
    reason: "exponents need a basis of the admissible velocities, and the system has no basis",
};

/// The matrix of a step by stages, after a look whether it ends where the step did.
fn of_stages<const N: usize, const M: usize>(
    stages: &Stages,
    flow: &dyn ReducedFlow<N, M>,
    variables: &Variables,
    (t, h): (f64, f64),
    (start, xi): (&State<N>, &[f64; N]),
    end: &State<N>,
) -> Result<DMatrix<f64>, SensitivityError> {
    let count = variables.count();
    let mut matrix = DMatrix::identity(count, count);
    for block in variables.blocks() {
        let increments = stages.increments(flow, (t, h), start.q(), xi, block)?;
        let moved = end.moved_since(start);
        let (mut off, mut size) = (0.0f64, 0.0f64);
        for i in 0..N {
            off = off.max((moved[i] - increments[0][i].re).abs());
            size = size.max(end.unwrapped()[i].abs()).max(moved[i].abs());
        }
        let defect = if off == 0.0 { 0.0 } else { off / size };
        if defect > AGREEMENT || defect.is_nan() {
            return Err(SensitivityError::OtherSolution { defect });
        }
        for (direction, _) in block.all() {
            for place in 0..count {
                matrix[(place, block.first + direction)] += entry(&increments, variables.at(place)).eps[direction];
            }
        }
    }
    Ok(matrix)
}
