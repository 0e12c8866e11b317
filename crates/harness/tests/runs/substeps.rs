//! Runs whose steps may be made in parts: measured, watched, saved, stopped, and those of trains.

use super::{Particle, families, general, request, run};
use crate::common::{bits, goes_on_to_the_same_bits, resumed, saved, watched};
use dla::{Event, Subject, Substeps};
use harness::{Method, MethodInfo, Progress, Record, Request};

fn in_parts(name: &str) -> Method {
    Method::named(name, Some(0.3)).unwrap().with_substeps(Substeps::default())
}

fn system() -> Particle {
    Particle { basis: true, ..Particle::of(100.0) }
}

test_systems::short_and_full! {
    steps_that_are_too_long_are_made_in_parts => check_long_steps(&["dla", "lobatto3", "energy4", "implicit-midpoint"], 2, 20);
    steps_that_are_too_long_are_made_in_parts_in_full => check_long_steps(&["dla", "dla4", "lobatto3", "energy4", "rk4-reduced", "implicit-midpoint"], 20, 200);
}

/// Steps of nearly a swing of the well, which these methods make in parts (`gauss8` does it in one); the energy is that of the motion, of which each step is made in
/// `fine` short ones.
fn check_long_steps(names: &[&str], steps: u64, fine: u64) {
    let short = request(steps * fine, 0.5 / fine as f64);
    let right = run(&Subject::from(&system()), &Method::named("gauss8", None).unwrap(), &short);
    for name in names {
        let record = run(&Subject::from(&system()), &in_parts(name), &request(steps, 0.5));
        assert!(record.failure.is_none(), "{name}: {:?}", record.failure);
        let substeps = record.substeps.unwrap();
        assert_eq!((record.steps, substeps.divided, substeps.undivided), (steps, steps, None), "{name}");
        assert!(substeps.parts >= 2 * steps && (2..=substeps.parts).contains(&substeps.most), "{name}: {substeps:?}");
        // Each part is wrong by a ten-thousandth of the velocity at most.
        let bar = 1e-4 * substeps.parts as f64;
        assert!((record.q[1] - right.q[1]).abs() < bar && (record.q[0] - right.q[0]).abs() < 10.0 * bar, "{name}");
        assert!(record.energy.max_error < 0.05 * right.energy.initial, "{name}: {:e}", record.energy.max_error);
        let held = *name != "implicit-midpoint";
        assert!(record.constraint_max < if held { 1e-14 } else { 1e-2 }, "{name}: {:e}", record.constraint_max);
    }
}

test_systems::short_and_full! {
    where_nothing_is_divided_no_bit_is_changed => check_undivided(families(), 10);
    where_nothing_is_divided_no_bit_is_changed_at_length => check_undivided(general(), 200);
}

/// Steps that resolve the motion are never divided: the run is the same to the last bit if it may divide none.
fn check_undivided(methods: impl Iterator<Item = &'static MethodInfo>, steps: u64) {
    let (system, request) = (Particle { basis: true, ..Particle::of(1.0) }, request(steps, 0.01));
    let system = Subject::from(&system);
    for info in methods {
        let plain = run(&system, &Method::named(info.name, Some(0.3)).unwrap(), &request);
        let record = run(&system, &in_parts(info.name), &request);
        if record.substeps.unwrap().divided == 0 {
            assert_eq!(bits(&Record { substeps: None, ..record }), bits(&plain), "{}", info.name);
        } else {
            // Of order one, and that which carries a mode along.
            assert!(["dla-alpha", "gni"].contains(&info.name), "{}: {:?}", info.name, record.substeps);
        }
        assert!(plain.substeps.is_none());
    }
}

/// The steps of a run, and after how many a checkpoint is made.
type Length = (u64, u64);
const SHORT: Length = (6, 4);
const LONG: Length = (40, 7);

test_systems::short_and_full! {
    every_checkpoint_leads_to_the_same_bits => check_checkpoints(&["dla", "gauss8"], SHORT);
    every_checkpoint_leads_to_the_same_bits_at_length => check_checkpoints(&["dla", "dla-trapezoid", "dla4", "lobatto3", "gauss8", "energy4", "dop853"], LONG);
}

fn check_checkpoints(names: &[&str], length: Length) {
    for &name in names {
        let method = in_parts(name);
        // Some of whose steps are divided: those of order 8 may be longer.
        let step = if name == "gauss8" { 0.6 } else { 0.15 };
        let whole = goes_on_to_the_same_bits(&Subject::from(&system()), &method, &request(length.0, step), length.1);
        assert!(name == "dop853" || whole.substeps.unwrap().divided > 0, "{name}");
    }
}

/// Somebody who stops a run within a divided step: it is asked after every part.
struct StopsAfter(std::cell::Cell<u32>);

impl Progress for StopsAfter {
    fn advance(&mut self, _steps: u64) {}
    fn stops(&self) -> bool {
        self.0.set(self.0.get().saturating_sub(1));
        self.0.get() == 0
    }
}

#[test]
fn a_run_that_is_stopped_within_a_step_goes_on_from_the_node_before() {
    let (method, request, (steps, every)) = (in_parts("dla"), request(LONG.0, 0.15), LONG);
    let system = system();
    let system = Subject::from(&system);
    let whole = run(&system, &method, &request);
    for asked in [1, 50, 333] {
        let mut stops = StopsAfter(std::cell::Cell::new(asked));
        let (part, checkpoints) = saved(&system, &method, &request, every, &mut stops);
        assert!(part.interrupted && part.steps < steps && part.failure.is_none(), "{asked}: {}", part.steps);
        let rest = resumed(&system, &method, &request, checkpoints.last().unwrap(), "a").unwrap();
        assert_eq!(bits(&rest), bits(&whole), "{asked}");
    }
}

test_systems::short_and_full! {
    events_are_looked_for_in_every_part => check_events((2, 0.8), 40, 0.5);
    events_are_looked_for_in_every_part_in_full => check_events((4, 2.5), 500, 2.0);
}

/// A step in which the well is crossed many times: every crossing is found, as in short steps, `fine` for each; and where the first ends the
/// run, at `end`, it ends there.
fn check_events((steps, step): (u64, f64), fine: u64, end: f64) {
    let crossing = [Event::new("y", |_, q, _| q[1])];
    let watched = |method: &Method, request: &Request, events: &[Event<'_>]| {
        watched(&Subject::from(&system()), method, request, events, 1)
    };
    let right = watched(&Method::named("gauss8", None).unwrap(), &request(steps * fine, step / fine as f64), &crossing);
    // A crossing takes less than half a second.
    assert!(right.crossings.len() as f64 > 2.0 * steps as f64 * step, "{}", right.crossings.len());
    let found = watched(&in_parts("gauss8"), &request(steps, step), &crossing);
    assert_eq!((found.crossings.len(), found.record.substeps.unwrap().divided), (right.crossings.len(), steps));
    for (one, other) in found.crossings.iter().zip(&right.crossings) {
        assert!((one.t - other.t).abs() < 1e-2 && one.rising == other.rising, "{} {}", one.t, other.t);
        // The crossing has the number of the step that it is in.
        assert_eq!(one.k, (one.t / step).floor() as u64);
    }

    let last = [Event::new("x", |_, q, _| q[0] - end).terminal()];
    let ended = watched(&in_parts("dla4"), &request(steps, step), &last);
    assert!(ended.record.failure.is_none() && (ended.record.q[0] - end).abs() < 1e-12, "{:?}", ended.record);
    assert_eq!(ended.record.t.to_bits(), ended.crossings[0].t.to_bits());
    assert_eq!(ended.nodes.last().unwrap().t.to_bits(), ended.record.t.to_bits());
}

/// The bound is told with what was tried, and all is as before the step.
#[test]
fn a_step_that_cannot_be_divided_so_far_is_a_failure() {
    let few = Method::named("dla", None).unwrap().with_substeps(Substeps::new(1, 10));
    let record = run(&Subject::from(&system()), &few, &request(20, 0.5));
    let (failure, why) = (record.failure.unwrap(), record.substeps.unwrap().undivided.unwrap());
    assert_eq!((failure.step, failure.time, record.steps, failure.source), (1, 0.0, 0, why.source));
    assert_eq!((why.tried, why.time, why.part), (1, 0.0, 0.25));
    assert_eq!((record.q, record.energy.work), (request(20, 0.5).q, 0.0));
    // What no shorter step mends is not tried.
    let refused = run(&Subject::from(&Particle::of(1.0)), &in_parts("rk4-reduced"), &request(20, 0.5));
    assert!(refused.refusal().is_some() || refused.failure.is_some());
    assert_eq!(refused.substeps.unwrap().undivided, None);
}
