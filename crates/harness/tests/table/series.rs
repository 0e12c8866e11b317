//! Taylor series on motions that are known: corners, lengths that begin with zero, pulses, any scale of time, and as many nodes as one likes.

use crate::table::case::Point;
use crate::table::rows::named;
use crate::table::text::{end, system};
use approx::assert_abs_diff_eq;
use dla::{AnyState, Event, RunError, Schedule, StepError, Watch, make_steps};
use harness::Method;
use text::{Unit, Words};

fn taylor(tolerance: f64) -> Method {
    Method::named("taylor", None).unwrap().with_tolerance(tolerance).unwrap()
}

/// A particle of unit mass in the plane, under forces.
fn particle(forces: [&str; 2]) -> Words {
    let coordinates = ["x", "y"].map(|name| (name.to_owned(), Unit::other("m"))).to_vec();
    let forces = ["x", "y"].iter().zip(forces).map(|(name, force)| ((*name).to_owned(), force.to_owned())).collect();
    Words { coordinates, lagrangian: "(x'^2 + y'^2)/2".to_owned(), forces, ..Words::default() }
}

fn run(forces: [&str; 2], (q, v): ([f64; 2], [f64; 2]), (step, steps): (f64, u64)) -> Result<Point, RunError> {
    let start = Point { q: q.into(), v: v.into() };
    let system = system(&particle(forces), &start);
    end(&*system.mechanism(), &taylor(1e-15), &start, &Schedule { t0: 0.0, step, steps })
}

/// A force of constant size toward a line: parabolas, each ending at a corner.
#[test]
fn a_polynomial_ends_at_a_corner() {
    for (step, steps) in [(100.5, 1), (0.0625, 1608), (-100.5, 1)] {
        let back = |t: f64| t.signum();
        let found = run(["-sign(x)", "-2*sign(y)"], ([0.0, 0.0], [1.0, 2.0]), (step, steps));
        let Point { q, v } = found.unwrap();
        // The period is 4 in both coordinates, and `t = 100.5` half a second into one.
        let expected = [0.5 - 0.125, 2.0 * (0.5 - 0.125)].map(|x| back(step) * x);
        for (q, expected) in q.iter().zip(expected) {
            assert_abs_diff_eq!(*q, expected, epsilon = 1e-11);
        }
        assert_abs_diff_eq!(v[0], 0.5, epsilon = 1e-11);
    }
    // The larger and the smaller of two: with 1 for the larger force the same motion as with the absolute value.
    let [one, other] = ["-max(x, -x)*x", "-abs(x)*x"]
        .map(|force| run([force, "-min(y, 0)"], ([0.7, 0.2], [0.1, -0.3]), (10.0, 1)).unwrap());
    assert_abs_diff_eq!(one.q[0], other.q[0], epsilon = 1e-12);
}

/// Friction by a sign holds what has come to rest: no step is short enough, and that is said.
#[test]
fn friction_that_holds_is_told() {
    let error = run(["-0.3*sign(x')", "0"], ([0.0; 2], [1.0, 0.5]), (0.5, 10)).unwrap_err();
    assert!(matches!(error.source, StepError::JumpsAtRest { coordinate: 0 }), "{error}");
    // It stops at `t = 1/0.3`.
    assert!((3.0..=3.34).contains(&error.time), "{error}");
    // Until then it is a parabola.
    let Point { q, .. } = run(["-0.3*sign(x')", "0"], ([0.0; 2], [1.0, 0.5]), (1.0, 3)).unwrap();
    assert_abs_diff_eq!(q[0], 3.0 - 0.15 * 9.0, epsilon = 1e-13);
}

/// A drag with the square of the speed, from rest: `x' = tanh t`.
#[test]
fn a_length_may_begin_with_zero() {
    let drag = ["1 - x'*sqrt(x'^2 + y'^2)", "-y'*sqrt(x'^2 + y'^2)"];
    let Point { q, v } = run(drag, ([0.0; 2], [0.0; 2]), (2.0, 1)).unwrap();
    assert_abs_diff_eq!(q[0], 2.0_f64.cosh().ln(), epsilon = 1e-13);
    assert_abs_diff_eq!(v[0], 2.0_f64.tanh(), epsilon = 1e-13);
    assert_eq!((q[1], v[1]), (0.0, 0.0));
}

/// A pulse of which nothing tells before is seen where steps are not much longer than it; and a smooth turn-over at any step.
#[test]
fn what_time_brings_is_seen() {
    let change = |width: f64| width * std::f64::consts::PI.sqrt();
    for (force, width, step, steps) in
        [("exp(-((t - 5)/0.2)^2)", 0.2, 0.5, 20), ("exp(-((t - 5)/0.01)^2)", 0.01, 0.02, 500)]
    {
        let Point { v, .. } = run([force, "0"], ([0.0; 2], [0.0; 2]), (step, steps)).unwrap();
        assert_abs_diff_eq!(v[0], change(width), epsilon = 1e-11);
    }
    let Point { v, .. } = run(["(1 + tanh(20*(t - 3)))/2", "0"], ([0.0; 2], [0.0; 2]), (0.5, 20)).unwrap();
    assert_abs_diff_eq!(v[0], 7.0, epsilon = 1e-11);
}

/// Springs whose periods are 1e-15 s and 1e15 s, over the same number of turns: in powers of two the same bits.
#[test]
fn any_scale_of_time() {
    for exponent in [-50, 0, 50] {
        let rate = 2f64.powi(-exponent);
        let spring = format!("-{}*x", rate * rate);
        let Point { q, v } = run([&spring, "0"], ([1.0, 0.0], [0.0, 0.0]), (40.0 / rate, 1)).unwrap();
        assert_abs_diff_eq!(q[0], 40.0_f64.cos(), epsilon = 2e-14);
        // A tolerance has the units of the unknowns, so a velocity that is small beside 1 m/s is not held to its own size.
        if exponent <= 0 {
            assert_abs_diff_eq!(v[0] / rate, -40.0_f64.sin(), epsilon = 2e-14);
        }
    }
}

/// The steps of the run only say where the nodes are.
#[test]
fn nodes_cut_no_step() {
    let case = named("free sleigh");
    let exact = case.exact_from(&case.start(), case.duration()).unwrap();
    for tolerance in [1e-4, 1e-6, 1e-9, 1e-12, 1e-15] {
        let ends = [1, 7, 1000].map(|steps| case.end(&taylor(tolerance), steps).unwrap());
        for end in &ends {
            assert!(end.distance(&exact) < 30.0 * tolerance.max(1e-14), "{tolerance:e}: {:e}", end.distance(&exact));
            // But for the rounding of the velocity at a node.
            assert!(end.distance(&ends[0]) < 1e-13, "{tolerance:e}: {:e}", end.distance(&ends[0]));
        }
    }
}

/// Two hundred crossings within one step of the run: several in an own step, and pairs beside a tangent.
#[test]
fn crossings_are_found_on_the_polynomials() {
    let levels: Vec<f64> = (0..10).map(|k| if k == 9 { 1.0 - 1e-9 } else { 0.11 * f64::from(k) - 0.3 }).collect();
    let events: Vec<Event<'_>> =
        levels.iter().map(|level| Event::new("level", move |_, q: &[f64], _: &[f64]| q[0] - level)).collect();
    let start = Point { q: vec![0.0, 1.0], v: vec![1.0, 0.0] };
    let system = system(&particle(["-x", "0"]), &start);
    let (mechanism, method) = (system.mechanism(), taylor(1e-16));
    let mut watch = Watch::new(&method, &events, ());
    let (mut integrator, n) = (mechanism.integrator(&method), mechanism.size().n);
    let row = |x: &[f64]| (0..n).map(|i| x.get(i).copied().unwrap_or(0.0)).collect::<Vec<f64>>();
    let mut state = mechanism.state(&row(&start.q), &row(&start.v));
    // Ten turns, from where none of the levels is.
    let schedule = Schedule { t0: 0.0, step: 10.0 * std::f64::consts::TAU, steps: 1 };
    make_steps(&*mechanism, &mut *integrator, &schedule, 0..1, &mut state, &mut watch).unwrap();
    let mut expected: Vec<(f64, usize)> = Vec::new();
    for (event, level) in levels.iter().enumerate() {
        for turn in -1..=10 {
            let begin = f64::from(turn) * std::f64::consts::TAU;
            expected.extend([level.asin(), std::f64::consts::PI - level.asin()].map(|t| (begin + t, event)));
        }
    }
    expected.retain(|(t, _)| (0.0..schedule.step).contains(t));
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = watch.crossings();
    assert_eq!((found.len(), expected.len()), (200, 200));
    for (found, (t, event)) in found.iter().zip(&expected) {
        // The time of a tangent is known to the root of rounding over the slope: 4.5e-5 there.
        let slope = (1.0 - levels[*event] * levels[*event]).sqrt();
        assert_eq!(found.event, *event);
        assert_abs_diff_eq!(found.t, *t, epsilon = f64::max(1e-12, 2e-14 / slope));
    }
    // Of each pair beside a tangent it is told that there may be more.
    assert_eq!(watch.close().map(|close| (close.count, close.incomplete)), Some((10, 0)));
}

/// A run is continued to the bit from what the method remembers; and whatever a file says that it remembers, nothing panics.
#[test]
fn a_memory_continues_the_polynomial() {
    let start = Point { q: vec![0.3, -0.2], v: vec![1.0, 0.4] };
    let system = system(&particle(["-abs(x)*x - y", "-2*sign(y) + x"]), &start);
    let (mechanism, method) = (system.mechanism(), taylor(1e-12));
    let n = mechanism.size().n;
    let row = |x: &[f64]| (0..n).map(|i| x.get(i).copied().unwrap_or(0.0)).collect::<Vec<f64>>();
    let mut integrator = mechanism.integrator(&method);
    let mut state = mechanism.state(&row(&start.q), &row(&start.v));
    let step = 0.05;
    let mut resumed: Option<AnyState> = None;
    for k in 0..20 {
        let time = |k: i32| f64::from(k) * step;
        integrator.step(time(k), step, &mut state).unwrap();
        if let Some(resumed) = resumed {
            assert_eq!((resumed.q(), resumed.v()), (state.q(), state.v()), "step {k}");
        }
        let memory = integrator.memory();
        let next = |memory: &[f64]| {
            let (mut other, mut state) = (mechanism.integrator(&method), state.clone());
            other.recall(memory, &state);
            other.step(time(k + 1), step, &mut state).map(|_| state)
        };
        resumed = Some(next(&memory).unwrap());
        for at in 0..memory.len() {
            let _ = next(&memory[..at]);
            for wrong in [f64::NAN, f64::INFINITY] {
                let mut memory = memory.clone();
                memory[at] = wrong;
                let _ = next(&memory);
            }
        }
    }
}
