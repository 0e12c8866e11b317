//! The coordinates of long runs: compensated sums, and angles with their turns.

use crate::support::ByHand;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use dla::{Checkpoint, Dla, OneStep, State, StepError};
use lagrangian::{System, Twofold, With};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, EggCrate};
use sleigh::{ClosedMap, Sleigh, SleighState};
use std::f64::consts::{PI, TAU};

/// `2 pi` in units of `2^-100`, exact to one of them.
const EXACT_TAU: i128 = 0x0064_87ED_5110_B461_1A62_6331_45C0;

/// Exact angles: whole turns, and the rest in units of `2^-100`, within half a turn.
#[derive(Debug, Default, Clone, Copy)]
struct Exact {
    turns: i128,
    rest: i128,
}

impl Exact {
    fn add(&mut self, increment: f64) {
        let units = increment * 100f64.exp2();
        assert!(units.fract() == 0.0 && units.abs() < 126f64.exp2(), "{increment:e} is not a multiple of 2^-100");
        let sum = self.rest + units as i128;
        let turns = (2 * sum + EXACT_TAU).div_euclid(2 * EXACT_TAU);
        (self.turns, self.rest) = (self.turns + turns, sum - turns * EXACT_TAU);
    }
    fn angle(&self) -> f64 {
        self.rest as f64 / 100f64.exp2()
    }
    fn unwrapped(&self) -> f64 {
        // The products are exact to 2^-75 of a turn.
        self.turns as f64 * TAU + (self.angle() + self.turns as f64 * 2.449_293_598_294_706_4e-16)
    }
}

fn angle(q: f64) -> State<1> {
    State::new([q], [0.0], [true])
}

fn check(state: &State<1>, exact: &Exact, tolerance: f64) {
    let ((sin, cos), (s, c)) = (state.q()[0].sin_cos(), exact.angle().sin_cos());
    assert!((sin - s).abs() <= tolerance && (cos - c).abs() <= tolerance, "{:e}, {:e}", sin - s, cos - c);
    assert!(state.q()[0].abs() <= PI + 1e-9);
    // One rounding of the sum, one of each product.
    assert_relative_eq!(state.unwrapped()[0], exact.unwrapped(), epsilon = tolerance, max_relative = 4e-16);
}

/// Uniform in -1..1, always the same.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 * (-52f64).exp2() - 1.0
}

#[test]
fn sums_are_compensated() {
    compensated(100_000, 1e4);
}

#[test]
#[ignore = "slow"]
fn sums_are_compensated_in_full() {
    compensated(10_000_000, 1e6);
}

/// The error of the naive sum in units of the last place.
fn compensated(terms: u32, naive_ulps: f64) {
    let (mut state, mut naive) = (State::new([0.0, 3.0], [0.0; 2], [false; 2]), 0.0f64);
    for _ in 0..terms {
        state.advance(&[0.1, -0.1], [0.0; 2], None);
        naive += 0.1;
    }
    // So many times the f64 nearest to 0.1, which is 0.1 + 5.55e-18.
    let (sum, rest) = (f64::from(terms) / 10.0, f64::from(terms) * 5.55e-18);
    let ulp = sum.next_up() - sum;
    assert!((state.q()[0] - (sum + rest)).abs() <= ulp, "{:e}", state.q()[0] - sum);
    assert!((state.q()[1] - (3.0 - sum - rest)).abs() <= ulp);
    assert!((naive - sum).abs() > naive_ulps * ulp, "a naive sum is off by {:e}", naive - sum);
}

#[test]
fn small_increments_far_from_the_origin_count() {
    let mut state = State::new([1e9], [0.0], [false]);
    for _ in 0..1000 {
        state.advance(&[1e-8], [0.0], None);
    }
    assert_eq!(state.q()[0], 1e9 + 1e-5);
    assert_eq!(1e9 + 1e-8, 1e9, "a naive sum would not move");
    assert_eq!(state.ahead(&[1.0]), [1e9 + 1.0 + 1e-5]);
}

#[test]
fn angles_stay_within_a_turn() {
    for (q, turns) in
        [(0.0, 0.0), (3.0, 0.0), (-3.0, 0.0), (PI, 0.0), (3.2, 1.0), (-3.2, -1.0), (7.0, 1.0), (100.0, 16.0)]
    {
        let state = angle(q);
        assert_eq!(state.turns(), &[turns]);
        assert_eq!(state.unwrapped(), [q], "what the user gave");
        // `TAU` is short of the turn by 2.4e-16.
        assert_relative_eq!(state.q()[0], q - turns * TAU, epsilon = (1.0 + turns.abs()) * 2.5e-16);
    }
    let other = State::new([100.0, 100.0], [0.0; 2], [false, true]);
    assert_eq!((other.q()[0], other.turns()), (100.0, &[0.0, 16.0]), "only angles are wrapped");
}

/// A sine of the rounded sum would be off by half an ulp of 6e6, which is 5e-10.
#[test]
fn a_million_turns_lose_no_digits() {
    let start = 1e6 * TAU + 1.0;
    let (mut state, mut exact) = (angle(start), Exact::default());
    exact.add(start);
    check(&state, &exact, 1e-15);
    assert_eq!(state.turns(), &[1e6]);
    assert_eq!(state.unwrapped(), [start], "what the user gave");
    for _ in 0..1000 {
        state.advance(&[0.125], [0.0], None);
        exact.add(0.125);
    }
    // Each sum of increment and rest is rounded by 2^-57 at most.
    check(&state, &exact, 1e-15);
}

#[test]
fn a_million_random_increments() {
    // Each is rounded by 2^-62 at most when the rest is added to it: 1.3e-16 in 1e6 by chance. A naive sum as the control.
    let (mut state, mut exact, mut naive, mut seed) = (angle(0.5), Exact::default(), 0.5, 7);
    exact.add(0.5);
    for k in 0..1_000_000 {
        let increment = (random(&mut seed) + 0.5) / 512.0;
        state.advance(&[increment], [0.0], None);
        exact.add(increment);
        naive += increment;
        if k % 1000 == 0 {
            check(&state, &exact, 1e-15);
        }
    }
    check(&state, &exact, 1e-15);
    assert_eq!(state.turns()[0], exact.turns as f64);
    assert!(exact.turns > 100, "{}", exact.turns);
    let lost = (naive - exact.unwrapped()).abs();
    assert!(lost > 1e-12, "a naive sum is off by {lost:e}");
}

/// Increments of whole degrees, and of more than a turn, against the count of the degrees.
#[test]
fn degrees_add_up_to_turns() {
    let (mut state, mut degrees, mut seed) = (angle(0.0), 0i64, 3);
    for _ in 0..100_000 {
        let k = (random(&mut seed) * 1000.0) as i64;
        state.advance(&[TAU * (k as f64 / 360.0)], [0.0], None);
        degrees += k;
    }
    let expected = ((degrees + 180).rem_euclid(360) - 180) as f64 * (TAU / 360.0);
    // The increments are rounded three times by 4e-16 each, which adds up as the root of their number.
    let (sin, cos) = state.q()[0].sin_cos();
    assert!((sin - expected.sin()).abs() <= 1e-12 && (cos - expected.cos()).abs() <= 1e-12);
    assert_relative_eq!(state.unwrapped()[0], degrees as f64 * (TAU / 360.0), epsilon = 1e-12, max_relative = 1e-15);
}

#[test]
fn velocities_and_quasi_velocities() {
    let mut state = State::new([1.0, 9.0], [2.0, -3.0], [false, true]);
    assert_eq!((state.v(), state.xi()), (&[2.0, -3.0], None));
    state.advance(&[0.5, 0.5], [4.0, 5.0], Some([6.0, 7.0]));
    let back = state.reversed();
    assert_eq!((back.v(), back.xi()), (&[-4.0, -5.0], Some([-6.0, -7.0])));
    assert_eq!((back.q(), back.turns()), (state.q(), state.turns()));
    assert_eq!(back.reversed(), state);
    state.advance(&[0.0; 2], [1.0, 1.0], None);
    assert_eq!(state.xi(), None, "a method that does not know them leaves no old ones");
    let pi = [Twofold::from(3.0), Twofold::new(1.0, 1e-17)];
    state.advance_with_momenta(&[0.0; 2], [1.0, 1.0], [2.0, 1.0], pi);
    assert_eq!((state.xi(), state.quasi_momenta()), (Some([2.0, 1.0]), Some(pi)));
    assert_eq!(state.reversed().quasi_momenta(), None, "of a velocity the other way they are not known");
    state.advance(&[0.0; 2], [1.0, 1.0], Some([2.0, 1.0]));
    assert_eq!(state.quasi_momenta(), None, "nor after a method that does not carry them");
}

#[test]
fn angles_that_are_no_numbers_come_through() {
    for q in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut state = angle(q);
        state.advance(&[1.0], [0.0], None);
        assert!(!state.q()[0].is_finite() && !state.unwrapped()[0].is_finite());
        let mut state = angle(1.0);
        state.advance(&[q], [0.0], None);
        assert!(!state.q()[0].is_finite());
    }
}

/// An angle of more turns than have digits is still an angle, and the one that a sine takes it for.
#[test]
fn angles_beyond_counting_are_wrapped() {
    for q in [7e15, 1e17, -1.4e18, 1e40, -1e200, f64::MAX] {
        let mut state = angle(q);
        for _ in 0..2 {
            let within = state.q()[0];
            assert!(within.abs() <= PI, "{q:e}: {within}");
            // Of a sine and its arcus two units each, and half of one of the angle.
            let bound = 5.0 * f64::EPSILON;
            assert_abs_diff_eq!(within.sin(), q.sin(), epsilon = bound);
            assert_abs_diff_eq!(within.cos(), q.cos(), epsilon = bound);
            // Half a unit of what the velocity was found at is no part of the next node.
            state = angle(0.0);
            state.advance(&[q], [0.0], None);
        }
        let (turned, turns) = (state.unwrapped()[0], state.turns()[0]);
        assert_relative_eq!(turned, q, max_relative = 2.0 * f64::EPSILON);
        assert_eq!(turns.fract(), 0.0);
    }
}

/// Increments along a polynomial are extrapolated to rounding from as many as determine it, up to seven; increments of other steps are forgotten.
#[test]
fn the_next_increment_is_expected() {
    let mut state = State::new([0.0; 2], [0.0; 2], [false; 2]);
    for degree in 2..=6 {
        let along = |k: i32| [0.1 + 0.02 * f64::from(k) - (0.1 * f64::from(k)).powi(degree), 1.0];
        state = State::new([0.0; 2], [0.0; 2], [false; 2]);
        for k in 0..12 {
            let expected = state.expected(0.5);
            assert_eq!(expected.is_some(), k >= 3, "step {k}");
            if let Some(expected) = expected.filter(|_| k > degree) {
                // Weights of together 127, of numbers below 3.
                assert_abs_diff_eq!(expected[0], along(k)[0], epsilon = 127.0 * 3.0 * f64::EPSILON);
                assert_abs_diff_eq!(expected[1], 1.0, epsilon = 127.0 * f64::EPSILON);
            }
            state.advance_with_acceleration(0.5, &along(k), [0.0; 2], [0.0; 2]);
        }
    }
    assert!(state.expected(0.25).is_none(), "of another length");
    assert!(state.reversed().expected(0.5).is_none(), "the other way");

    let mut checkpoint = Checkpoint::of([]);
    state.save(&mut checkpoint);
    let again = State::load(&checkpoint, [false; 2]).unwrap();
    assert_eq!(again.expected(0.5), state.expected(0.5));
    assert_eq!(again, state);

    let mut other = state;
    other.advance_with_acceleration(0.25, &[0.0; 2], [0.0; 2], [0.0; 2]);
    assert!(other.expected(0.5).is_none() && other.expected(0.25).is_none());
    state.advance(&[0.0; 2], [0.0; 2], None);
    assert!(state.expected(0.5).is_none(), "after a step of which nothing is remembered");
}

proptest! {
    #[test]
    fn any_start_is_wrapped_exactly(turns in -1_000_000..1_000_000i32, part in -0.5..0.5f64, bits in -20..0i32) {
        let q = (f64::from(turns) + part) * TAU * f64::from(bits).exp2();
        let mut exact = Exact::default();
        exact.add((q * 45f64.exp2()).round() * (-45f64).exp2());
        let state = angle((q * 45f64.exp2()).round() * (-45f64).exp2());
        check(&state, &exact, 1e-15);
    }
}

/// A difference of states is what moved them: over full turns, and with what the sums keep.
#[test]
fn a_state_knows_how_far_it_has_moved() {
    for increment in [0.5, -0.7, 1.3, 2.9, -3.1] {
        let before = State::new([3.0, 1e9], [0.0; 2], [true, false]);
        let mut state = before;
        for k in 1..=12 {
            state.advance(&[increment, 3e-9], [0.0; 2], None);
            let [turned, moved] = state.moved_since(&before);
            // The difference of two angles has half an ulp of a number below eight, and the products of whole turns theirs.
            let expected = f64::from(k) * increment;
            assert_abs_diff_eq!(turned, expected, epsilon = 4.5e-16 + f64::EPSILON * expected.abs());
            assert_abs_diff_eq!(moved, 3e-9 * f64::from(k), epsilon = 1e-22);
        }
    }
    // Back over the seam: one turn forward and one back.
    let start = State::new([3.0], [0.0], [true]);
    let mut over = start;
    over.advance(&[0.5], [0.0], None);
    assert_abs_diff_eq!(start.moved_since(&over)[0], -0.5, epsilon = 4.5e-16);
}

/// What the next step begins from is part of a state: at the same place two are not the same after other steps.
#[test]
fn states_after_other_steps_differ() {
    fn after<Sys: System<3, 1>>(system: &Sys, steps: &[f64]) -> State<3> {
        let mut state = State::new([0.0; 3], [0.0; 3], [false, false, true]);
        for h in steps {
            Dla::midpoint().step(system, 0.0, *h, &mut state).unwrap();
        }
        state
    }
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    // At rest with its centre of mass at the lowest place.
    let well = ByHand::from(With { body, effects: (Bowl::new([0.7, 0.4], [0.5, 0.0]).unwrap(),) });
    assert_eq!(after(&well, &[0.5]), after(&well, &[0.5]));
    assert_ne!(after(&well, &[0.5]), after(&well, &[0.25]));
    // A step of another length begins anew.
    assert_eq!(after(&well, &[0.5]), after(&well, &[0.25, 0.5]));
    // The step counts its increments.
    assert_ne!(after(&well, &[0.5]), after(&well, &[0.5, 0.5]));
}

/// What would not be a finite place or velocity is refused before the state has moved.
#[test]
fn a_step_stays_among_the_numbers() {
    let state = State::new([1e308, 0.0], [0.0; 2], [false; 2]);
    assert!(state.stays_finite(&[0.5e308, 1.0], &[0.0; 2]).is_ok());
    assert!(state.stays_finite(&[1e308, 0.0], &[0.0; 2]).is_err());
    assert!(state.stays_finite(&[0.0; 2], &[0.0, f64::NAN]).is_err());
}

/// Nor has it moved, or forgotten its increments, where a step in closed form would leave them.
#[test]
fn a_closed_step_that_fails_leaves_the_state() {
    let body = Sleigh::new(1.0, 1.0, 0.0).unwrap();
    let mut state = State::new([1.7e308, 0.0, 0.0], [1e308, 0.0, 0.0], [false, false, true]);
    for _ in 0..3 {
        state.advance_with_acceleration(0.5, &[0.0; 3], [1e308, 0.0, 0.0], [0.0; 3]);
    }
    let before = state;
    assert!(before.expected(0.5).is_some());
    let failed = ClosedMap::of(body).step(&ByHand::from(body), 0.0, 1.0, &mut state).unwrap_err();
    assert_eq!(failed, StepError::NotFinite);
    assert_eq!(state, before);
    // The control: to the other side it is a step.
    ClosedMap::of(body).step(&ByHand::from(body), 0.0, -1.0, &mut state).unwrap();
    assert!(state.expected(0.5).is_none() && state != before);
}

/// The search of a step begins from what the state remembers: from several steps of the same length it needs one correction, and a look
/// that sees that it has settled, and where derivatives serve many steps often a second one; from the acceleration alone more, and more
/// still from the velocity.
#[test]
fn what_a_state_remembers_shortens_the_next_search() {
    const STEPS: u32 = 200;
    let body = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let crowd = (Bowl::new([0.7, 0.4], [0.2, -0.1]).unwrap(), EggCrate::new(0.3, [1.0, 1.2]).unwrap());
    let system = ByHand::from(With { body, effects: (crowd, Drag::new(0.1, 0.1).unwrap()) });
    let corrections = |h: &dyn Fn(u32) -> f64, forget: bool| {
        let start = SleighState { x: 0.3, y: -0.2, heading: 0.4, speed: -1.0, turn_rate: 0.7 };
        let (q, v) = start.to_coordinates();
        let mut state = State::new(q, v, system.angles());
        let mut method = Dla::midpoint();
        let steps = (0..STEPS).map(|k| {
            if forget {
                state = State::new(*state.q(), *state.v(), system.angles());
            }
            // Nothing depends on the time.
            method.step(&system, 0.0, h(k), &mut state).unwrap().iterations
        });
        steps.sum::<u32>()
    };
    let same = corrections(&|_| 0.1, false);
    let other = corrections(&|k| if k % 2 == 0 { 0.1 } else { 0.09 }, false);
    let forgetful = corrections(&|_| 0.1, true);
    println!("{same} corrections, {other} at steps of two lengths, {forgetful} without memory");
    // The first steps begin from the acceleration; and one step in two may take a correction more, with derivatives of another.
    assert!(same <= 2 * STEPS + STEPS / 2 + 5 * 3, "{same} corrections");
    assert!(same + STEPS / 2 < other && other + STEPS / 2 < forgetful, "{same}, {other}, {forgetful}");
}
