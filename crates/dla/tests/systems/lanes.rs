//! Stages in vector registers against stages one by one, and steps of their own length.

use crate::support::{ByHand, Three};
use approx::assert_abs_diff_eq;
use dla::{Gauss, GaussAdaptive, OneStep, Schedule, State, StepError, drive};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, With, constraint_residual, energy};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, EggCrate, Slope, Torque};
use sleigh::{Flywheel, Sleigh, SleighState, TimeFunction};

fn start(sleigh_state: &SleighState) -> State<3> {
    let (q, v) = sleigh_state.to_coordinates();
    State::new(q, v, [false, false, true])
}

/// The state after some steps, and the iterations they took.
fn after<Sys, Method, const N: usize>(system: &Sys, mut method: Method, h: f64, state: &State<N>) -> (State<N>, u32)
where
    Sys: System<N, 1>,
    Method: OneStep<N, 1>,
{
    let (mut state, mut iterations) = (*state, 0);
    for k in 0..STEPS {
        iterations += method.step(system, f64::from(k) * h, h, &mut state).unwrap().iterations;
    }
    (state, iterations)
}

const STEPS: u32 = 12;

/// Both solve the same equations until changes are rounding: each step leaves some ulps of the sizes it computes with, and
/// further steps enlarge them by no more than these short motions do, a factor of `e^2`.
fn same<Sys: System<N, 1>, const N: usize, const S: usize>(system: &Sys, h: f64, state: &State<N>) {
    let (lanes, _) = after(system, Gauss::new::<S>(), h, state);
    let (turns, _) = after(system, Gauss::new::<S>().one_by_one(), h, state);
    let size = |x: &[f64; N]| x.iter().fold(1.0f64, |m, x| m.max(x.abs()));
    let tolerance = f64::from(STEPS) * 32.0 * 8.0 * f64::EPSILON;
    for i in 0..N {
        assert_abs_diff_eq!(lanes.q()[i], turns.q()[i], epsilon = tolerance * size(turns.q()));
        assert_abs_diff_eq!(lanes.v()[i], turns.v()[i], epsilon = tolerance * size(turns.v()));
    }
}

fn every_order<Sys: System<N, 1>, const N: usize>(system: &Sys, h: f64, state: &State<N>) {
    same::<_, N, 2>(system, h, state);
    same::<_, N, 3>(system, h, state);
    same::<_, N, 4>(system, h, state);
    same::<_, N, 5>(system, h, state);
    same::<_, N, 7>(system, h, state);
    same::<_, N, 8>(system, h, state);
}

/// A sleigh and its start, the stiffness of a bowl, the length of a step.
fn sleighs() -> impl Strategy<Value = (Sleigh, SleighState, f64, f64)> {
    let sleigh = (0.1f64..10.0, 0.1f64..10.0, -1.0f64..1.0)
        .prop_map(|(mass, inertia, offset)| Sleigh::new(mass, inertia, offset).unwrap());
    let state = |(speed, turn_rate, heading)| SleighState { speed, turn_rate, heading, x: 1.0, y: -0.5 };
    let start = (-2.0f64..2.0, -1.0f64..1.0, -3.0f64..3.0).prop_map(state);
    (sleigh, start, 0.01f64..1.0, 0.01f64..0.2)
}

fn at_once_as_in_turn((body, begin, stiffness, h): (Sleigh, SleighState, f64, f64)) {
    let state = start(&begin);
    every_order(&ByHand::from(body), h, &state);
    let bowl = Bowl::new([stiffness, 0.3], [0.2, 0.1]).unwrap();
    let amplitude = 0.5 * body.inertia();
    let swing = Torque::new(TimeFunction::Sine { amplitude, frequency: 2.0, phase: 0.3 }).unwrap();
    every_order(&ByHand::from(With { body, effects: (bowl.clone(),) }), h, &state);
    let (drag, slope) = (Drag::new(0.1, 0.2).unwrap(), Slope::new([0.3, -0.2]).unwrap());
    let crowd = (bowl, drag, slope, EggCrate::new(0.2, [1.0, 2.0]).unwrap(), swing);
    every_order(&ByHand::from(With { body, effects: crowd }), h, &state);
    let flywheel = Flywheel::new(body, 0.3, None).unwrap();
    let (q, v) = (state.q(), state.v());
    let turning = State::new([q[0], q[1], q[2], 0.4], [v[0], v[1], v[2], -0.7], [false, false, true, true]);
    every_order(&flywheel, h, &turning);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2))]

    #[test]
    fn eight_stages_at_once_are_the_stages_in_turn(sleigh in sleighs()) {
        at_once_as_in_turn(sleigh);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    #[ignore = "slow"]
    fn eight_stages_at_once_are_the_stages_in_turn_in_full(sleigh in sleighs()) {
        at_once_as_in_turn(sleigh);
    }

    /// A spin that is nothing beside the speed keeps its digits: every component settles by its own size.
    #[test]
    fn a_spin_that_dies_out_keeps_its_digits(exponent in -200i32..-3) {
        let (body, h) = (Sleigh::new(1.0, 1.0, 0.5).unwrap(), 0.1);
        let turn_rate = 10f64.powi(exponent);
        let begin = start(&SleighState { speed: 1.0, turn_rate, ..SleighState::default() });
        let (state, _) = after(&ByHand::from(body), Gauss::new::<8>(), h, &begin);
        // omega' = -c u omega with a speed that the spin changes by its square.
        let exact = turn_rate * (-body.spin_gain() * f64::from(STEPS) * h).exp();
        let square = if exponent < -8 { 0.0 } else { turn_rate * turn_rate };
        approx::assert_relative_eq!(state.v()[2], exact, max_relative = 64.0 * f64::EPSILON + 4.0 * square);
    }
}

/// The polynomial of the last step is a better beginning than the slopes at the start: the control that it is used.
#[test]
fn the_last_step_helps_the_next() {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let system = ByHand::from(With { body, effects: (Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap(),) });
    let state = start(&SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() });
    let (_, remembered) = after(&system, Gauss::new::<8>(), 0.3, &state);
    let mut forgetful = 0;
    let mut moved = state;
    for k in 0..STEPS {
        forgetful += Gauss::new::<8>().step(&system, f64::from(k) * 0.3, 0.3, &mut moved).unwrap().iterations;
    }
    assert!(remembered < forgetful, "{remembered} iterations, without memory {forgetful}");

    // And from a checkpoint too.
    let mut method = Gauss::new::<8>();
    let mut moved = state;
    method.step(&system, 0.0, 0.3, &mut moved).unwrap();
    let mut recalled = Gauss::new::<8>();
    OneStep::<3, 1>::recall(&mut recalled, &OneStep::<3, 1>::memory(&method), &moved);
    let next = |mut method: Gauss| method.step(&system, 0.3, 0.3, &mut { moved }).unwrap().iterations;
    assert_eq!(next(recalled), next(method));
    assert!(next(recalled) < next(Gauss::new::<8>()));
}

/// A turned velocity is another motion: the memory of the old one must not serve it.
#[test]
fn the_way_back_ends_at_the_start() {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let system = ByHand::from(With { body, effects: (Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap(),) });
    let begin = start(&SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() });
    let mut method = Gauss::new::<8>();
    let mut state = begin;
    for _ in 0..STEPS {
        method.step(&system, 0.0, 0.3, &mut state).unwrap();
    }
    state = state.reversed();
    for _ in 0..STEPS {
        method.step(&system, 0.0, 0.3, &mut state).unwrap();
    }
    for i in 0..3 {
        assert_abs_diff_eq!(state.q()[i], begin.q()[i], epsilon = 2.0 * f64::from(STEPS) * 32.0 * f64::EPSILON);
        assert_abs_diff_eq!(state.v()[i], -begin.v()[i], epsilon = 2.0 * f64::from(STEPS) * 32.0 * f64::EPSILON);
    }
}

/// Across one interval, however long: the error follows the tolerance, and the velocity is on the constraint.
#[test]
fn steps_of_their_own_length_meet_a_tolerance() {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let bowl = ByHand::from(With { body, effects: (Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap(),) });
    let begin = start(&SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() });
    let run = |method: &mut dyn FnMut(&mut State<3>)| {
        let mut state = begin;
        method(&mut state);
        state
    };
    let exact = run(&mut |state| {
        let schedule = Schedule { t0: 0.0, step: 0.1, steps: 200 };
        drive(&bowl, &mut Gauss::new::<8>(), &schedule, state, ()).unwrap();
    });
    let mut last = (f64::INFINITY, 0);
    for exponent in [-4, -7, -10, -13] {
        let tolerance = 10f64.powi(exponent);
        let mut iterations = 0;
        let end = run(&mut |state| {
            iterations = GaussAdaptive::new::<8>(tolerance).step(&bowl, 0.0, 20.0, state).unwrap().iterations;
        });
        let error = (0..3).map(|i| (end.unwrapped()[i] - exact.unwrapped()[i]).abs()).fold(0.0, f64::max);
        // Some ten steps, whose errors the motion enlarges by some ten times.
        assert!(error < 1e2 * tolerance + 1e-12, "{error:e} at the tolerance {tolerance:e}");
        assert!(error < last.0 && iterations > last.1, "tighter is more exact, and more work");
        last = (error, iterations);
        if exponent >= -10 {
            // Nor is it much smaller, and constant steps that meet the tolerance take more iterations.
            assert!(error > 1e-3 * tolerance, "{error:e} at the tolerance {tolerance:e}");
            let constant = (2..60).find_map(|steps| {
                let (mut state, mut method, h) = (begin, Gauss::new::<8>(), 20.0 / f64::from(steps));
                let made =
                    (0..steps).map(|_| method.step(&bowl, 0.0, h, &mut state).ok().map(|report| report.iterations));
                let made = made.sum::<Option<u32>>()?;
                let off = (0..3).map(|i| (state.unwrapped()[i] - exact.unwrapped()[i]).abs()).fold(0.0, f64::max);
                (off < tolerance).then_some(made)
            });
            assert!(iterations < constant.unwrap(), "{iterations} iterations, {constant:?} at constant steps");
        }
        let slip = constraint_residual(&bowl, 0.0, end.q(), end.v());
        assert_abs_diff_eq!(slip[0], 0.0, epsilon = 4.0 * f64::EPSILON);
    }
}

/// A sleigh whose blade turns in its body at 0.9 rad/s, pushed by a torque that swings: a basis that moves, and no reduced
/// equations by hand.
#[derive(Clone, Copy)]
pub(crate) struct Swivelling;

impl System<3, 1> for Swivelling {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        let (vx, vy) = (v[0] - sin * v[2] * 0.4, v[1] + cos * v[2] * 0.4);
        (vx * vx + vy * vy) * 0.65 + v[2] * v[2] * 0.4
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = (q[2] + t * 0.9).sin_cos();
        ([[-sin, cos, S::zero()]], [S::zero()])
    }
    fn force<S: Scalar>(&self, t: S, _q: &[S; 3], _v: &[S; 3]) -> Option<[S; 3]> {
        Some([S::zero(), S::zero(), (t * 2.0).cos() * 0.5])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (sin, cos) = (q[2] + t * 0.9).sin_cos();
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[cos, sin, zero], [zero, zero, one]]))
    }
}

/// The time within an interval goes on with its steps, whether the stages are found at once or in turn.
#[test]
fn steps_of_their_own_length_know_the_time() {
    fn check<Sys: System<3, 1>>(system: &Sys, t0: f64, begin: &State<3>) {
        let (mut state, mut exact) = (*begin, *begin);
        let schedule = Schedule { t0, step: 0.05, steps: 100 };
        drive(system, &mut Gauss::new::<8>(), &schedule, &mut exact, ()).unwrap();
        let mut method = GaussAdaptive::new::<8>(1e-11);
        // Of the second interval the first step is the last of the first.
        for k in 0..2 {
            method.step(system, t0 + 2.5 * f64::from(k), 2.5, &mut state).unwrap();
        }
        for i in 0..3 {
            // As many steps, and as much enlarged, as above.
            assert_abs_diff_eq!(state.q()[i], exact.q()[i], epsilon = 1e2 * 1e-11 + 1e-12);
            assert_abs_diff_eq!(state.v()[i], exact.v()[i], epsilon = 1e2 * 1e-11 + 1e-12);
        }
        let slip = constraint_residual(system, t0 + 5.0, state.q(), state.v());
        assert_abs_diff_eq!(slip[0], 0.0, epsilon = 4.0 * f64::EPSILON * state.v()[0].hypot(state.v()[1]).max(1.0));
    }
    let start_at =
        |angle: f64| State::new([0.3, -0.2, 0.5], [0.6 * angle.cos(), 0.6 * angle.sin(), 0.4], [false, false, true]);
    check(&Three::from(Swivelling), 0.4, &start_at(0.5 + 0.9 * 0.4));
    let body = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let swing = Torque::new(TimeFunction::Sine { amplitude: 0.5, frequency: 2.0, phase: 0.3 }).unwrap();
    check(&ByHand::from(With { body, effects: (swing,) }), 0.4, &start_at(0.5));
}

/// What it remembers is all that the next interval depends on.
#[test]
fn an_adaptive_run_continues_from_a_checkpoint() {
    let body = ByHand::from(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    let mut state = start(&SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() });
    let mut method = GaussAdaptive::new::<8>(1e-9);
    OneStep::<3, 1>::step(&mut method, &body, 0.0, 7.0, &mut state).unwrap();
    let memory = OneStep::<3, 1>::memory(&method);
    let (mut again, mut other) = (state, GaussAdaptive::new::<8>(1e-9));
    OneStep::<3, 1>::recall(&mut other, &memory, &again);
    method.step(&body, 7.0, 7.0, &mut state).unwrap();
    other.step(&body, 7.0, 7.0, &mut again).unwrap();
    assert_eq!(state, again);
    assert_ne!(memory, OneStep::<3, 1>::memory(&method));
}

/// What a file says of the last step may be any numbers: the next interval is crossed all the same, or refused.
#[test]
fn numbers_that_no_step_leaves_do_no_harm() {
    let body = ByHand::from(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    let mut begin = start(&SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() });
    let mut method = GaussAdaptive::new::<8>(1e-9);
    OneStep::<3, 1>::step(&mut method, &body, 0.0, 7.0, &mut begin).unwrap();
    let memory = OneStep::<3, 1>::memory(&method);
    let mut exact = begin;
    method.step(&body, 7.0, 7.0, &mut exact).unwrap();
    for wild in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300, -1e300, -1.0, 0.0] {
        for place in 0..memory.len() {
            let (mut state, mut other, mut numbers) = (begin, GaussAdaptive::new::<8>(1e-9), memory.clone());
            numbers[place] = wild;
            OneStep::<3, 1>::recall(&mut other, &numbers, &state);
            if other.step(&body, 7.0, 7.0, &mut state).is_ok() {
                for i in 0..3 {
                    // As many steps, and as much enlarged, as above.
                    assert_abs_diff_eq!(state.q()[i], exact.q()[i], epsilon = 1e2 * 1e-9);
                }
            } else {
                assert_eq!(state, begin);
            }
        }
    }
}

/// A place where nothing is finite ends the interval with an error, and nothing has moved.
#[test]
fn what_cannot_be_crossed_is_an_error() {
    let body = ByHand::from(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    let begin = start(&SleighState { speed: 1e200, turn_rate: 1e200, ..SleighState::default() });
    let mut state = begin;
    let found = GaussAdaptive::new::<8>(1e-9).step(&body, 0.0, 1.0, &mut state);
    assert!(matches!(found, Err(StepError::Tolerance { .. } | StepError::NotFinite)), "{found:?}");
    assert_eq!(state, begin);
}

#[test]
fn a_million_steps_lose_no_energy_but_by_rounding() {
    lose_no_energy(1000, (200, 1e-6));
}

#[test]
#[ignore = "slow"]
fn a_million_steps_lose_no_energy_but_by_rounding_at_length() {
    lose_no_energy(1_000_000, (100_000, 1e-12));
}

/// What a step leaves out is the same in every step, and adds up, where rounding only wanders: sums of `n` steps that are each
/// rounded by less than `eps E` are off by `sqrt(n) eps E`, and by five times that once in a million.
fn lose_no_energy(steps: u32, (control, tolerance): (u32, f64)) {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let system = ByHand::from(With { body, effects: (Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap(),) });
    let begin = start(&SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() });
    let at = |state: &State<3>| energy(&system, 0.0, state.q(), state.v());
    let walk = |steps: u32| 5.0 * f64::EPSILON * f64::from(steps).sqrt() * at(&begin);
    let (mut state, mut method) = (begin, Gauss::new::<4>());
    for k in 0..steps {
        method.step(&system, f64::from(k) * 0.05, 0.05, &mut state).unwrap();
    }
    assert_abs_diff_eq!(at(&state), at(&begin), epsilon = walk(steps));

    // The control: stages that are iterated to a tolerance.
    let (mut state, mut loose) = (begin, GaussAdaptive::new::<4>(tolerance));
    for k in 0..control {
        loose.step(&system, f64::from(k) * 0.05, 0.05, &mut state).unwrap();
    }
    assert!((at(&state) - at(&begin)).abs() > walk(control));
}

/// Where the slopes are constant there is nothing to contract: an interval is crossed in one step, however often.
#[test]
fn a_steady_motion_takes_no_more_steps() {
    let circle = ByHand::from(Sleigh::new(1.0, 1.0, 0.0).unwrap());
    let mut method = GaussAdaptive::new::<8>(1e-12);
    for start in [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.0, 0.7]] {
        let mut state = State::new([0.3, -0.2, 0.0], start, [false, false, true]);
        for k in 0..200 {
            let report = method.step(&circle, 0.05 * f64::from(k), 0.05, &mut state).unwrap();
            assert!(report.iterations <= 8, "{start:?}, step {k}: {} iterations", report.iterations);
        }
    }
}
