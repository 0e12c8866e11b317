//! One step from anywhere: the node's constraint, and the same result in the basis and with multipliers.

use crate::support::{Four, Free, Three};
use crate::systems::models::{Disk, Hyperbolic, Kinetic, Oscillator, Particle, Pushed};
use dla::{Discretisation, Dla, Form, OneStep, State};
use lagrangian::{Midpoint, System, Trapezoid, constraint_residual, momentum};
use proptest::prelude::*;
use std::array::from_fn;

/// One step of `method` in both forms, checked against the equations it stands for.
fn check<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: Dla,
    q0: [f64; N],
    v0: [f64; N],
    (t, h): (f64, f64),
) -> Result<(), TestCaseError> {
    let start = State::new(q0, v0, [false; N]);
    let [basis, multipliers] = [Form::Best, Form::Multipliers].map(|form| {
        let mut state = start;
        let report = method.solved(form).step(system, t, h, &mut state).unwrap();
        (state, report)
    });
    let start_slopes = method.rules.momenta(system, (t, h), &q0, &v0).slopes;
    for (state, report) in [basis, multipliers] {
        let (q1, v1) = (*state.q(), *state.v());
        // A few roundings of terms below 10.
        let residual: [f64; M] = constraint_residual(system, t + h, &q1, &v1);
        prop_assert!(residual.iter().all(|r| r.abs() <= 1e-13), "node {residual:?}");
        // From here on with the rounding of q1 - q0, for positions below 4 and h above 0.01.
        let v: [f64; N] = from_fn(|i| (q1[i] - q0[i]) / h);
        let w = method.rules.residual(system, (t, h), &q0, &v);
        prop_assert!(w.iter().all(|w| w.abs() <= 1e-12), "pair {w:?}");
        // The impulses are those that move the momentum: p1 - p0 = D1 + D2 + f + A0' lambda + A1' mu.
        let ends = method.rules.momenta(system, (t, h), &q0, &v);
        let ([d1, d2], [minus, plus]) = (ends.slopes, ends.forces.unwrap_or([[0.0; N]; 2]));
        let (p0, p1) = (momentum(system, t, &q0, &v0), momentum(system, t + h, &q1, &v1));
        let (a0, a1) = (system.constraint(t, &q0).0, system.constraint(t + h, &q1).0);
        for i in 0..N {
            let at_start: f64 = (0..M).map(|k| a0[k][i] * report.impulses[0][k]).sum();
            let at_end: f64 = (0..M).map(|k| a1[k][i] * report.impulses[1][k]).sum();
            prop_assert!((p0[i] + d1[i] + minus[i] + at_start).abs() <= 1e-11, "start, {i}");
            prop_assert!((p1[i] - d2[i] - plus[i] - at_end).abs() <= 1e-11, "end, {i}");
        }
    }
    for i in 0..N {
        // Solved differently, with condition numbers below 100.
        let scale = 1.0 + start_slopes[0][i].abs();
        prop_assert!((basis.0.q()[i] - multipliers.0.q()[i]).abs() <= 1e-13 * scale, "q {i}");
        prop_assert!((basis.0.v()[i] - multipliers.0.v()[i]).abs() <= 1e-12 * scale, "v {i}");
    }
    for (a, b) in basis.1.impulses.iter().flatten().zip(multipliers.1.impulses.iter().flatten()) {
        prop_assert!((a - b).abs() <= 1e-12, "impulses {a:e} and {b:e}");
    }
    Ok(())
}

/// The step with every pair of rules.
fn check_all<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    q: [f64; N],
    v: [f64; N],
    at: (f64, f64),
) -> Result<(), TestCaseError> {
    check(system, Dla::midpoint(), q, v, at)?;
    check(system, Dla::trapezoid(), q, v, at)?;
    check(system, Dla::new(Midpoint, Trapezoid), q, v, at)?;
    check(system, Dla::new(Trapezoid, Midpoint), q, v, at)?;
    check(system, Dla::alpha(0.3).unwrap(), q, v, at)
}

fn component() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -1.0..1.0, 1 => Just(0.0), 1 => -1e-9..1e-9]
}

proptest! {
    #[test]
    fn every_step_keeps_its_equations(
        q in prop::array::uniform4(component()), v in prop::array::uniform2(component()), t in -2.0..2.0f64,
        h in prop_oneof![0.01..0.2f64, -0.2..-0.01f64], damping in 0.0..0.5f64,
    ) {
        let (at, place) = ((t, h), [q[0], q[1], q[2]]);
        for kinetic in [Kinetic::Quadratic, Kinetic::Quartic] {
            let along = [v[0], v[1], q[1] * v[0]];
            check_all(&Three::from(Particle { kinetic, damping: 0.0 }), place, along, at)?;
            check_all(&Three::from(Particle { kinetic, damping }), place, along, at)?;
        }
        // Below the speed of light.
        let relativistic = Particle { kinetic: Kinetic::Relativistic, damping: 0.0 };
        check_all(&Three::from(relativistic), place, [0.5 * v[0], 0.5 * v[1], 0.5 * q[1] * v[0]], at)?;
        check_all(&Three::from(Hyperbolic), place, [v[0], v[1], q[1].sinh() * v[0]], at)?;
        check_all(&Three::from(Pushed), place, [v[0], v[1], q[1] * v[0] + t.cos()], at)?;
        let (sin, cos) = q[3].sin_cos();
        check_all(&Four::from(Disk), q, [0.7 * v[0] * cos, 0.7 * v[0] * sin, v[0], v[1]], at)?;
        check_all(&Free::from(Oscillator { damping, drive: 0.3 }), [q[0]], [v[0]], at)?;
    }

    /// Through a turning point the mean velocity of a step is zero, and its equations end in rounding.
    #[test]
    fn turning_points_are_passed(q in -1.0..1.0f64, h in 0.01..0.5f64, off in prop_oneof![Just(0.0), -1e-15..1e-15f64]) {
        let free = Free::from(Oscillator { damping: 0.0, drive: 0.0 });
        let v = 0.5 * h * q + off;
        for method in [Dla::midpoint(), Dla::midpoint().solved(Form::Multipliers)] {
            let mut state = State::new([q], [v], [false]);
            method.clone().step(&free, 0.0, h, &mut state).unwrap();
            prop_assert!((state.v()[0] + v).abs() <= 1e-14 && (state.q()[0] - q).abs() <= 1e-14);
        }
    }
}

/// At rest there is nothing to find, relative to nothing.
#[test]
fn rest_stays_rest() {
    let mut state = State::new([0.0], [0.0], [false]);
    let report =
        Dla::midpoint().step(&Free::from(Oscillator { damping: 0.1, drive: 0.0 }), 0.0, 0.1, &mut state).unwrap();
    assert_eq!((state.q(), state.v(), report.iterations), (&[0.0], &[0.0], 1));
    let mut state = State::new([1.0, 2.0, 3.0], [0.0; 3], [false; 3]);
    Dla::midpoint().step(&Three::from(Particle::FREE), 0.0, 0.1, &mut state).unwrap();
    assert_eq!((state.q(), state.v()), (&[1.0, 2.0, 3.0], &[0.0; 3]));
}
