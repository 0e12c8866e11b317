//! Steps that have no solution fail with an error value, and what was reached before stays.

use crate::common::{midpoint_forms, sleigh, state_of};
use dla::{ClosedStepError, Dla, NewtonError, OneStep, Schedule, Stage, StepError, Trajectory, drive};
use sleigh::{ClosedMap, SleighState};

fn start(speed: f64, turn_rate: f64) -> SleighState {
    SleighState { speed, turn_rate, ..SleighState::default() }
}

#[test]
fn a_step_that_turns_too_far_is_refused() {
    let sleigh = sleigh();
    for turn_rate in [4.8, 100.0, -1e200] {
        let mut state = state_of(&sleigh, &start(0.1, turn_rate));
        let before = state;
        let error = ClosedMap::of(sleigh).step(&sleigh, 0.0, 1.0, &mut state).unwrap_err();
        assert!(matches!(error, StepError::Closed(ClosedStepError::NoSolution { .. })), "{turn_rate}: {error}");
        assert_eq!(state, before, "a failed step leaves the state");
    }
}

/// At `h c u = -2` the equations of straight motion are singular: before it a solution, beyond it none.
#[test]
fn the_singular_step_is_refused() {
    let sleigh = sleigh();
    let critical = 2.0 / sleigh.spin_gain();
    let step = |h: f64| {
        let mut state = state_of(&sleigh, &start(-1.0, 1e-3));
        ClosedMap::of(sleigh).step(&sleigh, 0.0, h, &mut state)
    };
    assert!(step(0.9 * critical).is_ok());
    for h in [critical, 1.1 * critical, 10.0 * critical] {
        let error = step(h).unwrap_err();
        assert!(matches!(error, StepError::Closed(_)), "h = {h}: {error}");
    }
}

#[test]
fn numbers_that_overflow_are_reported() {
    let sleigh = sleigh();
    for (speed, turn_rate) in [(1e308, 1e-3), (f64::INFINITY, 0.1), (f64::NAN, 0.1), (0.1, f64::NAN), (-1e200, 1e-3)] {
        for (name, mut method) in midpoint_forms(sleigh) {
            let mut state = state_of(&sleigh, &start(speed, turn_rate));
            let outcome = method.step(&sleigh, 0.0, 0.05, &mut state);
            let finite = state.v().iter().all(|v| v.is_finite());
            assert!(outcome.is_err() || finite, "{name}, u = {speed}, omega = {turn_rate}: {state:?}");
        }
    }
}

/// The general form says which equations failed, and how.
#[test]
fn the_general_form_reports_its_newton() {
    let sleigh = sleigh();
    let mut method = Dla::midpoint();
    method.newton.max_iterations = 1;
    let mut state = state_of(&sleigh, &start(-1.0, 0.5));
    let error = method.step(&sleigh, 0.0, 0.3, &mut state).unwrap_err();
    let StepError::Newton { stage: Stage::Increment, source: NewtonError::IterationLimit { iterations: 1, .. } } =
        error
    else {
        panic!("{error}");
    };
    assert!(error.to_string().contains("discrete Lagrange-d'Alembert equations"), "{error}");
}

/// The trajectory is kept up to the step that failed, which the error names.
#[test]
fn a_failed_run_keeps_its_trajectory() {
    let sleigh = sleigh();
    // Backward with a long step: the spin grows until half a turn a step is too much.
    let h = 2.9;
    let mut state = state_of(&sleigh, &start(-1.5, 1e-3));
    let mut trajectory = Trajectory::every(3);
    let schedule = Schedule { t0: 1.0, step: h, steps: 1000 };
    let mut method = Dla::midpoint();
    let error = drive(&sleigh, &mut method, &schedule, &mut state, &mut trajectory).unwrap_err();
    println!("{error}");
    let last = trajectory.nodes().last().unwrap();
    assert!(error.step > 1, "{error}");
    assert_eq!(last.k, error.step - 1, "the last good node is kept");
    assert_eq!(last.t.to_bits(), schedule.time(last.k).to_bits());
    assert_eq!(error.time.to_bits(), last.t.to_bits());
    assert_eq!(last.q, state.unwrapped());
    assert!(trajectory.nodes().iter().all(|node| node.energy.is_finite() && node.constraint < 1e-12));
}
