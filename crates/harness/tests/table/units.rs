//! Other units of time and mass, by powers of two, move a system in the same bits: no method has a tolerance with units.
//!
//! Lengths are not asked: pivots and the largest component compare them with angles.

use crate::table::case::{Point, end};
use crate::table::tools::{Methods, all_methods, method, methods};
use dla::Schedule;
use std::sync::Arc;
use text::{TextMechanics, TextModel, TextStart, Unit, Words};

/// A sleigh at its centre of mass that is driven in a well, with friction; the units of time and mass are `2^-time` and `2^-mass` of the base's.
fn driven([time, mass]: [i32; 2]) -> Words {
    let power = |exponent: i32| 2f64.powi(exponent);
    let parameters = [
        ("m", 1.3 * power(mass)),
        ("I", 0.8 * power(mass)),
        ("a", 0.4),
        ("k", 0.7 * power(mass - 2 * time)),
        ("c", 0.2 * power(mass - time)),
        ("F", 0.3 * power(mass - 2 * time)),
    ];
    let text = |words: &str| words.to_owned();
    Words {
        coordinates: vec![(text("x"), Unit::other("m")), (text("y"), Unit::other("m")), (text("theta"), Unit::Angle)],
        parameters: parameters.map(|(name, value)| (text(name), value)).into(),
        lagrangian: text("m/2*(x'^2 + y'^2) + I/2*theta'^2 - k/2*(x^2 + y^2)"),
        constraints: vec![text("y'*cos(theta) - x'*sin(theta) - a*theta'")],
        basis: vec![
            ["cos(theta)", "sin(theta)", "0"].map(text).into(),
            ["-a*sin(theta)", "a*cos(theta)", "1"].map(text).into(),
        ],
        ..Words::default()
    }
}

/// As above, pushed along its heading and braked.
fn forced(units: [i32; 2]) -> Words {
    let forces = [("x", "F*cos(theta) - c*x'"), ("y", "F*sin(theta) - c*y'")];
    let forces = forces.map(|(name, force)| (name.to_owned(), force.to_owned()));
    Words { forces: forces.into(), ..driven(units) }
}

/// Where a run ends, in the units of the base, from places larger by the part `more`.
fn ends(words: &Words, name: &str, [time, _]: [i32; 2], more: f64, steps: u64) -> Point {
    let time = 2f64.powi(time);
    // Admissible: `y' = a theta'` at heading zero.
    let (q, v) = ([0.5, -0.2, 0.0].map(|q| q * (1.0 + more)), [0.7, 0.36, 0.9].map(|v| v / time));
    let at = TextStart { q: q.to_vec(), v: v.to_vec(), ..TextStart::default() };
    let system = TextMechanics::new(&Arc::new(TextModel::new(words).unwrap()), &at).unwrap();
    let system = system.mechanism();
    let filled = |x: [f64; 3]| [&x[..], &vec![0.0; system.size().n - 3]].concat();
    let schedule = Schedule { t0: 0.0, step: 0.05 * time, steps };
    let Point { q, v } =
        end(&*system, &method(name), &Point { q: filled(q), v: filled(v) }, &schedule, &mut |_| {}).unwrap();
    Point { q, v: v.iter().map(|v| v * time).collect() }
}

fn same_in(units: &[[i32; 2]], methods: &Methods, steps: u64) {
    let mut seen = 0;
    // The series is the sleigh's own; adaptive methods have a tolerance with the units of what they compute.
    for info in methods.iter().filter(|info| info.name != "taylor" && !info.kind.is_adaptive()) {
        let words = if info.name.starts_with("energy") { driven } else { forced };
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
