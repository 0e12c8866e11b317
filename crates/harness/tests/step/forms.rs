//! One step, three ways to solve it: the closed map, the basis of admissible velocities, and the multipliers.

use crate::common::{midpoint_forms, sleighs, starts, state_of};
use approx::assert_relative_eq;
use dla::{Discretisation, Dla, OneStep};
use lagrangian::{Midpoint, Motion, System, Trapezoid, constraint_residual, momentum};
use proptest::prelude::*;
use sleigh::{CentreOfMass, ClosedMap};

fn step_fits(sleigh: &sleigh::Sleigh, start: &sleigh::SleighState, h: f64) -> bool {
    let speed = start.speed.hypot((sleigh.pivot_inertia() / sleigh.mass()).sqrt() * start.turn_rate);
    h * sleigh.spin_gain().abs() * speed < 0.5
}

proptest! {
    #[test]
    fn all_forms_agree_to_rounding(sleigh in sleighs(), start in starts(), h in 0.001..0.3f64) {
        prop_assume!(step_fits(&sleigh, &start, h));
        let results = midpoint_forms(sleigh).map(|(name, mut method)| {
            let mut state = state_of(&sleigh, &start);
            let report = method.step(&sleigh, 0.0, h, &mut state).unwrap();
            (name, state, report)
        });
        // Rounding of the momenta, of size m + J, amplified by the condition (m + J)/I of the mass matrix.
        let mass = sleigh.mass() + sleigh.pivot_inertia();
        let rounding = 1e-14 * (1.0 + mass / sleigh.inertia().min(sleigh.mass())) * 4.0;
        for (name, state, report) in &results[1..] {
            for i in 0..3 {
                assert_relative_eq!(state.unwrapped()[i], results[0].1.unwrapped()[i], epsilon = rounding);
                assert_relative_eq!(state.v()[i], results[0].1.v()[i], epsilon = rounding);
            }
            for end in 0..2 {
                let (a, b) = (report.impulses[end][0], results[0].2.impulses[end][0]);
                prop_assert!((a - b).abs() <= rounding * mass, "{name}, impulse {end}: {a} and {b}");
            }
        }
    }

    /// What was solved is what the equations say, term by term, for rules of both kinds and in both coordinates.
    #[test]
    fn the_equations_hold(sleigh in sleighs(), start in starts(), h in 0.001..0.3f64) {
        prop_assume!(step_fits(&sleigh, &start, h));
        let (q, v) = start.to_coordinates();
        check(&sleigh, Dla::midpoint(), q, v, h)?;
        check(&sleigh, Dla::trapezoid(), q, v, h)?;
        check(&sleigh, Dla::new(Trapezoid, Midpoint), q, v, h)?;
        let com = CentreOfMass(sleigh);
        let (q, v) = com.from_blade(&q, &v);
        check(&com, Dla::midpoint(), q, v, h)?;
        check(&com, Dla::new(Midpoint, Trapezoid), q, v, h)?;
    }

    /// The mean constraint force of a step tends to the multiplier of the continuous motion, `m I u omega / J`.
    #[test]
    fn impulses_are_those_of_the_blade(sleigh in sleighs(), start in starts()) {
        let h = 1e-3;
        prop_assume!(step_fits(&sleigh, &start, h));
        let mut state = state_of(&sleigh, &start);
        let before = Motion::of(&sleigh, 0.0, state.q(), state.v()).unwrap().multiplier[0];
        let report = ClosedMap::of(sleigh).step(&sleigh, 0.0, h, &mut state).unwrap();
        let after = Motion::of(&sleigh, h, state.q(), state.v()).unwrap().multiplier[0];
        let mean = report.multipliers(h)[0];
        // Velocities below 2 and rates c u, omega below 10: the second derivative of the force, times h^2.
        let tolerance = 1e3 * h * h * sleigh.mass() * 10.0 + 1e-12 / h;
        prop_assert!((mean - 0.5 * (before + after)).abs() <= tolerance, "{mean} between {before} and {after}");
    }
}

fn check<Sys: System<3, 1>>(
    system: &Sys,
    mut method: Dla,
    q0: [f64; 3],
    v0: [f64; 3],
    h: f64,
) -> Result<(), TestCaseError> {
    let start = dla::State::new(q0, v0, [false; 3]);
    let mut state = start;
    let report = method.step(system, 0.0, h, &mut state).unwrap();
    let q1 = *state.q();
    let v: [f64; 3] = std::array::from_fn(|i| (q1[i] - q0[i]) / h);
    // The increment was rounded relative to positions up to 15.
    let rounding = 1e-14 / h;
    prop_assert!(method.rules.residual(system, (0.0, h), &q0, &v)[0].abs() <= rounding);
    prop_assert!(constraint_residual(system, h, &q1, state.v())[0].abs() <= 1e-14);
    let [d1, d2] = method.rules.momenta(system, (0.0, h), &q0, &v).slopes;
    let (p0, p1) = (momentum(system, 0.0, &q0, &v0), momentum(system, h, &q1, state.v()));
    let (a0, a1) = (system.constraint(0.0, &q0).0, system.constraint(h, &q1).0);
    let size = 1.0 + d1.iter().chain(&d2).fold(0.0f64, |m, x| m.max(x.abs()));
    for i in 0..3 {
        let first = p0[i] + d1[i] + a0[0][i] * report.impulses[0][0];
        let second = p1[i] - d2[i] - a1[0][i] * report.impulses[1][0];
        prop_assert!(first.abs() <= rounding * size * 10.0, "first, {i}: {first:e}");
        prop_assert!(second.abs() <= rounding * size * 10.0, "second, {i}: {second:e}");
    }
    Ok(())
}
