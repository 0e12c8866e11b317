//! Systems of up to sixty coordinates on threads with the stack that the methods count on, and no more.

mod fleet;
#[cfg(any(clippy, not(debug_assertions)))]
mod shapes;

use dla::{Dla, Energy, Hint, RunError, StackUse, StepError};
use fleet::{Ended, Fleet, STEPS, for_steps, on_stack};

pub(crate) use fleet::with_stack;

/// Methods that count what they take compare it with this; so no run may need more, the caller's part included.
const STACK: usize = StackUse::LIMIT;

/// A run that ends, on the constraint and no further from the motion than this.
fn ends(what: &str, run: Result<Ended, RunError>, error: f64) {
    let end = run.unwrap_or_else(|error| panic!("{what}: {error}"));
    println!("{what}: {end:?}");
    assert!(end.error <= error && end.slip <= 1e-13 && end.off <= 1e-14, "{what}: {end:?}");
}

/// A run that is refused before its first step, with the size of the system and what it would take.
fn is_too_large(what: &str, run: Result<Ended, RunError>, size: (usize, usize)) {
    let Err(RunError { step: 1, source, .. }) = run else { panic!("{what}: {run:?}") };
    let StepError::TooLarge { coordinates, constraints, bytes, limit } = source else { panic!("{what}: {source}") };
    assert_eq!((coordinates, constraints, limit), (size.0, size.1, StackUse::LIMIT));
    assert!(bytes > limit, "{what}: {bytes}");
    assert_eq!(source.hint(), Some(Hint::LessStack));
    let message = source.to_string();
    assert!(message.contains(&format!("{} coordinates and {} constraints", size.0, size.1)), "{message}");
}

/// Errors of the second order after twenty steps of a hundredth.
const SECOND: f64 = 2e-4;

#[test]
fn thirty_by_the_discrete_principle() {
    let steps = 8;
    let run = for_steps::<Fleet<30, true>, _, 30, 10>(steps, STACK, Dla::midpoint);
    ends("in the basis", run, SECOND * steps as f64 / STEPS as f64);
}

#[test]
fn by_methods_that_keep_the_energy() {
    is_too_large("order 2", on_stack::<Fleet<30, true>, _, 30, 10>(STACK, Energy::new::<1>), (30, 10));
}

/// The count grows with the system, whatever the method, and small systems are far below the limit.
#[test]
fn counts() {
    const USE: StackUse = StackUse { squares: 20, rows: 20 };
    assert!(USE.bytes::<3, 1>() < USE.bytes::<3, 2>() && USE.bytes::<3, 2>() < USE.bytes::<4, 2>());
    assert!(USE.bytes::<3, 1>() < StackUse::LIMIT / 16 && !USE.exceeds::<8, 5>());
    assert!(USE.exceeds::<100, 90>());
}
