//! There and back: self-adjoint methods on any row, and time reversal where the row has it.

use crate::table::case::{Case, Rows};
use crate::table::rows::{kinds, table};
use crate::table::tools::{Methods, all_methods, families, method, refuses, symmetric};
use dla::Schedule;
use harness::Method;

/// Three seconds.
const THERE: Schedule = Schedule { t0: 0.0, step: 0.05, steps: 60 };

/// How far from the start a run there, and back with negative steps, ends.
fn returns(case: &dyn Case, method: &Method, forward: &Schedule) -> f64 {
    let there = case.run(method, &case.start(), forward, &mut |_| {}).unwrap();
    assert!(there.distance(&case.start()) > 0.1, "{} does not move", case.name());
    case.run(method, &there, &backward(forward), &mut |_| {}).unwrap().distance(&case.start())
}

/// The way back.
fn backward(forward: &Schedule) -> Schedule {
    Schedule { t0: forward.time(forward.steps), step: -forward.step, steps: forward.steps }
}

/// The same with the velocity reversed at the far end and at the near one.
fn reverses(case: &dyn Case, method: &Method, schedule: &Schedule) -> f64 {
    let there = case.run(method, &case.start(), schedule, &mut |_| {}).unwrap();
    let back = case.run(method, &there.reversed(), schedule, &mut |_| {}).unwrap();
    back.reversed().distance(&case.start())
}

/// The symmetric ones among the methods return within the bound; other methods do not.
fn check(rows: &Rows, methods: &Methods, forward: &Schedule, bound: f64) {
    let one_sided = Method::named("dla-alpha", Some(0.25)).unwrap();
    for case in rows {
        let (facts, case) = (case.facts(), case.as_ref());
        let mut largest = (0.0, "");
        for info in methods.iter().filter(|info| symmetric(info) && refuses(info, facts).is_none()) {
            let mut error = returns(case, &method(info.name), forward);
            if facts.reversible {
                error = error.max(reverses(case, &method(info.name), forward));
            }
            assert!(error <= bound, "{}, {} returns within {error:e}", case.name(), info.name);
            if error > largest.0 {
                largest = (error, info.name);
            }
        }
        // The controls are not their own adjoints.
        let [rk4, alpha] = [method("rk4"), one_sided].map(|method| returns(case, &method, forward));
        println!("{:<32} {largest:?}; rk4 {rk4:.1e}, alpha = 1/4 {alpha:.1e}", case.name());
        // The motion of the disk is a mere integral in time, and of such the rule of Runge and Kutta is symmetric.
        assert!(rk4 > 1e-10 || case.name() == "vertical rolling disk", "{}: rk4 returns within {rk4:e}", case.name());
        let alike = if facts.one_rule { alpha <= bound } else { alpha > 1e-4 };
        assert!(alike, "{}: alpha = 1/4 returns within {alpha:e}", case.name());
    }
}

#[test]
fn symmetric_methods_return() {
    // Some roundings a step.
    check(&kinds(), &families(), &Schedule { t0: 0.0, step: 0.1, steps: 6 }, 1e-13);
}

#[test]
#[ignore = "slow"]
fn symmetric_methods_return_at_length() {
    // Some roundings a step, which in three seconds none of the motions makes a thousand times larger.
    check(&table(), &all_methods(), &THERE, 1e-12);
}

/// A Lagrangian that is not even in the velocities is not reversed with them, and no more are its self-adjoint methods.
#[test]
fn what_is_not_reversible_does_not_reverse() {
    for case in table().iter().filter(|case| case.facts().momentum_is_not_mass_times_velocity) {
        let error = reverses(case.as_ref(), &method("dla"), &THERE);
        println!("{:<32} dla reversed: {error:.1e}", case.name());
        assert!(error > 1e-6, "{}: {error:e}", case.name());
    }
}

/// The rule with `alpha` and the one with `1 - alpha` undo each other.
#[test]
fn the_alpha_rule_and_its_adjoint() {
    let [rule, adjoint] = [0.2, 0.8].map(|alpha| Method::named("dla-alpha", Some(alpha)).unwrap());
    for case in table() {
        let there = case.run(&rule, &case.start(), &THERE, &mut |_| {}).unwrap();
        let back = case.run(&adjoint, &there, &backward(&THERE), &mut |_| {}).unwrap();
        let error = back.distance(&case.start());
        assert!(error <= 1e-12, "{}: {error:e}", case.name());
    }
}
