//! Methods with steps of their own within a step are looked at in each of them.

use crate::support::{ByHand, OWN_STEPS, run_own};
use approx::assert_abs_diff_eq;
use dla::{
    Close, Crossing, Event, Gauss, GaussAdaptive, OneStep, Schedule, State, StepError, StepReport, Watch, drive,
};
use lagrangian::{System, With, constraint_residual};
use proptest::prelude::*;
use sleigh::effects::Bowl;
use sleigh::{Sleigh, Taylor};
use std::ops::ControlFlow;

/// `x'' = -100 x` along a line: with `x = 0` and `x' = 1` it is `sin(10 t)/10`.
fn well() -> With<Sleigh, Bowl> {
    With { body: Sleigh::new(1.0, 1.0, 0.0).unwrap(), effects: Bowl::new([100.0; 2], [0.0; 2]).unwrap() }
}

/// The same, to be passed to a method.
fn spring() -> ByHand {
    well().into()
}

/// The first `n` times at which `sin(10 t)/10` is 0.05: twice in each of its turns.
fn crossings(n: u32) -> impl Iterator<Item = f64> {
    use std::f64::consts::{PI, TAU};
    (0..n).map(|k| (f64::from(k / 2) * TAU + if k % 2 == 0 { PI / 6.0 } else { 5.0 * PI / 6.0 }) / 10.0)
}

fn found<Method>(method: &Method, (step, steps): (f64, u64)) -> (Vec<Crossing>, Option<Close>)
where
    Method: OneStep<3, 1> + Clone,
{
    let events = [Event::new("x = 0.05", |_, q, _| q[0] - 0.05)];
    let mut watch = Watch::new(&OWN_STEPS, &events, ());
    let mut state = State::new([0.0; 3], [1.0, 0.0, 0.0], [false, false, true]);
    let schedule = Schedule { t0: 0.0, step, steps };
    run_own(&spring(), method.clone(), &schedule, &mut state, &mut watch).unwrap();
    (watch.crossings().to_vec(), watch.close())
}

fn all_twenty<Method>(method: &Method)
where
    Method: OneStep<3, 1> + Clone,
{
    for run in [(6.0, 1), (2.0, 3), (0.75, 8)] {
        let (found, close) = found(method, run);
        assert_eq!(found.len(), 20, "steps of {} s: {found:?}", run.0);
        for (k, (crossing, t)) in found.iter().zip(crossings(20)).enumerate() {
            assert_abs_diff_eq!(crossing.t, t, epsilon = 1e-9);
            assert_abs_diff_eq!(crossing.state.q()[0], 0.05, epsilon = 1e-14);
            assert!(crossing.rising == (k % 2 == 0) && crossing.spacing < 0.1, "{crossing:?}");
        }
        assert_eq!(close, None);
    }
}

/// A method that keeps its own steps to itself.
#[derive(Clone)]
struct Closed<Method>(Method);

impl<Method: OneStep<3, 1>> OneStep<3, 1> for Closed<Method> {
    fn step(
        &mut self,
        system: &dyn dla::Mechanics<3, 1>,
        t: f64,
        h: f64,
        state: &mut State<3>,
    ) -> Result<StepReport<1>, StepError> {
        self.0.step(system, t, h, state)
    }
}

/// SciPy issue 9228: several roots within a long step. The control, which is looked at in its whole steps, misses most of them, and
/// says that.
#[test]
fn crossings_within_a_long_step_are_all_found() {
    all_twenty(&GaussAdaptive::new::<8>(1e-13));
    all_twenty(&GaussAdaptive::new::<4>(1e-12));
    all_twenty(&Taylor::of(&well(), 1e-15).unwrap());
    let (few, close) = found(&Closed(Taylor::of(&well(), 1e-15).unwrap()), (2.0, 3));
    let close = close.unwrap();
    assert!(few.len() == 4 && close.count > 0, "{few:?}");
    assert_abs_diff_eq!(close.spacing, 0.5, epsilon = 1e-15);
}

/// What is shown of a step: the times and the states, and what the method remembers then.
fn shown<Method>(
    method: &Method,
    (t, h): (f64, f64),
    state: &State<3>,
    memory: &mut Vec<f64>,
) -> Result<Vec<(f64, State<3>)>, StepError>
where
    Method: OneStep<3, 1>,
{
    let mut seen = Vec::new();
    method.own_steps(&spring(), (t, h), state, memory, &mut |t, state| {
        seen.push((t, *state));
        ControlFlow::Continue(())
    })?;
    Ok(seen)
}

/// Two steps of a run, in what the method shows of its own steps within them.
fn are_those_of_the_run<Method>(new: &Method, h: f64, start: &State<3>, error: f64) -> Result<(), TestCaseError>
where
    Method: OneStep<3, 1> + Clone,
{
    let (system, mut method, mut state, mut memory) = (spring(), new.clone(), *start, Vec::new());
    for t in [0.0, h] {
        let seen = shown(new, (t, h), &state, &mut memory).unwrap();
        prop_assert!(seen.len() > 2, "{} steps", seen.len());
        // In order, inside the step.
        let times: Vec<f64> = [t].into_iter().chain(seen.iter().map(|(t, _)| *t)).chain([t + h]).collect();
        prop_assert!(times.windows(2).all(|pair| (pair[1] - pair[0]) * h > 0.0), "{times:?}");
        let (begin, mut other, mut from) = (state, state, t);
        method.step(&system, t, h, &mut state).unwrap();
        prop_assert_eq!(&memory, &OneStep::<3, 1>::memory(&method), "it remembers what the run does");
        for (at, inner) in &seen {
            let residual = constraint_residual(&system, *at, inner.q(), inner.v())[0];
            // Speeds of up to 15 m/s, in axes whose angle is rounded.
            prop_assert!(residual.abs() <= 64.0 * f64::EPSILON, "{:e}", residual);
            // On the motion: where a method of order 16 leads with a quarter of these steps.
            let schedule = Schedule { t0: from, step: 0.25 * (at - from), steps: 4 };
            drive(&system, &mut Gauss::new::<8>(), &schedule, &mut other, ()).unwrap();
            from = *at;
            for i in 0..3 {
                prop_assert!((inner.unwrapped()[i] - other.unwrapped()[i]).abs() <= error);
            }
        }
        // Asked for no more, it shows no more.
        let mut count = 0;
        let _ = new.own_steps(&system, (t, h), &begin, &mut Vec::new(), &mut |_, _| {
            count += 1;
            if count == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        prop_assert_eq!(count, 2);
    }
    Ok(())
}

/// A start, and the length of a step in either direction.
fn steps() -> impl Strategy<Value = (State<3>, f64)> {
    let quasi = (-1.5..1.5f64, -1.5..1.5f64);
    (proptest::array::uniform3(-1.0..1.0f64), quasi, 1.5..3.0f64, any::<bool>()).prop_map(
        |(q, (speed, turn_rate), length, backward)| {
            let well = spring();
            let v = lagrangian::velocity_of(&well, 0.0, &q, &[speed, turn_rate, 0.0]).unwrap();
            (State::new(q, v, well.angles()), if backward { -length } else { length })
        },
    )
}

/// They are the steps of the run itself, forward and backward.
fn by_both((start, h): (State<3>, f64)) -> Result<(), TestCaseError> {
    // Frequencies of ten, over two steps, which errors are enlarged by.
    are_those_of_the_run(&GaussAdaptive::new::<8>(1e-12), h, &start, 1e-8)?;
    are_those_of_the_run(&Taylor::of(&well(), 1e-14).unwrap(), h, &start, 1e-8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1))]

    #[test]
    fn own_steps_are_those_of_the_run(step in steps()) {
        by_both(step)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    #[ignore = "slow"]
    fn own_steps_are_those_of_the_run_in_full(step in steps()) {
        by_both(step)?;
    }
}

/// A method that takes the steps of the run shows none of its own, and remembers nothing.
#[test]
fn steps_of_the_run_have_none_within() {
    let start = State::new([0.0; 3], [1.0, 0.0, 0.0], [false, false, true]);
    let mut memory = Vec::new();
    assert_eq!(shown(&Gauss::new::<8>(), (0.0, 0.1), &start, &mut memory), Ok(Vec::new()));
    assert!(memory.is_empty());
}
