use crate::runs::{backward, sleigh, sleigh_state, state_of, system};
use crate::support::{OWN, run_own};
use dla::{
    AnyState, Composition, Dla, Gauss, OneStep, RecommendError, Recommendation, RunError, Samples, Schedule,
    Trajectory, drive, recommend_by_trial,
};
use lagrangian::Alpha;
use sleigh::Exact;

const DURATION: f64 = 40.0;

fn recommended<Method>(method: Method, duration: f64, tolerance: f64) -> Result<Recommendation, RecommendError>
where
    Method: OneStep<3, 1> + Copy,
{
    recommend_by_trial(duration, tolerance, |schedule, times| {
        let mut samples = Samples::new(&OWN, times);
        run_own(&system(), method, schedule, &mut state_of(&backward()), &mut samples)?;
        let taken = samples.into_taken().map_err(|source| RunError::new(schedule.steps, schedule.t0, source))?;
        Ok(taken.iter().map(AnyState::unwrapped).collect())
    })
}

/// The largest error of a coordinate at any node.
fn reached<Method: OneStep<3, 1>>(mut method: Method, found: &Recommendation) -> f64 {
    let mut trajectory = Trajectory::every((found.steps / 500).max(1));
    let schedule = Schedule { t0: 0.0, step: found.step, steps: found.steps };
    drive(&system(), &mut method, &schedule, &mut state_of(&backward()), &mut trajectory).unwrap();
    let exact = Exact::new(&sleigh(), &backward()).unwrap();
    trajectory.nodes().iter().fold(0.0, |largest: f64, node| {
        let (q, _) = exact.at(node.t).to_coordinates();
        (0..3).fold(largest, |largest, i| largest.max((q[i] - node.q[i]).abs()))
    })
}

fn has_the_error<Method: OneStep<3, 1> + Copy>(name: &str, method: Method, tolerance: f64) {
    let found = recommended(method, DURATION, tolerance).unwrap();
    assert_eq!(found.step, DURATION / found.steps as f64);
    let error = reached(method, &found);
    println!("{name} {tolerance:e}: {found:?}, reached {error:.2e}");
    assert!((0.1..=10.0).contains(&(error / tolerance)), "{name} {tolerance:e}: {found:?} {error:e}");
    assert!((0.2..=2.0).contains(&(found.estimated_error / error)), "{name}: {found:?} {error:e}");
}

#[test]
fn the_error_is_that_of_the_tolerance() {
    has_the_error("dla", Dla::midpoint(), 1e-3);
    has_the_error("gauss8", Gauss::new::<4>(), 1e-6);
}

#[test]
#[ignore = "slow"]
fn the_error_is_that_of_the_tolerance_at_length() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        has_the_error("dla", Dla::midpoint(), tolerance);
        has_the_error("dla4", Composition::suzuki4(Dla::midpoint()), tolerance);
        has_the_error("gauss8", Gauss::new::<4>(), tolerance);
    }
}

/// What cannot be reached is said, with what can.
#[test]
fn a_tolerance_below_rounding_is_refused_with_the_best() {
    let error = recommended(Gauss::new::<4>(), DURATION, 1e-17).unwrap_err();
    println!("{error}");
    let RecommendError::OutOfReach { best, steps, .. } = error else { panic!("{error}") };
    // Positions of forty metres have an ulp of 7e-15.
    assert!(best < 1e-11 && steps > 8, "{error}");
    for (tolerance, duration) in [(0.0, 1.0), (f64::NAN, 1.0), (1e-3, -1.0), (1e-3, f64::INFINITY)] {
        let error = recommended(Dla::midpoint(), duration, tolerance).unwrap_err();
        assert!(matches!(error, RecommendError::Request { .. }), "{error}");
    }
}

/// Forward, flip, back: how far from the start the recommended steps end, and how far rounding may bring them.
fn returned<Method: OneStep<3, 1> + Copy>(method: Method, duration: f64, tolerance: f64) -> (f64, f64) {
    let (sleigh, start) = (system(), state_of(&backward()));
    let found = recommended(method, duration, tolerance).unwrap();
    let schedule = Schedule { t0: 0.0, step: found.step, steps: found.steps };
    let mut state = start;
    drive(&sleigh, &mut { method }, &schedule, &mut state, ()).unwrap();
    state = state.reversed();
    drive(&sleigh, &mut { method }, &schedule, &mut state, ()).unwrap();
    let (end, start) = (sleigh_state(&state.reversed()), sleigh_state(&start));
    let distance = f64::hypot(end.x - start.x, end.y - start.y).max((end.heading - start.heading).abs());
    // Every step leaves a rounding error in the velocities, of size one. The way back leaves a straight motion that repels
    // it at the rate kappa = a U m/J = 0.40, from the end to the turn at 7.2 s; a velocity moves the place for the rest
    // of the time.
    let growth = (0.4 * (duration - 7.2)).exp();
    (distance, 2.0 * found.steps as f64 * f64::EPSILON * growth * duration)
}

test_systems::short_and_full! {
    the_symmetry_is_kept => symmetric_methods_return(&[1e-3], 1e-2);
    the_symmetry_is_kept_in_full => symmetric_methods_return(&[1e-3, 1e-6], 1e-3);
}

/// The control, whose error is of the first order, returns no nearer than its tolerance has it.
fn symmetric_methods_return(tolerances: &[f64], control: f64) {
    for &tolerance in tolerances {
        let symmetric = [
            returned(Dla::midpoint(), 10.0, tolerance),
            returned(Composition::suzuki4(Dla::midpoint()), 10.0, tolerance),
            returned(Gauss::new::<4>(), 10.0, tolerance),
        ];
        println!("return {tolerance:e}: {symmetric:?}");
        assert!(symmetric.iter().all(|(distance, rounding)| distance <= rounding), "{symmetric:?}");
    }
    let alpha = Alpha::new(0.3).unwrap();
    let (unsymmetric, _) = returned(Dla::new(alpha, alpha), 10.0, control);
    assert!(unsymmetric > 0.1 * control, "{unsymmetric:e}");
}
