//! Constant thrust against the direction of travel: periodic motions whose spin runs through decades, with the integral
//! `K = m u^2/2 + J omega^2/2 + (F/c) ln |omega|`, `c = m a/J`.

use crate::table::case::{Case, Facts, Row};
use crate::table::shapes::Three;
use crate::table::systems::Thrust;
use crate::table::tools::method;
use dla::Schedule;
use lagrangian::With;
use sleigh::{Sleigh, SleighState};

const FORCE: f64 = -0.5;

/// The largest change of `K`, and its slope (J/s), in `steps` steps.
fn change(name: &str, steps: u64) -> (f64, f64) {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let start = SleighState { turn_rate: 0.1, ..SleighState::default() };
    let case: Row<Three, 3> = Row {
        name: "thrust",
        system: With { body: sleigh, effects: Thrust { force: FORCE, frequency: 0.0 } }.into(),
        start: start.to_coordinates(),
        duration: 0.0,
        facts: Facts::default(),
    };
    // The kinetic energy, for the thrust is a force.
    let integral = |energy: f64, omega: f64| energy + FORCE / sleigh.spin_gain() * omega.abs().ln();
    let first = integral(0.5 * sleigh.pivot_inertia() * 0.01, 0.1);
    let (mut k, mut largest, mut trend) = (0u64, 0.0f64, harness::Trend::default());
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    case.run(&method(name), &case.start(), &schedule, &mut |node| {
        if k.is_multiple_of(4) {
            let change = integral(node.energy(), node.point().v[2]) - first;
            largest = if change.is_nan() { f64::INFINITY } else { largest.max(change.abs()) };
            trend.add(node.t(), change);
        }
        k += 1;
    })
    .unwrap();
    let slope = trend.slope().unwrap();
    println!("{name}: K changes by {largest:.2e} at most, slope {slope:.2e}");
    (largest, slope)
}

/// The slope (J/s) of `dla`, of what comes and goes by `2.6e-3` in each period, is below a bound.
fn no_drift(steps: u64, least: f64) {
    let (largest, slope) = change("dla", steps);
    assert!(largest < 3e-3 && slope.abs() <= least, "dla: {largest:e}, slope {slope:e}");
    // The control: on the constraint and of a higher order, with smaller errors, but they add up.
    let (largest, slope) = change("rk4-reduced", steps);
    assert!(largest < 1e-3 && (slope / -5.6e-9 - 1.0).abs() < 0.1, "rk4-reduced: {largest:e}, slope {slope:e}");
}

test_systems::short_and_full! {
    the_integral_does_not_drift => no_drift(2_000, 1e-6);
    /// For `1e5 s`.
    the_integral_does_not_drift_at_length => no_drift(2_000_000, 1e-11);
}
