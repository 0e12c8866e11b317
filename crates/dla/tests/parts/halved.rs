//! When the halves of a step say that it resolves the motion.

use dla::Halved;
use proptest::prelude::*;

/// A step of length one along a motion that is known, made whole by it and by halves of it.
fn exact(v: impl Fn(f64) -> f64, moved: f64) -> Halved {
    Halved { v: [v(0.0), v(0.5), v(1.0), v(1.0)], moved: [moved; 2] }
}

/// Simpson's rule misses a turn by `a^4/2880` of it: a radian and a half are resolved, two and a half are not.
#[test]
fn a_turn_is_resolved_up_to_two_radians() {
    for (turn, resolved) in [(0.1, true), (1.5, true), (2.5, false), (std::f64::consts::TAU, false), (100.0, false)] {
        let along = exact(|t| (turn * t).cos(), f64::sin(turn) / turn);
        let across = exact(|t| (turn * t).sin(), (1.0 - f64::cos(turn)) / turn);
        assert_eq!(along.is_resolved(1.0, 1.0, 0.0) && across.is_resolved(1.0, 1.0, 0.0), resolved, "{turn}");
    }
}

#[test]
fn halves_that_lead_elsewhere_do_not_resolve() {
    let right = exact(|t| 1.0 + t, 1.5);
    assert!(right.is_resolved(1.0, 1.0, 0.0));
    for (v, moved) in [(2.001, 1.5), (2.0, 1.505), (f64::NAN, 1.5), (2.0, f64::INFINITY)] {
        let wrong = Halved { v: [1.0, 1.5, 2.0, v], moved: [1.5, moved] };
        assert!(!wrong.is_resolved(1.0, 1.0, 0.0), "{v} {moved}");
    }
    // The same in a thousandth of the difference.
    assert!(Halved { v: [1.0, 1.5, 2.0, 2.000_001], moved: [1.5, 1.500_001] }.is_resolved(1.0, 1.0, 0.0));
}

/// What a midpoint rule makes of a turn of a million radians: the body keeps its place, and turns as before. All halves agree.
#[test]
fn a_way_that_the_velocities_do_not_account_for_is_no_motion() {
    let stays = Halved { v: [0.3; 4], moved: [0.0; 2] };
    assert!(!stays.is_resolved(1e12, 1.0, Halved::nothing(1e12, 1.0, 1.0)));
    // But what is at rest.
    let rests = Halved { v: [0.0; 4], moved: [0.0; 2] };
    assert!(rests.is_resolved(1e12, 1.0, Halved::nothing(1e12, 0.0, 0.0)));
}

/// Noise of a place that is a metre off is no velocity; the same velocity in a place that has its digits is one.
#[test]
fn rounding_is_nothing() {
    let noise = Halved { v: [0.0, 1e-17, 0.0, -1e-17], moved: [1e-19, -1e-19] };
    assert!(noise.is_resolved(0.01, 1.0, Halved::nothing(0.01, 1.0, 0.0)));
    assert!(!noise.is_resolved(0.01, 1.0, Halved::nothing(0.01, 1e-20, 0.0)));
    let beside = Halved { v: [0.0, 1e-13, -1e-13, 0.0], moved: [0.0; 2] };
    assert!(beside.is_resolved(0.01, 1.0, Halved::nothing(0.01, 0.0, 1.0)));
}

proptest! {
    /// Units do not matter, nor the sense of the step.
    #[test]
    fn scales_do_not_matter(v in prop::array::uniform4(-1.0..1.0f64), moved in prop::array::uniform2(-1.0..1.0f64), by in -200..200i32) {
        let scale = 2f64.powi(by);
        let scaled = Halved { v: v.map(|v| scale * v), moved: moved.map(|way| scale * way) };
        let one = Halved { v, moved };
        prop_assert_eq!(one.is_resolved(1.0, 1.0, 0.0), scaled.is_resolved(1.0, scale, 0.0));
        let back = Halved { v: v.map(|v| -v), moved };
        prop_assert_eq!(one.is_resolved(1.0, 1.0, 0.0), back.is_resolved(-1.0, 1.0, 0.0));
    }

    /// A constant acceleration is resolved in steps of any length.
    #[test]
    fn constant_accelerations_are_resolved(v in -1.0..1.0f64, a in -1.0..1.0f64, exponent in -30..30i32) {
        let h = 10f64.powi(exponent);
        let now = |t: f64| v + a * t * h;
        let moved = h * (v + 0.5 * a * h);
        let all = Halved { v: [now(0.0), now(0.5), now(1.0), now(1.0)], moved: [moved; 2] };
        prop_assert!(all.is_resolved(h, 1.0 + h, 0.0));
    }
}
