//! What the whole-program tests share.

use dla::{
    Checkpoint, CheckpointError, Close, Dla, Event, Form, Mechanism, Node, OneStep, Schedule, State, Stepper,
    Trajectory, drive,
};
use harness::{Method, Progress, Record, Request, Run, SavedCrossing, Saving};
use lagrangian::System;
use proptest::prelude::*;
use sleigh::{ClosedMap, Sleigh, SleighState};

/// The sleigh of the bundled scene `turnaround`.
pub fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// Its start: backward, with a little spin.
pub fn backward() -> SleighState {
    SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }
}

/// Random sleighs: two decades of mass and inertia, the centre of mass ahead, behind, nearly over and over the blade.
pub fn sleighs() -> impl Strategy<Value = Sleigh> {
    let size = || (-1.0..1.0f64).prop_map(|e| 10f64.powf(e));
    (size(), size(), prop_oneof![4 => -1.0..1.0, 1 => Just(0.0), 1 => -1e-9..1e-9])
        .prop_map(|(m, i, a)| Sleigh::new(m, i, a).unwrap())
}

pub fn starts() -> impl Strategy<Value = SleighState> {
    (
        -5.0..5.0f64,
        -5.0..5.0f64,
        -10.0..10.0f64,
        -2.0..2.0f64,
        prop_oneof![4 => -1.5..1.5, 1 => -1e-9..1e-9, 1 => Just(0.0)],
    )
        .prop_map(|(x, y, heading, speed, turn_rate)| SleighState { x, y, heading, speed, turn_rate })
}

pub fn state_of<Sys: System<3, 1>>(system: &Sys, start: &SleighState) -> State<3> {
    let (q, v) = start.to_coordinates();
    State::new(q, v, system.angles())
}

/// Makes `steps` steps of `h` and returns the state at the end.
pub fn advanced<Sys, Method>(system: &Sys, method: &mut Method, h: f64, steps: u64, state: State<3>) -> State<3>
where
    Sys: System<3, 1>,
    Method: OneStep<3, 1>,
{
    let mut state = state;
    drive(system, method, &Schedule { t0: 0.0, step: h, steps }, &mut state, ()).expect("the steps succeed");
    state
}

pub fn sleigh_state(state: &State<3>) -> SleighState {
    SleighState::from_coordinates(&state.unwrapped(), state.v())
}

/// The state of a sleigh at a configuration and a velocity.
pub fn sleigh_at(q: &[f64], v: &[f64]) -> SleighState {
    SleighState::from_coordinates(&row(q), &row(v))
}

/// The first numbers of a list.
pub fn row<const N: usize>(x: &[f64]) -> [f64; N] {
    *x.first_chunk().unwrap()
}

/// The midpoint method by the closed map of this sleigh, in the basis, and with multipliers.
pub fn midpoint_forms(sleigh: Sleigh) -> [(&'static str, Stepper<'static, 3, 1>); 3] {
    [
        ("closed", Box::new(ClosedMap::of(sleigh))),
        ("basis", Box::new(Dla::midpoint())),
        ("multipliers", Box::new(Dla::midpoint().solved(Form::Multipliers))),
    ]
}

/// A measured run, with the nodes that were kept and the events that happened.
pub struct Watched {
    pub record: Record,
    pub nodes: Vec<Node>,
    pub crossings: Vec<SavedCrossing>,
    pub close: Option<Close>,
}

/// A measured run that looks for events in four parts of each step, and keeps every `every`-th node.
pub fn watched(
    system: &dyn Mechanism,
    method: &Method,
    request: &Request,
    events: &[Event<'_>],
    every: u64,
) -> Watched {
    let mut nodes = Trajectory::every(every);
    let made = Run::of(system, method).events(events, 4).observe(&mut nodes).go(request);
    Watched { record: made.record, nodes: nodes.nodes().to_vec(), crossings: made.crossings, close: made.close }
}

/// A run with all of its checkpoints, as their text gives them back.
pub fn saved(
    system: &dyn Mechanism,
    method: &Method,
    request: &Request,
    every: u64,
    progress: &mut dyn Progress,
) -> (Record, Vec<Checkpoint>) {
    let mut all = Vec::new();
    let mut save = |made: &Checkpoint| all.push(Checkpoint::from_text(&made.to_text()).unwrap());
    let identity = Checkpoint::of([("run", "a".to_owned())]);
    let mut saving = Saving { identity: &identity, from: None, every: Some(every), save: &mut save };
    let made = Run::of(system, method).progress(progress).saved(request, &mut saving, None);
    (made.unwrap().record, all)
}

/// A run from a checkpoint of [`saved`].
pub fn resumed(
    system: &dyn Mechanism,
    method: &Method,
    request: &Request,
    from: &Checkpoint,
    name: &str,
) -> Result<Record, CheckpointError> {
    let identity = Checkpoint::of([("run", name.to_owned())]);
    let mut saving = Saving { identity: &identity, from: Some(from), every: None, save: &mut |_| () };
    Run::of(system, method).saved(request, &mut saving, None).map(|made| made.record)
}

/// All of a record but the time, each number with every digit and its sign.
pub fn bits(record: &Record) -> String {
    format!("{:?}", Record { wall_seconds: 0.0, ..record.clone() })
}

/// The run at once, the run in parts and the run from each of its checkpoints have the same bits. Another run takes no checkpoint.
pub fn goes_on_to_the_same_bits(system: &dyn Mechanism, method: &Method, request: &Request, every: u64) -> Record {
    let (whole, name) = (Run::of(system, method).timed(request), method.info().name);
    let (parts, checkpoints) = saved(system, method, request, every, &mut ());
    assert_eq!(bits(&parts), bits(&whole), "{name}");
    assert_eq!(checkpoints.len() as u64, request.schedule.steps.div_ceil(every), "{name}");
    for checkpoint in &checkpoints {
        let rest = resumed(system, method, request, checkpoint, "a").unwrap();
        assert_eq!(bits(&rest), bits(&whole), "{name}");
    }
    let refused = resumed(system, method, request, &checkpoints[0], "another");
    assert!(matches!(refused, Err(CheckpointError::Other { .. })), "{name}: {refused:?}");
    whole
}
