//! Small motions keep their digits.

use super::systems::{Cart, GRAVITY, Pendulum, Run, in_basis, methods};
use crate::support::Two;
use approx::assert_relative_eq;
use dla::{Schedule, State};

#[test]
fn small_swings_are_swings() {
    swings_are_alike(&[(0.1, 100)]);
}

#[test]
#[ignore = "slow"]
fn small_swings_are_swings_in_full() {
    swings_are_alike(&[(0.01, 1000), (0.1, 100)]);
}

/// Swings of 1e-3 to 1e-13 rad: from one amplitude to the next the motion is the same, but for the cubic term of the sine.
fn swings_are_alike(runs: &[(f64, u64)]) {
    for (name, run) in methods() {
        for &(step, steps) in runs {
            let swing = |amplitude: f64| {
                let (sin, cos) = amplitude.sin_cos();
                let start = State::new([sin, -cos], [0.0; 2], [false; 2]);
                let state = run(&Two::from(Pendulum { drag: 0.0 }), &Schedule { t0: 0.0, step, steps }, start)
                    .unwrap_or_else(|error| panic!("{name}, {amplitude:e} rad, step {step}: {error}"));
                [state.q()[0] / amplitude, state.v()[0] / (amplitude * GRAVITY.sqrt())]
            };
            let linear = swing(1e-13);
            // By the energy integral: the period is longer by a^2/16.
            for amplitude in [1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10] {
                let now = swing(amplitude);
                let bound = 0.1 * GRAVITY.sqrt() * step * steps as f64 * amplitude * amplitude;
                // The rounding of the height, 1 m, is seen by the velocity: of a swing as small as that it is noise of its own.
                let noise = 64.0 * f64::EPSILON / (step * amplitude).min(1.0) * amplitude.min(1.0);
                for i in 0..2 {
                    assert_relative_eq!(now[i], linear[i], epsilon = bound + noise + 1e-12, max_relative = 0.0);
                }
            }
        }
    }
}

/// A linear oscillator about the origin: `gauss16` has its closed form, whatever the amplitude.
#[test]
fn an_oscillator_is_as_exact_when_it_is_small() {
    let cart = Cart::<true> { ends: [0.0, 0.0], stiffness: [1.0, 2.0], drag: 0.0 };
    let omega = cart.frequency();
    let (step, steps) = (0.25, 400);
    let run: Run<Two, 2> = in_basis().into_iter().find(|(name, _)| *name == "gauss16").unwrap().1;
    for decade in 3..=14 {
        let amplitude = 10f64.powi(-decade);
        let start = State::new([0.0, 0.0], [amplitude * omega, 0.0], [false; 2]);
        let state = run(&Two::from(cart), &Schedule { t0: 0.0, step, steps }, start).unwrap();
        let (sin, cos) = (omega * step * steps as f64).sin_cos();
        assert_relative_eq!(state.q()[0] / amplitude, sin, epsilon = 1e-9);
        assert_relative_eq!(state.v()[0] / (amplitude * omega), cos, epsilon = 1e-9);
    }
}
