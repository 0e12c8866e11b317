use super::drive::steps_by;
use crate::{
    AnyState, Checkpoint, CheckpointError, Halved, Integrator, Mechanism, Method, Observer, Part, Report, RunError,
    Schedule, StepError, Substeps, Undivided, View, make_steps,
};
use std::ops::{ControlFlow, Range};

/// A summary of the steps of a run that may be divided.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SubstepSummary {
    /// Number of steps that were made in parts.
    pub divided: u64,
    /// Number of their parts, all together.
    pub parts: u64,
    /// The most parts of one step.
    pub most: u64,
    /// The failure of a step in parts, if the run ended with one.
    pub undivided: Option<Undivided<StepError>>,
}

impl SubstepSummary {
    /// Adds a step that was made in `parts` parts; zero stands for a step that was made whole.
    pub fn add(&mut self, parts: u64) {
        self.divided += u64::from(parts > 0);
        self.parts += parts;
        self.most = self.most.max(parts);
    }

    /// Writes the counts to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put_counts("substeps", &[self.divided, self.parts, self.most]);
    }

    /// The counts that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has none.
    pub fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [divided, parts, most] = checkpoint.counts("substeps")?;
        Ok(Self { divided, parts, most, undivided: None })
    }
}

/// A part of a run with divided steps, if the method may divide them: a step that fails, or does not resolve the motion, is made again in
/// sub-steps, each without the memory of the method, so that a run is the same from every checkpoint.
///
/// It goes through the code of whole steps, a step at a time. Without limits of division it is that code.
///
/// # Errors
/// [`RunError`] with the step that failed; the state then is the last good node.
pub fn substepped_part(
    system: &dyn Mechanism,
    method: &mut dyn Integrator,
    limits: Option<Substeps>,
    schedule: &Schedule,
    steps: Range<u64>,
    state: &mut AnyState,
    observer: &mut dyn Observer,
) -> Result<Part, RunError> {
    let Some(limits) = limits else {
        return make_steps(system, method, schedule, steps, state, observer)
            .map_err(|error| error.with_shorter(method, (schedule.step, state)));
    };
    if observer.measures_work() {
        method.measure_work(system.power_sources());
    }
    steps_by(system, schedule, steps, state, observer, |k, state, observer| {
        match step(system, method, (schedule, k, limits), state, observer) {
            Ok(ControlFlow::Continue(report)) => {
                let node = View { system, k: k + 1, t: schedule.time(k + 1), state };
                Ok(Some(observer.step(&node, &report)))
            }
            Ok(ControlFlow::Break(())) | Err(RunError { source: StepError::Stopped, .. }) => Ok(None),
            Err(error) => Err(error),
        }
    })
}

/// The step from node `k`, whole or in parts; `Break`, with everything as it was, if the observer gives it up.
fn step(
    system: &dyn Mechanism,
    method: &mut dyn Integrator,
    (schedule, k, limits): (&Schedule, u64, Substeps),
    state: &mut AnyState,
    observer: &mut dyn Observer,
) -> Result<ControlFlow<(), Report>, RunError> {
    let (before, remembered) = (state.clone(), method.memory());
    let (t, h) = (schedule.time(k), schedule.step);
    // From what a checkpoint has.
    method.recall(&remembered, state);
    let mut last = LastReport { report: Report::default(), work: true };
    let mut memory = Vec::new();
    let whole = make_steps(system, method, schedule, k..k + 1, state, &mut last)
        .map_err(|error| error.source)
        .and_then(|part| if part.made > k { Ok(()) } else { Err(StepError::Stopped) })
        .and_then(|()| {
            memory = method.memory();
            resolves(system, method, (t, h), &before, state)
        });
    let Err(failure) = whole else {
        method.recall(&memory, state);
        return Ok(ControlFlow::Continue(last.report));
    };

    state.clone_from(&before);
    let mut total = Report::of(system.size().m);
    let made = limits.divide((t, h), failure, StepError::may_hold_in_parts, |(t, h), after| {
        let start = state.clone();
        let report = alone(system, method, None, (t, h), state, true)?;
        if let Err(failure) = resolves(system, method, (t, h), &start, state) {
            *state = start;
            return Err(failure);
        }
        total.add(&report);
        let t = if after < 1.0 { t + h } else { schedule.time(k + 1) };
        Ok(observer.part(&View { system, k: k + 1, t, state }, &report))
    });
    match made {
        Ok(ControlFlow::Continue(_)) => {
            method.recall(&[], state);
            Ok(ControlFlow::Continue(total))
        }
        Ok(ControlFlow::Break(())) => {
            *state = before;
            method.recall(&remembered, state);
            Ok(ControlFlow::Break(()))
        }
        Err(undivided) => {
            *state = before;
            if undivided.tried > 0 {
                observer.undivided(&undivided);
            }
            Err(RunError::new(k + 1, t, undivided.source))
        }
    }
}

/// Whether a step resolves the motion.
fn resolves(
    system: &dyn Mechanism,
    method: &mut dyn Integrator,
    step: (f64, f64),
    before: &AnyState,
    after: &AnyState,
) -> Result<(), StepError> {
    Halved::resolves(step, before, after, |step, state| alone(system, method, None, step, state, true).map(|_| ()))
}

/// A step of a method by itself, without the memory of other steps, as a run of its own; with its work if that is asked for.
///
/// # Errors
/// [`StepError`] if the step has no solution; the state is then unchanged.
pub fn again(
    system: &dyn Mechanism,
    method: &Method,
    time: (f64, f64),
    state: &mut AnyState,
    work: bool,
) -> Result<Report, StepError> {
    Again::new(system, method).step(time, state, work)
}

/// Steps of a method by themselves, as those of [`again`]: for several steps from a node.
pub(super) struct Again<'a> {
    system: &'a dyn Mechanism,
    limits: Option<Substeps>,
    integrator: Box<dyn Integrator + 'a>,
}

impl<'a> Again<'a> {
    pub(super) fn new(system: &'a dyn Mechanism, method: &Method) -> Self {
        Self { system, limits: method.substeps(), integrator: system.integrator(method) }
    }

    pub(super) fn step(&mut self, time: (f64, f64), state: &mut AnyState, work: bool) -> Result<Report, StepError> {
        alone(self.system, &mut *self.integrator, self.limits, time, state, work)
    }
}

/// One step by itself, without the memory of the method.
fn alone(
    system: &dyn Mechanism,
    method: &mut dyn Integrator,
    limits: Option<Substeps>,
    (t, h): (f64, f64),
    state: &mut AnyState,
    work: bool,
) -> Result<Report, StepError> {
    method.recall(&[], state);
    let mut last = LastReport { report: Report::default(), work };
    let schedule = Schedule { t0: t, step: h, steps: 1 };
    let part = match limits {
        None => make_steps(system, method, &schedule, 0..1, state, &mut last),
        limits => substepped_part(system, method, limits, &schedule, 0..1, state, &mut last),
    };
    if part.map_err(|error| error.source)?.made == 1 { Ok(last.report) } else { Err(StepError::Stopped) }
}

/// The observer that keeps what the last step reported.
struct LastReport {
    report: Report,
    /// Whether the work of the step is asked for.
    work: bool,
}

impl Observer for LastReport {
    fn start(&mut self, _node: &View<'_>) {}

    fn step(&mut self, _node: &View<'_>, report: &Report) -> ControlFlow<()> {
        self.report.clone_from(report);
        ControlFlow::Continue(())
    }

    fn measures_work(&self) -> bool {
        self.work
    }
}
