use crate::runs::{backward, state_of, system};
use crate::support::One;
use approx::assert_relative_eq;
use dla::{Dla, OneStep, State, StepError, Substepping};
use lagrangian::{Constraint, Scalar, System, constraint_residual};
use sleigh::SleighState;

/// A spin for which a step of 2 s turns the blade by more than half a turn, and one of half a second does not.
fn spinning() -> State<3> {
    state_of(&SleighState { turn_rate: 2.5, ..backward() })
}

#[test]
fn a_step_that_is_too_long_is_made_of_shorter_ones() {
    let (sleigh, start) = (system(), spinning());
    let mut alone = start;
    let error = OneStep::<3, 1>::step(&mut Dla::midpoint(), &sleigh, 0.0, 2.0, &mut alone).unwrap_err();
    assert_eq!(alone, start, "{error}");

    let (mut state, mut method) = (start, Substepping::new(Dla::midpoint(), 8));
    let report = OneStep::<3, 1>::step(&mut method, &sleigh, 0.0, 2.0, &mut state).unwrap();
    assert_eq!(method.divided(), 1);
    assert!(report.iterations > 1);
    let residual = constraint_residual(&sleigh, 2.0, state.q(), state.v());
    assert!(residual[0].abs() < 1e-15);

    // The parts are as long as they can be: halves, quarters, .., and no two of them make one that would do.
    let mut by_hand = start;
    let (mut done, mut part) = (0.0, 0.5);
    while done < 1.0 {
        let mut tried = by_hand;
        if OneStep::<3, 1>::step(&mut Dla::midpoint(), &sleigh, 2.0 * done, 2.0 * part, &mut tried).is_err() {
            part *= 0.5;
            continue;
        }
        (by_hand, done) = (tried, done + part);
        if part < 0.5 && (done / (2.0 * part)).fract() == 0.0 {
            part *= 2.0;
        }
    }
    assert_eq!(state, by_hand);
}

#[test]
fn a_step_that_does_is_left_alone() {
    let (sleigh, mut method, mut whole) = (system(), Substepping::new(Dla::midpoint(), 8), Dla::midpoint());
    let (mut divided, mut plain) = (state_of(&backward()), state_of(&backward()));
    for k in 0..100 {
        let t = 0.05 * f64::from(k);
        OneStep::<3, 1>::step(&mut method, &sleigh, t, 0.05, &mut divided).unwrap();
        OneStep::<3, 1>::step(&mut whole, &sleigh, t, 0.05, &mut plain).unwrap();
    }
    assert_eq!((divided, method.divided()), (plain, 0));
}

/// A free particle on a line that no velocity is allowed to leave or to keep.
#[derive(Clone, Copy)]
pub(crate) struct Contradiction;

impl System<1, 1> for Contradiction {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 1> {
        ([[S::zero()]], [S::constant(1.0)])
    }
}

#[test]
fn what_no_shorter_step_mends_and_what_is_not_asked_for_stays_an_error() {
    let (sleigh, mut state) = (system(), spinning());
    for halvings in [0, 1] {
        let mut method = Substepping::new(Dla::midpoint(), halvings);
        let outcome = OneStep::<3, 1>::step(&mut method, &sleigh, 0.0, 8.0, &mut state);
        assert!(outcome.is_err() && method.divided() == 0 && state == spinning());
    }
    let mut still = State::new([0.0], [1.0], [false]);
    let plain =
        OneStep::<1, 1>::step(&mut Dla::midpoint(), &One::from(Contradiction), 0.0, 0.1, &mut still).unwrap_err();
    let mut method = Substepping::new(Dla::midpoint(), 20);
    let error: StepError =
        OneStep::<1, 1>::step(&mut method, &One::from(Contradiction), 0.0, 0.1, &mut still).unwrap_err();
    assert_eq!(error, plain);
}

/// The search begins nearer to its solution where the last step left the acceleration.
#[test]
fn a_step_is_predicted_from_the_last() {
    let (sleigh, mut method) = (system(), Dla::midpoint());
    let (mut carried, mut iterations) = (state_of(&backward()), [0, 0]);
    for k in 0..200 {
        let t = 0.05 * f64::from(k);
        // The same place without what the last step left.
        let mut fresh = State::new(*carried.q(), *carried.v(), [false, false, true]);
        let told = |state: &mut State<3>, method: &mut _| {
            let report = OneStep::<3, 1>::step(method, &sleigh, t, 0.05, state).unwrap();
            report.iterations
        };
        iterations[1] += told(&mut fresh, &mut method);
        iterations[0] += told(&mut carried, &mut method);
        // Both to the rounding of the search, of places a few metres off.
        for i in 0..3 {
            assert_relative_eq!(carried.v()[i], fresh.v()[i], epsilon = 1e-14);
        }
    }
    assert!(iterations[0] < iterations[1], "{iterations:?}");
    assert_eq!(carried.reversed().acceleration(), carried.acceleration(), "the same with time reversed");
}
