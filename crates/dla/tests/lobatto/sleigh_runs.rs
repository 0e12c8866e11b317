use crate::systems::{Potential, at_centre, com, distance, run, sleigh};
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
        straightens::<_, 3>(&sleigh(0.5), h, blade);
        straightens::<_, 4>(&sleigh(0.5), h, blade);
        straightens::<_, 5>(&sleigh(0.5), h, blade);
        let centre = at_centre([0.0, 0.0, 0.7, 1.0, 1e-3], 0.5);
        straightens::<_, 3>(&com(0.5, ()), h, centre);
        straightens::<_, 4>(&com(0.5, ()), h, centre);
    }
}

/// Without spin the straight motion is exact.
#[test]
fn straight_stays_straight() {
    let end = run(&sleigh(0.5), &mut Lobatto::<4>::new(), &([0.0; 3], [1.0, 0.0, 0.0]), (1024.0, 8192));
    assert!(distance(&end, &([1024.0, 0.0, 0.0], [1.0, 0.0, 0.0])) < 1e-12, "{end:?}");
}

/// Ends where the reference does.
fn reaches<Sys: System<3, 1>>(name: &str, system: &Sys, start: [f64; 5], end: [f64; 5]) {
    let state = run(system, &mut Lobatto::<5>::new(), &at_centre(start, 0.5), (10.0, 400));
    let error = distance(&state, &at_centre(end, 0.5));
    println!("{name}: error {error:.1e}");
    assert!(error < 1e-11, "{name}: {error:e}");
}

/// Runs of `m = I = 1`, `a = 1/2` to `t = 10`, computed in 30 digits: `(X, Y, theta, u, omega)` at the centre of mass.
#[test]
fn reference_states() {
    reaches(
        "free",
        &com(0.5, ()),
        [0.0, 0.0, 0.0, 1.0, 0.3],
        [8.630050962159051, 5.777081619895769, 0.7128922085503294, 1.054738987164179, 0.004531574197290071],
    );
    reaches(
        "well",
        &com(0.5, Potential::Well),
        [0.5, 0.0, 0.3, 0.4, 0.7],
        [-0.6032875134127324, 0.7304442206425285, 6.937651159895837, -0.3519104363064872, 0.0303902814569294],
    );
    reaches(
        "egg-crate",
        &com(0.5, Potential::EggCrate),
        [0.5, 1.0, 0.3, 0.4, 0.7],
        [6.116263299104192, 12.39178403258227, 1.011883547635337, 0.4666370265451718, 0.0372610222581567],
    );
}
