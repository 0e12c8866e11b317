//! Taylor series in the axes of the sleigh, in steps of their own length.

use approx::assert_abs_diff_eq;
use dla::{Gauss, OneStep, Schedule, State, StepError, drive};
use lagrangian::{System, With, constraint_residual, energy};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, EggCrate, Thrust, Torque};
use sleigh::series::InOwnAxes;
use sleigh::{Exact, Sleigh, SleighState, Taylor};

fn state_of<Sys: System<3, 1>>(system: &Sys, (q, v): ([f64; 3], [f64; 3])) -> State<3> {
    State::new(q, v, system.angles())
}

fn distance(a: &State<3>, b: &State<3>) -> f64 {
    let (a, b) = (a.unwrapped(), b.unwrapped());
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

fn slip<Sys: System<3, 1>>(system: &Sys, state: &State<3>) -> f64 {
    constraint_residual(system, 0.0, state.q(), state.v())[0].abs()
}

const TURNING: SleighState = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: -1.0, turn_rate: 0.1 };

fn bowl() -> With<Sleigh, Bowl> {
    With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: Bowl::new([0.1, 0.1], [0.0; 2]).unwrap() }
}

/// The closed form of the free sleigh, through its turn-around.
#[test]
fn the_free_sleigh_is_in_closed_form() {
    for offset in [0.5, 0.1, -0.3] {
        let sleigh = Sleigh::new(1.0, 1.0, offset).unwrap();
        let begin = SleighState { x: 0.3, y: -2.0, heading: 2.5, ..TURNING };
        let expected = Exact::new(&sleigh, &begin).unwrap().at(40.0);
        let expected = state_of(&sleigh, expected.to_coordinates());
        for (tolerance, error) in [(1e-6, 1e-4), (1e-9, 1e-7), (1e-12, 1e-10), (1e-16, 1e-12)] {
            let mut state = state_of(&sleigh, begin.to_coordinates());
            Taylor::of(&sleigh, tolerance).unwrap().step(&sleigh, 0.0, 40.0, &mut state).unwrap();
            // Some twenty steps, whose errors the spin enlarges by no more than the hundredfold of its own growth.
            assert_abs_diff_eq!(distance(&state, &expected), 0.0, epsilon = error);
            assert_abs_diff_eq!(slip(&sleigh, &state), 0.0, epsilon = 4.0 * f64::EPSILON);
        }
    }
}

/// The error at the end follows the tolerance.
#[test]
fn errors_follow_the_tolerance() {
    let (system, begin) = (&bowl(), TURNING.to_coordinates());
    let mut exact = state_of(system, begin);
    let schedule = Schedule { t0: 0.0, step: 0.1, steps: 200 };
    drive(system, &mut Gauss::new::<8>(), &schedule, &mut exact, ()).unwrap();
    let mut last = f64::INFINITY;
    for exponent in [-3, -6, -9, -12] {
        let tolerance = 10f64.powi(exponent);
        let mut state = state_of(system, begin);
        Taylor::of(system, tolerance).unwrap().step(system, 0.0, 20.0, &mut state).unwrap();
        let error = distance(&state, &exact);
        println!("{error:e} at {tolerance:e}");
        // Some twenty steps, whose errors the motion enlarges by some ten times.
        assert!(error < 2e2 * tolerance + 1e-13, "{error:e} at the tolerance {tolerance:e}");
        assert!(error < last, "tighter is more exact");
        // Nor is it much smaller: steps are as long as they may be.
        assert!(exponent < -9 || error > 1e-5 * tolerance, "{error:e} at the tolerance {tolerance:e}");
        last = error;
    }
}

fn sleighs() -> impl Strategy<Value = Sleigh> {
    (0.3..3.0f64, 0.3..3.0f64, prop_oneof![4 => -1.0..1.0, 1 => Just(0.0)])
        .prop_map(|(m, i, a)| Sleigh::new(m, i, a).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever pushes the sleigh in its own axes, and wherever they are counted from, the motion agrees with collocation.
    #[test]
    fn series_and_collocation_are_one_motion(
        sleigh in sleighs(), k in -0.3..0.3f64, push in proptest::array::uniform2(-0.5..0.5f64),
        center in proptest::array::uniform2(-2.0..2.0f64), z in proptest::array::uniform5(-1.5..1.5f64), backward: bool,
        drag in proptest::array::uniform2(0.0..0.5f64),
    ) {
        let begin = SleighState { x: z[0], y: z[1], heading: 4.0 * z[2], speed: z[3], turn_rate: z[4] };
        let h = if backward { -2.0 } else { 2.0 };
        let same = |system: &dyn Fn(&mut State<3>, bool), begin| {
            let (mut series, mut collocation) = (begin, begin);
            system(&mut series, true);
            system(&mut collocation, false);
            // A few steps of each, to rounding, in numbers of some units that two seconds enlarge by e^6 at most.
            assert_abs_diff_eq!(distance(&series, &collocation), 0.0, epsilon = 1e-10);
            for i in 0..3 {
                assert_abs_diff_eq!(series.v()[i], collocation.v()[i], epsilon = 1e-10);
            }
        };
        fn run<Sys: System<3, 1> + InOwnAxes>(system: &Sys, h: f64) -> impl Fn(&mut State<3>, bool) {
            move |state, by_series| {
                if by_series {
                    Taylor::of(system, 1e-15).unwrap().step(system, 0.0, h, state).unwrap();
                } else {
                    let schedule = Schedule { t0: 0.0, step: h / 60.0, steps: 60 };
                    drive(system, &mut Gauss::new::<8>(), &schedule, state, ()).unwrap();
                }
            }
        }
        same(&run(&sleigh, h), state_of(&sleigh, begin.to_coordinates()));
        let pushes = (Thrust::new(push[0]).unwrap(), Torque::new(push[1]).unwrap());
        let effects = (Bowl::new([k, k], center).unwrap(), pushes);
        let pushed = With { body: sleigh, effects };
        same(&run(&pushed, h), state_of(&pushed, begin.to_coordinates()));
        let slow = (Bowl::new([k, k], center).unwrap(), Drag::new(drag[0], drag[1]).unwrap());
        let damped = With { body: sleigh, effects: slow };
        same(&run(&damped, h), state_of(&damped, begin.to_coordinates()));
    }
}

/// To rounding, energy goes with the square root of the steps or a little faster; to a tolerance it is lost in proportion to the time,
/// as no symmetric method would. The velocity stays on the constraint all the same.
#[test]
fn energy_is_kept_to_the_tolerance() {
    let system = bowl();
    let lost = |tolerance: f64, time: f64| {
        let mut state = state_of(&system, TURNING.to_coordinates());
        let before = energy(&system, 0.0, state.q(), state.v());
        for part in [0.3, 0.7] {
            Taylor::of(&system, tolerance).unwrap().step(&system, 0.0, part * time, &mut state).unwrap();
        }
        // After hundreds of turns in each.
        assert_abs_diff_eq!(slip(&system, &state), 0.0, epsilon = 4.0 * f64::EPSILON);
        (energy(&system, 0.0, state.q(), state.v()) - before).abs() / before
    };
    // Each of 15,000 steps rounds by some units in the last place.
    assert!(lost(1e-17, 1e4) < 15_000.0 * 8.0 * f64::EPSILON, "{:e}", lost(1e-17, 1e4));
    assert!(lost(1e-6, 1e4) > 1e-6, "{:e}", lost(1e-6, 1e4));
}

#[test]
fn what_has_no_such_equations_is_refused() {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let system = With { body, effects: EggCrate::new(0.1, [1.0, 1.0]).unwrap() };
    assert_eq!(Taylor::of(&system, 1e-9), None);
}

/// Rest, motion without curvature, and numbers tiny and huge; and what cannot be crossed is an error, and nothing has moved.
#[test]
fn extremes_are_crossed_or_refused() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let cross = |speed: f64, turn_rate: f64, tolerance: f64, h: f64| {
        let begin = state_of(&sleigh, SleighState { speed, turn_rate, ..TURNING }.to_coordinates());
        let mut state = begin;
        let found = Taylor::of(&sleigh, tolerance).unwrap().step(&sleigh, 0.0, h, &mut state);
        if found.is_err() {
            assert_eq!(state, begin);
        }
        found.map(|_| state)
    };
    assert_eq!(cross(0.0, 0.0, 1e-9, 100.0).unwrap().unwrapped(), [0.0; 3]);
    assert_abs_diff_eq!(cross(2.0, 0.0, 1e-9, 1e6).unwrap().unwrapped()[0], 2e6, epsilon = 1e-9);
    assert_eq!(cross(1.0, 0.1, 1e-9, 0.0).unwrap().unwrapped(), [0.0; 3]);
    // The spin is not lost beside the speed.
    let tiny = cross(1.0, 1e-200, 1e-9, 1.0).unwrap();
    assert_abs_diff_eq!(tiny.v()[2] / 1e-200, (-sleigh.spin_gain()).exp(), epsilon = 1e-12);
    let slow = cross(1e-150, 1e-150, 1e-9, 10.0).unwrap();
    assert_abs_diff_eq!(slow.v()[2] / 1e-150, 1.0, epsilon = 1e-12);
    // What one short time does to great speed is done to small speed in a long one.
    let (fast, unit) = (cross(1e8, 1e8, 1e-12, 1e-8).unwrap(), cross(1.0, 1.0, 1e-12, 1.0).unwrap());
    assert_abs_diff_eq!(distance(&fast, &unit), 0.0, epsilon = 1e-9);
    for (speed, turn_rate) in [(1e200, 1e200), (1.0, 1e60), (1e300, 1.0)] {
        let found = cross(speed, turn_rate, 1e-9, 1.0);
        assert!(matches!(found, Err(StepError::Tolerance { .. } | StepError::NotFinite)), "{found:?}");
    }
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        if let Ok(state) = cross(-1.0, 0.1, tolerance, 100.0) {
            assert!(state.q().iter().all(|q| q.is_finite()));
        }
    }
}
