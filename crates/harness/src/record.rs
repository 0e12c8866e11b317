use crate::{MethodInfo, Trend};
use dla::{Checkpoint, CheckpointError, Observer, RunError, StepError, StepReport, View, Work};
use lagrangian::System;
use lagrangian::linear::larger;
use std::ops::ControlFlow;

/// Newton iterations a step; zeros for an explicit method.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NewtonSummary {
    /// The mean.
    pub mean: f64,
    /// The most.
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
}

/// A node kept for plots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<const N: usize> {
    /// Time (s).
    pub t: f64,
    /// Configuration, angles with their full turns.
    pub q: [f64; N],
    /// The largest `|E - E0 - work|` (J) since the sample before.
    pub energy_error: f64,
    /// The largest constraint residual since the sample before.
    pub constraint: f64,
}

/// One run of one method, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Record<const N: usize> {
    /// The method.
    pub method: MethodInfo,
    /// Step (s).
    pub step: f64,
    /// Steps made.
    pub steps: u64,
    /// Time of the steps alone, nothing observed (s): the median of repeated runs where they are short.
    pub wall_seconds: f64,
    /// Newton iterations.
    pub newton: NewtonSummary,
    /// Energy.
    pub energy: EnergySummary,
    /// `max |A(q) v + b|` over all nodes.
    pub constraint_max: f64,
    /// Time at the end (s).
    pub t: f64,
    /// Configuration at the end, angles with their full turns.
    pub q: [f64; N],
    /// Velocity at the end.
    pub v: [f64; N],
    /// Nodes for plots.
    pub samples: Vec<Sample<N>>,
    /// Why the run ended early, where it did; all else then tells of the part before.
    pub failure: Option<RunError>,
}

impl<const N: usize> Record<N> {
    /// Why the method refuses the system, where it does: no failure of a computation, since none was begun or could be.
    #[must_use]
    pub fn refusal(&self) -> Option<&'static str> {
        match self.failure {
            Some(RunError { source: StepError::Unsupported { reason }, .. }) => Some(reason),
            _ => None,
        }
    }
}

/// The observer that measures a run.
#[derive(Debug)]
pub(crate) struct Meter<const N: usize> {
    every: u64,
    initial: f64,
    last: f64,
    max_error: f64,
    constraint_max: f64,
    trend: Trend,
    work: Work<N>,
    iterations: u64,
    most: u32,
    bucket: (f64, f64),
    samples: Vec<Sample<N>>,
    end: (u64, f64, [f64; N], [f64; N]),
}

impl<const N: usize> Meter<N> {
    /// Keeps a sample every `every` steps.
    pub(crate) fn new(every: u64) -> Self {
        Self {
            every: every.max(1),
            initial: 0.0,
            last: 0.0,
            max_error: 0.0,
            constraint_max: 0.0,
            trend: Trend::default(),
            work: Work::default(),
            iterations: 0,
            most: 0,
            bucket: (0.0, 0.0),
            samples: Vec::new(),
            end: (0, 0.0, [0.0; N], [0.0; N]),
        }
    }

    /// Writes to a checkpoint all that the rest of a run needs; not the samples.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        let (energy, constraint) = self.bucket;
        let sizes = [self.initial, self.last, self.max_error, self.constraint_max, energy, constraint];
        checkpoint.put("meter", &sizes);
        checkpoint.put("trend", &self.trend.sums());
        checkpoint.put_counts("iterations", &[self.iterations, u64::from(self.most)]);
        self.work.save(checkpoint);
    }

    /// The meter that [`save`](Self::save) wrote, whose work is loaded already.
    pub(crate) fn load(checkpoint: &Checkpoint, every: u64, work: Work<N>) -> Result<Self, CheckpointError> {
        let [initial, last, max_error, constraint_max, energy, constraint] = checkpoint.get("meter")?;
        let [iterations, most] = checkpoint.counts("iterations")?;
        let most = u32::try_from(most).unwrap_or(u32::MAX);
        let trend = Trend::of_sums(checkpoint.get("trend")?);
        let sizes = Self { initial, last, max_error, constraint_max, ..Self::new(every) };
        Ok(Self { trend, work, iterations, most, bucket: (energy, constraint), ..sizes })
    }

    fn see<Sys: System<N, M>, const M: usize>(&mut self, node: &View<'_, Sys, N>) {
        self.last = node.energy();
        let error = self.last - self.initial - self.work.total();
        let constraint = node.constraint();
        self.max_error = larger(self.max_error, error.abs());
        self.constraint_max = larger(self.constraint_max, constraint);
        self.trend.add(node.t, error);
        self.bucket = (larger(self.bucket.0, error.abs()), larger(self.bucket.1, constraint));
    }

    fn sample<Sys>(&mut self, node: &View<'_, Sys, N>) {
        let (energy_error, constraint) = std::mem::take(&mut self.bucket);
        self.samples.push(Sample { t: node.t, q: node.state.unwrapped(), energy_error, constraint });
    }

    pub(crate) fn record(
        self,
        method: MethodInfo,
        step: f64,
        wall_seconds: f64,
        failure: Option<RunError>,
    ) -> Record<N> {
        let (steps, t, q, v) = self.end;
        let mean = if steps == 0 { 0.0 } else { self.iterations as f64 / steps as f64 };
        Record {
            method,
            step,
            steps,
            wall_seconds,
            newton: NewtonSummary { mean, max: self.most },
            energy: EnergySummary {
                initial: self.initial,
                last: self.last,
                work: self.work.total(),
                max_error: self.max_error,
                drift_per_time: self.trend.slope().unwrap_or(0.0),
            },
            constraint_max: self.constraint_max,
            t,
            q,
            v,
            samples: self.samples,
            failure,
        }
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Observer<Sys, N, M> for Meter<N> {
    fn start(&mut self, node: &View<'_, Sys, N>) {
        self.initial = node.energy();
        self.work.start(node);
        self.see(node);
        self.sample(node);
    }

    fn resume(&mut self, node: &View<'_, Sys, N>) {
        self.work.resume(node);
    }

    fn step(&mut self, node: &View<'_, Sys, N>, report: &StepReport<M>) -> ControlFlow<()> {
        // Work never ends a run.
        let _ = self.work.step(node, report);
        self.see(node);
        self.iterations += u64::from(report.iterations);
        self.most = self.most.max(report.iterations);
        if node.k.is_multiple_of(self.every) {
            self.sample(node);
        }
        ControlFlow::Continue(())
    }

    fn end(&mut self, node: &View<'_, Sys, N>) {
        self.end = (node.k, node.t, node.state.unwrapped(), *node.state.v());
        if !node.k.is_multiple_of(self.every) {
            self.sample(node);
        }
    }
}
