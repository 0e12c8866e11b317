//! Runs of assemblies.

use approx::assert_abs_diff_eq;
use assembly::parts::{Trailer, Train};
use assembly::{AssemblyError, AssemblyState};
use dla::{Checkpoint, CheckpointError, RecommendError, Schedule, Substeps, has_tangents};
use harness::{
    AssemblyEvent, AssemblyNodes, METHODS, Method, Progress, Saving, assembly_end, assembly_method, recommend_assembly,
    run_assembly, run_assembly_saved, run_assembly_watched,
};
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

fn steps(steps: u64) -> Schedule {
    Schedule { steps, ..SCHEDULE }
}

#[test]
fn a_run_of_a_train_is_measured() {
    check_measured(20);
}

#[test]
#[ignore = "slow"]
fn a_run_of_a_train_is_measured_in_full() {
    check_measured(200);
}

/// The work of drag and thrust is taken off the energy; what is left is of the order of the method.
fn check_measured(count: u64) {
    let (train, schedule) = (train(), steps(count));
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    let run = |name: &str| {
        let method = Method::named(name, None).unwrap();
        run_assembly(&train.assembly, &method, &schedule, &start, 10, &mut ())
    };
    let [second, fourth] = ["dla", "dla4"].map(run);
    for run in [&second, &fourth] {
        let record = &run.record;
        let nodes = count as usize / 10 + 1;
        assert_eq!((record.steps, run.nodes.len(), record.samples.len()), (count, nodes, nodes));
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
    let run = run_assembly(&train.assembly, &method, &SCHEDULE, &start, 10, &mut ());
    assert!(run.record.refusal().unwrap().contains("dla8"));
    assert_eq!(run.record.steps, 0);
}

/// The table of methods says of each what it does: trains, and derivatives of its steps.
#[test]
fn rows_say_what_methods_do() {
    let train = train();
    for info in METHODS {
        let method = Method::named(info.name, None).unwrap();
        let made = assembly_method(&train.assembly, &method);
        assert_eq!(made.is_ok(), info.assemblies, "{}", info.name);
        assert_eq!(has_tangents(&method).is_ok(), info.tangent.is_ok(), "{}", info.name);
        let Err(AssemblyError::Unsupported { reason }) = made else { continue };
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
fn an_interrupted_run_keeps_what_is_made() {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, ..SleighState::default() }, &[]);
    let method = Method::named("dla", None).unwrap();
    let long = Schedule { steps: 100_000_000, ..SCHEDULE };
    let run = run_assembly(&train.assembly, &method, &long, &start, long.steps, &mut Impatient);
    assert!(run.record.interrupted && run.record.steps > 0);
    assert_abs_diff_eq!(run.nodes.last().unwrap().t, run.record.t);
}

#[test]
fn events_along_a_train() {
    check_events([0.0513, 0.0911]);
}

#[test]
#[ignore = "slow"]
fn events_along_a_train_in_full() {
    check_events([0.513, 0.911]);
}

/// The state at a crossing is that of a shorter step of the method, and a terminal event ends the run there.
fn check_events(places: [f64; 2]) {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    for name in ["dla", "dla4"] {
        let method = Method::named(name, None).unwrap();
        let x = |value: f64| move |_: f64, state: &AssemblyState| state.unwrapped(0) - value;
        let events = [AssemblyEvent::new("first", false, x(places[0])), AssemblyEvent::new("last", true, x(places[1]))];
        let (run, crossings, _) = run_assembly_watched(
            &train.assembly,
            &method,
            &SCHEDULE,
            (&start, AssemblyNodes::Kept(1000)),
            (&events, 4),
            &mut (),
        );
        assert_eq!(crossings.iter().map(|crossing| crossing.event).collect::<Vec<_>>(), [0, 1]);
        for (crossing, value) in crossings.iter().zip(places) {
            assert!(crossing.rising && crossing.within < 1e-15);
            assert_abs_diff_eq!(crossing.state.unwrapped(0), value, epsilon = 1e-15);
            assert!(train.assembly.misses(crossing.t, &crossing.state).iter().all(|miss| *miss < 1e-14));
        }
        assert_eq!(run.end, crossings[1].state);
        assert_abs_diff_eq!(run.record.t, crossings[1].t);
        assert_eq!(run.nodes.len(), 2);
        assert_eq!(run.record.steps, crossings[1].k + 1);
        assert!(run.record.failure.is_none() && !run.record.interrupted);
    }
}

/// All but the time.
fn bits(run: &harness::Assembled) -> String {
    let record = harness::Record { wall_seconds: 0.0, ..run.record.clone() };
    format!("{record:?} {:?}", run.end)
}

#[test]
fn a_saved_run_goes_on_as_if_it_had_not_stopped() {
    check_saved(14, 5);
}

#[test]
#[ignore = "slow"]
fn a_saved_run_goes_on_as_if_it_had_not_stopped_in_full() {
    check_saved(200, 64);
}

/// In parts, and from the file of any of them, the numbers are the same to the last bit.
fn check_saved(count: u64, every: u64) {
    let (train, schedule) = (train(), steps(count));
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    for name in ["dla", "dla4"] {
        let method = Method::named(name, None).unwrap();
        let whole = run_assembly(&train.assembly, &method, &schedule, &start, 10, &mut ());
        let identity = Checkpoint::of([("method", name.to_owned())]);
        let mut files = Vec::new();
        let mut save = |made: &Checkpoint| files.push(made.to_text());
        let mut saving = Saving { identity: &identity, from: None, every: Some(every), save: &mut save };
        let run = |saving: &mut Saving<'_>| {
            run_assembly_saved(&train.assembly, &method, &schedule, (&start, AssemblyNodes::Kept(10)), saving, &mut ())
        };
        let parts = run(&mut saving).unwrap();
        assert_eq!(bits(&parts), bits(&whole));
        assert_eq!(files.len() as u64, count.div_ceil(every));
        for file in &files {
            let read = Checkpoint::from_text(file).unwrap();
            let mut saving = Saving { identity: &identity, from: Some(&read), every: None, save: &mut |_| {} };
            assert_eq!(bits(&run(&mut saving).unwrap()), bits(&whole));
        }
        // A positive control: another run does not take it.
        let other = Checkpoint::of([("method", "another".to_owned())]);
        let read = Checkpoint::from_text(&files[0]).unwrap();
        let mut saving = Saving { identity: &other, from: Some(&read), every: None, save: &mut |_| {} };
        assert!(matches!(run(&mut saving), Err(CheckpointError::Other { .. })));
    }
}

#[test]
fn a_step_for_a_tolerance() {
    check_recommended(0.4, 1e-5);
}

#[test]
#[ignore = "slow"]
fn a_step_for_a_tolerance_in_full() {
    check_recommended(4.0, 1e-4);
}

/// The recommended step meets its tolerance against a run of high order, and one of a quarter of the steps does not.
fn check_recommended(duration: f64, tolerance: f64) {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    let last = |state: &AssemblyState| [state.unwrapped(9), state.unwrapped(10), state.unwrapped(11)];
    let dla = Method::named("dla", None).unwrap();
    let found = recommend_assembly(&train.assembly, &dla, &start, duration, tolerance, last).unwrap();
    let end = |method: &Method, steps: u64| {
        let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
        last(&assembly_end(&train.assembly, method, &schedule, &start, &mut ()).unwrap().unwrap())
    };
    let exact = end(&Method::named("dla8", None).unwrap(), (duration / 0.02).round() as u64);
    let error = |steps: u64| {
        let pairs = end(&dla, steps).into_iter().zip(exact);
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    };
    println!("{found:?}, {:e}", error(found.steps));
    assert!(error(found.steps) < tolerance && error(found.steps / 4) > tolerance);
    let refused =
        recommend_assembly(&train.assembly, &Method::named("rk4", None).unwrap(), &start, duration, tolerance, last);
    assert!(matches!(refused, Err(RecommendError::Fails { .. })));
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

/// Driven in parts; on a way of some metres its end is that of short steps.
fn in_parts(name: &str, long: &Schedule, right: &AssemblyState) -> (Method, harness::Assembled) {
    let (train, start) = turning();
    let method = Method::named(name, None).unwrap().with_substeps(Substeps::default());
    let run = run_assembly(&train.assembly, &method, long, &start, 1, &mut ());
    assert!(run.failure.is_none(), "{name}: {:?}", run.failure);
    let substeps = run.record.substeps.unwrap();
    assert!(substeps.divided > 0 && run.record.steps == long.steps, "{name}: {substeps:?}");
    assert!(run.record.constraint_max < 1e-13 && run.record.leaf_max.unwrap() < 1e-13, "{name}: {:?}", run.record);
    for i in 0..right.len() {
        assert_abs_diff_eq!(run.end.unwrapped(i), right.unwrapped(i), epsilon = 3e-2);
    }
    assert!(run.record.energy.max_error < 1e-2 * run.record.energy.initial, "{name}: {:?}", run.record.energy);
    (method, run)
}

fn short_steps(step: f64, steps: u64) -> AssemblyState {
    let (train, start) = turning();
    let plain = Method::named("dla4", None).unwrap();
    let schedule = Schedule { t0: 0.0, step, steps };
    assembly_end(&train.assembly, &plain, &schedule, &start, &mut ()).unwrap().unwrap()
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
    assert!(run_assembly(&train.assembly, &plain, &seconds(6), &start, 1, &mut ()).failure.is_some());
    let few = plain.with_substeps(Substeps::new(1, 10));
    let run = run_assembly(&train.assembly, &few, &seconds(6), &start, 1, &mut ());
    assert!(run.failure.is_some() && run.record.substeps.unwrap().undivided.is_some(), "{:?}", run.record);
    assert_eq!(run.record.energy.work.abs().to_bits(), 0);
}

/// Also from a checkpoint and up to an event.
#[test]
#[ignore = "slow"]
fn long_steps_of_trains_are_made_in_parts_at_length() {
    let ((train, start), long) = (turning(), seconds(6));
    let right = short_steps(0.005, 1200);
    for name in ["dla", "dla4"] {
        let (method, run) = in_parts(name, &long, &right);
        let mut files = Vec::new();
        let mut save = |made: &Checkpoint| files.push(made.clone());
        let identity = Checkpoint::default();
        let mut saving = Saving { identity: &identity, from: None, every: Some(2), save: &mut save };
        let kept = || (&start, AssemblyNodes::Kept(1));
        let whole = run_assembly_saved(&train.assembly, &method, &long, kept(), &mut saving, &mut ()).unwrap();
        assert_eq!(bits(&whole), bits(&run), "{name}");
        for file in &files {
            let mut saving = Saving { identity: &identity, from: Some(file), every: None, save: &mut |_| () };
            let again = run_assembly_saved(&train.assembly, &method, &long, kept(), &mut saving, &mut ());
            assert_eq!(bits(&again.unwrap()), bits(&run), "{name}");
        }

        let events = [AssemblyEvent::new("x", true, |_, state| state.q(0) - 1.0)];
        let (ended, crossings, _) =
            run_assembly_watched(&train.assembly, &method, &long, kept(), (&events, 4), &mut ());
        assert_eq!((crossings.len(), ended.record.t), (1, crossings[0].t), "{name}");
        assert_abs_diff_eq!(ended.end.q(0), 1.0, epsilon = 1e-9);
    }
}
