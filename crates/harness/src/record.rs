use crate::slip::Slip;
use crate::{Blocks, Drift, DriftVerdict, Energies, EnergyJump, Method, MethodInfo, Request, SubstepSummary, Trend};
use dla::{AnyState, Checkpoint, CheckpointError, Observer, Report, RunError, StepError, Undivided, View, Work};
use lagrangian::linear::{larger, largest};
use std::ops::ControlFlow;

/// Newton iterations a step; zeros for an explicit method.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NewtonSummary {
    /// The mean.
    pub mean: f64,
    /// The largest number.
    pub max: u32,
}

/// The energy over a run (J).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySummary {
    /// At the start.
    pub initial: f64,
    /// At the end.
    pub last: f64,
    /// The work done over the run; zero unless forces, explicit time or moving constraints do some.
    pub work: f64,
    /// `max |E - E0 - work|` over all nodes.
    pub max_error: f64,
    /// Slope of the least-squares line through `E - E0 - work` at all nodes (J/s).
    pub drift_per_time: f64,
    /// The course of `E - E0 - work` over the run, its fast and its slow part.
    pub drift: Drift,
    /// Steps that change the energy though no force does that work; `None` if the run has none.
    pub jump: Option<EnergyJump>,
}

/// A node kept for plots.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Time (s).
    pub t: f64,
    /// Configuration, angles with their full turns.
    pub q: Vec<f64>,
    /// The largest `|E - E0 - work|` (J) since the sample before.
    pub energy_error: f64,
    /// The largest constraint residual since the sample before.
    pub constraint: f64,
}

/// One run of one method, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The method.
    pub method: MethodInfo,
    /// Step (s).
    pub step: f64,
    /// Steps made.
    pub steps: u64,
    /// Time of the steps (s). In a comparison, of the steps alone without observers: the median of repeated runs if they are short, and the
    /// processor's time of the thread if the system tells it. In a single run, elapsed time with the observers.
    pub wall_seconds: f64,
    /// Time in which formulas of a system of text were derived, when they were first asked for (s); it is not in the time of the steps.
    pub derivation_seconds: f64,
    /// Newton iterations.
    pub newton: NewtonSummary,
    /// Energy.
    pub energy: EnergySummary,
    /// `max |A(q) v + b|` over all nodes.
    pub constraint_max: f64,
    /// The largest residual of the discrete constraint `w_d` of a step, `A(q) (q1 - q0)/h + b` by the rule of the method (see
    /// `docs/methods/drift.md`), over all steps.
    pub step_constraint_max: f64,
    /// `max |g(q, t)|` over all nodes, the residual of the constraints on positions; `None` if no constraint is the rate of a function `g`
    /// of the positions ([`System::holonomic`](lagrangian::System::holonomic)).
    pub leaf_max: Option<f64>,
    /// Round-off that the equations of a step left in its velocities, at most, relative to the largest velocity of the run; zero if their last
    /// digits settled in every step.
    pub rounding: f64,
    /// Time at the end (s).
    pub t: f64,
    /// Configuration at the end, angles with their full turns.
    pub q: Vec<f64>,
    /// Velocity at the end.
    pub v: Vec<f64>,
    /// Nodes for plots.
    pub samples: Vec<Sample>,
    /// Why the run ended early; all else then describes the part before. `None` if it did not fail.
    pub failure: Option<RunError>,
    /// A summary of divided steps; `None` if the method may divide none.
    pub substeps: Option<SubstepSummary>,
    /// Whether the [`Progress`](crate::Progress) ended the run early.
    pub interrupted: bool,
}

impl Record {
    /// The time of the steps for each second of the motion; `None` for a run without a step.
    #[must_use]
    pub fn seconds_per_simulated_second(&self) -> Option<f64> {
        (self.steps > 0).then(|| self.wall_seconds / (self.steps as f64 * self.step.abs()))
    }

    /// Warnings for a user of the result: steps that change the energy though no force does, and velocities that hold few digits.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let rounded = (self.rounding > FEW_DIGITS).then(|| {
            format!(
                "round-off leaves the velocities of a step uncertain by {:.0e} of the largest, and adds up over the steps: the \
                 method divides the round-off of momenta by a small inertia; `dla` and `gauss*` do not",
                self.rounding
            )
        });
        self.energy.jump.map(|jump| jump.to_string()).into_iter().chain(rounded).collect()
    }

    /// Whether the run reached its end: it neither failed nor was it interrupted.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.failure.is_none() && !self.interrupted
    }

    /// The kind of the error of the energy; `None` if the run did not reach its end.
    #[must_use]
    pub fn verdict(&self) -> Option<DriftVerdict> {
        self.is_whole().then_some(self.energy.drift.verdict)
    }

    /// Why the method refuses the system, or `None`: a refusal is no failure of a computation, since none was begun or could be.
    #[must_use]
    pub fn refusal(&self) -> Option<&'static str> {
        match self.failure {
            Some(RunError { source: StepError::Unsupported { reason }, .. }) => Some(reason),
            _ => None,
        }
    }
}

/// Round-off of a step's velocities that is told, relative to the largest.
const FEW_DIGITS: f64 = 1e-11;

/// The observer that measures a run.
#[derive(Debug)]
pub(crate) struct Meter {
    every: u64,
    step: f64,
    initial: f64,
    last: f64,
    max_error: f64,
    constraint_max: f64,
    trend: Trend,
    blocks: Blocks,
    energies: Energies,
    slip: Slip,
    work: Work,
    iterations: u64,
    most: u32,
    rounding: f64,
    fastest: f64,
    bucket: (f64, f64),
    samples: Vec<Sample>,
    /// The end, if it is no regular sample.
    last_sample: Option<Sample>,
    end: (u64, f64, Vec<f64>, Vec<f64>),
    substeps: Option<SubstepSummary>,
    /// The number of parts of the step that is being made.
    parts: u64,
}

impl Meter {
    /// Keeps about as many samples as are asked for.
    pub(crate) fn new(request: &Request, method: &Method) -> Self {
        let Request { schedule, samples, .. } = request;
        Self {
            every: schedule.steps.div_ceil((*samples).max(1)).max(1),
            step: schedule.step,
            initial: 0.0,
            last: 0.0,
            max_error: 0.0,
            constraint_max: 0.0,
            trend: Trend::default(),
            blocks: Blocks::default(),
            energies: Energies::default(),
            slip: Slip::new(method, schedule.step),
            work: Work::default(),
            iterations: 0,
            most: 0,
            rounding: 0.0,
            fastest: 0.0,
            bucket: (0.0, 0.0),
            samples: Vec::new(),
            last_sample: None,
            end: (0, 0.0, request.q.clone(), request.v.clone()),
            substeps: method.substeps().map(|_| SubstepSummary::default()),
            parts: 0,
        }
    }

    /// Writes to a checkpoint all that the rest of a run needs.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        let (energy, constraint) = self.bucket;
        let sizes = [
            self.initial,
            self.last,
            self.max_error,
            self.constraint_max,
            energy,
            constraint,
            self.rounding,
            self.fastest,
        ];
        checkpoint.put("meter", &sizes);
        checkpoint.put("trend", &self.trend.sums());
        checkpoint.put_counts("iterations", &[self.iterations, u64::from(self.most)]);
        self.work.save(checkpoint);
        self.blocks.save(checkpoint);
        self.energies.save(checkpoint);
        self.slip.save(checkpoint);
        if let Some(substeps) = &self.substeps {
            substeps.save(checkpoint);
        }
        let samples = self
            .samples
            .iter()
            .flat_map(|s| [s.t, s.energy_error, s.constraint].into_iter().chain(s.q.iter().copied()));
        checkpoint.put("samples", &samples.collect::<Vec<_>>());
    }

    /// The meter that [`save`](Self::save) wrote after `made` steps, at `state`, whose work is loaded already.
    pub(crate) fn load(
        checkpoint: &Checkpoint,
        new: Self,
        made: u64,
        t: f64,
        state: &AnyState,
        work: Work,
    ) -> Result<Self, CheckpointError> {
        let [initial, last, max_error, constraint_max, energy, constraint, rounding, fastest] =
            checkpoint.get("meter")?;
        let [iterations, most] = checkpoint.counts("iterations")?;
        let substeps = new.substeps.map(|_| SubstepSummary::load(checkpoint)).transpose()?;
        let most = u32::try_from(most).unwrap_or(u32::MAX);
        let trend = Trend::of_sums(checkpoint.get("trend")?);
        let end = (made, t, state.unwrapped(), state.v().to_vec());
        let sizes = Self { initial, last, max_error, constraint_max, rounding, fastest, end, ..new };
        let (blocks, slip) = (Blocks::load(checkpoint)?, sizes.slip.load(checkpoint)?);
        let energies = Energies::load(checkpoint)?;
        let list = checkpoint.list("samples")?;
        let samples = list.chunks_exact(3 + state.q().len()).map(|numbers| Sample {
            t: numbers[0],
            q: numbers[3..].to_vec(),
            energy_error: numbers[1],
            constraint: numbers[2],
        });
        let samples = samples.collect();
        let last_sample = (!made.is_multiple_of(sizes.every)).then(|| Sample {
            t,
            q: state.unwrapped(),
            energy_error: energy,
            constraint,
        });
        Ok(Self {
            last_sample,
            trend,
            blocks,
            energies,
            slip,
            work,
            iterations,
            most,
            bucket: (energy, constraint),
            samples,
            substeps,
            ..sizes
        })
    }

    fn see(&mut self, node: &View<'_>) {
        self.last = node.energy();
        let error = self.last - self.initial - self.work.total();
        let constraint = node.constraint();
        self.max_error = larger(self.max_error, error.abs());
        self.constraint_max = larger(self.constraint_max, constraint);
        self.trend.add(node.t, error);
        self.blocks.add(node.t, error);
        self.energies.see(node.t, error, self.work.total(), || kinetic(node));
        self.bucket = (larger(self.bucket.0, error.abs()), larger(self.bucket.1, constraint));
    }

    fn sample(&mut self, node: &View<'_>) {
        let sample = self.sampled(node);
        self.samples.push(sample);
        self.bucket = (0.0, 0.0);
    }

    fn sampled(&self, node: &View<'_>) -> Sample {
        let (energy_error, constraint) = self.bucket;
        Sample { t: node.t, q: node.state.unwrapped(), energy_error, constraint }
    }

    pub(crate) fn record(self, method: MethodInfo, wall_seconds: f64, failure: Option<RunError>) -> Record {
        let (steps, t, q, v) = self.end;
        let mean = if steps == 0 { 0.0 } else { self.iterations as f64 / steps as f64 };
        Record {
            method,
            step: self.step,
            steps,
            wall_seconds,
            derivation_seconds: 0.0,
            newton: NewtonSummary { mean, max: self.most },
            energy: EnergySummary {
                initial: self.initial,
                last: self.last,
                work: self.work.total(),
                max_error: self.max_error,
                drift_per_time: self.trend.slope().unwrap_or(0.0),
                drift: Drift::of_energy(&self.blocks, &self.energies),
                jump: self.energies.jump(),
            },
            constraint_max: self.constraint_max,
            step_constraint_max: self.slip.step_max(),
            leaf_max: self.slip.leaf_max(),
            rounding: if self.rounding > 0.0 { self.rounding / self.fastest } else { 0.0 },
            t,
            q,
            v,
            samples: self.samples.into_iter().chain(self.last_sample).collect(),
            failure,
            substeps: self.substeps,
            interrupted: false,
        }
    }
}

impl Observer for Meter {
    fn start(&mut self, node: &View<'_>) {
        self.initial = node.energy();
        self.energies = Energies::of_start(self.initial, kinetic(node));
        self.work.start(node);
        self.slip.start(node);
        self.see(node);
        self.sample(node);
    }

    fn resume(&mut self, node: &View<'_>) {
        self.work.resume(node);
        self.slip.resume(node);
    }

    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        // Work never ends a run.
        let _ = self.work.step(node, report);
        // Over a divided step the discrete constraint is evaluated for its parts.
        if self.parts == 0 {
            self.slip.step(node);
        }
        if let Some(substeps) = &mut self.substeps {
            substeps.add(std::mem::take(&mut self.parts));
        }
        self.see(node);
        self.iterations += u64::from(report.iterations);
        self.most = self.most.max(report.iterations);
        self.rounding = self.rounding.max(report.rounding);
        self.fastest = self.fastest.max(largest(node.state.v()));
        if node.k.is_multiple_of(self.every) {
            self.sample(node);
        }
        ControlFlow::Continue(())
    }

    fn measures_work(&self) -> bool {
        true
    }

    fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
        self.slip.part(end);
        self.parts += 1;
        self.work.part(end, report)
    }

    fn undivided(&mut self, why: &Undivided<StepError>) {
        if let Some(substeps) = &mut self.substeps {
            substeps.undivided = Some(*why);
        }
    }

    fn end(&mut self, node: &View<'_>) {
        self.work.end(node);
        self.parts = 0;
        self.end = (node.k, node.t, node.state.unwrapped(), node.state.v().to_vec());
        self.last_sample = (!node.k.is_multiple_of(self.every)).then(|| self.sampled(node));
    }
}

fn kinetic(node: &View<'_>) -> f64 {
    node.system.kinetic_energy(node.t, node.state.q(), node.state.v())
}
