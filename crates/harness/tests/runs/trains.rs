//! Runs of assemblies.

use crate::common::{Watched, bits, goes_on_to_the_same_bits, watched as watched_on};
use approx::assert_abs_diff_eq;
use assembly::parts::{Trailer, Train};
use assembly::{AssemblyState, AssemblySubject, assembly_method};
use dla::{Checkpoint, Event, Mechanism, RecommendError, Schedule, StepError, Substeps, Trajectory, has_tangents};
use harness::{METHODS, Method, Progress, Record, Request, Run, Saving};
use lagrangian::With;
use sleigh::effects::{Drag, Thrust};
use sleigh::{Sleigh, SleighState, TimeFunction};

const SCHEDULE: Schedule = Schedule { t0: 0.0, step: 0.02, steps: 200 };

fn train() -> Train {
    let trailers = vec![Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap(); 3];
    let effects = (Drag::new(0.3, 0.1).unwrap(), Thrust::new(TimeFunction::Constant(0.4)).unwrap());
    let lead = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects };
    Train::new(lead, trailers, |trailer| trailer.sleigh).unwrap()
}

/// The request of a run from a start, which keeps about `samples` nodes.
pub(super) fn request(schedule: &Schedule, start: &AssemblyState, samples: u64) -> Request {
    Request { schedule: *schedule, q: start.unwrapped(), v: start.v().to_vec(), samples }
}

/// The run of a train, of which every node in `every` is kept.
pub(super) fn made(train: &Train, method: &Method, schedule: &Schedule, start: &AssemblyState, every: u64) -> Watched {
    watched((train, start), method, schedule, &[], every)
}

/// The same with an eye on events.
pub(super) fn watched(
    (train, start): (&Train, &AssemblyState),
    method: &Method,
    schedule: &Schedule,
    events: &[Event<'_>],
    every: u64,
) -> Watched {
    let request = request(schedule, start, schedule.steps.div_ceil(every));
    watched_on(&AssemblySubject::from(&train.assembly), method, &request, events, every)
}

/// The configuration at its end, nothing looking on.
pub(super) fn end_of(train: &Train, method: &Method, schedule: &Schedule, start: &AssemblyState) -> Vec<f64> {
    let system = AssemblySubject::from(&train.assembly);
    let mut state = system.state(&start.unwrapped(), start.v());
    Run::of(&system, method).moves(schedule, &mut state).unwrap();
    state.unwrapped()
}

fn steps(steps: u64) -> Schedule {
    Schedule { steps, ..SCHEDULE }
}

test_systems::short_and_full! {
    a_run_of_a_train_is_measured => check_measured(20);
    a_run_of_a_train_is_measured_in_full => check_measured(200);
}

/// The work of drag and thrust is taken off the energy; the rest is of the order of the method.
fn check_measured(count: u64) {
    let (train, schedule) = (train(), steps(count));
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    let run = |name: &str| {
        let method = Method::named(name, None).unwrap();
        made(&train, &method, &schedule, &start, 10)
    };
    let [second, fourth] = ["dla", "dla4"].map(run);
    for run in [&second, &fourth] {
        let record = &run.record;
        let nodes = count as usize / 10 + 1;
        let kept = run.nodes.len();
        assert_eq!((record.steps, kept, record.samples.len()), (count, nodes, nodes));
        assert_abs_diff_eq!(record.t, 0.02 * count as f64, epsilon = 1e-12);
        assert!(record.constraint_max < 1e-14 && record.leaf_max.unwrap() < 1e-14);
        assert!(record.energy.work.abs() > 0.1 * count as f64 / 200.0);
        assert!(record.newton.mean >= 1.0 && record.wall_seconds > 0.0);
    }
    // Simpson's rule leaves 1e-8 of the work; order 2 leaves 1e-4.
    assert!(fourth.record.energy.max_error < 1e-6, "{:e}", fourth.record.energy.max_error);
    assert!(second.record.energy.max_error > fourth.record.energy.max_error);
}

/// What the methods of a few coordinates cannot do they refuse.
#[test]
fn other_methods_refuse_trains() {
    let train = train();
    let start = train.start(&SleighState::default(), &[]);
    let method = Method::named("rk4", None).unwrap();
    let run = made(&train, &method, &SCHEDULE, &start, 10);
    assert!(run.record.refusal().unwrap().contains("dla8"));
    assert_eq!(run.record.steps, 0);
}

/// The table of methods says of each what it does: trains, and derivatives of its steps.
#[test]
fn rows_say_what_methods_do() {
    let train = train();
    for info in METHODS {
        let method = Method::named(info.name, None).unwrap();
        let made = assembly_method(&train.assembly, info.kind);
        assert_eq!(made.is_ok(), info.assemblies, "{}", info.name);
        assert_eq!(has_tangents(&method).is_ok(), info.tangent.is_ok(), "{}", info.name);
        let Err(StepError::Unsupported { reason }) = made else { continue };
        // The refusal names those that do.
        let named: Vec<&str> =
            reason.split([' ', ',']).filter(|word| METHODS.iter().any(|m| m.name == *word)).collect();
        let able: Vec<&str> = METHODS.iter().filter(|info| info.assemblies).map(|info| info.name).collect();
        assert_eq!(named, able);
    }
}

/// Somebody who stops a run as soon as asked.
struct Impatient;

impl Progress for Impatient {
    fn advance(&mut self, _steps: u64) {}

    fn stops(&self) -> bool {
        true
    }
}

#[test]
#[ignore = "slow"]
fn an_interrupted_run_keeps_what_is_made() {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, ..SleighState::default() }, &[]);
    let method = Method::named("dla", None).unwrap();
    let long = Schedule { steps: 100_000_000, ..SCHEDULE };
    let (system, request) = (AssemblySubject::from(&train.assembly), request(&long, &start, 1));
    let (mut nodes, mut impatient) = (Trajectory::every(long.steps), Impatient);
    let run = Run::of(&system, &method).observe(&mut nodes).progress(&mut impatient).go(&request);
    assert!(run.record.interrupted && run.record.steps > 0);
    assert_abs_diff_eq!(nodes.nodes().last().unwrap().t, run.record.t);
}

test_systems::short_and_full! {
    events_along_a_train => check_events([0.0513, 0.0911]);
    events_along_a_train_in_full => check_events([0.513, 0.911]);
}

/// The state at a crossing is the end of a shorter step of the method, and a terminal event ends the run there.
fn check_events(places: [f64; 2]) {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    for name in ["dla", "dla4"] {
        let method = Method::named(name, None).unwrap();
        let x = |value: f64| move |_: f64, q: &[f64], _: &[f64]| q[0] - value;
        let events = [Event::new("first", x(places[0])), Event::new("last", x(places[1])).terminal()];
        let run = watched((&train, &start), &method, &SCHEDULE, &events, 1000);
        let crossings = &run.crossings;
        assert_eq!(crossings.iter().map(|crossing| crossing.event).collect::<Vec<_>>(), [0, 1]);
        for (crossing, value) in crossings.iter().zip(places) {
            assert!(crossing.rising && crossing.within < 1e-15);
            assert_abs_diff_eq!(crossing.q[0], value, epsilon = 1e-15);
            let state = AssemblyState::new(&train.assembly, &crossing.q, &crossing.v);
            let misses = train.assembly.misses(crossing.t, &state);
            assert!(misses.iter().all(|miss| *miss < 1e-14));
        }
        assert_eq!((&run.record.q, &run.record.v), (&crossings[1].q, &crossings[1].v));
        assert_abs_diff_eq!(run.record.t, crossings[1].t);
        assert_eq!(run.nodes.len(), 2);
        assert_eq!(run.record.steps, crossings[1].k + 1);
        assert!(run.record.failure.is_none() && !run.record.interrupted);
    }
}

test_systems::short_and_full! {
    a_saved_run_goes_on_as_if_it_had_not_stopped => check_saved(14, 5);
    a_saved_run_goes_on_as_if_it_had_not_stopped_in_full => check_saved(200, 64);
}

/// In parts, and from the file of any of them, the numbers are the same to the last bit.
fn check_saved(count: u64, every: u64) {
    let (train, schedule) = (train(), steps(count));
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    for name in ["dla", "dla4"] {
        let method = Method::named(name, None).unwrap();
        let (system, request) = (AssemblySubject::from(&train.assembly), request(&schedule, &start, 10));
        goes_on_to_the_same_bits(&system, &method, &request, every);
    }
}

test_systems::short_and_full! {
    a_step_for_a_tolerance => check_recommended(0.4, 1e-5);
    a_step_for_a_tolerance_in_full => check_recommended(4.0, 1e-4);
}

/// The recommended step meets its tolerance against a run of high order, and one of a quarter of the steps does not.
fn check_recommended(duration: f64, tolerance: f64) {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    let dla = Method::named("dla", None).unwrap();
    let system = AssemblySubject::from(&train.assembly);
    let (q, v) = (start.unwrapped(), start.v());
    let of = |method: &Method| Run::of(&system, method).recommended((&q, v), (duration, tolerance));
    let found = of(&dla).unwrap();
    let end = |method: &Method, steps: u64| {
        end_of(&train, method, &Schedule { t0: 0.0, step: duration / steps as f64, steps }, &start)
    };
    let exact = end(&Method::named("dla8", None).unwrap(), (duration / 0.02).round() as u64);
    let error = |steps: u64| {
        let pairs = end(&dla, steps).into_iter().zip(&exact);
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    };
    println!("{found:?}, {:e}", error(found.steps));
    assert!(error(found.steps) < tolerance && error(found.steps / 4) > tolerance);
    assert!(matches!(of(&Method::named("rk4", None).unwrap()), Err(RecommendError::Fails { .. })));
}

/// A train that is to turn by a radian and more in a step of a second.
fn turning() -> (Train, AssemblyState) {
    let train = train();
    let start = train.start(&SleighState { speed: 3.0, turn_rate: 2.0, ..SleighState::default() }, &[0.4, -0.4]);
    (train, start)
}

fn seconds(steps: u64) -> Schedule {
    Schedule { t0: 0.0, step: 1.0, steps }
}

/// Driven in parts; on a way of some metres short steps end at the same place.
fn in_parts(name: &str, long: &Schedule, right: &[f64]) -> (Method, Record) {
    let (train, start) = turning();
    let method = Method::named(name, None).unwrap().with_substeps(Substeps::default());
    let run = made(&train, &method, long, &start, 1).record;
    assert!(run.failure.is_none(), "{name}: {:?}", run.failure);
    let substeps = run.substeps.unwrap();
    assert!(substeps.divided > 0 && run.steps == long.steps, "{name}: {substeps:?}");
    assert!(run.constraint_max < 1e-13 && run.leaf_max.unwrap() < 1e-13, "{name}: {run:?}");
    for (end, right) in run.q.iter().zip(right) {
        assert_abs_diff_eq!(end, right, epsilon = 3e-2);
    }
    assert!(run.energy.max_error < 1e-2 * run.energy.initial, "{name}: {:?}", run.energy);
    (method, run)
}

fn short_steps(step: f64, steps: u64) -> Vec<f64> {
    let (train, start) = turning();
    let plain = Method::named("dla4", None).unwrap();
    end_of(&train, &plain, &Schedule { t0: 0.0, step, steps }, &start)
}

#[test]
fn long_steps_of_trains_are_made_in_parts() {
    in_parts("dla4", &seconds(1), &short_steps(0.05, 20));
}

/// The bound, and what was tried.
#[test]
fn a_long_step_of_a_train_is_divided_so_far() {
    let (train, start) = turning();
    let plain = Method::named("dla4", None).unwrap();
    assert!(made(&train, &plain, &seconds(6), &start, 1).record.failure.is_some());
    let few = plain.with_substeps(Substeps::new(1, 10));
    let run = made(&train, &few, &seconds(6), &start, 1).record;
    assert!(run.failure.is_some() && run.substeps.unwrap().undivided.is_some(), "{run:?}");
    assert_eq!(run.energy.work.abs().to_bits(), 0);
}

/// Also from a checkpoint and up to an event.
#[test]
#[ignore = "slow"]
fn long_steps_of_trains_are_made_in_parts_at_length() {
    let ((train, start), long) = (turning(), seconds(6));
    let right = short_steps(0.005, 1200);
    for name in ["dla", "dla4"] {
        let (method, run) = in_parts(name, &long, &right);
        let (system, request) = (AssemblySubject::from(&train.assembly), request(&long, &start, long.steps));
        assert_eq!(bits(&goes_on_to_the_same_bits(&system, &method, &request, 2)), bits(&run), "{name}");

        let events = [Event::new("x", |_, q, _| q[0] - 1.0).terminal()];
        let ended = watched((&train, &start), &method, &long, &events, 1);
        assert_eq!((ended.crossings.len(), ended.record.t), (1, ended.crossings[0].t), "{name}");
        assert_abs_diff_eq!(ended.record.q[0], 1.0, epsilon = 1e-9);
        // Events are saved as those of other systems are.
        let identity = Checkpoint::default();
        let mut saving = Saving { identity: &identity, from: None, every: Some(2), save: &mut |_| () };
        let saved = Run::of(&system, &method).events(&events, 4).saved(&request, &mut saving, None).unwrap();
        assert_eq!((saved.crossings.len(), bits(&saved.record)), (1, bits(&ended.record)), "{name}");
    }
}
