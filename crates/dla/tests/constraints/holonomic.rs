//! Constraints on positions beside those on velocities.

use crate::constraints::tools::{Place, assert_order, distance, end, misses};
use crate::large::with_stack;
use crate::support::{ThreeTwo, Two};
use dla::{Composition, Dla, Energy, Form, Gauss, Gni, Lobatto, OneStep, State, StepError};
use lagrangian::{Constraint, Scalar, System};
use test_systems::{CompoundPendulum, Model, SleighOnArm};

fn sleigh() -> SleighOnArm {
    SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0)
}

fn pendulum() -> CompoundPendulum {
    CompoundPendulum::new(1.3, 0.4, 0.9, 9.81)
}

/// Both to 1e-13 over any number of steps; the pendulum whose hinge is given by its velocity alone shows that the positions are held.
fn positions_and_velocities_hold(steps: u64) {
    let sleigh = sleigh();
    let [g, slip] = misses(&ThreeTwo::from(sleigh), &mut Dla::midpoint(), sleigh.start(), 0.02, steps);
    println!("sleigh on an arm: g {g:e}, slip {slip:e}");
    assert!(g <= 1e-13 && slip <= 1e-13);

    let pendulum = pendulum();
    let [g, slip] = misses(&ThreeTwo::from(pendulum), &mut Dla::midpoint(), pendulum.start(), 0.02, steps);
    println!("pendulum: g {g:e}, slip {slip:e}");
    assert!(g <= 1e-13 && slip <= 1e-13);

    let pseudo = pendulum.pseudo_holonomic();
    let drifted = end(&ThreeTwo::from(pseudo), &mut Dla::midpoint(), pseudo.start(), 0.02, 1000);
    let [x, y] = pseudo.hinge(drifted.q());
    assert!(x.hypot(y) > 1e-5, "{x:e}, {y:e}");
}

#[test]
fn positions_and_velocities_hold_for_a_million_steps() {
    positions_and_velocities_hold(2000);
}

#[test]
#[ignore = "slow"]
fn positions_and_velocities_hold_for_a_million_steps_at_length() {
    positions_and_velocities_hold(1_000_000);
}

/// Far from the origin and at steps so short that a move is little more than the rounding of the place.
#[test]
fn positions_hold_at_any_step() {
    let pendulum = pendulum();
    for step in [0.1, 1e-3, 1e-6, 1e-9] {
        let [g, slip] = misses(&ThreeTwo::from(pendulum), &mut Dla::midpoint(), pendulum.start(), step, 1000);
        println!("h = {step:e}: g {g:e}, slip {slip:e}");
        assert!(g <= 1e-14 && slip <= 1e-14, "h = {step:e}: g {g:e}, slip {slip:e}");
    }
}

/// Errors at the time 1 with `counts` steps, against the known place.
fn errors<Method>(method: &Method, counts: [u64; 4], reference: &Place<3>) -> [f64; 4]
where
    Method: OneStep<3, 2> + Clone,
{
    let sleigh = sleigh();
    counts.map(|steps| {
        let [g, slip] = misses(&ThreeTwo::from(sleigh), &mut method.clone(), sleigh.start(), 1.0 / steps as f64, steps);
        assert!(g <= 1e-14 && slip <= 1e-14, "g {g:e}, slip {slip:e}");
        distance(
            &end(&ThreeTwo::from(sleigh), &mut method.clone(), sleigh.start(), 1.0 / steps as f64, steps),
            reference,
        )
    })
}

/// Against Lobatto's method of order 4, whose error is far smaller with the same steps.
fn orders(counts: [u64; 4], steps: u64) {
    let sleigh = sleigh();
    let reference = end(&ThreeTwo::from(sleigh), &mut Lobatto::<3>::new(), sleigh.start(), 1.0 / steps as f64, steps);
    let reference = (reference.unwrapped(), *reference.v());
    assert_order("dla", errors(&Dla::midpoint(), counts, &reference), 2.0);
    let multipliers = Dla::midpoint().solved(Form::Multipliers);
    assert_order("dla, multipliers", errors(&multipliers, counts, &reference), 2.0);
    assert_order("dla4", errors(&Composition::suzuki4(Dla::midpoint()), counts, &reference), 4.0);
    assert_order("lobatto3", errors(&Lobatto::<3>::new(), counts, &reference), 4.0);
    let gauss = with_stack(2 << 20, move || errors(&Gauss::new::<2>(), counts, &reference));
    assert_order("gauss4", gauss, 4.0);
}

/// The reference is a five-hundredth of the last error of fourth order off.
#[test]
fn orders_beside_constrained_positions() {
    orders([10, 20, 40, 80], 400);
}

/// The reference is off by rounding.
#[test]
#[ignore = "slow"]
fn orders_beside_constrained_positions_in_full() {
    orders([20, 40, 80, 160], 4000);
}

/// How far from its start a run there and back ends.
fn back<Method: OneStep<3, 2>>(mut method: Method) -> f64 {
    let sleigh = sleigh();
    let there = end(&ThreeTwo::from(sleigh), &mut method, sleigh.start(), 0.05, 100);
    let here = end(&ThreeTwo::from(sleigh), &mut method, (*there.q(), *there.reversed().v()), 0.05, 100);
    let (q, v) = sleigh.start();
    let turned = State::new(*here.q(), here.v().map(|v| -v), [false; 3]);
    distance(&turned, &(State::new(q, v, [false, false, true]).unwrapped(), v))
}

/// Symmetric methods return; the projection of the positions costs Gauss collocation that.
#[test]
fn the_step_is_symmetric() {
    let gauss = with_stack(2 << 20, || back(Gauss::new::<2>()));
    let [dla, lobatto] = [back(Dla::midpoint()), back(Lobatto::<3>::new())];
    println!("there and back: dla {dla:e}, lobatto3 {lobatto:e}, gauss4 {gauss:e}");
    assert!(dla <= 1e-11 && lobatto <= 1e-11);
    assert!(gauss > 1e-10, "no longer a control: {gauss:e}");
}

/// What cannot keep positions says so before its first step, and does the pseudo-holonomic pendulum.
#[test]
fn methods_that_would_drift_refuse() {
    let (q, v) = pendulum().start();
    let [pendulum, pseudo] = [pendulum(), pendulum().pseudo_holonomic()].map(ThreeTwo::from);
    let start = State::new(q, v, [false, false, true]);
    let check = |method: &mut dyn OneStep<3, 2>| {
        let mut state = start;
        let outcome = method.step(&pendulum, 0.0, 0.01, &mut state);
        assert!(matches!(outcome, Err(StepError::Unsupported { .. })), "{outcome:?}");
        assert_eq!(state, start);
        method.step(&pseudo, 0.0, 0.01, &mut state).unwrap();
    };
    check(&mut Energy::new::<1>());
    check(&mut Gni::default());
}

/// A particle on the line `y = sin t`, which moves.
#[derive(Clone, Copy)]
pub(crate) struct Lift;

impl System<2, 1> for Lift {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5 - q[1]
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        lagrangian::position_rows(self, t, q)
    }
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; 2]) -> Option<[Option<S>; 1]> {
        Some([Some(q[1] - t.sin())])
    }
}

/// A node is on the constraint of its own time.
#[test]
fn positions_that_move() {
    let mut state = State::new([0.0, 0.7f64.sin()], [0.4, 0.7f64.cos()], [false; 2]);
    for k in 0..20 {
        let t = 0.7 + 0.1 * f64::from(k);
        OneStep::<2, 1>::step(&mut Dla::midpoint(), &Two::from(Lift), t, 0.1, &mut state).unwrap();
        let t = t + 0.1;
        approx::assert_abs_diff_eq!(&state.q()[..], &[0.4 * (t - 0.7), t.sin()][..], epsilon = 8.0 * f64::EPSILON);
        approx::assert_abs_diff_eq!(&state.v()[..], &[0.4, t.cos()][..], epsilon = 8.0 * f64::EPSILON);
    }
}
