//! Damped motions, to their end and beyond.

use super::systems::{Cart, Pendulum, in_basis, methods};
use dla::{Schedule, State};
use proptest::prelude::*;

/// A swing that dies out, for as long as its velocity loses 100 decades.
#[test]
fn a_damped_pendulum_comes_to_rest() {
    let (sin, cos) = 1.0_f64.sin_cos();
    for (name, run) in methods() {
        for step in [0.01, 0.1] {
            let start = State::new([sin, -cos], [0.0; 2], [false; 2]);
            let schedule = Schedule { t0: 0.0, step, steps: (1000.0 / step) as u64 };
            let state = run(&Pendulum { drag: 0.5 }, &schedule, start)
                .unwrap_or_else(|error| panic!("{name}, step {step}: {error}"));
            // The position is on the circle to the rounding of its coordinates.
            let [x, y] = *state.q();
            assert!(x.abs() <= 1e-15 && (y + 1.0).abs() <= 4.0 * f64::EPSILON, "{name}: {x:e}, {:e}", y + 1.0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Over all decades of stiffness and damping, with the balance at the origin or off it, a cart ends at rest.
    #[test]
    fn a_damped_cart_comes_to_rest(
        decades in -3.0..6.0f64, ratio in -3.0..0.0f64, damping in -2.0..0.5f64, middle in -2.0..2.0f64, off in -4..1i32,
    ) {
        let k = 10f64.powf(decades);
        let ends = [middle - 0.3, middle + 0.4];
        let stiffness = [k, k * 10f64.powf(ratio)];
        let frequency = (stiffness[0] + stiffness[1]).sqrt();
        let drag = frequency * 10f64.powf(damping);
        let (plain, based) = (Cart::<false> { ends, stiffness, drag }, Cart::<true> { ends, stiffness, drag });
        let step = 0.45 / frequency.max(drag);
        // Until what is left of the slower of the two modes is below all rounding.
        let slow = if drag < 2.0 * frequency { 0.5 * drag } else { 0.5 * frequency * frequency / drag };
        let steps = ((60.0 / slow) / step).min(2e4) as u64;
        let settled = steps as f64 * step * slow > 45.0;
        let start = State::new([plain.balance() + 10f64.powi(off), 0.0], [0.0; 2], [false; 2]);
        let schedule = Schedule { t0: 0.0, step, steps };
        let end = |result: Result<State<2>, dla::RunError>, name: &str| {
            let state = match result {
                Ok(state) => state,
                Err(error) => return Err(TestCaseError::fail(format!("{name}: {error}"))),
            };
            let off = (state.q()[0] - plain.balance()).abs();
            prop_assert!(!settled || off <= 1e-12 * (1.0 + middle.abs()), "{name}: {off:e}");
            Ok(())
        };
        for (name, run) in methods() {
            end(run(&plain, &schedule, start), name)?;
        }
        for (name, run) in in_basis() {
            end(run(&based, &schedule, start), name)?;
        }
    }
}
