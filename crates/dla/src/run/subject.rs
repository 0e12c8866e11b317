use super::counted::Counted;
use super::integrator::Bound;
use super::mechanism::{Mechanism, Place, Size};
use super::state::{AnyState, row};
use crate::dependent::named;
use crate::method::differentiable;
use crate::power::work_between;
use crate::reduced_flow::reduced_flow;
use crate::suspect::suspect_along;
use crate::taylor::tangent::step_derivative;
use crate::{
    Checkpoint, CheckpointError, Discretisation, Dla, FullMechanics, Integrator, Mechanics, Method, MethodKind,
    OneStep, PiecewiseMechanics, ReducedField, Report, Rules, SeededMechanics, Sensitivity, SensitivityError, State,
    StepError, StepReport, has_derivatives, has_tangents, onto_constraint, reduced_field,
};
use lagrangian::linear::{Singular, larger, largest};
use lagrangian::{Gradients, MotionError, PowerSources, ReducedError, Scalar, Seeded, from_fn};
use nalgebra::DMatrix;
use std::cell::Cell;
use std::fmt;

/// A method of a shape as an object.
pub type Stepper<'a, const N: usize, const M: usize> = Box<dyn OneStep<N, M> + 'a>;

/// The integrators that a system brings of its own, besides the general ones; by default none.
pub trait OwnMethods<const N: usize, const M: usize> {
    /// The midpoint discrete Lagrange-d'Alembert map in a closed form of the system's own, for the smooth piece of a run that holds at the
    /// time `t` (s). The given method is the same map in its general form: it makes the steps that have no closed form, and is returned if
    /// the system has no closed form at all.
    fn closed_map<'a>(&'a self, _t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        general
    }

    /// The series of the motion that holds at the time `t` (s), with steps of its own as the tolerance asks for; `None` if the system has
    /// no series.
    fn series(&self, _t: f64, _tolerance: f64) -> Option<Stepper<'_, N, M>> {
        None
    }
}

/// No integrators of its own.
impl<const N: usize, const M: usize> OwnMethods<N, M> for () {}

/// A system of a shape as a [`Mechanism`], with the integrators that it brings of its own.
///
/// Every system converts to one without integrators of its own: `Subject::from(&system)`, or `Subject::smooth(&system)` of a system that is
/// not [`Piecewise`](lagrangian::Piecewise).
pub struct Subject<'a, const N: usize, const M: usize> {
    system: Held<'a, N, M>,
    own: &'a dyn OwnMethods<N, M>,
    /// The time of the smooth piece (s), if the system is one.
    at: f64,
    shaped: Option<&'static Shaped<N, M>>,
}

/// The code that is compiled for a shape if a system can be run by every method and analysed. A system that is only driven by methods of
/// its shape costs none of this code.
struct Shaped<const N: usize, const M: usize> {
    stepper: for<'b> fn(&Method, &'b dyn OwnMethods<N, M>, f64) -> Stepper<'b, N, M>,
    field: FieldOf<N, M>,
    flow: FlowOf<N, M>,
    derivative: StepDerivativeOf<N, M>,
}

/// The reduced equations with their derivatives at a point.
type FieldOf<const N: usize, const M: usize> =
    fn(&dyn Gradients<N, M>, f64, &[f64; N], &[f64; N]) -> Option<Result<ReducedField, Singular>>;

/// The reduced equations on numbers with derivatives.
type FlowOf<const N: usize, const M: usize> =
    fn(&dyn SeededMechanics<N, M>, f64, &[Seeded; N], &[Seeded; N]) -> Option<[[Seeded; N]; 2]>;

/// The derivative of a step of a method on a system.
type StepDerivativeOf<const N: usize, const M: usize> = fn(
    &dyn SeededMechanics<N, M>,
    &Method,
    (f64, f64),
    [&State<N>; 2],
    StepReport<M>,
) -> Result<DMatrix<f64>, SensitivityError>;

impl<const N: usize, const M: usize> Shaped<N, M> {
    const ALL: Self =
        Self { stepper: Method::stepper_of, field: reduced_field, flow: reduced_flow, derivative: reduced_derivative };
}

/// The derivative of a step in the coordinates `(q, xi)`.
fn reduced_derivative<const N: usize, const M: usize>(
    system: &dyn SeededMechanics<N, M>,
    method: &Method,
    time: (f64, f64),
    [start, end]: [&State<N>; 2],
    report: StepReport<M>,
) -> Result<DMatrix<f64>, SensitivityError> {
    const NO_BASIS: SensitivityError = SensitivityError::Unsupported {
        reason: "exponents need a basis of the admissible velocities, and the system has no basis",
    };
    if method.info().kind == MethodKind::Taylor {
        return step_derivative(system, method.tolerance(), time, [start, end]);
    }
    let rule = differentiable(method)?;
    let derivative = Sensitivity::<N, M, 0>::of(system).between(&*rule, time, start, end, report)?;
    let rows = derivative.reduced.ok_or(NO_BASIS)?.matrix();
    Ok(DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j]))
}

/// The system, by the questions that it answers.
enum Held<'a, const N: usize, const M: usize> {
    Smooth(&'a dyn Mechanics<N, M>),
    Seeded(&'a dyn SeededMechanics<N, M>),
    Piecewise(&'a dyn PiecewiseMechanics<N, M>),
    Piece(Box<dyn PiecewiseMechanics<N, M> + 'a>),
    Full(&'a dyn FullMechanics<N, M>),
}

impl<'a, const N: usize, const M: usize> Subject<'a, N, M> {
    /// A system that answers all questions.
    pub fn new(system: &'a dyn FullMechanics<N, M>, own: &'a dyn OwnMethods<N, M>) -> Self {
        Self { system: Held::Full(system), own, at: 0.0, shaped: Some(&Shaped::ALL) }
    }

    /// A system whose forces and constraints never jump, which needs no [`Piecewise`](lagrangian::Piecewise) for that. Its motions are not
    /// differentiated: see [`new`](Self::new).
    #[must_use]
    pub fn smooth(system: &'a dyn Mechanics<N, M>) -> Self {
        Self { system: Held::Smooth(system), own: &(), at: 0.0, shaped: Some(&Shaped::ALL) }
    }

    /// A system without jumps that methods of its shape drive: no method by name, and no analysis.
    pub(super) fn driven(system: &'a dyn Mechanics<N, M>) -> Self {
        Self { system: Held::Smooth(system), own: &(), at: 0.0, shaped: None }
    }

    /// Another system of the shape, with the same abilities.
    fn other<'b>(&self, system: Held<'b, N, M>, own: &'b dyn OwnMethods<N, M>, at: f64) -> Subject<'b, N, M> {
        Subject { system, own, at, shaped: self.shaped }
    }

    pub(super) fn system(&self) -> &dyn Mechanics<N, M> {
        match &self.system {
            Held::Smooth(system) => *system,
            Held::Seeded(system) => *system,
            Held::Piecewise(system) => *system,
            Held::Piece(system) => &**system,
            Held::Full(system) => *system,
        }
    }

    fn with_derivatives(&self) -> Option<&dyn SeededMechanics<N, M>> {
        match &self.system {
            Held::Seeded(system) => Some(*system),
            Held::Full(system) => Some(*system),
            Held::Smooth(_) | Held::Piecewise(_) | Held::Piece(_) => None,
        }
    }

    fn pieces(&self) -> Option<&dyn PiecewiseMechanics<N, M>> {
        match &self.system {
            Held::Piecewise(system) => Some(*system),
            Held::Piece(system) => Some(&**system),
            Held::Full(system) => Some(*system),
            Held::Smooth(_) | Held::Seeded(_) => None,
        }
    }
}

impl<const N: usize, const M: usize> fmt::Debug for Subject<'_, N, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.system().fmt(f)
    }
}

impl<'a, Sys: PiecewiseMechanics<N, M>, const N: usize, const M: usize> From<&'a Sys> for Subject<'a, N, M> {
    fn from(system: &'a Sys) -> Self {
        Self { system: Held::Piecewise(system), own: &(), at: 0.0, shaped: Some(&Shaped::ALL) }
    }
}

/// Numbers with derivatives as a row.
pub(super) fn seeded_row<const N: usize>(x: &[Seeded]) -> [Seeded; N] {
    from_fn(|i| x.get(i).copied().unwrap_or(Seeded::constant(f64::NAN)))
}

/// The error of a system that was given without derivatives.
const NO_DERIVATIVES: SensitivityError =
    SensitivityError::Unsupported { reason: "the system was given without the derivatives of its motions" };

impl<const N: usize, const M: usize> Mechanism for Subject<'_, N, M> {
    fn size(&self) -> Size {
        Size { n: N, m: M }
    }

    fn angles(&self) -> Vec<bool> {
        self.system().angles().to_vec()
    }

    fn state(&self, q: &[f64], v: &[f64]) -> AnyState {
        State::<N>::new(row(q), row(v), self.system().angles()).into()
    }

    fn load_state(&self, checkpoint: &Checkpoint) -> Result<AnyState, CheckpointError> {
        State::<N>::load(checkpoint, self.system().angles()).map(AnyState::from)
    }

    fn integrator(&self, method: &Method) -> Box<dyn Integrator + '_> {
        match self.shaped {
            Some(shaped) => Box::new(Bound::new(self.system(), (shaped.stepper)(method, self.own, self.at))),
            None => Box::new(Bound::new(self.system(), NotByName)),
        }
    }

    fn general_map(&self) -> Box<dyn Integrator + '_> {
        Box::new(Bound::new(self.system(), Dla::midpoint()))
    }

    fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        self.pieces().map_or_else(Vec::new, |system| system.jump_times(from, to))
    }

    fn smooth_piece(&self, t: f64) -> Box<dyn Mechanism + '_> {
        let system = match self.pieces() {
            Some(system) => Held::Piece(system.smooth_piece(t)),
            None => Held::Smooth(self.system()),
        };
        Box::new(self.other(system, self.own, t))
    }

    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.system().energy(t, &row(q), &row(v))
    }

    fn kinetic_energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let v = row(v);
        let p = self.system().momentum(t, &row(q), &v);
        0.5 * p.iter().zip(&v).map(|(p, v)| p * v).sum::<f64>()
    }

    fn residual(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        self.system().residual(t, &row(q), &row(v)).to_vec()
    }

    fn largest_residual(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        largest(&self.system().residual(t, &row(q), &row(v)))
    }

    fn largest_step_residual(&self, rules: &Rules, time: (f64, f64), q: &[f64], v: &[f64]) -> f64 {
        let residual: [f64; M] = rules.residual(self.system(), time, &row(q), &row::<N>(v));
        largest(&residual)
    }

    fn largest_position(&self, t: f64, state: &AnyState) -> Option<f64> {
        let functions = self.system().positions(t, &state.typed()?.unwrapped())?;
        functions.into_iter().flatten().map(f64::abs).reduce(larger)
    }

    fn position_misses(&self, t: f64, q: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let misses = self.system().position_misses(t, &row(q));
        misses.into_iter().flatten().flatten().map(|miss| (miss.re, miss.eps.to_vec())).collect()
    }

    fn onto_constraint(&self, (t, _): (f64, f64), state: &mut AnyState) -> Result<(), StepError> {
        onto_constraint(self.system(), t, state.typed_mut().ok_or(StepError::OTHER_SHAPE)?)
    }

    fn explained(&self, time: (f64, f64), state: &AnyState, error: StepError) -> StepError {
        let Some(state) = state.typed() else { return error };
        let error = suspect_along(self.system(), time, state, state.v(), error);
        named(self.system(), time, state, error)
    }

    fn power_sources(&self) -> PowerSources {
        self.system().power_sources()
    }

    fn work_between(&self, sources: PowerSources, (t0, q0, v0): Place<'_>, (t1, q1, v1): Place<'_>) -> f64 {
        work_between(self.system(), sources, (t0, &row(q0), &row(v0)), (t1, &row(q1), &row(v1)))
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64]) -> Result<[Vec<f64>; 2], MotionError> {
        let motion = self.system().motion(t, &row(q), &row(v))?;
        Ok([motion.acceleration.to_vec(), motion.multiplier.to_vec()])
    }

    fn velocity_of(&self, t: f64, q: &[f64], xi: &[f64]) -> Result<Vec<f64>, ReducedError> {
        self.system().velocity_of(t, &row(q), &row(xi)).map(|v| v.to_vec())
    }

    fn quasi_velocities(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Vec<f64>, ReducedError> {
        self.system().quasi_velocities(t, &row(q), &row(v)).map(|xi| xi.to_vec())
    }

    fn quasi_velocities_of(&self, t: f64, state: &AnyState) -> Result<Vec<f64>, ReducedError> {
        match state.typed::<N>() {
            Some(state) => state.quasi_velocities(self.system(), t).map(|xi| xi.to_vec()),
            None => self.quasi_velocities(t, state.q(), state.v()),
        }
    }

    fn is_driven(&self, t: f64, q: &[f64]) -> bool {
        self.system().constraint(t, &row(q)).1.iter().any(|b| *b != 0.0)
    }

    fn near(&self, t: f64, q: &[f64], basis: u64, then: &mut dyn FnMut(u64, &dyn Mechanism)) -> bool {
        match self.with_derivatives() {
            Some(system) => system.near_seeded(t, &row(q), basis, &mut |number, near| {
                then(number, &self.other(Held::Seeded(near), &(), self.at));
            }),
            None => self.system().near(t, &row(q), basis, &mut |number, near| {
                then(number, &self.other(Held::Smooth(near), &(), self.at));
            }),
        }
    }

    fn counted(&self, evaluations: &Cell<u64>, then: &mut dyn FnMut(&dyn Mechanism)) {
        let counted = Counted { system: self.system(), evaluations };
        then(&self.other(Held::Smooth(&counted), &(), self.at));
    }

    fn reduced_field(&self, t: f64, q: &[f64], xi: &[f64]) -> Option<Result<ReducedField, Singular>> {
        (self.shaped?.field)(&*self.with_derivatives()?.gradients(), t, &row(q), &row(xi))
    }

    fn reduced_flow(&self, t: f64, q: &[Seeded], xi: &[Seeded]) -> Option<[Vec<Seeded>; 2]> {
        let flow = (self.shaped?.flow)(self.with_derivatives()?, t, &seeded_row(q), &seeded_row(xi))?;
        Some(flow.map(|part| part.to_vec()))
    }

    fn velocity_seeded(&self, t: f64, q: &[Seeded], xi: &[Seeded]) -> Option<Vec<Seeded>> {
        let system = self.with_derivatives()?;
        system.velocity_seeded(Seeded::constant(t), &seeded_row(q), &seeded_row(xi)).map(|v| v.to_vec())
    }

    fn has_tangents(&self, method: &Method) -> Result<(), SensitivityError> {
        has_tangents(method)?;
        self.shaped.zip(self.with_derivatives()).ok_or(NO_DERIVATIVES)?;
        has_derivatives(method)
    }

    fn step_derivative(
        &self,
        method: &Method,
        time: (f64, f64),
        [start, end]: [&AnyState; 2],
        report: &Report,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        let (shaped, system) = self.shaped.zip(self.with_derivatives()).ok_or(NO_DERIVATIVES)?;
        let (start, end) = start.typed().zip(end.typed()).ok_or(StepError::OTHER_SHAPE)?;
        (shaped.derivative)(system, method, time, [start, end], report.typed())
    }
}

/// The method by name of a system that is driven by methods of its shape.
struct NotByName;

impl<const N: usize, const M: usize> OneStep<N, M> for NotByName {
    fn step(
        &mut self,
        _system: &dyn Mechanics<N, M>,
        _t: f64,
        _h: f64,
        _state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        Err(StepError::Unsupported {
            reason: "the run was begun with a method and not with its name: `Subject` has the methods by name",
        })
    }
}
