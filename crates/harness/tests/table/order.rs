//! The order of every method on every row.

use crate::table::case::{Case, Point, Rows};
use crate::table::rows::{kinds, rows, table};
use crate::table::tools::{Methods, all_methods, method, methods, refuses, slope, symmetric};
use harness::{METHODS, Method, MethodInfo};

/// How the order is looked for.
struct Look {
    /// Through how much time (s); all of the row's where none is said.
    duration: Option<f64>,
    /// By how many steps.
    steps: fn(f64, &MethodInfo) -> Vec<u64>,
    /// The number of last errors that count.
    last: usize,
    /// Steps a second of two references.
    fine: [f64; 2],
    /// How far the order may be from the nominal one.
    within: fn(&MethodInfo) -> f64,
}

/// Where the row is after a time: its closed form where it has one, else Gauss collocation of order 16 with short steps, so many a second.
fn reference(case: &dyn Case, duration: f64, fine: f64) -> Point {
    let by_steps = || case.end_after(duration, &method("gauss16"), (duration * fine) as u64).unwrap();
    case.exact_from(&case.start(), duration).unwrap_or_else(by_steps)
}

/// The rounding of a run of this row: what two runs of order 16 with different short steps differ by, at least some
/// roundings of the largest component.
fn rounding(case: &dyn Case, duration: f64, fine: f64, reference: &Point) -> f64 {
    let other = case.end_after(duration, &method("gauss16"), (duration * fine) as u64).unwrap();
    other.distance(reference).max(16.0 * f64::EPSILON * reference.size())
}

/// How many steps of its base a step of a method is.
fn parts(info: &MethodInfo) -> f64 {
    match info.name {
        "dla4" => 5.0,
        "dla6" => 9.0,
        "dla8" => 15.0,
        _ => 1.0,
    }
}

/// Steps and errors, from long steps to short ones, as far as rounding is a fiftieth of the error at most, each step adding
/// a tenth of one; those of the parts of a composition add like steps of a random walk. Steps that are too long for a method are left out.
fn ladder(case: &dyn Case, info: &MethodInfo, look: &Look, reference: &Point, rounding: f64) -> Vec<(f64, f64)> {
    let duration = look.duration.unwrap_or_else(|| case.duration());
    let mut ladder = Vec::new();
    for steps in (look.steps)(duration, info) {
        if let Ok(end) = case.end_after(duration, &method(info.name), steps) {
            let error = end.distance(reference);
            let plateau = rounding.max(0.1 * f64::EPSILON * reference.size() * parts(info).sqrt() * steps as f64);
            if error < 50.0 * plateau {
                break;
            }
            ladder.push((duration / steps as f64, error));
        }
    }
    ladder
}

/// For every method, on how many rows its order was seen, and on how many of those with forces and with explicit time.
fn orders(rows: &Rows, methods: &Methods, look: &Look) -> Vec<[u32; 3]> {
    let mut seen = vec![[0; 3]; methods.len()];
    for case in rows {
        let facts = case.facts();
        if facts.without_basis {
            continue;
        }
        let duration = look.duration.unwrap_or_else(|| case.duration());
        let reference = reference(case.as_ref(), duration, look.fine[0]);
        let rounding = rounding(case.as_ref(), duration, look.fine[1], &reference);
        for (info, seen) in methods.iter().zip(&mut seen) {
            // The error of an unsymmetric method has every power of the step, and one of order 8 is at its rounding before
            // the lowest is alone: its order shows on gentler motions only, as those above eight do.
            let not_for_it = info.kind.is_adaptive() || info.name == "gni" && facts.momentum_is_not_mass_times_velocity;
            if info.order > facts.highest_order || refuses(info, facts).is_some() || not_for_it {
                continue;
            }
            let ladder = ladder(case.as_ref(), info, look, &reference, rounding);
            let last = &ladder[ladder.len().saturating_sub(look.last)..];
            if last.len() < 3 {
                println!("{:<32} {:<14} too few errors above the rounding: {ladder:?}", case.name(), info.name);
                continue;
            }
            let order = slope(last);
            let (first, end) = (last[0].1, last[last.len() - 1].1);
            println!("{:<32} {:<14} order {order:.3}, errors {first:.0e} .. {end:.0e}", case.name(), info.name);
            let nominal = f64::from(method(info.name).info().order);
            let apart = (order - nominal).abs();
            assert!(apart <= (look.within)(info), "{}, {}: order {order}, {last:?}", case.name(), info.name);
            seen[0] += 1;
            seen[1] += u32::from(facts.forced);
            seen[2] += u32::from(facts.timed);
        }
    }
    seen
}

#[test]
fn every_method_has_its_order() {
    let look = Look {
        duration: Some(0.8),
        steps: |_, _| vec![4, 6, 8],
        last: 3,
        fine: [10.0, 7.0],
        // The next power of the step is the next but one where the method is symmetric.
        within: |info| if symmetric(info) { 0.1 } else { 0.4 },
    };
    let methods = methods(&["dla", "dla-trapezoid", "dla4", "lobatto3", "energy2", "rk4", "rk4-reduced"]);
    for (info, [rows, ..]) in methods.iter().zip(orders(&kinds(), &methods, &look)) {
        // The energy methods refuse what moves and constraints on positions.
        let expected = if info.name == "energy2" { 5 } else { 8 };
        assert_eq!(rows, expected, "{}", info.name);
    }
}

#[test]
fn a_high_order_with_long_steps() {
    let look = Look {
        duration: None,
        steps: |_, _| vec![5, 6, 8, 11, 16],
        last: 3,
        fine: [6.0, 5.0],
        // The powers above the eighth are some hundredths of it at such steps.
        within: |_| 0.2,
    };
    let rows = rows(&["free sleigh", "sleigh in the egg-crate", "sleigh with friction", "moving everything"]);
    assert_eq!(orders(&rows, &methods(&["gauss8"]), &look), [[4, 2, 1]]);
}

/// More and more steps.
fn ever_more(duration: f64, info: &MethodInfo) -> Vec<u64> {
    let ratio = if info.order <= 4 { 1.6 } else { 1.25 };
    let mut steps = Vec::new();
    let mut pairs = duration;
    while pairs < 400.0 {
        // The error of the counter-example alternates: even numbers of steps only.
        steps.push(if info.name == "gni" { 2 * pairs.round() as u64 } else { (2.0 * pairs).round() as u64 });
        pairs *= ratio;
    }
    steps
}

#[test]
#[ignore = "slow"]
fn every_method_has_its_order_at_length() {
    let look = Look { duration: None, steps: ever_more, last: 4, fine: [100.0, 71.0], within: |_| 0.1 };
    for (info, [rows, forced, timed]) in METHODS.iter().zip(orders(&table(), &all_methods(), &look)) {
        let few = info.order > 8 || info.kind.is_adaptive();
        let energy = info.name.starts_with("energy");
        assert!(few || (rows >= 5 && forced >= 1 && (timed >= 1 || energy)), "{}: {rows} rows", info.name);
    }
}

/// With one node away from the middle the rule loses an order, unless the row does not depend on the place of the node.
fn one_sided(rows: &Rows, duration: Option<f64>, fine: f64, steps: u64) {
    let rule = Method::named("dla-alpha", Some(0.25)).unwrap();
    for case in rows.iter().filter(|case| !case.facts().without_basis) {
        let duration = duration.unwrap_or_else(|| case.duration());
        let reference = reference(case.as_ref(), duration, fine);
        let errors = [steps, 2 * steps].map(|n| case.end_after(duration, &rule, n).unwrap().distance(&reference));
        let order = (errors[0] / errors[1]).log2();
        println!("{:<32} alpha = 1/4: order {order:.3}", case.name());
        let expected = if case.facts().one_rule { 2.0 } else { 1.0 };
        assert!((order - expected).abs() <= 0.1, "{}: order {order}, {errors:?}", case.name());
    }
}

test_systems::short_and_full! {
    a_one_sided_rule_is_of_order_one => one_sided(&kinds(), Some(1.0), 10.0, 50);
    a_one_sided_rule_is_of_order_one_in_full => one_sided(&table(), None, 100.0, 1600);
}
