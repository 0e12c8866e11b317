//! There and back: self-adjoint methods on any row, and time reversal where the row has it.

use crate::case::Case;
use crate::rows::table;
use crate::tools::{method, refuses, symmetric};
use dla::Schedule;
use harness::{METHODS, Method};

const STEP: f64 = 0.05;
const STEPS: u64 = 60;

/// How far from the start a run there, and back with negative steps, ends.
fn returns(case: &dyn Case, method: &Method) -> f64 {
    let forward = Schedule { t0: 0.0, step: STEP, steps: STEPS };
    let backward = Schedule { t0: forward.time(STEPS), step: -STEP, steps: STEPS };
    let there = case.run(method, &case.start(), &forward, &mut |_| {}).unwrap();
    assert!(there.distance(&case.start()) > 0.1, "{} does not move", case.name());
    case.run(method, &there, &backward, &mut |_| {}).unwrap().distance(&case.start())
}

/// The same with the velocity reversed at the far end and at the near one.
fn reverses(case: &dyn Case, method: &Method) -> f64 {
    let schedule = Schedule { t0: 0.0, step: STEP, steps: STEPS };
    let there = case.run(method, &case.start(), &schedule, &mut |_| {}).unwrap();
    let back = case.run(method, &there.reversed(), &schedule, &mut |_| {}).unwrap();
    back.reversed().distance(&case.start())
}

#[test]
fn symmetric_methods_return() {
    let one_sided = Method::named("dla-alpha", Some(0.25)).unwrap();
    for case in table() {
        let (facts, case) = (case.facts(), case.as_ref());
        let mut largest = (0.0, "");
        for info in METHODS.iter().filter(|info| symmetric(info) && refuses(info, facts).is_none()) {
            let mut error = returns(case, &method(info.name));
            if facts.reversible {
                error = error.max(reverses(case, &method(info.name)));
            }
            // Some roundings a step, which in three seconds none of the motions makes a thousand times larger.
            assert!(error <= 1e-12, "{}, {} returns within {error:e}", case.name(), info.name);
            if error > largest.0 {
                largest = (error, info.name);
            }
        }
        // The controls are not their own adjoints.
        let (rk4, alpha) = (returns(case, &method("rk4")), returns(case, &one_sided));
        println!("{:<32} {largest:?}; rk4 {rk4:.1e}, alpha = 1/4 {alpha:.1e}", case.name());
        // The motion of the disk is a mere integral in time, and of such the rule of Runge and Kutta is symmetric.
        assert!(rk4 > 1e-10 || case.name() == "vertical rolling disk", "{}: rk4 returns within {rk4:e}", case.name());
        let alike = if facts.one_rule { alpha <= 1e-12 } else { alpha > 1e-4 };
        assert!(alike, "{}: alpha = 1/4 returns within {alpha:e}", case.name());
    }
}

/// A Lagrangian that is not even in the velocities is not reversed with them, and no more are its self-adjoint methods.
#[test]
fn what_is_not_reversible_does_not_reverse() {
    for case in table().iter().filter(|case| case.facts().momentum_is_not_mass_times_velocity) {
        let error = reverses(case.as_ref(), &method("dla"));
        println!("{:<32} dla reversed: {error:.1e}", case.name());
        assert!(error > 1e-6, "{}: {error:e}", case.name());
    }
}

/// The rule with `alpha` and the one with `1 - alpha` undo each other.
#[test]
fn the_alpha_rule_and_its_adjoint() {
    let [rule, adjoint] = [0.2, 0.8].map(|alpha| Method::named("dla-alpha", Some(alpha)).unwrap());
    for case in table() {
        let forward = Schedule { t0: 0.0, step: STEP, steps: STEPS };
        let backward = Schedule { t0: forward.time(STEPS), step: -STEP, steps: STEPS };
        let there = case.run(&rule, &case.start(), &forward, &mut |_| {}).unwrap();
        let back = case.run(&adjoint, &there, &backward, &mut |_| {}).unwrap();
        let error = back.distance(&case.start());
        assert!(error <= 1e-12, "{}: {error:e}", case.name());
    }
}
