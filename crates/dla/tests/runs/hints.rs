//! What each failure says is to be changed.

use approx::assert_relative_eq;
use dla::{ClosedStepError, Hint, History, NewtonError, RunError, Shorter, Stage, StepError};
use lagrangian::linear::Singular;
use lagrangian::{MotionError, ReducedError};
use std::f64::consts::PI;

const HALF: Option<Hint> = Some(Hint::ShorterStep { part: 0.5 });

fn history(sizes: &[f64]) -> History {
    let mut history = History::new();
    sizes.iter().for_each(|size| history.push(*size));
    history
}

fn newton(stage: Stage, source: NewtonError) -> Option<Hint> {
    let error = StepError::Newton { stage, source };
    assert_eq!((error.history(), error.iterations()), (Some(source.history()), Some(source.iterations())));
    error.hint()
}

#[test]
fn of_a_search() {
    let singular = |pivot: f64| NewtonError::Singular {
        iteration: 3,
        source: Singular { column: 1, pivot },
        history: history(&[0.5, 0.25]),
    };
    for pivot in [f64::NAN, f64::INFINITY] {
        assert_eq!(newton_hint(Stage::Projection, singular(pivot)), Some(Hint::Numbers));
    }
    assert_eq!(newton(Stage::Projection, singular(0.0)), Some(Hint::Constraints));
    assert_eq!(newton(Stage::Increment, singular(0.0)), HALF);

    let limit = |sizes: &[f64], correction: f64| NewtonError::IterationLimit {
        iterations: 9,
        correction,
        history: history(sizes),
    };
    // Fast until it was cut off; rounding; slow.
    assert_eq!(newton(Stage::Increment, limit(&[1.0, 0.2], 0.2)), Some(Hint::MoreIterations));
    assert_eq!(newton(Stage::Increment, limit(&[], 0.2)), Some(Hint::MoreIterations));
    for correction in [1e-9, -1e-9] {
        assert_eq!(newton(Stage::Increment, limit(&[1.0, 0.25], correction)), Some(Hint::LooserTolerance));
    }
    for correction in [1e-8, -1e-7, 0.2] {
        assert_eq!(newton(Stage::Increment, limit(&[1.0, 0.25], correction)), HALF);
    }
    assert_eq!(newton(Stage::Collocation, limit(&[1.0, 0.2], 1e-9)), HALF);

    let lost = |iteration| NewtonError::NotFinite { iteration, history: history(&[]) };
    assert_eq!(newton(Stage::Increment, lost(1)), Some(Hint::Numbers));
    assert_eq!(newton(Stage::Increment, lost(2)), HALF);
    let grows = NewtonError::Diverged { iteration: 4, correction: 2.0, before: 1.0, history: history(&[1.0, 2.0]) };
    assert_eq!(newton(Stage::Increment, grows), HALF);
    assert_eq!(grows.iterations(), 4);
}

/// A pivot that is no number is not equal to itself, nor is the error with it.
fn newton_hint(stage: Stage, source: NewtonError) -> Option<Hint> {
    StepError::Newton { stage, source }.hint()
}

#[test]
fn of_a_closed_step() {
    let none = |value: f64| StepError::Closed(ClosedStepError::NoSolution { quantity: "q", value, bound: 1.0 });
    let part = |value: f64| match none(value).hint() {
        Some(Hint::ShorterStep { part }) => part,
        other => panic!("{other:?}"),
    };
    // Half of what the bound allows, and not below a quarter of the step; an iterate below the bound says nothing.
    for (value, expected) in [(1.25, 0.4), (1.0, 0.5), (10.0, 0.25), (0.5, 0.5), (f64::NAN, 0.5), (f64::INFINITY, 0.5)]
    {
        assert_relative_eq!(part(value), expected, max_relative = 1e-15);
    }
    let limit = StepError::Closed(ClosedStepError::IterationLimit { iterations: 7, correction: 0.1 });
    assert_eq!((limit.hint(), limit.iterations(), limit.history()), (HALF, Some(7), None));
    let lost = StepError::Closed(ClosedStepError::NotFinite { quantity: "q" });
    assert_eq!((lost.hint(), lost.iterations()), (Some(Hint::Numbers), None));
}

#[test]
fn of_everything_else() {
    let motion = |pivot: f64| MotionError { time: 2.0, source: Singular { column: 0, pivot } };
    for (error, hint) in [
        (StepError::NotFinite, Some(Hint::Numbers)),
        (StepError::Overshoot { part: 0.3 }, Some(Hint::ShorterStep { part: 0.3 })),
        (StepError::Branch, HALF),
        (StepError::Stiff, HALF),
        (StepError::Turn { coordinate: 2, turn: 5.0, step: 0.1 }, Some(Hint::ShorterStep { part: 0.99 * PI / 5.0 })),
        (StepError::LeavesBasis, HALF),
        (StepError::LightMass { pivot: 1e-17 }, Some(Hint::OtherMethod)),
        (StepError::Energy { defect: 1.0, bound: 0.1 }, HALF),
        (StepError::Tolerance { tries: 5, step: 1e-9 }, HALF),
        (StepError::Unsupported { reason: "it cannot" }, Some(Hint::OtherMethod)),
        (StepError::Reduced(ReducedError::NoBasis), Some(Hint::OtherMethod)),
        (StepError::Jump { time: 1.5 }, Some(Hint::NodeAt { time: 1.5 })),
        (StepError::Motion(motion(0.0)), Some(Hint::Constraints)),
        (StepError::Motion(motion(f64::INFINITY)), Some(Hint::Numbers)),
        (StepError::Reduced(ReducedError::Motion(motion(0.0))), Some(Hint::Constraints)),
        (StepError::Reduced(ReducedError::Motion(motion(f64::INFINITY))), Some(Hint::Numbers)),
    ] {
        assert_eq!(error.hint(), hint, "{error}");
        assert_eq!(RunError::new(8, 0.7, error).hint(), hint);
        assert_eq!(RunError::new(8, 0.7, error).valid_steps(), 7);
        assert_eq!((error.history(), error.iterations()), (None, None));
    }
}

/// The outcome of shorter steps replaces the hint of the failure alone; a hint that is certain stays.
#[test]
fn of_steps_that_were_tried() {
    let hint = |source, shorter| RunError { shorter, ..RunError::new(1, 0.0, source) }.hint();
    for source in [StepError::Branch, StepError::Stiff] {
        assert_eq!(hint(source, Shorter::Succeeds(0.125)), Some(Hint::ShorterStep { part: 0.125 }));
        assert_eq!(hint(source, Shorter::Fails(1e-3)), Some(Hint::NoShorterStep { part: 1e-3 }));
        assert_eq!(hint(source, Shorter::Untried), HALF);
    }
    assert_eq!(hint(StepError::NotFinite, Shorter::Fails(1e-3)), Some(Hint::Numbers));
}

#[test]
fn a_hint_says_it() {
    for (hint, words) in [
        (Hint::ShorterStep { part: 0.25 }, "0.25"),
        (Hint::NoShorterStep { part: 0.25 }, "0.25"),
        (Hint::MoreIterations, "more iterations"),
        (Hint::LooserTolerance, "fewer digits"),
        (Hint::Constraints, "constraint rows"),
        (Hint::OtherMethod, "another method"),
        (Hint::NodeAt { time: 1.5 }, "t = 1.5 s"),
        (Hint::Numbers, "undefined"),
        (Hint::Corner, "Scalar::length"),
    ] {
        assert!(hint.to_string().contains(words), "{hint}");
    }
}
