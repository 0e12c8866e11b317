//! Damped motions, to their end and beyond.

use super::systems::{Cart, Pendulum, in_basis, methods};
use crate::support::Two;
use dla::{Schedule, State};
use proptest::prelude::*;

/// Its velocity loses 17 decades.
#[test]
fn a_damped_pendulum_comes_to_rest() {
    dies_out(2.0, 40.0, &[0.1]);
}

/// And 100.
#[test]
#[ignore = "slow"]
fn a_damped_pendulum_comes_to_rest_at_length() {
    dies_out(0.5, 1000.0, &[0.01, 0.1]);
}

/// A swing that dies out as `e^(-drag t/2)`.
fn dies_out(drag: f64, duration: f64, lengths: &[f64]) {
    let (sin, cos) = 1.0_f64.sin_cos();
    for (name, run) in methods() {
        for &step in lengths {
            let start = State::new([sin, -cos], [0.0; 2], [false; 2]);
            let schedule = Schedule { t0: 0.0, step, steps: (duration / step) as u64 };
            let state = run(&Two::from(Pendulum { drag }), &schedule, start)
                .unwrap_or_else(|error| panic!("{name}, step {step}: {error}"));
            // The position is on the circle to the rounding of its coordinates.
            let [x, y] = *state.q();
            assert!(x.abs() <= 1e-15 && (y + 1.0).abs() <= 4.0 * f64::EPSILON, "{name}: {x:e}, {:e}", y + 1.0);
        }
    }
}

/// Decades of the stiffness and of the ratio of two springs, of the damping beside the frequency, and of the distance at the start from the
/// balance, with the middle of the springs.
type Damped = (f64, f64, f64, i32, f64);

/// A damped cart ends at rest, after so many steps at most; says whether they are enough for that.
fn ends_at_rest((decades, ratio, damping, off, middle): Damped, most: f64) -> Result<bool, TestCaseError> {
    let k = 10f64.powf(decades);
    let ends = [middle - 0.3, middle + 0.4];
    let stiffness = [k, k * 10f64.powf(ratio)];
    let frequency = (stiffness[0] + stiffness[1]).sqrt();
    let drag = frequency * 10f64.powf(damping);
    let (plain, based) = (Cart::<false> { ends, stiffness, drag }, Cart::<true> { ends, stiffness, drag });
    let step = 0.45 / frequency.max(drag);
    // Until what is left of the slower of the two modes is below all rounding.
    let slow = if drag < 2.0 * frequency { 0.5 * drag } else { 0.5 * frequency * frequency / drag };
    let steps = ((60.0 / slow) / step).min(most) as u64;
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
        end(run(&Two::from(plain), &schedule, start), name)?;
    }
    for (name, run) in in_basis() {
        end(run(&Two::from(based), &schedule, start), name)?;
    }
    Ok(settled)
}

/// One that settles soon, and two that would not: soft and overdamped, stiff and hardly damped.
#[test]
fn a_damped_cart_comes_to_rest() {
    for (cart, most, settled) in [
        ((2.0, -1.0, 0.25, 0, 0.7), 210.0, true),
        ((-3.0, -2.5, 0.5, -4, -1.6), 20.0, false),
        ((6.0, -0.5, -2.0, -1, 1.3), 20.0, false),
    ] {
        assert_eq!(ends_at_rest(cart, most).unwrap(), settled);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Over all decades of stiffness and damping, with the balance at the origin or off it.
    #[test]
    #[ignore = "slow"]
    fn a_damped_cart_comes_to_rest_at_length(
        decades in -3.0..6.0f64, ratio in -3.0..0.0f64, damping in -2.0..0.5f64, middle in -2.0..2.0f64, off in -4..1i32,
    ) {
        ends_at_rest((decades, ratio, damping, off, middle), 2e4)?;
    }
}
