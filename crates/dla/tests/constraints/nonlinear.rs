//! A constraint that is not affine in the velocities.

use crate::constraints::tools::{assert_order, distance, end, misses};
use crate::support::Two;
use dla::{Composition, Dla, Energy, Gauss, Gni, Lobatto, OneStep, State, StepError};
use test_systems::{IsokineticParticle, Model};

fn particle() -> IsokineticParticle {
    IsokineticParticle::new(1.3, 0.8, -0.9)
}

fn errors<Method: OneStep<2, 1> + Clone>(method: &Method) -> [f64; 4] {
    let particle = particle();
    [20, 40, 80, 160].map(|steps| {
        let end = end(&Two::from(particle), &mut method.clone(), particle.start(), 2.0 / steps as f64, steps);
        distance(&end, &particle.exact(2.0).unwrap())
    })
}

#[test]
fn orders_by_the_closed_form() {
    assert_order("dla", errors(&Dla::midpoint()), 2.0);
    assert_order("dla4", errors(&Composition::suzuki4(Dla::midpoint())), 4.0);
}

/// The kinetic energy is the constraint, and holds to round-off; the energy does not.
fn speed_holds(steps: u64) {
    let particle = particle();
    let [_, slip] = misses(&Two::from(particle), &mut Dla::midpoint(), particle.start(), 0.05, steps);
    println!("isokinetic: {slip:e}");
    // (|v|^2 - c^2)/(2 c) of speeds below one: two roundings of the squares.
    assert!(slip <= 4.0 * f64::EPSILON, "{slip:e}");
    let there = end(&Two::from(particle), &mut Dla::midpoint(), particle.start(), 0.05, 20);
    let (q, v) = particle.start();
    let energy = |q, v| lagrangian::energy(&particle, 0.0, q, v);
    assert!((energy(there.q(), there.v()) - energy(&q, &v)).abs() > 0.1);
}

#[test]
fn the_speed_holds() {
    speed_holds(10_000);
}

#[test]
#[ignore = "slow"]
fn the_speed_holds_in_full() {
    speed_holds(100_000);
}

#[test]
fn the_step_is_symmetric() {
    let particle = particle();
    let (q, v) = particle.start();
    let there = end(&Two::from(particle), &mut Dla::midpoint(), (q, v), 0.1, 20);
    let here = end(&Two::from(particle), &mut Dla::midpoint(), (*there.q(), *there.reversed().v()), 0.1, 20);
    // The direction grows away from the force at exp(0.9 t) on the way back.
    assert!(distance(&here.reversed(), &(q, v)) <= 1e-13);
}

/// `phi_v = 0` where the particle rests: no direction for the reaction.
#[test]
fn a_particle_at_rest_is_an_error() {
    let mut state = State::new([0.0; 2], [0.0; 2], [false; 2]);
    let outcome = Dla::midpoint().step(&Two::from(particle()), 0.0, 0.1, &mut state);
    let Err(StepError::Dependent(error)) = outcome else { panic!("{outcome:?}") };
    assert!(error.to_string().starts_with("row 1 of the constraint vanishes"), "{error}");
}

#[test]
fn methods_for_affine_constraints_refuse() {
    let particle = particle();
    let (q, v) = particle.start();
    let refused = |method: &mut dyn OneStep<2, 1>| {
        let mut state = State::new(q, v, [false; 2]);
        let outcome = method.step(&Two::from(particle), 0.0, 0.1, &mut state);
        assert!(matches!(outcome, Err(StepError::Unsupported { .. })), "{outcome:?}");
    };
    refused(&mut Lobatto::<3>::new());
    refused(&mut Gauss::new::<2>());
    refused(&mut Energy::new::<1>());
    refused(&mut Gni::default());
}
