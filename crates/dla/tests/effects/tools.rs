//! Runs of systems that may jump.

use dla::{
    AnyState, Observer, OneStep, Piece, PiecewiseMechanics, Schedule, State, Subject, drive_part, piece_by_piece,
};
use lagrangian::With;
use scene::{AnyEffect, EffectList};
use sleigh::{Sleigh, SleighState};

/// Runs piece by piece, as a command does.
pub fn run<Sys: PiecewiseMechanics<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut dyn OneStep<N, M>,
    schedule: &Schedule,
    (q, v): ([f64; N], [f64; N]),
    mut observer: impl Observer,
) -> State<N> {
    let mut state = AnyState::from(State::new(q, v, system.angles()));
    piece_by_piece(0, &Subject::from(system), schedule, &mut state, |_, Piece { steps, schedule }, state| {
        let piece = system.smooth_piece(schedule.middle(&steps));
        drive_part(&*piece, method, &schedule, steps, state.typed_mut().unwrap(), &mut observer)
    })
    .unwrap();
    *state.typed().unwrap()
}

/// A body of a scene with a list of effects: the type of all runs here, so that each body is compiled once.
pub type Laden<B> = With<B, EffectList>;

pub fn laden<B>(body: B, effects: Vec<AnyEffect>) -> Laden<B> {
    With { body, effects: effects.into() }
}

/// `m = 1.3`, `I = 0.8`, `a = 0.4`.
pub fn sleigh() -> Sleigh {
    Sleigh::new(1.3, 0.8, 0.4).unwrap()
}

/// A start with both velocities.
pub fn moving() -> SleighState {
    SleighState { x: 0.3, y: -0.2, heading: 0.5, speed: -0.6, turn_rate: 1.1 }
}

/// `steps` steps of `h` from `t = 0`.
pub fn steps(h: f64, steps: u64) -> Schedule {
    Schedule { t0: 0.0, step: h, steps }
}

/// Asserts the slope from the first error to the last, each at half the step of the one before; returns it.
pub fn assert_order(name: &str, errors: &[f64], order: f64) {
    let halvings = (errors.len() - 1) as f64;
    let slope = (errors[0] / errors[errors.len() - 1]).log2() / halvings;
    let shown: Vec<String> = errors.iter().map(|e| format!("{e:.1e}")).collect();
    println!("{name}: {}, order {slope:.2}", shown.join(" "));
    assert!((slope - order).abs() < 0.25, "{name}: order {slope}, not {order}: {errors:?}");
}
