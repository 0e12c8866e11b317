//! A drag that stops the sleigh within a step: it brakes, or the step is refused, and the hint is good.

use crate::effects::tools::{Laden, laden, sleigh};
use approx::assert_relative_eq;
use dla::{Dla, Hint, OneStep, State, StepError};
use scene::AnyEffect;
use sleigh::effects::{Drag, Thrust};
use sleigh::{Sleigh, SleighState};

/// The speed after a step of `h` (s) from 1 m/s.
fn after(system: &Laden<Sleigh>, h: f64) -> Result<f64, StepError> {
    let start = SleighState { heading: 0.7, speed: 1.0, ..SleighState::default() };
    let (q, v) = start.to_coordinates();
    let mut state = State::new(q, v, [false, false, true]);
    Dla::midpoint().step(system, 0.0, h, &mut state)?;
    Ok(SleighState::from_coordinates(state.q(), state.v()).speed)
}

fn drag(along: f64) -> AnyEffect {
    AnyEffect::Drag(Drag::new(along, 0.0).unwrap())
}

#[test]
fn a_drag_turns_no_speed_round() {
    let (h, mass) = (0.05, sleigh().mass());
    for part in [1e-3, 0.5, 1.0, 1.99] {
        let speed = after(&laden(sleigh(), vec![drag(part * mass / h)]), h).unwrap();
        assert_relative_eq!(speed, (1.0 - 0.5 * part) / (1.0 + 0.5 * part), epsilon = 1e-14);
    }
    for part in [2.01, 3.0, 1e3, 1e6] {
        let system = laden(sleigh(), vec![drag(part * mass / h)]);
        let error = after(&system, h).unwrap_err();
        let Some(Hint::ShorterStep { part: shorter }) = error.hint() else { panic!("{error}") };
        assert!(matches!(error, StepError::Overshoot { .. }), "{error}");
        // The rounding of a difference of velocities that nearly cancels.
        assert_relative_eq!(shorter, 2.0 / part, max_relative = 1e-9);
        assert!(after(&system, 0.999 * shorter * h).unwrap() >= 0.0);
    }
}

/// What drives may turn the speed round, and so may a drag towards another speed than zero, where it does not overshoot.
#[test]
fn what_drives_may() {
    let (h, mass) = (0.05, sleigh().mass());
    let thrust = |force: f64| AnyEffect::Thrust(Thrust::new(force).unwrap());
    let driven = after(&laden(sleigh(), vec![thrust(-3.0 * mass / h)]), h).unwrap();
    assert_relative_eq!(driven, -2.0, epsilon = 1e-14);
    let along = mass / h;
    let braked = after(&laden(sleigh(), vec![drag(along), thrust(-2.0 * along)]), h).unwrap();
    assert_relative_eq!(braked, -1.0, epsilon = 1e-14);
    // At the speed where drag and thrust balance nothing changes, and nothing overshoots.
    let still = after(&laden(sleigh(), vec![drag(10.0 * along), thrust(10.0 * along)]), h).unwrap();
    assert_relative_eq!(still, 1.0, epsilon = 1e-14);
}
