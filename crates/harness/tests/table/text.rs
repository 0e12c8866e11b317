//! A row written as text moves as the row in Rust, by every method.

use crate::table::case::{self, Point, Rows};
use crate::table::rows::{kinds, rows, table};
use crate::table::texts;
use crate::table::tools::{Methods, all_methods, method, methods, refuses};
use dla::{Mechanism, RunError, Schedule};
use harness::{METHODS, Method};
use std::sync::Arc;
use text::{TextMechanics, TextModel, TextStart, Words};

/// The system of a text, from this start.
pub fn system(words: &Words, start: &Point) -> TextMechanics {
    let start = TextStart { q: start.q.clone(), v: start.v.clone(), ..TextStart::default() };
    TextMechanics::new(&Arc::new(TextModel::new(words).unwrap()), &start).unwrap()
}

/// A point with the coordinates that fill up a shape, at rest at zero.
fn filled(system: &dyn Mechanism, point: &Point) -> Point {
    let Point { mut q, mut v } = point.clone();
    [&mut q, &mut v].into_iter().for_each(|x| x.resize(system.size().n, 0.0));
    Point { q, v }
}

/// Where a run of the text ends.
pub fn end(system: &dyn Mechanism, method: &Method, start: &Point, schedule: &Schedule) -> Result<Point, RunError> {
    let Point { mut q, mut v } = case::end(system, method, &filled(system, start), schedule, &mut |_| {})?;
    [&mut q, &mut v].into_iter().for_each(|x| x.truncate(start.q.len()));
    Ok(Point { q, v })
}

/// The text and the row, by every one of the methods that takes the row, through so many steps, of which `whole` make the row's time; how
/// many pairs there are, and how many agree to 1e-13.
///
/// Both round what they compute, and a motion lets two roundings grow apart. How far is seen from a run that starts a rounding away.
fn same(rows: &Rows, methods: &Methods, whole: u64, steps: u64) -> [u32; 2] {
    let (mut pairs, mut close) = (0, 0);
    for case in rows {
        let Some(words) = texts::of(case.name()) else { continue };
        let (start, facts) = (case.start(), case.facts());
        let text = system(&words, &start);
        let schedule = Schedule { t0: 0.0, step: case.duration() / whole as f64, steps };
        for info in methods.iter().filter(|info| refuses(info, facts).is_none()) {
            let method = method(info.name);
            let Ok(rust) = case.run(&method, &start, &schedule, &mut |_| {}) else { continue };
            let away = Point { q: start.q.iter().map(|x| x * (1.0 + f64::EPSILON)).collect(), v: start.v.clone() };
            let near = case.run(&method, &away, &schedule, &mut |_| {}).unwrap();
            let there = end(&*text.mechanism(), &method, &start, &schedule).unwrap();
            let (apart, size) = (rust.distance(&there), rust.size());
            // As many roundings as there are steps add up as their square root does, each grown at most as the one at the start.
            let grown = rust.distance(&near).max(f64::EPSILON * size);
            let bound = (10.0 * (steps as f64).sqrt() * grown).max(1e-13 * size);
            assert!(apart <= bound, "{}, {}: {apart:.1e}, expected {bound:.1e}", case.name(), info.name);
            pairs += 1;
            close += u32::from(apart <= 1e-13 * size);
        }
    }
    [pairs, close]
}

#[test]
fn it_moves_as_the_row_does() {
    let methods = methods(&["dla", "lobatto3", "gauss8", "energy2", "rk4-reduced"]);
    let [pairs, close] = same(&kinds(), &methods, 200, 3);
    // Three rows refuse the energy.
    assert_eq!(pairs, 8 * 5 - 3);
    assert!(20 * close > 19 * pairs, "{close} of {pairs} pairs within 1e-13");
}

#[test]
#[ignore = "slow"]
fn it_moves_as_the_row_does_at_length() {
    let [pairs, close] = same(&table(), &all_methods(), 200, 200);
    println!("{close} of {pairs} pairs within 1e-13");
    assert!(pairs > 400 && 20 * close > 19 * pairs, "{close} of {pairs} pairs within 1e-13");
}

#[test]
#[ignore = "slow"]
fn it_moves_as_the_row_does_for_long() {
    let [pairs, close] = same(&table(), &all_methods(), 10_000, 10_000);
    // Every pair is within its own bound; one in a hundred may let roundings grow beyond this one.
    assert!(pairs > 400 && 100 * close >= 99 * pairs, "{close} of {pairs} pairs within 1e-13");
}

/// Where a text gives no basis the methods move in a derived one, and keep their orders, the energy and the constraint.
///
/// Through a time (s), or the row's, by so many steps and twice as many, against `fine` steps of order 16. How many systems there are, and on
/// how many pairs the order is seen.
fn derived(rows: &Rows, duration: Option<f64>, steps: fn(f64) -> u64, fine: u64) -> [u32; 2] {
    let (mut systems, mut seen) = (0, 0);
    for case in rows {
        let Some(mut words) = texts::of(case.name()) else { continue };
        words.basis.clear();
        systems += 1;
        let (start, facts) = (case.start(), case.facts());
        let duration = duration.unwrap_or_else(|| case.duration());
        let text = system(&words, &start);
        let run = |name: &str, steps: u64| {
            let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
            end(&*text.mechanism(), &method(name), &start, &schedule)
        };
        let reference = case.end_after(duration, &method("gauss16"), fine).unwrap();
        for (name, order) in [("dla", 2.0), ("gauss4", 4.0), ("rk4-reduced", 4.0), ("energy4", 4.0)] {
            if METHODS.iter().any(|info| info.name == name && refuses(info, facts).is_some()) {
                continue;
            }
            let steps = steps(duration);
            let [coarse, fine] = [steps, 2 * steps].map(|steps| run(name, steps).unwrap());
            let [far, near] = [&coarse, &fine].map(|found| found.distance(&reference));
            let found = (far / near).log2();
            // The next terms of the expansion are some tenths of the first at these steps; below 1e-11 the reference counts.
            assert!((found - order).abs() < 0.5 || near < 1e-11, "{}, {name}: order {found}, {far:e}", case.name());
            seen += u32::from(near > 1e-11);
            let system = text.mechanism();
            let (start, fine) = (filled(&*system, &start), filled(&*system, &fine));
            let slip = system.largest_residual(duration, &fine.q, &fine.v);
            let energies = [(0.0, &start), (duration, &fine)].map(|(t, Point { q, v })| system.energy(t, q, v));
            let kept = [slip, (energies[1] - energies[0]).abs()];
            assert!(kept[0] < 1e-13, "{}, {name}: slips by {:e}", case.name(), kept[0]);
            if name == "energy4" && !facts.forced {
                assert!(kept[1] < 1e-12, "{}, {name}: energy {:e}", case.name(), kept[1]);
            }
        }
    }
    [systems, seen]
}

#[test]
fn a_derived_basis_keeps_what_methods_promise() {
    let rows = rows(&["free sleigh", "moving everything", "snakeboard"]);
    // The one that moves refuses the energy.
    assert_eq!(derived(&rows, Some(0.8), |_| 5, 8), [3, 3 * 4 - 1]);
}

#[test]
#[ignore = "slow"]
fn a_derived_basis_keeps_what_methods_promise_at_length() {
    let [systems, seen] = derived(&table(), None, |duration| (duration / 0.04) as u64, 200);
    assert!(systems >= 20 && seen > 60, "{systems} systems, {seen} orders");
}

/// The control: of another parameter the motion is another.
#[test]
fn another_parameter_is_seen() {
    let case = crate::table::rows::named("free sleigh");
    let mut words = texts::of(case.name()).unwrap();
    words.parameters[0].1 *= 1.0 + 1e-9;
    let start = case.start();
    let text = system(&words, &start);
    let schedule = Schedule { t0: 0.0, step: 0.02, steps: 200 };
    let rust = case.run(&method("dla"), &start, &schedule, &mut |_| {}).unwrap();
    let there = end(&*text.mechanism(), &method("dla"), &start, &schedule).unwrap();
    let apart = rust.distance(&there);
    assert!(apart > 1e-11 && apart < 1e-7, "{apart:e}");
}
