//! A constraint on positions entered as one on velocities: the leaf is left by a bounded amount of the second order
//! (McLachlan and Perlmutter 2006, J. Nonlinear Sci. 16, 283-328, section 5).

use crate::constraints::tools::{Largest, assert_order};
use crate::support::ThreeTwo;
use dla::{Dla, Schedule, State, View, drive};
use test_systems::{CompoundPendulum, Model};

/// The largest distance of the hinge from the origin (m).
fn drift(step: f64, steps: u64) -> f64 {
    let pendulum = CompoundPendulum::new(1.3, 0.4, 0.9, 9.81).pseudo_holonomic();
    let (q, v) = pendulum.start();
    let mut off = Largest::of(|node: &View<'_>| {
        let [x, y] = pendulum.hinge(node.state.typed().unwrap().q());
        x.hypot(y)
    });
    let mut state = State::new(q, v, [false, false, true]);
    drive(&ThreeTwo::from(pendulum), &mut Dla::midpoint(), &Schedule { t0: 0.0, step, steps }, &mut state, &mut off)
        .unwrap();
    off.value
}

/// The order of what is left to 20 s, and by the first steps of so many no more until a late time (s).
fn left_by_a_bounded_amount(count: usize, late: f64) {
    let steps = [0.04, 0.02, 0.01, 0.005];
    let early = steps.map(|h| drift(h, (20.0 / h) as u64));
    assert_order("drift", early, 2.0);
    for (h, early) in steps.into_iter().zip(early).take(count) {
        let after = drift(h, (late / h) as u64);
        println!("h = {h}: {early:e} to 20 s, {after:e} to {late} s");
        // Turning points a little farther out are found in a hundred times as many swings; a drift would add up.
        assert!(early > 0.5 * h * h && after <= 1.001 * early, "h = {h}: {early:e}, then {after:e}");
    }
}

#[test]
fn the_leaf_is_left_by_a_bounded_amount() {
    left_by_a_bounded_amount(1, 100.0);
}

#[test]
#[ignore = "slow"]
fn the_leaf_is_left_by_a_bounded_amount_in_full() {
    left_by_a_bounded_amount(4, 2000.0);
}
