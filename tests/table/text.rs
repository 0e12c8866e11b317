//! A row written as text moves as the row in Rust, by every method.

use crate::case::Point;
use crate::rows::table;
use crate::texts;
use crate::tools::{method, refuses};
use dla::{Mechanics, RunError, Schedule, State, drive};
use harness::{METHODS, Method};
use std::sync::Arc;
use text::{AnyText, TextModel, TextStart, Words, with_text};

/// The system of a text, from this start.
fn system(words: &Words, start: &Point) -> AnyText {
    let start = TextStart { q: start.q.clone(), v: start.v.clone(), ..TextStart::default() };
    AnyText::new(&Arc::new(TextModel::new(words).unwrap()), &start).unwrap()
}

/// Where a run of the text ends.
fn end<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &Method,
    (q, v): ([f64; N], [f64; N]),
    schedule: &Schedule,
    places: usize,
) -> Result<Point, RunError> {
    let mut state = State::new(q, v, system.angles());
    drive(system, &mut *method.stepper(), schedule, &mut state, ())?;
    Ok(Point { q: state.unwrapped()[..places].to_vec(), v: state.v()[..places].to_vec() })
}

/// The text and the row, by every method that takes the row, through so many steps of the row's time; and how many pairs agree to 1e-13.
///
/// Both round what they compute, and a motion lets two roundings grow apart. How far is seen from a run that starts a rounding away.
fn same(steps: u64) -> [u32; 2] {
    let (mut pairs, mut close) = (0, 0);
    for case in table() {
        let Some(words) = texts::of(case.name()) else { continue };
        let (start, facts) = (case.start(), case.facts());
        let places = start.q.len();
        let text = system(&words, &start);
        let schedule = Schedule { t0: 0.0, step: case.duration() / steps as f64, steps };
        for info in METHODS.iter().filter(|info| refuses(info, facts).is_none()) {
            let method = method(info.name);
            let Ok(rust) = case.run(&method, &start, &schedule, &mut |_| {}) else { continue };
            let away = Point { q: start.q.iter().map(|x| x * (1.0 + f64::EPSILON)).collect(), v: start.v.clone() };
            let near = case.run(&method, &away, &schedule, &mut |_| {}).unwrap();
            let there =
                with_text!(&text, started => end(&*started.system, &method, (started.q, started.v), &schedule, places))
                    .unwrap();
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
    let [pairs, close] = same(200);
    println!("{close} of {pairs} pairs within 1e-13");
    assert!(pairs > 400 && 20 * close > 19 * pairs, "{close} of {pairs} pairs within 1e-13");
}

/// Ten thousand steps: twenty minutes of processor time in a development build.
#[test]
#[ignore = "long"]
fn it_moves_as_the_row_does_for_long() {
    let [pairs, close] = same(10_000);
    assert!(pairs > 400 && close == pairs, "{close} of {pairs} pairs within 1e-13");
}

/// Where a text gives no basis the methods move in a derived one, and keep their orders, the energy and the constraint.
#[test]
fn a_derived_basis_keeps_what_methods_promise() {
    let (mut systems, mut seen) = (0, 0);
    for case in table() {
        let Some(mut words) = texts::of(case.name()) else { continue };
        words.basis.clear();
        systems += 1;
        let (start, facts) = (case.start(), case.facts());
        let (places, duration) = (start.q.len(), case.duration());
        let text = system(&words, &start);
        let run = |name: &str, steps: u64| {
            let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
            with_text!(&text, started => end(&*started.system, &method(name), (started.q, started.v), &schedule, places))
        };
        let reference = case.end(&method("gauss16"), 200).unwrap();
        for (name, order) in [("dla", 2.0), ("gauss4", 4.0), ("rk4-reduced", 4.0), ("energy4", 4.0)] {
            if METHODS.iter().any(|info| info.name == name && refuses(info, facts).is_some()) {
                continue;
            }
            let steps = (duration / 0.04) as u64;
            let [coarse, fine] = [steps, 2 * steps].map(|steps| run(name, steps).unwrap());
            let [far, near] = [&coarse, &fine].map(|found| found.distance(&reference));
            let found = (far / near).log2();
            // The next terms of the expansion are some tenths of the first at these steps; below 1e-11 the reference counts.
            assert!((found - order).abs() < 0.5 || near < 1e-11, "{}, {name}: order {found}, {far:e}", case.name());
            seen += u32::from(near > 1e-11);
            let kept = with_text!(&text, started => {
                let system = started.system.smooth_piece(duration);
                let place = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
                let (q, v) = (place(&fine.q), place(&fine.v));
                let slip = system.residual(duration, &q, &v).iter().fold(0.0, |most: f64, slip| most.max(slip.abs()));
                let first = started.system.smooth_piece(0.0).energy(0.0, &started.q, &started.v);
                [slip, (system.energy(duration, &q, &v) - first).abs()]
            });
            assert!(kept[0] < 1e-13, "{}, {name}: slips by {:e}", case.name(), kept[0]);
            if name == "energy4" && !facts.forced {
                assert!(kept[1] < 1e-12, "{}, {name}: energy {:e}", case.name(), kept[1]);
            }
        }
    }
    assert!(systems >= 20 && seen > 60, "{systems} systems, {seen} orders");
}

/// The control: of another parameter the motion is another.
#[test]
fn another_parameter_is_seen() {
    let case = crate::rows::named("free sleigh");
    let mut words = texts::of(case.name()).unwrap();
    words.parameters[0].1 *= 1.0 + 1e-9;
    let start = case.start();
    let text = system(&words, &start);
    let schedule = Schedule { t0: 0.0, step: 0.02, steps: 200 };
    let rust = case.run(&method("dla"), &start, &schedule, &mut |_| {}).unwrap();
    let there =
        with_text!(&text, started => end(&*started.system, &method("dla"), (started.q, started.v), &schedule, 3))
            .unwrap();
    let apart = rust.distance(&there);
    assert!(apart > 1e-11 && apart < 1e-7, "{apart:e}");
}
