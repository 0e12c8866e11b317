//! What a round of a tracer does to the headings, against the integrated equation of the blade.

use approx::assert_abs_diff_eq;
use proptest::prelude::*;
use sleigh::planimeter::{Class, Leg, of_curve, of_legs};
use sleigh::{ClosedPath, SleighError};
use std::f64::consts::{PI, TAU};

/// By how much a blade turns that is led for a time: `a theta' = y' cos theta - x' sin theta`, by 2000 steps of the classical
/// Runge-Kutta method. It turns by less than `r` = 10 rad here, so that an error is of the size `r (r/2000)^4 / 120` = 5e-11.
pub(crate) fn led(velocity: impl Fn(f64) -> [f64; 2], time: f64, a: f64, heading: f64) -> f64 {
    let steps = 2000;
    let h = time / f64::from(steps);
    let rate = |t: f64, turn: f64| {
        let ([x, y], (sin, cos)) = (velocity(t), (heading + turn).sin_cos());
        (y * cos - x * sin) / a
    };
    (0..steps).fold(0.0, |turn, k| {
        let t = f64::from(k) * h;
        let k1 = rate(t, turn);
        let k2 = rate(t + 0.5 * h, turn + 0.5 * h * k1);
        let k3 = rate(t + 0.5 * h, turn + 0.5 * h * k2);
        let k4 = rate(t + h, turn + h * k3);
        turn + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    })
}

/// Along one leg in a unit of time.
fn along(leg: &Leg, a: f64, heading: f64) -> f64 {
    match *leg {
        Leg::Segment(d) => led(|_| d, 1.0, a, heading),
        Leg::Arc { radius, from, by } => {
            let speed = radius * by;
            led(|t| [-speed * (from + by * t).sin(), speed * (from + by * t).cos()], 1.0, a, heading)
        }
    }
}

/// Legs of many offsets in length, whose maps are products of pieces; with all the full turns.
#[test]
fn long_legs_count_their_turns() {
    for a in [0.7, -0.7] {
        let arc = |radius, from, by| Leg::Arc { radius, from, by };
        for legs in [
            vec![Leg::Segment([2.0, -3.5])],
            vec![Leg::Segment([-0.6, 0.1]), Leg::Segment([0.0, 2.5])],
            vec![arc(0.5, 0.3, 9.0)],
            vec![arc(1.2, -1.0, -7.0), Leg::Segment([0.5, 0.2]), arc(0.3, 0.4, 2.0)],
        ] {
            let holonomy = of_legs(&legs, a).unwrap();
            for heading in [0.2, -2.0, 5.0] {
                let turn = legs.iter().fold(0.0, |turn, leg| turn + along(leg, a, heading + turn));
                assert_abs_diff_eq!(holonomy.turn(heading), turn, epsilon = 1e-9);
                let rest = (holonomy.map().change(heading) - turn) / TAU;
                assert_abs_diff_eq!(rest, rest.round(), epsilon = 1e-9);
            }
        }
    }
    // The control: a blade led around often does turn around.
    let circle = [Leg::Arc { radius: 1.5, from: 0.0, by: 3.0 * TAU }];
    assert!(of_legs(&circle, 1.0).unwrap().turn(0.3) > 2.5 * TAU);
}

proptest! {
    /// Curves, in pieces of the fourth order: a half ellipse, and back through its chord in pieces of their own.
    #[test]
    fn curves_are_led_as_well(heading in -3.0..3.0, (p, q) in (0.2..1.0f64, -1.0..1.0f64), a in prop_oneof![-2.0..-0.8, 0.8..2.0]) {
        let half = |t: f64| [-p * t.sin(), q * t.cos()];
        // Pieces of pi/500: their fourth power is 1.6e-9, and a hundredth of it the constant of Magnus' series.
        let holonomy = of_curve(half, PI, 500, a).unwrap();
        assert_abs_diff_eq!(holonomy.turn(heading), led(half, PI, a, heading), epsilon = 1e-9);
    }
}

/// `2 pi (1 - sqrt(1 - r^2))` a round within the offset, a full turn beyond it; either way round, often, from anywhere.
#[test]
fn mean_turns() {
    let mean = |r: f64, from: f64, by: f64| {
        let shift = [0.3, -0.4];
        // A loop that begins elsewhere has the same mean.
        let legs = [Leg::Segment(shift), Leg::Arc { radius: 0.8 * r, from, by }, Leg::Segment(shift.map(|x| -x))];
        of_legs(&legs, 0.8).unwrap().mean_turn()
    };
    for rounds in [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0] {
        for from in [0.0, 2.0] {
            for r in [0.1_f64, 0.5, 0.95] {
                let expected = TAU * (1.0 - (1.0 - r * r).sqrt()) * rounds;
                assert_abs_diff_eq!(mean(r, from, rounds * TAU), expected, epsilon = 1e-10);
            }
            assert_abs_diff_eq!(mean(1.5, from, rounds * TAU), rounds * TAU, epsilon = 1e-12);
        }
    }
}

/// The legs of a path are its round: they close, and a circle within the offset is elliptic, as a small polygon is.
#[test]
fn legs_of_paths() {
    let corners = vec![[1.0, 2.0], [1.5, 2.1], [1.2, 2.7]];
    let triangle = ClosedPath::polygon(corners.clone(), 3.0).unwrap();
    let legs = triangle.legs();
    assert_eq!(legs.len(), 3);
    for (k, leg) in legs.iter().enumerate() {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        assert_eq!(*leg, Leg::Segment([to[0] - from[0], to[1] - from[1]]));
    }
    let circle = ClosedPath::circle(0.5, [3.0, 4.0], 2.0).unwrap();
    assert_eq!(circle.legs(), [Leg::Arc { radius: 0.5, from: 0.0, by: TAU }]);
    for path in [triangle, circle] {
        let holonomy = path.holonomy(1.0).unwrap();
        assert_eq!(holonomy.map().class(), Class::Elliptic);
        let turn = path.legs().iter().fold(0.0, |turn, leg| turn + along(leg, 1.0, 0.3 + turn));
        assert_abs_diff_eq!(holonomy.turn(0.3), turn, epsilon = 1e-9);
    }
}

#[test]
fn what_is_refused() {
    let segment = |d: f64| of_legs(&[Leg::Segment([d, 0.0])], 0.5);
    for a in [0.0, f64::NAN, f64::INFINITY] {
        assert!(of_legs(&[Leg::Segment([1.0, 0.0])], a).is_err(), "{a}");
    }
    assert!(segment(f64::NAN).is_err());
    assert!(of_legs(&[Leg::Arc { radius: 1.0, from: f64::INFINITY, by: 1.0 }], 0.5).is_err());
    // Up to a million pieces of three offsets.
    let too_long = |holonomy| matches!(holonomy, Err(SleighError::Path { .. }));
    assert!(too_long(segment(1.6e6)) && too_long(of_legs(&[Leg::Arc { radius: 1e3, from: 0.0, by: -1.6e3 }], 0.5)));
    assert!(segment(1.5e6).is_ok());
    // A piece of a curve has at most three offsets, where it is fastest.
    let speeding =
        |first: f64, second: f64| of_curve(move |t| if t < 0.25 { [0.0, first] } else { [second, 0.0] }, 0.5, 1, 0.5);
    assert!(speeding(2.9, 2.9).is_ok() && speeding(0.1, -2.9).is_ok());
    assert!(too_long(speeding(3.1, 0.1)) && too_long(speeding(0.1, -3.1)));
    assert!(of_curve(|_| [f64::NAN, 0.0], 1.0, 1, 0.5).is_err());
    // No pieces are no path.
    assert_eq!(of_curve(|_| [1.0, 0.0], 1.0, 0, 0.5).unwrap().turn(0.4), 0.0);
}
