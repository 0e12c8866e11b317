//! The momenta of horizontal symmetries.

use crate::case::Case;
use crate::rows::{named, table};
use crate::tools::{method, symmetric};
use dla::Schedule;
use harness::{METHODS, MethodInfo};

/// The largest change of an invariant over a thousand steps, relative to its size or to one.
fn change(case: &dyn Case, name: &str, invariant: &str) -> f64 {
    let value = |point: &crate::case::Point| {
        let all = case.invariants(point);
        all.iter().find(|(name, _)| *name == invariant).map(|(_, value)| *value).unwrap()
    };
    let first = value(&case.start());
    let mut largest = 0.0f64;
    let schedule = Schedule { t0: 0.0, step: 0.03, steps: 1000 };
    case.run(&method(name), &case.start(), &schedule, &mut |node| {
        let change = (value(&node.point()) - first).abs() / first.abs().max(1.0);
        largest = if change.is_nan() { f64::INFINITY } else { largest.max(change) };
    })
    .unwrap();
    largest
}

/// The energy-preserving methods average force and bracket apart from each other: the steering of the snakeboard, whose
/// rows of the bracket change with it, is kept to their order only.
fn promised(info: &MethodInfo, row: &str) -> bool {
    info.keeps.contains("constraint") && !(info.keeps.contains("energy") && row == "snakeboard")
}

/// With every method that is a map on the constraint, the baselines apart.
#[test]
fn horizontal_symmetries_keep_their_momenta() {
    let mut rows = 0;
    for case in table().iter().filter(|case| !case.facts().momenta.is_empty()) {
        rows += 1;
        for momentum in case.facts().momenta {
            for info in METHODS.iter().filter(|info| symmetric(info) && promised(info, case.name())) {
                let change = change(case.as_ref(), info.name, momentum);
                println!("{:<26} {:<14} {momentum}: {change:.1e}", case.name(), info.name);
                // The spins of the disk are constant; elsewhere at worst a rounding a step, all in the same direction.
                let bound = if case.name() == "vertical rolling disk" { 1e-14 } else { 1000.0 * f64::EPSILON };
                assert!(change <= bound, "{}, {}, {momentum}: {change:e}", case.name(), info.name);
            }
        }
    }
    assert!(rows >= 3);
}

/// The controls: the turn of a sleigh with an offset is no horizontal symmetry, nor is any behind these integrals.
#[test]
fn other_integrals_are_not_kept() {
    for (row, invariant, least) in [
        ("free sleigh", "turn momentum", 0.1),
        ("knife edge on an incline", "hodograph", 1e-6),
        ("nonholonomic particle in a well", "energy along x and z", 1e-6),
    ] {
        let change = change(named(row).as_ref(), "dla", invariant);
        println!("{row}, {invariant}: {change:.1e}");
        assert!(change > least, "{row}, {invariant}: {change:e}");
    }
    let averaged = change(named("snakeboard").as_ref(), "energy2", "steering momentum");
    assert!(averaged > 1e-10, "a method that does not promise it there: {averaged:e}");
    let projected = change(named("vertical rolling disk").as_ref(), "rk4-projected", "spin momentum");
    assert!(projected > 1e-10, "a method that does not promise it: {projected:e}");
}
