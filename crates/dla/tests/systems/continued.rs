//! Steps that go on from the last one, against the same steps made without memory.

use crate::support::{ByHand, Four, Free, Three, ThreeTwo};
use crate::systems::models::{Disk, Hyperbolic, Kinetic, Oscillator, Particle, Pushed};
use dla::{Dla, Form, OneStep, State};
use lagrangian::{Constraint, Scalar, System};
use proptest::prelude::*;
use sleigh::{Sleigh, SleighState};

/// As many steps find predictions of every order, and derivatives that are renewed.
const STEPS: u32 = 40;

/// Every step of a run, with memory and without.
fn check<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: Dla,
    (q, v): ([f64; N], [f64; N]),
    (t, h): (f64, f64),
) -> Result<(), TestCaseError> {
    check_each(|_| system, method, (q, v), (t, h))
}

/// The same with a system for each step.
fn check_each<'a, Sys: System<N, M> + 'a, const N: usize, const M: usize>(
    system: impl Fn(u32) -> &'a Sys,
    method: Dla,
    (q, v): ([f64; N], [f64; N]),
    (t, h): (f64, f64),
) -> Result<(), TestCaseError> {
    let (mut going_on, mut state) = (method, State::new(q, v, [false; N]));
    for k in 0..STEPS {
        let (system, t, mut alone) = (system(k), t + f64::from(k) * h, state);
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
    check(system, Dla::midpoint(), place, at)?;
    check(system, Dla::midpoint().solved(Form::Multipliers), place, at)?;
    check(system, Dla::trapezoid(), place, at)
}

/// Numbers for the places and the velocities, time and length of a step, a damping.
type Numbers = ([f64; 4], [f64; 2], (f64, f64), f64);

fn numbers() -> impl Strategy<Value = Numbers> {
    let h = prop_oneof![0.001..0.05f64, -0.05..-0.001f64];
    (prop::array::uniform4(-1.0..1.0f64), prop::array::uniform2(-1.0..1.0f64), (-2.0..2.0f64, h), 0.0..0.5f64)
}

fn all_go_on((q, v, at, damping): Numbers) -> Result<(), TestCaseError> {
    let place = [q[0], q[1], q[2]];
    for kinetic in [Kinetic::Quadratic, Kinetic::Quartic] {
        let along = [v[0], v[1], q[1] * v[0]];
        check_all(&Three::from(Particle { kinetic, damping: 0.0 }), (place, along), at)?;
        check_all(&Three::from(Particle { kinetic, damping }), (place, along), at)?;
    }
    let relativistic = Particle { kinetic: Kinetic::Relativistic, damping: 0.0 };
    check_all(&Three::from(relativistic), (place, [0.5 * v[0], 0.5 * v[1], 0.5 * q[1] * v[0]]), at)?;
    check_all(&Three::from(Hyperbolic), (place, [v[0], v[1], q[1].sinh() * v[0]]), at)?;
    check_all(&Three::from(Pushed), (place, [v[0], v[1], q[1] * v[0] + at.0.cos()]), at)?;
    let (sin, cos) = q[3].sin_cos();
    check_all(&Four::from(Disk), (q, [0.7 * v[0] * cos, 0.7 * v[0] * sin, v[0], v[1]]), at)?;
    check_all(&Free::from(Oscillator { damping, drive: 0.3 }), ([q[0]], [v[0]]), at)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3, ..ProptestConfig::default() })]
    #[test]
    fn steps_that_go_on_are_those_without_memory(numbers in numbers()) {
        all_go_on(numbers)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
    #[test]
    #[ignore = "slow"]
    fn steps_that_go_on_are_those_without_memory_at_length(numbers in numbers()) {
        all_go_on(numbers)?;
    }
}

/// A wheel whose mass, moment of inertia and radius a user may change between steps.
#[derive(Clone, Copy)]
pub(crate) struct Wheel {
    mass: f64,
    inertia: f64,
    lead: f64,
}

impl System<3, 1> for Wheel {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass) + v[2] * v[2] * (0.5 * self.inertia) - q[0] * q[0] * 0.2
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, S::constant(-self.lead)]], [S::zero()])
    }
}

proptest! {
    /// What is remembered of one system says nothing of where a step of another ends, however little they differ.
    #[test]
    fn a_system_may_change_between_steps(
        change in prop_oneof![Just(0.0), 1e-12..1e-3f64, 1e-3..1.0f64], at in 6..30u32, which in 0..3usize, every in any::<bool>(),
    ) {
        // The lead alone asks for another velocity, which none but a projection could give.
        let wheel = Wheel { mass: 1.3, inertia: 0.8, lead: 0.0 };
        let wheels: Vec<Three> = (0..STEPS).map(|k| {
            let times = if every { f64::from(k) / 10.0 } else { f64::from(u8::from(k >= at)) };
            let by = 1.0 + change * times;
            Three::from(match which {
                0 => Wheel { mass: wheel.mass * by, ..wheel },
                1 => Wheel { inertia: wheel.inertia * by, ..wheel },
                _ => Wheel { mass: wheel.mass * by, inertia: wheel.inertia * by, ..wheel },
            })
        }).collect();
        let start = ([0.4, -0.1, 0.3], [0.3f64.cos(), 0.3f64.sin(), 0.7]);
        check_each(|k| &wheels[k as usize], Dla::midpoint(), start, (0.0, 0.01))?;
        let [skewed, wheel] = [Wheel { lead: change, ..wheel }, wheel].map(Three::from);
        let mixed = |k: u32| if k >= at { &skewed } else { &wheel };
        check_each(mixed, Dla::midpoint().solved(Form::Multipliers), start, (0.0, 0.01))?;
    }
}

/// Nearly all of the mass in one point: the mass matrix is singular but for rounding, though not on the constraint, which
/// the basis keeps and the elimination of multipliers would not.
#[test]
fn a_light_inertia_is_left_to_the_basis() {
    let start = SleighState { speed: -1.0, turn_rate: 0.3, ..SleighState::default() };
    for inertia in [1e-2, 1e-5, 1e-8, 1e-12] {
        let light = ByHand::from(Sleigh::new(1.0, inertia, 0.5).unwrap());
        let ((q, v), mut method) = (start.to_coordinates(), Dla::trapezoid());
        let mut state = State::new(q, v, light.angles());
        for k in 0..1000 {
            method.step(&light, f64::from(k) * 0.005, 0.005, &mut state).unwrap();
            let [slip] = lagrangian::constraint_residual(&light, 0.0, state.q(), state.v());
            assert!(slip.abs() <= 4.0 * f64::EPSILON, "I = {inertia:e}, step {k}: {slip:e}");
        }
    }
}

/// A blade that is towed along itself with the speed `3 sin^2(pi t)`, or held; it turns freely.
#[derive(Clone, Copy)]
pub(crate) struct Towed {
    held: bool,
}

impl System<3, 2> for Towed {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let ((sin, cos), zero) = (q[2].sin_cos(), S::zero());
        let stroke = (t * std::f64::consts::PI).sin();
        let speed = if self.held { zero } else { stroke * stroke * 3.0 };
        ([[sin, -cos, zero], [cos, sin, zero]], [zero, -speed])
    }
}

/// A search whose solution is zero in some unknowns ends, with memory and without; and motions that have stopped go on.
#[test]
fn what_comes_to_rest_beside_what_moves() {
    for (heading, turning) in (0..40).map(|k| (0.17 * f64::from(k), 0.3 * f64::from(k % 8))) {
        for h in [0.0625, 0.1, 0.03] {
            for form in [Form::Best, Form::Multipliers] {
                let mut state = State::new([0.0, 0.0, heading], [0.0, 0.0, turning], [false; 3]);
                let (mut method, steps) = (Dla::midpoint().solved(form), (3.0 / h) as u32);
                let mut reached = 0.0f64;
                for k in 0..steps {
                    let t = -0.5 + f64::from(k) * h;
                    let system = ThreeTwo::from(Towed { held: !(0.0..1.0).contains(&(t + 0.5 * h)) });
                    method.step(&system, t, h, &mut state).unwrap();
                    reached = reached.max(state.v()[0].hypot(state.v()[1]));
                }
                assert!(reached > 2.9 && state.v()[0].hypot(state.v()[1]) < 1e-30, "{:?}", state.v());
                assert!((state.v()[2] - turning).abs() <= 1e-13 * turning);
            }
        }
    }
}
