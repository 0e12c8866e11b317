use super::counted::Counted;
use super::integrator::{Bound, OTHER_SHAPE};
use super::mechanism::{Mechanism, Place, Size};
use super::state::{AnyState, row};
use crate::dependent::named;
use crate::method::differentiable;
use crate::power::work_between;
use crate::reduced_flow::reduced_flow;
use crate::suspect::suspect_along;
use crate::{
    Checkpoint, CheckpointError, Discretisation, Dla, FullMechanics, Integrator, Mechanics, Method, MethodKind,
    OneStep, PiecewiseMechanics, ReducedField, Report, Rk4, Rules, SeededMechanics, Sensitivity, SensitivityError,
    State, StepError, onto_constraint, reduced_field, slip,
};
use lagrangian::linear::{Singular, larger, largest};
use lagrangian::{MotionError, PowerSources, ReducedError, Scalar, Seeded, from_fn};
use nalgebra::DMatrix;
use std::cell::Cell;
use std::fmt;

/// A method of a shape as an object.
pub type Stepper<'a, const N: usize, const M: usize> = Box<dyn OneStep<N, M> + 'a>;

/// The integrators that a system brings of its own, beside those that are for every system; by default none.
pub trait OwnMethods<const N: usize, const M: usize> {
    /// The midpoint discrete Lagrange-d'Alembert map in a closed form of the system's own, for the smooth piece of a run that holds at the
    /// time `t` (s). The given method is the same map in its general form: it makes the steps that have no closed form, and where the
    /// system has none at all it is what is returned.
    fn closed_map<'a>(&'a self, _t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        general
    }

    /// The series of the motion that holds at the time `t` (s), with steps of its own as the tolerance asks for; none where the system
    /// has none.
    fn series(&self, _t: f64, _tolerance: f64) -> Option<Stepper<'_, N, M>> {
        None
    }
}

/// None.
impl<const N: usize, const M: usize> OwnMethods<N, M> for () {}

/// A system of a shape as a [`Mechanism`], with the integrators that it brings of its own.
///
/// Every system is one that brings none: `Subject::from(&system)`.
pub struct Subject<'a, const N: usize, const M: usize> {
    system: Held<'a, N, M>,
    own: &'a dyn OwnMethods<N, M>,
    /// The time of the smooth piece (s), where it is one.
    at: f64,
}

/// The system, by what can be asked of it.
enum Held<'a, const N: usize, const M: usize> {
    Smooth(&'a dyn Mechanics<N, M>),
    Seeded(&'a dyn SeededMechanics<N, M>),
    Piecewise(&'a dyn PiecewiseMechanics<N, M>),
    Piece(Box<dyn PiecewiseMechanics<N, M> + 'a>),
    Full(&'a dyn FullMechanics<N, M>),
}

impl<'a, const N: usize, const M: usize> Subject<'a, N, M> {
    /// A system of which everything can be asked.
    pub fn new(system: &'a dyn FullMechanics<N, M>, own: &'a dyn OwnMethods<N, M>) -> Self {
        Self { system: Held::Full(system), own, at: 0.0 }
    }

    /// A system without jumps, whose motions are not differentiated.
    pub fn smooth(system: &'a dyn Mechanics<N, M>) -> Self {
        Self { system: Held::Smooth(system), own: &(), at: 0.0 }
    }

    /// A system without jumps.
    pub fn seeded(system: &'a dyn SeededMechanics<N, M>) -> Self {
        Self { system: Held::Seeded(system), own: &(), at: 0.0 }
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
        Self { system: Held::Piecewise(system), own: &(), at: 0.0 }
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
        Box::new(Bound::new(self.system(), method.stepper_of(self.own, self.at)))
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
        Box::new(Subject { system, own: self.own, at: t })
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

    fn largest_position(&self, t: f64, q: &[f64]) -> Option<f64> {
        let functions = self.system().positions(t, &row(q))?;
        functions.into_iter().flatten().map(f64::abs).reduce(larger)
    }

    fn position_misses(&self, t: f64, q: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let misses = self.system().position_misses(t, &row(q));
        misses.into_iter().flatten().flatten().map(|miss| (miss.re, miss.eps.to_vec())).collect()
    }

    fn slip(&self, t: f64, state: &AnyState) -> Option<StepError> {
        slip(self.system(), t, state.typed()?)
    }

    fn onto_constraint(&self, t: f64, state: &mut AnyState) -> Result<(), StepError> {
        onto_constraint(self.system(), t, state.typed_mut().ok_or(OTHER_SHAPE)?)
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
            Some(system) => {
                system.near_seeded(t, &row(q), basis, &mut |number, near| then(number, &Subject::seeded(near)))
            }
            None => self.system().near(t, &row(q), basis, &mut |number, near| then(number, &Subject::smooth(near))),
        }
    }

    fn counted(&self, evaluations: &Cell<u64>, then: &mut dyn FnMut(&dyn Mechanism)) {
        then(&Subject::smooth(&Counted { system: self.system(), evaluations }));
    }

    fn reduced_field(&self, t: f64, q: &[f64], xi: &[f64]) -> Option<Result<ReducedField, Singular>> {
        reduced_field(&*self.with_derivatives()?.gradients(), t, &row(q), &row(xi))
    }

    fn reduced_flow(&self, t: f64, q: &[Seeded], xi: &[Seeded]) -> Option<[Vec<Seeded>; 2]> {
        let flow = reduced_flow(self.with_derivatives()?, t, &seeded_row(q), &seeded_row(xi))?;
        Some(flow.map(|part| part.to_vec()))
    }

    fn velocity_seeded(&self, t: f64, q: &[Seeded], xi: &[Seeded]) -> Option<Vec<Seeded>> {
        let system = self.with_derivatives()?;
        system.velocity_seeded(Seeded::constant(t), &seeded_row(q), &seeded_row(xi)).map(|v| v.to_vec())
    }

    fn has_derivatives(&self, method: &Method) -> Result<(), SensitivityError> {
        self.with_derivatives().ok_or(NO_DERIVATIVES)?;
        differentiable::<N, M>(method).map(drop)
    }

    fn step_derivative(
        &self,
        method: &Method,
        time: (f64, f64),
        [start, end]: [&AnyState; 2],
        report: &Report,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        const NO_BASIS: SensitivityError = SensitivityError::Unsupported {
            reason: "exponents need a basis of the admissible velocities, and the system has no basis",
        };
        let rule = match method.info().kind {
            // It leaves the distribution, on which exponents are defined, and its steps have derivatives there.
            MethodKind::Rk4 => Box::new(Rk4),
            _ => differentiable(method)?,
        };
        let sensitivity = Sensitivity::<N, M, 0>::of(self.with_derivatives().ok_or(NO_DERIVATIVES)?);
        let (start, end) = start.typed().zip(end.typed()).ok_or(OTHER_SHAPE)?;
        let derivative = sensitivity.between(&*rule, time, start, end, report.typed())?;
        let rows = derivative.reduced.ok_or(NO_BASIS)?.matrix();
        Ok(DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j]))
    }
}
