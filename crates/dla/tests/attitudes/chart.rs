//! Coordinates that end: runs are refused near there, and not before.

use crate::attitudes::angles::{AngleBall, CHART};
use crate::attitudes::tools::largest;
use crate::support::{Five, Four, Six};
use dla::{Composition, Dla, Gauss, Hint, InChart, Lobatto, OneStep, State, StepError, View};
use lagrangian::System;
use models::{ChaplyginBall, Model, Suslov, TurntableBall};

type Guarded<Method> = InChart<Method, fn(&[f64; 5]) -> f64>;

fn guarded<Method>(method: Method) -> Guarded<Method> {
    InChart::new(method, CHART, |q| BALL.regularity(q))
}

const LEAST: f64 = InChart::<(), ()>::LEAST;

const BALL: AngleBall = AngleBall { mass: 1.0, radius: 1.0, inertia: [0.4; 3] };
const SYSTEM: Five = Five::AngleBall(BALL);

/// The largest error of the place of a run that is to be refused, the time of that, and the error.
fn refused<Method: OneStep<5, 2>>(method: Method, omega: [f64; 3], step: f64) -> (f64, f64, StepError) {
    let steps = (10.0 / step).round() as u64;
    let ([off], end) =
        largest(&SYSTEM, &mut guarded(method), BALL.level(omega), (step, steps), |node: &View<'_, 5, 2>| {
            let q = node.state.q();
            assert!(BALL.regularity(q) >= LEAST);
            [(q[0] - omega[1] * node.t).abs().max((q[1] + omega[0] * node.t).abs())]
        });
    let error = end.unwrap_err();
    (off, error.time, error.source)
}

/// The runs that left the line are refused before their quarter turn, at a place that has the method's own error.
fn refused_near_the_end(steps: &[f64]) {
    for omega in [[0.0, 1.0, 0.0], [1e-6, 1.0, 0.0], [1e-3, 1.0, 0.0], [0.1, 1.0, 0.05]] {
        for &step in steps {
            for (name, bound, (off, time, error)) in [
                ("dla", 2e-4, refused(Dla::midpoint(), omega, step)),
                ("dla4", 1e-5, refused(Composition::suzuki4(Dla::midpoint()), omega, step)),
                ("lobatto3", 1e-5, refused(Lobatto::<3>::new(), omega, step)),
                ("gauss8", 1e-8, refused(Gauss::new::<4>(), omega, step)),
            ] {
                println!("{name}, {omega:?}, h = {step}: {off:e} m at {time} s, {error}");
                let StepError::Chart { chart, regularity, least, change } = error else { panic!("{name}: {error}") };
                assert_eq!((chart, least), (CHART, LEAST));
                assert!(regularity < least || regularity < change, "{error}");
                assert!(error.to_string().contains("cos(beta)") && error.to_string().contains("quaternion"));
                assert!((1.3..1.6).contains(&time), "{name}: refused at {time} s");
                assert!(off <= bound, "{name}: {off:e} m");
            }
        }
    }
}

#[test]
fn a_run_is_refused_near_the_end() {
    refused_near_the_end(&[0.1]);
}

#[test]
#[ignore = "slow"]
fn a_run_is_refused_near_the_end_in_full() {
    refused_near_the_end(&[0.1, 0.01]);
}

/// A failed step changes nothing, and one that is far from the end is the method's own.
#[test]
fn other_steps_are_the_method_s_own() {
    let (q, v) = BALL.level([0.3, 0.2, -0.4]);
    let (mut alone, mut watched) = (State::new(q, v, [false; 5]), State::new(q, v, [false; 5]));
    let (mut method, mut inside) = (Dla::midpoint(), guarded(Dla::midpoint()));
    for k in 0..50 {
        let t = 0.02 * f64::from(k);
        method.step(&SYSTEM, t, 0.02, &mut alone).unwrap();
        inside.step(&SYSTEM, t, 0.02, &mut watched).unwrap();
    }
    assert_eq!(alone, watched);
    assert_eq!(OneStep::<5, 2>::memory(&inside), OneStep::<5, 2>::memory(&method));

    // Begun beyond the least, and stepping over the end: nothing moves.
    for (beta, step) in [(1.55, 1e-3), (1.5, 0.2), (f64::NAN, 0.01)] {
        let (q, v) = ([0.0, 0.0, 0.0, beta, 0.0], [1.0, 0.0, 0.0, 1.0, 0.0]);
        let start = State::new(q, v, [false; 5]);
        let mut state = start;
        let error = guarded(Dla::midpoint()).step(&SYSTEM, 0.0, step, &mut state).unwrap_err();
        assert!(matches!(error, StepError::Chart { .. }), "{error}");
        assert_eq!(state.q().map(f64::to_bits), start.q().map(f64::to_bits));
        assert_eq!(error.hint(), Some(Hint::OtherCoordinates), "{error}");
    }
}

/// What is not a number, half way only, is no regularity.
#[test]
fn no_regularity_is_none() {
    let (q, v) = BALL.level([0.0, 0.0, 1.0]);
    let half_way = |q: &[f64; 5]| if (0.04..0.06).contains(&q[4]) { f64::NAN } else { 1.0 };
    let mut state = State::new(q, v, [false; 5]);
    let error = InChart::new(Dla::midpoint(), CHART, half_way).step(&SYSTEM, 0.0, 0.1, &mut state).unwrap_err();
    assert!(matches!(error, StepError::Chart { regularity, .. } if regularity.is_nan()), "{error}");
    assert_eq!(state, State::new(q, v, [false; 5]));
}

/// However long the step, no run gets past the end: the regularity alone, at nodes, might miss it.
fn none_passes_the_end(stride: usize) {
    for k in (0..200).step_by(stride) {
        let step = 0.05 + 0.005 * f64::from(k);
        let (q, v) = BALL.level([0.01, 1.0, 0.0]);
        let mut state = State::new(q, v, [false; 5]);
        let mut method = guarded(Gauss::new::<8>());
        let mut t = 0.0;
        let error = loop {
            match method.step(&SYSTEM, t, step, &mut state) {
                Ok(_) => t += step,
                Err(error) => break error,
            }
            assert!(t < std::f64::consts::FRAC_PI_2, "h = {step}: past the end at {t} s");
        };
        // A method may give a long step up by itself, far from the end.
        let too_long = matches!(error, StepError::Newton { .. }) && step > 0.5;
        assert!(matches!(error, StepError::Chart { .. }) || too_long, "h = {step}: {error}");
    }
}

#[test]
fn no_step_passes_the_end() {
    none_passes_the_end(20);
}

#[test]
#[ignore = "slow"]
fn no_step_passes_the_end_in_full() {
    none_passes_the_end(1);
}

/// The models have coordinates without an end.
#[test]
fn no_model_has_an_end() {
    fn everywhere<Mo, Sys, const N: usize, const M: usize>(model: Mo, system: impl Fn(Mo) -> Sys)
    where
        Mo: Model<N, M> + Copy,
        Sys: System<N, M>,
    {
        let (q, v) = model.start();
        let mut method = InChart::new(Dla::midpoint(), "a quaternion", |q: &[f64; N]| model.regularity(q));
        largest(&system(model), &mut method, (q, v), (0.05, 2000), |node: &View<'_, N, M>| {
            assert!(model.regularity(node.state.q()) == 1.0);
            [0.0]
        })
        .1
        .unwrap();
    }
    everywhere(Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5).unwrap(), Four::from);
    everywhere(ChaplyginBall::new(1.2, 0.6, [0.5, 0.8, 1.1]).unwrap(), Six::from);
    everywhere(TurntableBall::new(1.0, 0.5, 0.1, 0.3).unwrap(), Six::from);
}
