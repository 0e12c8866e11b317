//! Runs of assemblies, measured as those of static systems are.

use crate::{Blocks, Drift, EnergySummary, Kind, Method, MethodInfo, NewtonSummary, Progress, Record, Sample, Trend};
use assembly::{Assembly, AssemblyError, Composition, Dla, OneStep, RunError, Solver, State};
use dla::Schedule;
use lagrangian::linear::larger;
use std::time::{Duration, Instant};

/// A node of an assembly that was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyNode {
    /// Time (s).
    pub t: f64,
    /// Configuration, angles with their full turns.
    pub q: Vec<f64>,
    /// Velocity.
    pub v: Vec<f64>,
    /// Energy (J).
    pub energy: f64,
    /// Work done since the start (J).
    pub work: f64,
    /// The largest `|A v + b|` here.
    pub constraint: f64,
    /// The largest `|g|` of a joint here.
    pub joint: f64,
}

/// A run of an assembly, measured.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// The record, whose coordinates are the first three of the assembly; [`Record::leaf_max`] is that of its joints.
    pub record: Record<3>,
    /// The nodes kept.
    pub nodes: Vec<AssemblyNode>,
    /// The state at the end.
    pub end: State,
    /// Why the run ended early, where it did, with the constraints that are the cause.
    pub failure: Option<RunError>,
}

/// Why a method is refused.
const OTHERS: &str =
    "the method is for systems of a few coordinates; trains and other assemblies are done by dla, dla4, dla6 and dla8";

/// The method of that name for an assembly.
///
/// # Errors
/// [`AssemblyError::Unsupported`] for one that does none.
pub fn assembly_method(assembly: &Assembly, method: &Method) -> Result<Box<dyn OneStep>, AssemblyError> {
    let composed = |order| Composition::new(assembly, Solver::Best, order).map(|method| Box::new(method) as _);
    match method.info().kind {
        Kind::Dla => Dla::new(assembly, Solver::Best).map(|method| Box::new(method) as _),
        Kind::Dla4 => composed(4),
        Kind::Dla6 => composed(6),
        Kind::Dla8 => composed(8),
        _ => Err(AssemblyError::Unsupported { reason: OTHERS }),
    }
}

/// The state at the end of a run, nothing looking on but the progress; none where that stops it.
///
/// # Errors
/// [`RunError`] with the step that failed.
pub fn assembly_end(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    start: &State,
    progress: &mut dyn Progress,
) -> Result<Option<State>, RunError> {
    let mut state = start.clone();
    let fail = |k: u64| move |source| RunError { step: k + 1, time: schedule.time(k), source };
    let (mut method, mut ticker) = (assembly_method(assembly, method).map_err(fail(0))?, Ticker::new(progress));
    for k in 0..schedule.steps {
        method.step(assembly, schedule.time(k), schedule.step, &mut state).map_err(fail(k))?;
        if ticker.stops(k + 1) {
            return Ok(None);
        }
    }
    ticker.finish(schedule.steps);
    Ok(Some(state))
}

/// Makes a run of an assembly and measures it, keeping every `every`-th node and the last.
///
/// The time is that of the steps alone. Work is integrated by Simpson's rule along the cubic polynomial of each step, which is
/// of order 4. A run that fails gives the record of its valid part.
pub fn run_assembly(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    start: &State,
    every: u64,
    progress: &mut dyn Progress,
) -> Assembled {
    let mut meter = Meter::new(assembly, schedule, start, every.max(1));
    let (mut state, mut ticker) = (start.clone(), Ticker::new(progress));
    let (mut made, mut seconds, mut failure) = (0, 0.0, None);
    match assembly_method(assembly, method) {
        Err(source) => failure = Some(RunError { step: 1, time: schedule.t0, source }),
        Ok(mut method) => {
            while made < schedule.steps && !ticker.stopped {
                let (time, before, clock) = (schedule.time(made), state.clone(), Instant::now());
                match method.step(assembly, time, schedule.step, &mut state) {
                    Ok(report) => {
                        seconds += clock.elapsed().as_secs_f64();
                        made += 1;
                        meter.see(assembly, made, schedule, &before, &state, report.iterations);
                        ticker.stops(made);
                    }
                    Err(source) => {
                        failure = Some(RunError { step: made + 1, time, source });
                        break;
                    }
                }
            }
        }
    }
    ticker.finish(made);
    let interrupted = ticker.stopped && made < schedule.steps;
    meter.finish(assembly, schedule.time(made), &state);
    let record = meter.record(method.info(), schedule, (made, seconds), &state, failure.as_ref());
    Assembled { record: Record { interrupted, ..record }, nodes: meter.nodes, end: state, failure }
}

/// What a run of an assembly is measured by.
struct Meter {
    every: u64,
    initial: f64,
    last: f64,
    max_error: f64,
    most: [f64; 2],
    work: f64,
    power: f64,
    trend: Trend,
    blocks: Blocks,
    iterations: u64,
    most_iterations: u32,
    bucket: (f64, f64),
    samples: Vec<Sample<3>>,
    nodes: Vec<AssemblyNode>,
}

impl Meter {
    fn new(assembly: &Assembly, schedule: &Schedule, start: &State, every: u64) -> Self {
        let t = schedule.t0;
        let (initial, most) = (assembly.energy(t, start), assembly.misses(t, start));
        let mut meter = Self {
            every,
            initial,
            last: initial,
            max_error: 0.0,
            most,
            work: 0.0,
            power: assembly.power(t, start),
            trend: Trend::default(),
            blocks: Blocks::default(),
            iterations: 0,
            most_iterations: 0,
            bucket: (0.0, most[0]),
            samples: Vec::new(),
            nodes: Vec::new(),
        };
        meter.trend.add(t, 0.0);
        meter.blocks.add(t, 0.0);
        meter.keep(assembly, t, start);
        meter
    }

    fn see(
        &mut self,
        assembly: &Assembly,
        made: u64,
        schedule: &Schedule,
        before: &State,
        state: &State,
        iterations: u32,
    ) {
        let (t, h) = (schedule.time(made), schedule.step);
        let power = assembly.power(t, state);
        if power != 0.0 || self.power != 0.0 {
            let middle = assembly.power(t - 0.5 * h, &middle(assembly, before, state, h));
            self.work += h / 6.0 * (self.power + 4.0 * middle + power);
        }
        self.power = power;
        self.last = assembly.energy(t, state);
        let (error, miss) = (self.last - self.initial - self.work, assembly.misses(t, state));
        self.max_error = larger(self.max_error, error);
        self.most = [larger(self.most[0], miss[0]), larger(self.most[1], miss[1])];
        self.trend.add(t, error);
        self.blocks.add(t, error);
        self.bucket = (larger(self.bucket.0, error), larger(self.bucket.1, miss[0]));
        self.iterations += u64::from(iterations);
        self.most_iterations = self.most_iterations.max(iterations);
        if made.is_multiple_of(self.every) {
            self.keep(assembly, t, state);
        }
    }

    fn keep(&mut self, assembly: &Assembly, t: f64, state: &State) {
        let q: Vec<f64> = (0..state.len()).map(|i| state.unwrapped(i)).collect();
        let [constraint, joint] = assembly.misses(t, state);
        let v = (0..state.len()).map(|i| state.v(i)).collect();
        self.samples.push(Sample { t, q: first(&q), energy_error: self.bucket.0, constraint: self.bucket.1 });
        self.bucket = (0.0, 0.0);
        let (energy, work) = (assembly.energy(t, state), self.work);
        self.nodes.push(AssemblyNode { t, q, v, energy, work, constraint, joint });
    }

    /// Keeps the last node, where that is no regular one.
    fn finish(&mut self, assembly: &Assembly, t: f64, state: &State) {
        if self.nodes.last().is_none_or(|node| node.t < t) {
            self.keep(assembly, t, state);
        }
    }

    fn record(
        &self,
        method: MethodInfo,
        schedule: &Schedule,
        (steps, wall_seconds): (u64, f64),
        state: &State,
        failure: Option<&RunError>,
    ) -> Record<3> {
        let coordinates: Vec<[f64; 2]> = (0..state.len().min(3)).map(|i| [state.unwrapped(i), state.v(i)]).collect();
        let of = |which: usize| first(&coordinates.iter().map(|pair| pair[which]).collect::<Vec<_>>());
        let mean = if steps == 0 { 0.0 } else { self.iterations as f64 / steps as f64 };
        Record {
            method,
            step: schedule.step,
            steps,
            wall_seconds,
            newton: NewtonSummary { mean, max: self.most_iterations },
            energy: EnergySummary {
                initial: self.initial,
                last: self.last,
                work: self.work,
                max_error: self.max_error,
                drift_per_time: self.trend.slope().unwrap_or(0.0),
                drift: Drift::of(&self.blocks),
            },
            constraint_max: self.most[0],
            // The mean velocities of the steps are not kept; the equations of a step meet it as they do the joints.
            step_constraint_max: f64::NAN,
            leaf_max: Some(self.most[1]),
            t: schedule.time(steps),
            q: of(0),
            v: of(1),
            samples: self.samples.clone(),
            failure: failure.map(|error| dla::RunError {
                step: error.step,
                time: error.time,
                source: error.source.step_error(),
            }),
            interrupted: false,
        }
    }
}

/// The first three of some numbers.
fn first(x: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}

/// The middle of the cubic polynomial through two nodes.
fn middle(assembly: &Assembly, before: &State, state: &State, h: f64) -> State {
    let n = state.len();
    let moved = |i: usize| state.unwrapped(i) - before.unwrapped(i);
    let q: Vec<f64> =
        (0..n).map(|i| before.unwrapped(i) + 0.5 * moved(i) + 0.125 * h * (before.v(i) - state.v(i))).collect();
    let v: Vec<f64> = (0..n).map(|i| 1.5 * moved(i) / h - 0.25 * (before.v(i) + state.v(i))).collect();
    State::new(assembly, &q, &v)
}

/// Tells a [`Progress`] now and then: a step may take long.
struct Ticker<'a> {
    progress: &'a mut dyn Progress,
    told: u64,
    clock: Instant,
    stopped: bool,
}

impl<'a> Ticker<'a> {
    const EVERY: Duration = Duration::from_millis(50);

    fn new(progress: &'a mut dyn Progress) -> Self {
        Self { progress, told: 0, clock: Instant::now(), stopped: false }
    }

    /// Whether the run is to end, after so many steps.
    fn stops(&mut self, made: u64) -> bool {
        if self.clock.elapsed() >= Self::EVERY {
            self.finish(made);
            self.stopped = self.progress.stops();
            self.clock = Instant::now();
        }
        self.stopped
    }

    fn finish(&mut self, made: u64) {
        self.progress.advance(made - self.told);
        self.told = made;
    }
}
