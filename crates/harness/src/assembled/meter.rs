use super::{AssemblyNode, AssemblyNodes};
use crate::{
    Blocks, Drift, Energies, EnergySummary, Method, MethodInfo, NewtonSummary, Record, Sample, SubstepSummary, Trend,
};
use assembly::{Assembly, AssemblyError, AssemblyRunError, AssemblyState, AssemblyWork};
use dla::{Checkpoint, CheckpointError, Undivided};
use lagrangian::linear::larger;

/// What a run of an assembly is measured by.
pub(super) struct AssemblyMeter<'a> {
    /// Where nodes go that are not kept.
    shown: Option<ShownNode<'a>>,
    /// Every so manieth node is a sample, and is kept unless nodes are shown.
    every: u64,
    initial: f64,
    last: f64,
    max_error: f64,
    most: [f64; 2],
    work: AssemblyWork,
    trend: Trend,
    blocks: Blocks,
    energies: Energies,
    iterations: u64,
    most_iterations: u32,
    bucket: (f64, f64),
    samples: Vec<Sample>,
    pub(super) nodes: Vec<AssemblyNode>,
    substeps: Option<SubstepSummary>,
}

/// Where nodes go.
struct ShownNode<'a> {
    every: u64,
    sink: &'a mut dyn FnMut(u64, &AssemblyNode),
    /// The time (s) of the last one.
    last: f64,
}

impl<'a> AssemblyMeter<'a> {
    pub(super) fn new(
        assembly: &Assembly,
        method: &Method,
        t: f64,
        start: &AssemblyState,
        nodes: AssemblyNodes<'a>,
    ) -> Self {
        let (every, shown) = split(nodes);
        let (initial, most) = (assembly.energy(t, start), assembly.misses(t, start));
        let mut meter = Self {
            shown,
            every,
            initial,
            last: initial,
            max_error: 0.0,
            most,
            work: AssemblyWork::default(),
            trend: Trend::default(),
            blocks: Blocks::default(),
            energies: Energies::of_start(initial, kinetic(assembly, t, start)),
            iterations: 0,
            most_iterations: 0,
            bucket: (0.0, most[0]),
            samples: Vec::new(),
            nodes: Vec::new(),
            substeps: method.substeps().map(|_| SubstepSummary::default()),
        };
        meter.trend.add(t, 0.0);
        meter.blocks.add(t, 0.0);
        meter.keep(assembly, t, start);
        meter.show(assembly, (0, t), start);
        meter
    }

    /// Adds the work over a step, or a part of one, from one time and state to another.
    pub(super) fn over(&mut self, assembly: &Assembly, before: (f64, &AssemblyState), after: (f64, &AssemblyState)) {
        self.work.step(assembly, before, after);
    }

    /// Sees the state where a piece begins at the time `t`: an impulse has done the work by which the energy is another than `before`.
    pub(super) fn jumped(&mut self, assembly: &Assembly, t: f64, before: &AssemblyState, state: &AssemblyState) {
        self.work.add(assembly.energy(t, state) - assembly.energy(t, before));
    }

    /// The work so far.
    pub(super) fn work(&self) -> [f64; 2] {
        self.work.sum()
    }

    /// Takes back the work of parts that have come to nothing.
    pub(super) fn back_to(&mut self, work: [f64; 2]) {
        self.work.back_to(work);
    }

    /// Notes why a step cannot be made in parts either.
    pub(super) fn undivided(&mut self, why: &Undivided<AssemblyError>) {
        if let Some(substeps) = self.substeps.as_mut().filter(|_| why.tried > 0) {
            let Undivided { tried, time, part, ref source } = *why;
            substeps.undivided = Some(Undivided { tried, time, part, source: source.step_error() });
        }
    }

    /// Sees the node number `made`, at the time `t`, after a step that was made in so many parts, none where it was made whole.
    pub(super) fn see(
        &mut self,
        assembly: &Assembly,
        (made, t): (u64, f64),
        state: &AssemblyState,
        iterations: u32,
        parts: u64,
    ) {
        if let Some(substeps) = &mut self.substeps {
            substeps.add(parts);
        }
        self.last = assembly.energy(t, state);
        let (error, miss) = (self.last - self.initial - self.work.total(), assembly.misses(t, state));
        self.max_error = larger(self.max_error, error);
        self.most = [larger(self.most[0], miss[0]), larger(self.most[1], miss[1])];
        self.trend.add(t, error);
        self.blocks.add(t, error);
        self.energies.see(t, error, self.work.total(), || kinetic(assembly, t, state));
        self.bucket = (larger(self.bucket.0, error), larger(self.bucket.1, miss[0]));
        self.iterations += u64::from(iterations);
        self.most_iterations = self.most_iterations.max(iterations);
        if made.is_multiple_of(self.every) {
            self.keep(assembly, t, state);
        }
        if self.shown.as_ref().is_some_and(|shown| made.is_multiple_of(shown.every)) {
            self.show(assembly, (made, t), state);
        }
    }

    fn node(&self, assembly: &Assembly, t: f64, state: &AssemblyState) -> AssemblyNode {
        AssemblyNode::of(assembly, (t, state), self.work.total())
    }

    fn keep(&mut self, assembly: &Assembly, t: f64, state: &AssemblyState) {
        let node = self.node(assembly, t, state);
        self.samples.push(Sample {
            t,
            q: first(&node.q).to_vec(),
            energy_error: self.bucket.0,
            constraint: self.bucket.1,
        });
        self.bucket = (0.0, 0.0);
        if self.shown.is_none() {
            self.nodes.push(node);
        }
    }

    /// Hands on the node of that number, where nodes are handed on.
    fn show(&mut self, assembly: &Assembly, (made, t): (u64, f64), state: &AssemblyState) {
        if self.shown.is_some() {
            let node = self.node(assembly, t, state);
            if let Some(shown) = &mut self.shown {
                (shown.sink)(made, &node);
                shown.last = t;
            }
        }
    }

    /// Keeps and hands on the last node, where that is no regular one.
    pub(super) fn finish(&mut self, assembly: &Assembly, (made, t): (u64, f64), state: &AssemblyState) {
        if self.samples.last().is_none_or(|sample| sample.t < t) {
            self.keep(assembly, t, state);
        }
        if self.shown.as_ref().is_some_and(|shown| shown.last < t) {
            self.show(assembly, (made, t), state);
        }
    }

    pub(super) fn record(
        &self,
        method: MethodInfo,
        step: f64,
        (t, steps, wall_seconds): (f64, u64, f64),
        state: &AssemblyState,
        failure: Option<&AssemblyRunError>,
    ) -> Record {
        let coordinates: Vec<[f64; 2]> = (0..state.len().min(3)).map(|i| [state.unwrapped(i), state.v(i)]).collect();
        let of = |which: usize| first(&coordinates.iter().map(|pair| pair[which]).collect::<Vec<_>>());
        let mean = if steps == 0 { 0.0 } else { self.iterations as f64 / steps as f64 };
        Record {
            method,
            step,
            steps,
            wall_seconds,
            derivation_seconds: 0.0,
            newton: NewtonSummary { mean, max: self.most_iterations },
            energy: EnergySummary {
                initial: self.initial,
                last: self.last,
                work: self.work.total(),
                max_error: self.max_error,
                drift_per_time: self.trend.slope().unwrap_or(0.0),
                drift: Drift::of_energy(&self.blocks, &self.energies),
                jump: self.energies.jump(),
            },
            constraint_max: self.most[0],
            // The mean velocities of the steps are not kept; the equations of a step meet it as they do the joints.
            step_constraint_max: f64::NAN,
            leaf_max: Some(self.most[1]),
            t,
            q: of(0).to_vec(),
            v: of(1).to_vec(),
            samples: self.samples.clone(),
            failure: failure.map(|error| dla::RunError::new(error.step, error.time, error.source.step_error())),
            substeps: self.substeps,
            interrupted: false,
        }
    }

    /// Writes to a checkpoint all that the rest of a run needs.
    pub(super) fn save(&self, checkpoint: &mut Checkpoint) {
        let sizes = [self.initial, self.last, self.max_error, self.most[0], self.most[1]];
        checkpoint.put("meter", &[&sizes[..], &[self.bucket.0, self.bucket.1]].concat());
        checkpoint.put("trend", &self.trend.sums());
        checkpoint.put_counts("iterations", &[self.iterations, u64::from(self.most_iterations)]);
        self.work.save(checkpoint);
        self.blocks.save(checkpoint);
        self.energies.save(checkpoint);
        if let Some(substeps) = &self.substeps {
            substeps.save(checkpoint);
        }
        let numbers = |s: &Sample| [&[s.t, s.energy_error, s.constraint][..], &s.q].concat();
        let samples = self.samples.iter().flat_map(numbers);
        checkpoint.put("samples", &samples.collect::<Vec<_>>());
    }

    /// The meter that [`save`](Self::save) wrote after so many steps, at the time `t`; nodes are those from there on.
    pub(super) fn load(
        checkpoint: &Checkpoint,
        method: &Method,
        (made, t): (u64, f64),
        nodes: AssemblyNodes<'a>,
    ) -> Result<Self, CheckpointError> {
        let (every, mut shown) = split(nodes);
        // A node that is due was handed on before.
        if let Some(shown) = shown.as_mut().filter(|shown| made.is_multiple_of(shown.every)) {
            shown.last = t;
        }
        let [initial, last, max_error, constraint, joint, error, slip] = checkpoint.get("meter")?;
        let [iterations, most] = checkpoint.counts("iterations")?;
        let substeps = method.substeps().map(|_| SubstepSummary::load(checkpoint)).transpose()?;
        let samples = checkpoint.list("samples")?;
        let sample = |x: &[f64]| Sample { t: x[0], energy_error: x[1], constraint: x[2], q: x[3..6].to_vec() };
        Ok(Self {
            shown,
            every,
            initial,
            last,
            max_error,
            most: [constraint, joint],
            work: AssemblyWork::load(checkpoint)?,
            trend: Trend::of_sums(checkpoint.get("trend")?),
            blocks: Blocks::load(checkpoint)?,
            energies: Energies::load(checkpoint)?,
            iterations,
            most_iterations: u32::try_from(most).unwrap_or(u32::MAX),
            bucket: (error, slip),
            samples: samples.chunks_exact(6).map(sample).collect(),
            nodes: Vec::new(),
            substeps,
        })
    }
}

/// Every how manieth node is a sample, and where nodes go that are not kept.
fn split(nodes: AssemblyNodes<'_>) -> (u64, Option<ShownNode<'_>>) {
    match nodes {
        AssemblyNodes::Kept(every) => (every.max(1), None),
        AssemblyNodes::Shown(every, sink) => {
            (u64::MAX, Some(ShownNode { every: every.max(1), sink, last: f64::NEG_INFINITY }))
        }
    }
}

/// The kinetic energy (J): the energy less that of the same place at rest.
fn kinetic(assembly: &Assembly, t: f64, state: &AssemblyState) -> f64 {
    let q: Vec<f64> = (0..state.len()).map(|i| state.unwrapped(i)).collect();
    let resting = AssemblyState::new(assembly, &q, &vec![0.0; state.len()]);
    assembly.energy(t, state) - assembly.energy(t, &resting)
}

/// The first three of some numbers.
fn first(x: &[f64]) -> [f64; 3] {
    lagrangian::from_fn(|i| x.get(i).copied().unwrap_or(0.0))
}
