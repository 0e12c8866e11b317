use crate::lobatto::systems::{distance, run, sleigh};
use dla::{Lobatto, OneStep, State};
use lagrangian::System;

/// The stable straight motion, a little disturbed: the spin dies out and stays out.
fn straightens<Sys: System<3, 1>, const S: usize>(system: &Sys, h: f64, (q, v): ([f64; 3], [f64; 3])) {
    let mut state = State::new(q, v, system.angles());
    let mut method = Lobatto::<S>::new();
    let (spin, steps) = (v[2].abs(), (200.0 / h).round() as u32);
    for k in 1..=steps {
        method.step(system, 0.0, h, &mut state).unwrap();
        let now = state.v()[2].abs();
        // exp(-c u t) of the motion, with room for the error of the step; below it rounding.
        let bound = 1.1 * spin * (-0.38 * h * f64::from(k)).exp() + 4.0 * f64::EPSILON;
        assert!(now <= bound, "S = {S}, h = {h}, t = {}: spin {now:e} above {bound:e}", h * f64::from(k));
    }
    let speed = state.v()[0].hypot(state.v()[1]);
    println!("S = {S}, h = {h}: spin {:e} after t = 200, speed {speed}", state.v()[2]);
    assert!((speed - 1.0).abs() < 1e-5);
}

#[test]
fn no_parasitic_mode() {
    for h in [0.05, 0.2, 0.5] {
        let blade = ([0.0; 3], [1.0, 0.0, 1e-3]);
        straightens::<_, 2>(&sleigh(0.5), h, blade);
        straightens::<_, 4>(&sleigh(0.5), h, blade);
    }
}

/// Without spin the straight motion is exact.
#[test]
fn straight_stays_straight() {
    let end = run(&sleigh(0.5), &mut Lobatto::<4>::new(), &([0.0; 3], [1.0, 0.0, 0.0]), (1024.0, 8192));
    assert!(distance(&end, &([1024.0, 0.0, 0.0], [1.0, 0.0, 0.0])) < 1e-12, "{end:?}");
}
