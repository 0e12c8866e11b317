//! Other units of time and mass, by powers of two, move a system in the same bits: no method has a tolerance with units.
//!
//! Lengths are not asked: pivots and the largest component compare them with angles.

use crate::table::case::Point;
use crate::table::text::{end, system};
use crate::table::texts::in_field;
use crate::table::tools::{Methods, all_methods, method, methods};
use dla::Schedule;
use text::Words;

/// A sleigh in a well, in units of time and mass that are `2^-time` and `2^-mass` of the base's.
fn free([time, mass]: [i32; 2]) -> Words {
    let power = |exponent: i32| 2f64.powi(exponent);
    let parameters = [
        ("m", 1.3 * power(mass)),
        ("I", 0.8 * power(mass)),
        ("a", 0.4),
        ("k", 0.7 * power(mass - 2 * time)),
        ("c", 0.2 * power(mass - time)),
        ("F", 0.3 * power(mass - 2 * time)),
    ];
    let parameters = parameters.map(|(name, value)| (name.to_owned(), value)).into();
    Words { parameters, ..in_field(&["x", "y", "theta!"], "k/2*(x^2 + y^2)") }
}

/// As above, pushed along its heading and braked.
fn forced(units: [i32; 2]) -> Words {
    let forces = [("x", "F*cos(theta) - c*x'"), ("y", "F*sin(theta) - c*y'")];
    let forces = forces.map(|(name, force)| (name.to_owned(), force.to_owned()));
    Words { forces: forces.into(), ..free(units) }
}

/// Where a run ends, in the units of the base, from places larger by the part `more`.
fn ends(words: &Words, name: &str, [time, _]: [i32; 2], more: f64, steps: u64) -> Point {
    let time = 2f64.powi(time);
    // Admissible: `y' = a theta'` at heading zero.
    let (q, v) = ([0.5, -0.2, 0.0].map(|q| q * (1.0 + more)), [0.7, 0.36, 0.9].map(|v| v / time));
    let start = Point { q: q.into(), v: v.into() };
    let schedule = Schedule { t0: 0.0, step: 0.05 * time, steps };
    let Point { q, v } = end(&*system(words, &start).mechanism(), &method(name), &start, &schedule).unwrap();
    Point { q, v: v.iter().map(|v| v * time).collect() }
}

fn same_in(units: &[[i32; 2]], methods: &Methods, steps: u64) {
    let mut seen = 0;
    // The tolerance of an adaptive method has the units of the unknowns.
    for info in methods.iter().filter(|info| !info.kind.is_adaptive()) {
        let words = if info.name.starts_with("energy") { free } else { forced };
        let run = |units, more| ends(&words(units), info.name, units, more, steps);
        let base = run([0; 2], 0.0);
        for units in units {
            let there = run(*units, 0.0);
            assert_eq!((&there.q, &there.v), (&base.q, &base.v), "{} in units {units:?}", info.name);
            seen += 1;
        }
        // The control: bits are seen.
        assert_ne!(run([0; 2], 8.0 * f64::EPSILON).q, base.q, "{}", info.name);
    }
    assert!(seen >= 5 * units.len());
}

#[test]
fn a_motion_has_no_units() {
    let methods = methods(&["dla", "dla4", "lobatto3", "gauss8", "energy4", "implicit-midpoint", "rk4-reduced"]);
    same_in(&[[20, 0], [-20, 0], [0, 30], [-10, -30]], &methods, 60);
}

#[test]
#[ignore = "slow"]
fn a_motion_has_no_units_at_length() {
    same_in(&[[40, 0], [-40, 0], [0, 60], [0, -60], [30, -30]], &all_methods(), 1000);
}
