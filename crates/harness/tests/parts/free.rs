//! The free sleigh, in steps that nearly every method refuses, against the motion in closed form.

use crate::parts::{BAR, EACH, Run, by, by_each, request, sleigh};
use dla::{Subject, Substeps};
use harness::Method;
use sleigh::{Exact, SleighState};

/// The whole motion at its end; places relative to the way.
fn ends_right(label: &str, run: &Run, exact: &Exact, (step, steps): (f64, u64)) {
    let (end, right) = (run.end(), exact.at(step * steps as f64));
    let speed = (2.0 * exact.energy()).sqrt();
    let way = speed * step * steps as f64;
    let near = |what: &str, found: f64, right: f64, size: f64| {
        assert!((found - right).abs() <= BAR * size, "{label}: {what} {found} {right}");
    };
    near("x", end.x, right.x, way);
    near("y", end.y, right.y, way);
    near("heading", end.heading, right.heading, 1.0);
    near("speed", end.speed, right.speed, speed);
    near("turn rate", end.turn_rate, right.turn_rate, speed);
}

#[test]
fn long_steps() {
    turning(&["dla", "gauss8"], &[3.2], 4);
    against_the_line(&["dla"], &[2.2]);
}

#[test]
#[ignore = "slow"]
fn long_steps_in_full() {
    turning(EACH, &[0.6, 1.2, 2.4, 3.1, 3.2, 4.8, 100.0], 20);
    against_the_line(EACH, &[1.8, 2.0, 2.2, 20.0]);
}

/// Half a turn a step and more, up to a hundred radians.
fn turning(methods: &[&str], turn_rates: &[f64], steps: u64) {
    for &turn_rate in turn_rates {
        let start = SleighState { speed: 0.1, turn_rate, ..SleighState::default() };
        let exact = Exact::new(&sleigh(0.5), &start).unwrap();
        for name in methods {
            let run = by(name, &sleigh(0.5), &start, (1.0, steps));
            ends_right(&format!("{name}, h omega = {turn_rate}"), &run, &exact, (1.0, steps));
            // Only the first of them can be made whole by any method.
            assert!(turn_rate < 3.0 || run.substeps.divided > 0, "{name} {turn_rate}");
        }
    }
}

/// Steps against the line that repels, at and beyond where the equations have no solution.
fn against_the_line(methods: &[&str], growths: &[f64]) {
    for &growth in growths {
        let (start, step) = (SleighState { speed: -1.0, turn_rate: 1e-3, ..SleighState::default() }, growth / 0.4);
        let exact = Exact::new(&sleigh(0.5), &start).unwrap();
        for name in methods {
            let run = by(name, &sleigh(0.5), &start, (step, 20));
            ends_right(&format!("{name}, h c u = -{growth}"), &run, &exact, (step, 20));
            // Where the spin is not nothing beside the speed, it has its sign.
            let spins = run.seen(|state| state.turn_rate);
            assert!(spins.iter().all(|spin| *spin > -1e-12), "{name} {growth}: {spins:?}");
        }
    }
}

const AHEAD: SleighState = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: 1.0, turn_rate: 0.3 };

/// Steps of a quarter of an hour, and what there may be of them.
fn quarters_of_hours(runs: impl Iterator<Item = (&'static str, Run)>) {
    let exact = Exact::new(&sleigh(0.5), &AHEAD).unwrap();
    for (name, run) in runs {
        ends_right(&format!("{name}, h = 1e3 s"), &run, &exact, (1e3, 10));
        assert!(run.substeps.divided > 0 && run.substeps.parts < 4000, "{name}: {}", run.substeps.parts);
    }
}

#[test]
#[ignore = "slow"]
fn step_lengths_in_full() {
    quarters_of_hours(by_each(&sleigh(0.5), &AHEAD, (1e3, 10)));
}

/// Steps of a quarter of an hour and of thirty thousand years. The parts grow as the motion becomes straight, so that there are
/// hardly more of the one than of the other.
#[test]
fn step_lengths() {
    let (start, exact) = (AHEAD, Exact::new(&sleigh(0.5), &AHEAD).unwrap());
    quarters_of_hours([("dla", by("dla", &sleigh(0.5), &start, (1e3, 10)))].into_iter());
    let run = by("dla", &sleigh(0.5), &start, (1e12, 10));
    ends_right("dla, h = 1e12 s", &run, &exact, (1e12, 10));
    assert!(run.substeps.divided > 0 && run.substeps.parts < 1000, "{}", run.substeps.parts);
    // What would be taken for the motion: the mean spin is nothing, and no node says so but by its own.
    let (method, request) = (Method::named("dla", None).unwrap(), request(&start, (1e12, 10)));
    let whole = harness::Run::of(&Subject::from(&sleigh(0.5)), &method).timed(&request);
    assert!((whole.q[2] - exact.at(1e13).heading).abs() > 0.5);
}

/// A composition goes back within its step, against the line that then repels; no part of it may be longer than a few seconds,
/// however straight the motion has become. So it ends at the bound, which says what was tried, and changes nothing.
fn too_many_parts(most: u64) {
    let start = SleighState { speed: 1.0, turn_rate: 0.3, ..SleighState::default() };
    let method = Method::named("dla4", None).unwrap().with_substeps(Substeps::new(53, most));
    let record = harness::Run::of(&Subject::from(&sleigh(0.5)), &method).timed(&request(&start, (1e12, 1)));
    let (failure, why) = (record.failure.unwrap(), record.substeps.unwrap().undivided.unwrap());
    assert_eq!((why.tried, record.steps, failure.source), (most, 0, why.source));
    let made = most as f64;
    assert!(why.part < 10.0 && why.time > 0.1 * made && why.time < 100.0 * made, "{why}");
    assert!(why.to_string().contains(&format!("{most} parts of the step were tried")), "{why}");
}

test_systems::short_and_full! {
    what_needs_too_many_parts_says_so => too_many_parts(1000);
    what_needs_too_many_parts_says_so_in_full => too_many_parts(10_000);
}
