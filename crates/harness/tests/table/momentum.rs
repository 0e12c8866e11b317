//! The momenta of horizontal symmetries.

use crate::table::case::{Case, Point, Rows};
use crate::table::rows::{named, rows, table};
use crate::table::tools::{Methods, all_methods, families, method, symmetric};
use dla::Schedule;
use harness::MethodInfo;

/// The largest change of each invariant, relative to its size or to one.
fn changes(case: &dyn Case, name: &str, invariants: &[&str], steps: u64) -> Vec<f64> {
    let value = |point: &Point, invariant: &str| {
        let all = case.invariants(point);
        all.iter().find(|(name, _)| *name == invariant).map(|(_, value)| *value).unwrap()
    };
    let first: Vec<f64> = invariants.iter().map(|invariant| value(&case.start(), invariant)).collect();
    let mut largest = vec![0.0f64; invariants.len()];
    let schedule = Schedule { t0: 0.0, step: 0.03, steps };
    case.run(&method(name), &case.start(), &schedule, &mut |node| {
        let point = node.point();
        for ((invariant, first), largest) in invariants.iter().zip(&first).zip(&mut largest) {
            let change = (value(&point, invariant) - first).abs() / first.abs().max(1.0);
            *largest = if change.is_nan() { f64::INFINITY } else { largest.max(change) };
        }
    })
    .unwrap();
    largest
}

/// The energy-preserving methods average force and bracket apart from each other: the steering of the snakeboard, whose
/// rows of the bracket change with it, is kept to their order only.
fn promised(info: &MethodInfo, row: &str) -> bool {
    info.keeps.contains("constraint") && !(info.keeps.contains("energy") && row == "snakeboard")
}

/// With every method that is a map on the constraint, the baselines apart; on how many rows.
fn kept(rows: &Rows, methods: &Methods, steps: u64) -> u32 {
    let mut seen = 0;
    for case in rows.iter().filter(|case| !case.facts().momenta.is_empty()) {
        seen += 1;
        let momenta = case.facts().momenta;
        for info in methods.iter().filter(|info| symmetric(info) && promised(info, case.name())) {
            for (momentum, change) in momenta.iter().zip(changes(case.as_ref(), info.name, momenta, steps)) {
                println!("{:<26} {:<14} {momentum}: {change:.1e}", case.name(), info.name);
                // The spins of the disk are constant; elsewhere at worst a rounding a step, all in the same direction.
                let bound = if case.name() == "vertical rolling disk" { 1e-14 } else { steps as f64 * f64::EPSILON };
                assert!(change <= bound, "{}, {}, {momentum}: {change:e}", case.name(), info.name);
            }
        }
    }
    seen
}

#[test]
fn horizontal_symmetries_keep_their_momenta() {
    let rows = rows(&["balanced sleigh", "vertical rolling disk", "snakeboard"]);
    assert_eq!(kept(&rows, &families(), 30), 3);
}

#[test]
#[ignore = "slow"]
fn horizontal_symmetries_keep_their_momenta_in_full() {
    assert!(kept(&table(), &all_methods(), 1000) >= 3);
}

/// The controls: the turn of a sleigh with an offset is no horizontal symmetry, nor is any behind these integrals.
fn not_kept(steps: u64) {
    let change = |case: &str, name: &str, invariant: &str| changes(named(case).as_ref(), name, &[invariant], steps)[0];
    for (row, invariant, least) in [
        ("free sleigh", "turn momentum", 0.1),
        ("knife edge on an incline", "hodograph", 1e-6),
        ("nonholonomic particle in a well", "energy along x and z", 1e-6),
    ] {
        let change = change(row, "dla", invariant);
        println!("{row}, {invariant}: {change:.1e}");
        assert!(change > least, "{row}, {invariant}: {change:e}");
    }
    let averaged = change("snakeboard", "energy2", "steering momentum");
    assert!(averaged > 1e-10, "a method that does not promise it there: {averaged:e}");
    let projected = change("vertical rolling disk", "rk4-projected", "spin momentum");
    assert!(projected > 1e-10, "a method that does not promise it: {projected:e}");
}

test_systems::short_and_full! {
    other_integrals_are_not_kept => not_kept(100);
    other_integrals_are_not_kept_in_full => not_kept(1000);
}
