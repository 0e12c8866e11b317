use crate::motion::ElementMotion;
use crate::work::{StepWork, moves};
use crate::{Assembly, AssemblyMethod, AssemblyState, assembly_method};
use dla::{
    AnyState, Checkpoint, CheckpointError, Integrator, Mechanism, Method, MethodKind, Place, ReducedField, Report,
    Rules, SeeOwnStep, SensitivityError, Size, StepError,
};
use lagrangian::linear::Singular;
use lagrangian::{MotionError, PowerSources, ReducedError, Seeded};
use nalgebra::DMatrix;
use std::borrow::Cow;
use std::cell::{Cell, OnceCell, RefCell};

/// An assembly as a [`Mechanism`], for runs. It has no quasi-velocities and no derivatives of steps.
pub struct AssemblySubject<'a> {
    assembly: Cow<'a, Assembly>,
    work: RefCell<StepWork>,
    /// The power sources of all elements, found when they are first asked for.
    sources: OnceCell<PowerSources>,
    /// The method of the last integrator, with its memory: who looks inside steps makes one integrator after the other.
    spare: RefCell<Option<(MethodKind, Box<dyn AssemblyMethod>)>>,
}

impl<'a> From<&'a Assembly> for AssemblySubject<'a> {
    fn from(assembly: &'a Assembly) -> Self {
        Self::of(Cow::Borrowed(assembly))
    }
}

impl<'a> AssemblySubject<'a> {
    fn of(assembly: Cow<'a, Assembly>) -> Self {
        Self { assembly, work: RefCell::default(), sources: OnceCell::new(), spare: RefCell::default() }
    }

    fn integrator_of(&self, kind: MethodKind) -> AssemblyIntegrator<'_> {
        let spare = self.spare.take().filter(|(known, _)| *known == kind).map(|(_, method)| Ok(method));
        let method = spare.unwrap_or_else(|| assembly_method(&self.assembly, kind));
        AssemblyIntegrator { subject: self, kind, method, report: Report::of(0) }
    }

    /// The numbers of a list for all coordinates; NaN beyond its end.
    fn all(&self, x: &[f64]) -> Vec<f64> {
        let mut all = x.to_vec();
        all.resize(self.assembly.coordinates(), f64::NAN);
        all
    }
}

impl std::fmt::Debug for AssemblySubject<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.assembly.fmt(f)
    }
}

/// The refusal of the derivatives of steps.
const NO_DERIVATIVES: SensitivityError =
    SensitivityError::Unsupported { reason: "the steps of trains and other large systems have no derivatives" };

impl Mechanism for AssemblySubject<'_> {
    fn size(&self) -> Size {
        Size { n: self.assembly.coordinates(), m: self.assembly.rows() }
    }

    fn angles(&self) -> Vec<bool> {
        self.assembly.angles().to_vec()
    }

    fn state(&self, q: &[f64], v: &[f64]) -> AnyState {
        AssemblyState::new(&self.assembly, &self.all(q), &self.all(v)).into()
    }

    fn load_state(&self, checkpoint: &Checkpoint) -> Result<AnyState, CheckpointError> {
        AssemblyState::load(checkpoint, &self.assembly).map(AnyState::from)
    }

    fn integrator(&self, method: &Method) -> Box<dyn Integrator + '_> {
        Box::new(self.integrator_of(method.info().kind))
    }

    fn general_map(&self) -> Box<dyn Integrator + '_> {
        Box::new(self.integrator_of(MethodKind::Dla))
    }

    fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        self.assembly.jump_times(from, to)
    }

    fn smooth_piece(&self, t: f64) -> Box<dyn Mechanism + '_> {
        Box::new(AssemblySubject::of(Cow::Owned(self.assembly.smooth_piece(t))))
    }

    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.assembly.energy_at(t, q, v)
    }

    /// The energy, less the energy of the same place at rest.
    fn kinetic_energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.assembly.energy_at(t, q, v) - self.assembly.energy_at(t, q, &vec![0.0; v.len()])
    }

    fn residual(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        let (levels, _) = self.assembly.levels(t, &self.all(q), &self.all(v));
        levels.into_iter().map(|level| -level).collect()
    }

    fn largest_residual(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.assembly.largest_residual(t, q, v)
    }

    /// The residual is not measured: the equations of a step meet the constraint as they do the joints.
    fn largest_step_residual(&self, _rules: &Rules, _time: (f64, f64), _q: &[f64], _v: &[f64]) -> f64 {
        f64::NAN
    }

    fn largest_position(&self, t: f64, state: &AnyState) -> Option<f64> {
        Some(self.assembly.misses(t, state.held()?)[1])
    }

    fn position_misses(&self, _t: f64, _q: &[f64]) -> Vec<(f64, Vec<f64>)> {
        Vec::new()
    }

    fn onto_constraint(&self, time: (f64, f64), state: &mut AnyState) -> Result<(), StepError> {
        self.assembly.onto_constraint(time, self.assembly.own(state)?)
    }

    fn explained(&self, time: (f64, f64), state: &AnyState, error: StepError) -> StepError {
        state.held().map_or(error, |state| self.assembly.named(error, time, state))
    }

    fn power_sources(&self) -> PowerSources {
        *self.sources.get_or_init(|| {
            let each = self.assembly.placed().iter().map(|placed| placed.element.power_sources());
            each.fold(PowerSources::NONE, PowerSources::and)
        })
    }

    fn work_between(&self, sources: PowerSources, from: Place<'_>, to: Place<'_>) -> f64 {
        self.work.borrow_mut().between((&self.assembly, sources), from, to)
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64]) -> Result<[Vec<f64>; 2], MotionError> {
        let degenerate = |_| MotionError { time: t, source: Singular { column: 0, pivot: 0.0 } };
        let mut motion = ElementMotion::of(&self.assembly).map_err(degenerate)?;
        let solved = motion.solved(&self.assembly, t, &self.all(q), &self.all(v));
        let (accelerations, multipliers) = solved.map_err(degenerate)?;
        Ok([accelerations.to_vec(), multipliers.iter().map(|mu| -mu).collect()])
    }

    fn velocity_of(&self, _t: f64, _q: &[f64], _xi: &[f64]) -> Result<Vec<f64>, ReducedError> {
        Err(ReducedError::NoBasis)
    }

    fn quasi_velocities(&self, _t: f64, _q: &[f64], _v: &[f64]) -> Result<Vec<f64>, ReducedError> {
        Err(ReducedError::NoBasis)
    }

    fn quasi_velocities_of(&self, _t: f64, _state: &AnyState) -> Result<Vec<f64>, ReducedError> {
        Err(ReducedError::NoBasis)
    }

    fn is_driven(&self, t: f64, q: &[f64]) -> bool {
        moves(&self.assembly, t, &self.all(q))
    }

    fn near(&self, _t: f64, _q: &[f64], _basis: u64, _then: &mut dyn FnMut(u64, &dyn Mechanism)) -> bool {
        false
    }

    fn counted(&self, _evaluations: &Cell<u64>, then: &mut dyn FnMut(&dyn Mechanism)) {
        then(self);
    }

    fn reduced_field(&self, _t: f64, _q: &[f64], _xi: &[f64]) -> Option<Result<ReducedField, Singular>> {
        None
    }

    fn reduced_flow(&self, _t: f64, _q: &[Seeded], _xi: &[Seeded]) -> Option<[Vec<Seeded>; 2]> {
        None
    }

    fn velocity_seeded(&self, _t: f64, _q: &[Seeded], _xi: &[Seeded]) -> Option<Vec<Seeded>> {
        None
    }

    fn has_tangents(&self, _method: &Method) -> Result<(), SensitivityError> {
        Err(NO_DERIVATIVES)
    }

    fn step_derivative(
        &self,
        _method: &Method,
        _time: (f64, f64),
        _ends: [&AnyState; 2],
        _report: &Report,
    ) -> Result<DMatrix<f64>, SensitivityError> {
        Err(NO_DERIVATIVES)
    }
}

impl Assembly {
    /// The state of this assembly.
    fn own<'s>(&self, state: &'s mut AnyState) -> Result<&'s mut AssemblyState, StepError> {
        let own = state.held_mut().filter(|state: &&mut AssemblyState| state.len() == self.coordinates());
        own.ok_or(StepError::OTHER_SHAPE)
    }
}

/// A method on an assembly. A method that could not be made fails in its first step.
struct AssemblyIntegrator<'a> {
    subject: &'a AssemblySubject<'a>,
    kind: MethodKind,
    method: Result<Box<dyn AssemblyMethod>, StepError>,
    report: Report,
}

impl Drop for AssemblyIntegrator<'_> {
    fn drop(&mut self) {
        if let Ok(method) = std::mem::replace(&mut self.method, Err(StepError::Stopped)) {
            self.subject.spare.replace(Some((self.kind, method)));
        }
    }
}

impl Integrator for AssemblyIntegrator<'_> {
    fn step(&mut self, t: f64, h: f64, state: &mut AnyState) -> Result<&Report, StepError> {
        let method = self.method.as_mut().map_err(|error| *error)?;
        let assembly = &*self.subject.assembly;
        self.report.iterations = method.step(assembly, t, h, assembly.own(state)?)?;
        Ok(&self.report)
    }

    fn memory(&self) -> Vec<f64> {
        Vec::new()
    }

    fn recall(&mut self, _memory: &[f64], _state: &AnyState) {}

    fn measure_work(&mut self, _sources: PowerSources) {}

    fn own_steps(
        &self,
        _time: (f64, f64),
        _state: &AnyState,
        _memory: &mut Vec<f64>,
        _see: &mut SeeOwnStep<'_>,
    ) -> Result<(), StepError> {
        Ok(())
    }
}
