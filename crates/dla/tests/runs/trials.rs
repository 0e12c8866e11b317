//! Steps that are recommended by trials whose errors follow a law.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dla::{RecommendError, Recommendation, RunError, StepError, recommend_by_trial};

/// Trials with the error `c h^order` at every time, and with a failure above a step.
fn by_law(order: i32, tolerance: f64, longest: f64) -> Result<Recommendation, RecommendError> {
    recommend_by_trial(10.0, tolerance, |schedule, times| {
        if schedule.step > longest {
            return Err(RunError::new(1, 0.0, StepError::Branch));
        }
        Ok(times.iter().map(|t| vec![t + 3.0 * schedule.step.powi(order)]).collect())
    })
}

#[test]
fn a_step_is_recommended_by_the_law_of_its_errors() {
    for order in [1, 2, 4, 6] {
        for tolerance in [1e-2, 1e-4, 1e-6] {
            for longest in [f64::INFINITY, 0.1] {
                let found = by_law(order, tolerance, longest).unwrap();
                assert_relative_eq!(found.step * found.steps as f64, 10.0, max_relative = 1e-15);
                assert!(found.step <= longest);
                // Known to a twentieth of the tolerance, it is below the half that is aimed at.
                let error = 3.0 * found.step.powi(order);
                assert_abs_diff_eq!(found.estimated_error, error, epsilon = 0.05 * tolerance);
                assert!(error <= 0.55 * tolerance, "{order} {tolerance}: {error}");
                // The longest that is content with that, unless a longer one fails or one step makes the difference.
                let longer = 10.0 / (found.steps - 1) as f64;
                let as_long = error >= 0.2 * tolerance || 3.0 * longer.powi(order) > 0.45 * tolerance;
                assert!(as_long || longest < 1.0 || found.steps <= 4, "{order} {tolerance}: {found:?}");
            }
        }
    }
}

#[test]
fn what_cannot_be_recommended() {
    for (tolerance, duration) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (1.0, 0.0), (1.0, f64::INFINITY)] {
        let refused = recommend_by_trial(duration, tolerance, |_, _| Ok(Vec::new())).unwrap_err();
        assert!(matches!(refused, RecommendError::Request { .. }));
    }
    // A method that cannot do the system is asked once, at the longest step of a fourth.
    let mut asked = 0;
    let refused = recommend_by_trial(10.0, 1e-3, |_, _| {
        asked += 1;
        Err(RunError::new(1, 0.0, StepError::Unsupported { reason: "it cannot" }))
    });
    assert!(matches!(refused, Err(RecommendError::Fails { step, .. }) if step == 2.5) && asked == 1, "{refused:?}");
    // Errors that stay are out of reach, whatever the step.
    let mut sign = 1.0;
    let stays = recommend_by_trial(10.0, 1e-9, |schedule, times| {
        sign = -sign;
        Ok(times.iter().map(|t| vec![t + sign * 1e-8 * (1.0 + schedule.step)]).collect())
    });
    let Err(RecommendError::OutOfReach { tolerance, best, step, steps }) = stays else { panic!("{stays:?}") };
    assert!(tolerance == 1e-9 && (2e-8..1e-6).contains(&best));
    assert_relative_eq!(step * steps as f64, 10.0, max_relative = 1e-15);
}
