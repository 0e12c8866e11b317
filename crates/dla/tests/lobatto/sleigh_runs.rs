use crate::energy::systems::run;
use crate::lobatto::systems::{distance, sleigh};
use crate::support::ByHand;
use dla::{Lobatto, OneStep, State};
use lagrangian::System;

/// The stable straight motion, a little disturbed: the spin dies out and stays out.
fn straightens<const S: usize>(h: f64, end: f64) {
    let (system, (q, v)) = (ByHand::from(sleigh(0.5)), ([0.0; 3], [1.0, 0.0, 1e-3]));
    let mut state = State::new(q, v, system.angles());
    let mut method = Lobatto::<S>::new();
    let (spin, steps) = (v[2].abs(), (end / h).round() as u32);
    for k in 1..=steps {
        method.step(&system, 0.0, h, &mut state).unwrap();
        let now = state.v()[2].abs();
        // exp(-c u t) of the motion, with room for the error of the step; below it rounding.
        let bound = 1.1 * spin * (-0.38 * h * f64::from(k)).exp() + 4.0 * f64::EPSILON;
        assert!(now <= bound, "S = {S}, h = {h}, t = {}: spin {now:e} above {bound:e}", h * f64::from(k));
    }
    let speed = state.v()[0].hypot(state.v()[1]);
    println!("S = {S}, h = {h}: spin {:e} after t = {end}, speed {speed}", state.v()[2]);
    assert!((speed - 1.0).abs() < 1e-5);
}

#[test]
fn no_parasitic_mode() {
    for (h, end) in [(0.2, 40.0), (0.5, 100.0)] {
        straightens::<2>(h, end);
        straightens::<4>(h, end);
    }
}

#[test]
#[ignore = "slow"]
fn no_parasitic_mode_in_full() {
    for h in [0.05, 0.2, 0.5] {
        straightens::<2>(h, 200.0);
        straightens::<4>(h, 200.0);
    }
}

/// Without spin the straight motion is exact.
fn stays_straight(length: f64, steps: u64) {
    let end = run(&ByHand::from(sleigh(0.5)), &mut Lobatto::<4>::new(), &([0.0; 3], [1.0, 0.0, 0.0]), (length, steps));
    assert!(distance(&end, &([length, 0.0, 0.0], [1.0, 0.0, 0.0])) < 1e-12 / 1024.0 * length, "{end:?}");
}

#[test]
fn straight_stays_straight() {
    stays_straight(128.0, 1024);
}

#[test]
#[ignore = "slow"]
fn straight_stays_straight_in_full() {
    stays_straight(1024.0, 8192);
}
