//! The order of every method on every row.

use crate::case::{Case, Point};
use crate::rows::table;
use crate::tools::{method, refuses, slope};
use harness::{METHODS, MethodInfo};

/// Where the row ends: its closed form where it has one, else Gauss collocation of order 16 with short steps.
fn reference(case: &dyn Case) -> Point {
    let fine = || case.end(&method("gauss16"), (case.duration() * 100.0) as u64).unwrap();
    case.exact_from(&case.start(), case.duration()).unwrap_or_else(fine)
}

/// The rounding of a run of this row: what two runs of order 16 with different short steps differ by, at least some
/// roundings of the largest component.
fn rounding(case: &dyn Case, reference: &Point) -> f64 {
    let other = case.end(&method("gauss16"), (case.duration() * 71.0) as u64).unwrap();
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
fn ladder(case: &dyn Case, info: &MethodInfo, reference: &Point, rounding: f64) -> Vec<(f64, f64)> {
    let ratio = if info.order <= 4 { 1.6 } else { 1.25 };
    let mut ladder = Vec::new();
    let mut pairs = case.duration();
    while pairs < 400.0 {
        // The error of the counter-example alternates: even numbers of steps only.
        let steps = if info.name == "gni" { 2 * pairs.round() as u64 } else { (2.0 * pairs).round() as u64 };
        if let Ok(end) = case.end(&method(info.name), steps) {
            let error = end.distance(reference);
            let plateau = rounding.max(0.1 * f64::EPSILON * reference.size() * parts(info).sqrt() * steps as f64);
            if error < 50.0 * plateau {
                break;
            }
            ladder.push((case.duration() / steps as f64, error));
        }
        pairs *= ratio;
    }
    ladder
}

#[test]
fn every_method_has_its_order() {
    // For every method, the rows on which its order was seen, and those among them with forces and with explicit time.
    let mut seen = vec![[0; 3]; METHODS.len()];
    for case in table() {
        let facts = case.facts();
        if facts.without_basis {
            continue;
        }
        let reference = reference(case.as_ref());
        let rounding = rounding(case.as_ref(), &reference);
        for (info, seen) in METHODS.iter().zip(&mut seen) {
            // The error of an unsymmetric method has every power of the step, and one of order 8 is at its rounding before
            // the lowest is alone: its order shows on gentler motions only, as those above eight do.
            let not_for_it = info.kind.is_adaptive() || info.name == "gni" && facts.momentum_is_not_mass_times_velocity;
            if info.order > facts.highest_order || refuses(info, facts).is_some() || not_for_it {
                continue;
            }
            let ladder = ladder(case.as_ref(), info, &reference, rounding);
            let last = &ladder[ladder.len().saturating_sub(4)..];
            if last.len() < 3 {
                println!("{:<32} {:<14} too few errors above the rounding: {ladder:?}", case.name(), info.name);
                continue;
            }
            let order = slope(last);
            let (first, end) = (last[0].1, last[last.len() - 1].1);
            println!("{:<32} {:<14} order {order:.3}, errors {first:.0e} .. {end:.0e}", case.name(), info.name);
            let nominal = f64::from(method(info.name).info().order);
            assert!((order - nominal).abs() <= 0.1, "{}, {}: order {order}, {last:?}", case.name(), info.name);
            seen[0] += 1;
            seen[1] += u32::from(facts.forced);
            seen[2] += u32::from(facts.timed);
        }
    }
    for (info, [rows, forced, timed]) in METHODS.iter().zip(seen) {
        let few = info.order > 8 || info.kind.is_adaptive();
        let energy = info.name.starts_with("energy");
        assert!(few || (rows >= 5 && forced >= 1 && (timed >= 1 || energy)), "{}: {rows} rows", info.name);
    }
}

/// With one node away from the middle the rule loses an order, unless the row does not tell where it is.
#[test]
fn a_one_sided_rule_is_of_order_one() {
    let one_sided = harness::Method::named("dla-alpha", Some(0.25)).unwrap();
    for case in table().iter().filter(|case| !case.facts().without_basis) {
        let reference = reference(case.as_ref());
        let errors = [800, 1600, 3200].map(|n| {
            let error = case.end(&one_sided, n).unwrap().distance(&reference);
            (case.duration() / n as f64, error)
        });
        let order = (errors[1].1 / errors[2].1).log2();
        println!("{:<32} alpha = 1/4: order {order:.3}", case.name());
        let expected = if case.facts().one_rule { 2.0 } else { 1.0 };
        assert!((order - expected).abs() <= 0.1, "{}: order {order}, {errors:?}", case.name());
    }
}
