//! Steps that go on from the last one, against the same steps made without memory.

use crate::models::{Disk, Hyperbolic, Kinetic, Oscillator, Particle, Pushed};
use dla::{Dla, Form, OneStep, State};
use lagrangian::{DiscreteConstraint, DiscreteLagrangian, Symmetrised, System};
use proptest::prelude::*;

/// As many steps find predictions of every order, and derivatives that are renewed.
const STEPS: u32 = 40;

/// Every step of a run, with memory and without.
fn check<Sys, L, C, const N: usize, const M: usize>(
    system: &Sys,
    method: Dla<L, C>,
    (q, v): ([f64; N], [f64; N]),
    (t, h): (f64, f64),
) -> Result<(), TestCaseError>
where
    Sys: System<N, M>,
    L: DiscreteLagrangian<Sys, N, M> + Copy + 'static,
    C: DiscreteConstraint<Sys, N, M> + Copy + 'static,
{
    let (mut going_on, mut state) = (method, State::new(q, v, [false; N]));
    for k in 0..STEPS {
        let (t, mut alone) = (t + f64::from(k) * h, state);
        let report = method.clone().step(system, t, h, &mut alone).unwrap();
        let continued = going_on.step(system, t, h, &mut state).unwrap();
        for i in 0..N {
            // Solved differently, with condition numbers below 100; all is of order one.
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
            prop_assert!(near(state.q()[i], alone.q()[i]), "q {i} after step {k}: {} {}", state.q()[i], alone.q()[i]);
            prop_assert!(near(state.v()[i], alone.v()[i]), "v {i} after step {k}: {} {}", state.v()[i], alone.v()[i]);
        }
        for (a, b) in continued.impulses.iter().flatten().zip(report.impulses.iter().flatten()) {
            prop_assert!((a - b).abs() <= 1e-12, "impulses {a:e} and {b:e} of step {k}");
        }
    }
    Ok(())
}

fn check_all<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    place: ([f64; N], [f64; N]),
    at: (f64, f64),
) -> Result<(), TestCaseError> {
    let symmetrised = Symmetrised::new(0.2).unwrap();
    check(system, Dla::midpoint().solved(Form::General), place, at)?;
    check(system, Dla::midpoint().solved(Form::Multipliers), place, at)?;
    check(system, Dla::trapezoid(), place, at)?;
    check(system, Dla::new(symmetrised, symmetrised), place, at)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
    #[test]
    fn steps_that_go_on_are_those_without_memory(
        q in prop::array::uniform4(-1.0..1.0f64), v in prop::array::uniform2(-1.0..1.0f64), t in -2.0..2.0f64,
        h in prop_oneof![0.001..0.05f64, -0.05..-0.001f64], damping in 0.0..0.5f64,
    ) {
        let (at, place) = ((t, h), [q[0], q[1], q[2]]);
        for kinetic in [Kinetic::Quadratic, Kinetic::Quartic] {
            let along = [v[0], v[1], q[1] * v[0]];
            check_all(&Particle { kinetic, damping: 0.0 }, (place, along), at)?;
            check_all(&Particle { kinetic, damping }, (place, along), at)?;
        }
        let relativistic = Particle { kinetic: Kinetic::Relativistic, damping: 0.0 };
        check_all(&relativistic, (place, [0.5 * v[0], 0.5 * v[1], 0.5 * q[1] * v[0]]), at)?;
        check_all(&Hyperbolic, (place, [v[0], v[1], q[1].sinh() * v[0]]), at)?;
        check_all(&Pushed, (place, [v[0], v[1], q[1] * v[0] + t.cos()]), at)?;
        let (sin, cos) = q[3].sin_cos();
        check_all(&Disk, (q, [0.7 * v[0] * cos, 0.7 * v[0] * sin, v[0], v[1]]), at)?;
        check_all(&Oscillator { damping, drive: 0.3 }, ([q[0]], [v[0]]), at)?;
    }
}
