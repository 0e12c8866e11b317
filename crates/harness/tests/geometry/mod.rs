//! The geometry of the sleigh and of other systems: brackets, phases, steady motions, parking.

mod attitude;
mod brackets;
mod equilibria;
mod exchange;
mod gaits;
mod parking;
mod phase;

use dla::{AnyState, Observer, PiecewiseMechanics, Schedule, State, Subject};
use harness::{Method, Run};

/// Runs a method on a system that may jump.
fn run<const N: usize, const M: usize>(
    system: &impl PiecewiseMechanics<N, M>,
    method: &str,
    (step, steps): (f64, u64),
    state: &mut State<N>,
    observer: &mut dyn Observer,
) {
    let (method, schedule) = (Method::named(method, None).unwrap(), Schedule { t0: 0.0, step, steps });
    let mut moved = AnyState::from(*state);
    Run::of(&Subject::from(system), &method).observe(observer).moves(&schedule, &mut moved).unwrap();
    *state = *moved.typed().unwrap();
}
