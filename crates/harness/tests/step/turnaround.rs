//! The turn-around: its angle, and how little spin it needs.

use crate::common::{advanced, sleigh, sleigh_state, state_of};
use harness::Trend;
use sleigh::{ClosedMap, Exact, Sleigh, SleighState};
use std::f64::consts::PI;

fn turning_angle(sleigh: &Sleigh) -> f64 {
    PI * (sleigh.pivot_inertia() / (sleigh.mass() * sleigh.offset() * sleigh.offset())).sqrt()
}

/// From far past to far future the heading turns by `pi sqrt(J / (m a^2))`.
#[test]
fn the_whole_turn() {
    let sleigh = sleigh();
    // So far back that the spin is 1e-12: what it turns outside the run is far below the errors.
    let start = SleighState { speed: -1.0, turn_rate: 1e-12, ..SleighState::default() };
    let turn = |h: f64| {
        let steps = (160.0 / h).round() as u64;
        let end = advanced(&sleigh, &mut ClosedMap::of(sleigh), h, steps, state_of(&sleigh, &start));
        sleigh_state(&end).heading
    };
    let mut trend = Trend::default();
    for h in [0.2f64, 0.1, 0.05, 0.025] {
        let error = (turn(h) - turning_angle(&sleigh)).abs();
        println!("h = {h}: the turn misses pi sqrt(J/(m a^2)) by {error:.2e}");
        trend.add(h.log2(), error.log2());
    }
    let order = trend.slope().unwrap();
    assert!((order - 2.0).abs() < 0.05, "the error of the turn has order {order}");
    assert!((turn(0.0125) - turning_angle(&sleigh)).abs() < 1e-3);
}

/// However small the spin, its sign is kept and the sleigh turns around, at the time that the closed form says.
#[test]
fn any_spin_turns_the_sleigh_around() {
    let sleigh = sleigh();
    let h = 0.05;
    for exponent in [1, 8, 20, 100, 200, 300] {
        for sign in [1.0, -1.0] {
            let start = SleighState { speed: -1.0, turn_rate: sign * 10f64.powi(-exponent), ..SleighState::default() };
            let exact = Exact::new(&sleigh, &start).unwrap();
            let kappa = sleigh.spin_gain();
            let flip = (2.0 * (1.0 / sleigh.pivot_inertia()).sqrt() / start.turn_rate.abs()).ln() / kappa;
            let steps = ((flip + 40.0) / h).ceil() as u64;
            let mut state = state_of(&sleigh, &start);
            let mut method = ClosedMap::of(sleigh);
            for k in 0..steps {
                state = advanced(&sleigh, &mut method, h, 1, state);
                let now = sleigh_state(&state);
                assert!(now.turn_rate * sign > 0.0, "the spin changes its sign at step {k}: {now:?}");
            }
            let (end, expected) = (sleigh_state(&state), exact.at(h * steps as f64));
            println!("omega0 = {:e}: turned by {}, speed {}", start.turn_rate, end.heading, end.speed);
            assert!((end.speed - expected.speed).abs() < 1e-3, "it runs forward: {end:?}, {expected:?}");
            // Second-order errors of the turn; the time of the flip shifts by O(h^2) of itself, which no longer matters.
            assert!((end.heading - expected.heading).abs() < 1e-2, "{end:?}, {expected:?}");
        }
    }
}

/// No spin is no spin.
#[test]
fn straight_motion_is_exact() {
    let sleigh = sleigh();
    for speed in [1.0, -1.0] {
        let start = SleighState { speed, heading: 0.3, ..SleighState::default() };
        let end =
            sleigh_state(&advanced(&sleigh, &mut ClosedMap::of(sleigh), 0.05, 100_000, state_of(&sleigh, &start)));
        assert_eq!(end.turn_rate, 0.0);
        assert_eq!(end.heading, 0.3);
        assert!((end.speed - speed).abs() < 1e-15);
    }
}
