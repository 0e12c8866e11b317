//! The constraint at the nodes.

use crate::table::case::{Case, Point, Rows};
use crate::table::rows::{kinds, named, table};
use crate::table::tools::{Methods, all_methods, families, method, refuses};
use dla::Schedule;

/// The largest residual in each tenth of a run.
fn slip(case: &dyn Case, name: &str, start: &Point, step: f64, steps: u64) -> [f64; 10] {
    let mut tenths = [0.0f64; 10];
    let schedule = Schedule { t0: 0.0, step, steps };
    case.run(&method(name), start, &schedule, &mut |node| {
        let tenth = ((node.t() / step).round() as u64).saturating_sub(1) * 10 / steps;
        let slip = node.slip();
        if slip.is_nan() || slip > tenths[tenth as usize] {
            tenths[tenth as usize] = slip;
        }
    })
    .unwrap();
    tenths
}

fn worst(tenths: &[f64; 10]) -> f64 {
    tenths.iter().fold(0.0, |m, x| if x.is_nan() { f64::INFINITY } else { f64::max(m, *x) })
}

/// On circles that come back again and again.
fn on_circles(methods: &Methods, steps: u64) {
    let case = named("balanced sleigh");
    for info in methods.iter().filter(|info| refuses(info, case.facts()).is_none()) {
        let tenths = slip(case.as_ref(), info.name, &case.start(), 0.05, steps);
        println!("{:<14} {steps} steps: slip {:.1e}", info.name, worst(&tenths));
        if info.keeps.contains("constraint") {
            assert!(worst(&tenths) <= 1e-13, "{} slips: {tenths:?}", info.name);
        } else {
            assert!(worst(&tenths) > 1e-9, "the control does not slip: {tenths:?}");
        }
    }
}

test_systems::short_and_full! {
    it_holds_for_long => on_circles(&families(), 150);
    it_holds_for_long_at_length => on_circles(&all_methods(), 100_000);
}

/// On every row; on how many of them the same measure sees the slip of `rk4`.
fn on_rows(rows: &Rows, methods: &Methods, step: f64, steps: impl Fn(&dyn Case) -> u64) -> u32 {
    let mut controls = 0;
    for case in rows {
        let (facts, start, steps) = (case.facts(), case.start(), steps(case.as_ref()));
        for info in methods.iter().filter(|info| info.keeps.contains("constraint") && refuses(info, facts).is_none()) {
            if info.name == "gni" && facts.momentum_is_not_mass_times_velocity {
                continue;
            }
            let worst = worst(&slip(case.as_ref(), info.name, &start, step, steps));
            // Some hundred roundings of velocities of order one.
            assert!(worst <= 1e-13, "{}, {}: {worst:e}", case.name(), info.name);
        }
        let control = worst(&slip(case.as_ref(), "rk4", &start, step, steps));
        println!("{:<32} rk4 slips by {control:.1e}", case.name());
        controls += u32::from(control > 1e-9);
    }
    controls
}

#[test]
fn it_holds_on_every_row() {
    let controls = on_rows(&kinds(), &families(), 0.1, |_| 12);
    assert!(controls >= 7, "the same measure sees the slip of rk4 on {controls} rows only");
}

/// Through the time of the row and once more, on those that come back a thousand steps.
#[test]
#[ignore = "slow"]
fn it_holds_on_every_row_at_length() {
    let steps = |case: &dyn Case| if case.facts().recurrent { 1000 } else { (2.0 * case.duration() / 0.05) as u64 };
    let controls = on_rows(&table(), &all_methods(), 0.05, steps);
    assert!(controls >= 15, "the same measure sees the slip of rk4 on {controls} rows only");
}

/// The blade far from the origin, and on circles for ever: no growth.
fn without_growth(methods: &[&str], steps: u64) {
    let turning = Point { q: vec![0.0; 3], v: vec![1.0, 0.0, 1.0] };
    for name in ["free sleigh", "balanced sleigh"] {
        let case = named(name);
        for method in methods {
            let tenths = slip(case.as_ref(), method, &turning, 0.05, steps);
            println!("{name}, {method:<14} {tenths:?}");
            // One rounding each of the direction, the velocity and the residual, of a speed of order one.
            assert!(worst(&tenths) <= 1e-14, "{name}, {method} slips: {tenths:?}");
            // No growth: the last tenth is not above what one rounding more or less can do to the first.
            assert!(tenths[9] <= 2.0 * tenths[0] + f64::EPSILON, "{name}, {method}: the slip grows, {tenths:?}");
        }
    }
    let slips = worst(&slip(named("free sleigh").as_ref(), "rk4", &turning, 0.05, steps));
    assert!(slips > 1e-9, "the control slips by {slips:e} only");
}

test_systems::short_and_full! {
    /// A tenth is half a turn.
    it_holds_for_a_million_steps => without_growth(&["dla", "rk4-reduced"], 630);
    it_holds_for_a_million_steps_at_length => without_growth(&["dla", "dla-trapezoid", "rk4-projected", "rk4-reduced"], 1_000_000);
}
