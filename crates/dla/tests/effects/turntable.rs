//! The sleigh on a turning plane.

use crate::effects::balance::Balance;
use crate::effects::tools::{Laden, laden, moving, run, sleigh, steps};
use dla::{Dla, Energy, OneStep, State, StepError, onto_constraint};
use lagrangian::System;
use sleigh::{Guided, Sleigh};

fn table(rate: f64) -> Laden<Guided<0>> {
    laden(Guided::turntable(sleigh(), rate).unwrap(), vec![])
}

/// The place after `count` steps, and the largest residual of the constraint.
fn on_the_constraint(count: u64) -> (State<3>, Balance) {
    let mut seen = Balance::default();
    let end = run(&table(0.35), &mut Dla::midpoint(), &steps(0.02, count), moving().to_coordinates(), &mut seen);
    let (q, v) = (end.unwrapped(), end.v());
    println!("turntable: slip {:.1e}, at {q:?} with {v:?}", seen.slip);
    // b, of a few digits less than the place far from the axis, is what the velocity answers to its own rounding.
    let speed = f64::hypot(v[0], v[1]).max(2.0);
    assert!(seen.slip < 8.0 * f64::EPSILON * speed, "{seen:?}");
    // The control: it is not the plane at rest.
    let still = State::new(q, *v, [false, false, true]);
    assert!(table(0.0).constraint(0.0, still.q()).1[0] == 0.0 && table(0.35).constraint(0.0, still.q()).1[0] != 0.0);
    (end, seen)
}

#[test]
fn the_affine_constraint_holds_to_rounding() {
    let (_, seen) = on_the_constraint(5000);
    // The control: the energy is not kept.
    assert!(seen.unpaid > 0.05, "{seen:?}");
}

/// It is flung outward in the end.
#[test]
#[ignore = "slow"]
fn the_affine_constraint_holds_to_rounding_in_full() {
    let (end, seen) = on_the_constraint(200_000);
    let [x, y, _] = end.unwrapped();
    assert!(f64::hypot(x, y) > 100.0 && seen.unpaid > 0.1, "{seen:?}");
}

#[test]
fn the_energy_methods_refuse_it() {
    let system = table(0.35);
    let (q, v) = moving().to_coordinates();
    let mut state = State::new(q, v, system.angles());
    onto_constraint(&system, 0.0, &mut state).unwrap();
    let before = state;
    let refused = Energy::new::<2>().step(&system, 0.0, 0.05, &mut state);
    assert!(matches!(refused, Err(StepError::Unsupported { .. })), "{refused:?}");
    assert!(refused.unwrap_err().to_string().contains("b = 0") && state == before);
    // The control: the sleigh on a plane at rest it takes.
    let still: Laden<Sleigh> = laden(sleigh(), vec![]);
    assert!(Energy::new::<2>().step(&still, 0.0, 0.05, &mut State::new(q, v, still.angles())).is_ok());
}
