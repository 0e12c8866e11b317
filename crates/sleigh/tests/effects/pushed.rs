//! The step in a potential against its own equations, term by term, and where it leaves the step to others.

use approx::assert_abs_diff_eq;
use lagrangian::{ClosedStep, Effect, Scalar, Slope, Start, System, With};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, EggCrate};
use sleigh::{Sleigh, SleighState};

/// The potential `-F x cos t`, on the blade.
#[derive(Debug, Clone, Copy)]
struct Tide(f64);

impl Effect<Sleigh, 3> for Tide {
    fn lagrangian<S: Scalar>(&self, _body: &Sleigh, t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        Some(q[0] * t.cos() * self.0)
    }
    fn slope<S: Scalar>(&self, _body: &Sleigh, t: S, _q: &[S; 3]) -> Slope<S, 3> {
        Slope::Known([t.cos() * self.0, S::zero(), S::zero()])
    }
}

type Laden = With<Sleigh, (Bowl, EggCrate, Tide)>;

/// The time at which steps begin (s).
const TIME: f64 = 0.7;

fn laden(m: f64, i: f64, a: f64, stiffness: [f64; 2], height: f64) -> Laden {
    let bowl = Bowl::new(stiffness, [0.4, -0.3]).unwrap();
    let effects = (bowl, EggCrate::new(height, [1.0, 1.3]).unwrap(), Tide(height));
    With { body: Sleigh::new(m, i, a).unwrap(), effects }
}

fn step<Sys: System<3, 1>>(
    system: &Sys,
    h: f64,
    (heading, u, omega): (f64, f64, f64),
    expected: Option<[f64; 3]>,
) -> Option<ClosedStep<3, 1>> {
    let (q, v) = SleighState { x: 0.3, y: -0.2, heading, speed: u, turn_rate: omega }.to_coordinates();
    system.closed_step(TIME, h, &Start { expected, ..Start::new(&q, &v) }).map(Result::unwrap)
}

proptest! {
    #[test]
    fn the_equations_of_the_step_hold(
        (m, i, a) in (0.3..3.0, 0.3..3.0, -0.8..0.8),
        (kx, ky, height) in (-0.5..0.5, -0.5..0.5, -0.3..0.3),
        (heading, u0, omega0) in (-3.0..3.0, -2.0..2.0, -2.0..2.0),
        h in prop_oneof![-0.1..-0.01, 0.01..0.1],
        wrong in -1e-3..1e-3,
    ) {
        let system = laden(m, i, a, [kx, ky], height);
        let made = step(&system, h, (heading, u0, omega0), None).expect("a short step");
        let (sleigh, [dx, dy, turn]) = (system.body, made.increment);
        let (w, d, k) = (turn / h, 0.5 * turn, 0.5 * h * sleigh.spin_gain());
        let (sin, cos) = (heading + d).sin_cos();
        let chord = (dx * cos + dy * sin) / h;
        let middle = [0.3 + 0.5 * dx, -0.2 + 0.5 * dy, heading + d];
        let Slope::Known([fx, fy, torque]) = system.effects.slope(&sleigh, TIME + 0.5 * h, &middle) else {
            return Err(TestCaseError::fail("the slopes are known by hand"));
        };
        let (along, across) = (cos * fx + sin * fy, cos * fy - sin * fx);
        let (of_mass, of_inertia) = (0.5 * h / m, 0.5 * h / sleigh.pivot_inertia());
        let [u1, omega1, _] = made.xi;
        // Terms below ten, and their rounding divided by a determinant that is near one.
        let bound = 1e-13;
        assert_abs_diff_eq!(dy * cos - dx * sin, 0.0, epsilon = 1e-15);
        let turned = a * w * d.sin();
        let pushed = |side: f64| of_mass * (along * d.cos() + side * across * d.sin());
        assert_abs_diff_eq!(chord * d.cos() - turned, u0 + pushed(-1.0), epsilon = bound);
        assert_abs_diff_eq!(chord * d.cos() + turned, u1 - pushed(1.0), epsilon = bound);
        assert_abs_diff_eq!(w * (1.0 + k * chord), omega0 + of_inertia * torque, epsilon = bound);
        assert_abs_diff_eq!(w * (1.0 - k * chord), omega1 - of_inertia * torque, epsilon = bound);

        // Whatever is expected, right, about right, or far off.
        for expected in [made.increment, made.increment.map(|d| d * (1.0 + wrong)), made.increment.map(|d| 3.0 * d + 0.1)] {
            let again = step(&system, h, (heading, u0, omega0), Some(expected)).expect("the same step");
            for i in 0..3 {
                assert_abs_diff_eq!(again.increment[i], made.increment[i], epsilon = bound);
                assert_abs_diff_eq!(again.velocity[i], made.velocity[i], epsilon = bound);
            }
            for end in 0..2 {
                assert_abs_diff_eq!(again.impulses[end][0], made.impulses[end][0], epsilon = 10.0 * bound);
            }
        }
    }
}

/// Newton's correction leaves an error of second order: from one of 1e-8 it leaves rounding, and no other correction is made.
#[test]
fn one_correction_is_enough_where_the_end_is_nearly_known() {
    let mut corrections = Vec::new();
    for k in 0..100 {
        let swing = |factor: f64| (factor * f64::from(k)).sin();
        let system = laden(1.3, 0.8, 0.4, [swing(1.1), swing(1.7)], 0.5 * swing(2.3));
        // The velocities change by less than an eighth: what is expected is believed.
        let start = (3.0 * swing(0.7), 1.5 + 0.5 * swing(1.3), swing(1.9));
        let made = step(&system, 0.1, start, None).expect("a short step");
        let [dx, dy, turn] = made.increment;
        let nearly = [dx * (1.0 + 1e-8), dy * (1.0 + 1e-8), turn * (1.0 - 1e-8)];
        corrections.push(step(&system, 0.1, start, Some(nearly)).expect("the same step").iterations);
    }
    println!("{corrections:?}");
    assert!(corrections.iter().all(|n| *n == 1), "{corrections:?}");
}

/// Without a potential it would be the closed map's; a small one changes it little.
#[test]
fn a_vanishing_potential_leaves_the_free_step() {
    let at = (0.4, -1.0, 0.7);
    let free = step(&Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.05, at, None).unwrap();
    let none = step(&laden(1.3, 0.8, 0.4, [0.0; 2], 0.0), 0.05, at, None).unwrap();
    let some = step(&laden(1.3, 0.8, 0.4, [1e-3; 2], 0.0), 0.05, at, None).unwrap();
    for i in 0..3 {
        assert_abs_diff_eq!(none.increment[i], free.increment[i], epsilon = 1e-15);
        assert_abs_diff_eq!(none.velocity[i], free.velocity[i], epsilon = 1e-15);
    }
    assert!((some.velocity[0] - free.velocity[0]).abs() > 1e-6, "the control");
}

#[test]
fn what_it_does_not_know_is_left_to_the_general_step() {
    let (at, body) = ((0.4, -1.0, 0.7), Sleigh::new(1.3, 0.8, 0.4).unwrap());
    let bowl = || Bowl::new([0.1; 2], [0.0; 2]).unwrap();
    assert!(step(&With { body, effects: (bowl(),) }, 0.05, at, None).is_some());
    // A force that depends on the velocity.
    let drag = Drag::new(0.1, 0.1).unwrap();
    assert!(step(&With { body, effects: (bowl(), drag) }, 0.05, at, None).is_none());
    // A blade that turns by more than a radian in the step; one that would turn by a right angle in half of it.
    for omega in [2.5, 8.0] {
        assert!(step(&With { body, effects: (bowl(),) }, 0.5, (0.4, -1.0, omega), None).is_none());
    }
    // A potential whose force changes by more than itself within the step.
    let steep = Bowl::new([1e5; 2], [0.0; 2]).unwrap();
    assert!(step(&With { body, effects: (steep,) }, 0.5, at, None).is_none());
}
