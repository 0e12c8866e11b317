//! Newton's method on equations whose solutions are known.

use approx::assert_relative_eq;
use dla::{Equations, History, Newton, NewtonError};
use lagrangian::linear::{Lu, Singular};
use proptest::prelude::*;
use std::f64::consts::SQRT_2;

/// Equations given by their residual and Jacobian.
struct Of<F>(F);

impl<F: FnMut(&[f64; U]) -> ([f64; U], [[f64; U]; U]), const U: usize> Equations<U> for Of<F> {
    fn correction(&mut self, x: &[f64; U]) -> Result<[f64; U], Singular> {
        let (f, jacobian) = self.0(x);
        Ok(Lu::new(jacobian)?.solve(f.map(|f| -f)))
    }
}

fn solve<const U: usize>(f: impl FnMut(&[f64; U]) -> ([f64; U], [[f64; U]; U]), start: [f64; U]) -> ([f64; U], u32) {
    let mut x = start;
    let iterations = Newton::default().solve(&mut Of(f), &mut x).unwrap();
    (x, iterations)
}

fn failure(f: impl FnMut(&[f64; 1]) -> ([f64; 1], [[f64; 1]; 1]), start: f64) -> NewtonError {
    Newton::default().solve(&mut Of(f), &mut [start]).unwrap_err()
}

#[test]
fn the_iterations_are_those_that_are_needed() {
    // Corrections 8e-2, 2e-3, 2e-6, 2e-12: the fourth predicts 1e-24, and no fifth is made.
    let (x, iterations) = solve(|x: &[f64; 1]| ([x[0] * x[0] - 2.0], [[2.0 * x[0]]]), [1.5]);
    assert_relative_eq!(x[0], SQRT_2, max_relative = 2.0 * f64::EPSILON);
    assert_eq!(iterations, 4);
    // A linear equation, exact after one correction, which the second shows; from its solution the first does.
    assert_eq!(solve(|x: &[f64; 1]| ([2.0 * x[0] - 3.0], [[2.0]]), [0.0]), ([1.5], 2));
    assert_eq!(solve(|x: &[f64; 1]| ([2.0 * x[0] - 3.0], [[2.0]]), [1.5]), ([1.5], 1));
}

#[test]
fn a_system_of_two() {
    let circle_and_hyperbola =
        |x: &[f64; 2]| ([x[0] * x[0] + x[1] * x[1] - 5.0, x[0] * x[1] - 2.0], [[2.0 * x[0], 2.0 * x[1]], [x[1], x[0]]]);
    let (x, iterations) = solve(circle_and_hyperbola, [0.7, 2.2]);
    assert_relative_eq!(x[0], 1.0, max_relative = 4.0 * f64::EPSILON);
    assert_relative_eq!(x[1], 2.0, max_relative = 4.0 * f64::EPSILON);
    assert!(iterations <= 6, "{iterations}");
}

/// A tolerance on all components together would stop as soon as the large one is settled.
#[test]
fn small_components_get_all_their_digits() {
    for small in [1e-5, 1e-14, 1e-17, 1e-200] {
        // y (1 + x^2) = 3 small with x^2 = 2, and the reverse order of the unknowns.
        let f = |x: f64, y: f64| (x * x - 2.0, y * (1.0 + x * x) - 3.0 * small);
        for start in [0.0, small, 0.1, 1.0] {
            let (x, _) = solve(
                |&[x, y]: &[f64; 2]| (f(x, y).into(), [[2.0 * x, 0.0], [2.0 * x * y, 1.0 + x * x]]),
                [1.0, start],
            );
            assert_relative_eq!(x[0], SQRT_2, max_relative = 4.0 * f64::EPSILON);
            assert_relative_eq!(x[1], small, epsilon = 0.0, max_relative = 4.0 * f64::EPSILON);
            let (x, _) = solve(
                |&[y, x]: &[f64; 2]| (f(x, y).into(), [[0.0, 2.0 * x], [1.0 + x * x, 2.0 * x * y]]),
                [start, 1.0],
            );
            assert_relative_eq!(x[0], small, epsilon = 0.0, max_relative = 4.0 * f64::EPSILON);
        }
    }
}

#[test]
fn zeros_and_their_rounding_are_settled() {
    // A component whose solution is zero: exactly, and with a noise in every evaluation.
    for noise in [0.0, 1e-300, 1e-17, 1e-13] {
        let mut evaluations = 0u32;
        let (x, iterations) = solve(
            |&[x, y]: &[f64; 2]| {
                evaluations += 1;
                // Neither of one sign nor of one size.
                let rest = noise * f64::from(evaluations * evaluations * 7 % 11) - 5.0 * noise;
                ([x * x - 2.0, y + rest], [[2.0 * x, 0.0], [0.0, 1.0]])
            },
            [1.0, 0.3],
        );
        assert_relative_eq!(x[0], SQRT_2, max_relative = 4.0 * f64::EPSILON);
        assert!(x[1].abs() <= 5.0 * noise && iterations <= 8, "{x:?} in {iterations}");
    }
}

/// The correction relative to the unknown then grows without end, although it converges.
#[test]
fn a_solution_of_zeros_only() {
    assert_eq!(solve(|x: &[f64; 1]| ([x[0] + x[0] * x[0]], [[1.0 + 2.0 * x[0]]]), [0.1]).0, [0.0]);
    assert_eq!(solve(|x: &[f64; 1]| ([x[0] + x[0].powi(3)], [[1.0 + 3.0 * x[0] * x[0]]]), [0.5]).0, [0.0]);
    assert_eq!(solve(|x: &[f64; 2]| (*x, [[1.0, 0.0], [0.0, 1.0]]), [0.0, 0.0]), ([0.0, 0.0], 1));
    // A residual that is the difference of two rounded numbers never tells zero from 1e-17.
    let mut evaluations = 0u32;
    let (x, iterations) = solve(
        |x: &[f64; 1]| {
            evaluations += 1;
            ([x[0] + 1e-17 * (f64::from(evaluations * 7 % 5) - 2.2)], [[1.0]])
        },
        [0.05],
    );
    assert!(x[0].abs() <= 3e-17 && iterations <= 8, "{x:?} in {iterations}");
}

/// Corrections that make `rate` of the way to the solution, as those with derivatives of another point do.
struct Simplified<const U: usize> {
    solution: [f64; U],
    rate: f64,
    made: u32,
}

impl<const U: usize> Equations<U> for Simplified<U> {
    fn correction(&mut self, x: &[f64; U]) -> Result<[f64; U], Singular> {
        self.made += 1;
        // The first leaves rounding of what it takes.
        let (rate, rest) = if self.made == 1 { (1.0, 1e-15) } else { (self.rate, 0.0) };
        Ok(std::array::from_fn(|i| rate * (self.solution[i] - x[i]) + rest))
    }
    fn is_simplified(&self) -> bool {
        self.made > 1
    }
}

/// Their corrections shrink by the same factor for ever, alone and beside one that goes on.
#[test]
fn what_stops_is_settled_with_derivatives_of_its_start_too() {
    // One that starts at zero beside others is seen to move by their rounding.
    let cases = [
        ([0.0, 0.0], [1.0, 0.3], 1e-32),
        ([0.0, 1.0], [1.0, 0.9], 1e-32),
        ([0.0, 0.0], [1.0, 0.0], 1e-15),
        ([0.0, 1.0], [0.0, 0.9], 1e-15),
    ];
    for (solution, start, epsilon) in cases {
        for rate in [0.994, 0.9, 0.88] {
            let mut x = start;
            let iterations = Newton::default().solve(&mut Simplified { solution, rate, made: 0 }, &mut x).unwrap();
            for i in 0..2 {
                assert_relative_eq!(x[i], solution[i], epsilon = epsilon, max_relative = 4.0 * f64::EPSILON);
            }
            assert!(iterations <= 24, "{iterations}");
        }
    }
    // What does not stop keeps its digits, however small it is beside others.
    let mut x = [1.0, 1.1e-60];
    Newton::default().solve(&mut Simplified { solution: [0.9, 1e-60], rate: 0.99, made: 1 }, &mut x).unwrap();
    assert_relative_eq!(x[1], 1e-60, epsilon = 0.0, max_relative = 8.0 * f64::EPSILON);
}

/// The rounding of what comes to rest exactly: below the smallest normal number a correction may overshoot for ever.
#[test]
fn what_is_below_every_normal_number_is_settled() {
    let overshooting = |x: &[f64; 1]| ([2.0 * x[0]], [[1.0]]);
    let (x, iterations) = solve(overshooting, [f64::MIN_POSITIVE / 64.0]);
    assert!(x[0].abs() < f64::MIN_POSITIVE && iterations <= 2);
    // The positive control: a normal number that does the same is no solution.
    assert!(matches!(failure(overshooting, 1e-300), NewtonError::IterationLimit { .. }));
}

#[test]
fn no_unknowns_need_one_iteration() {
    assert_eq!(solve(|_: &[f64; 0]| ([], []), []), ([], 1));
}

#[test]
fn divergence_is_reported() {
    // |x| > 1.39 runs away: 3, -9.5, 124, -2.4e4.
    let error = failure(|x| ([x[0].atan()], [[(1.0 + x[0] * x[0]).recip()]]), 3.0);
    assert!(matches!(error, NewtonError::Diverged { iteration: 4, .. }), "{error}");
    // No solution: the corrections wander.
    let error = failure(|x| ([x[0] * x[0] + 1.0], [[2.0 * x[0]]]), 0.3);
    assert!(matches!(error, NewtonError::Diverged { .. }), "{error}");
    // Within 1.39 it converges, to zero.
    assert_eq!(solve(|x: &[f64; 1]| ([x[0].atan()], [[(1.0 + x[0] * x[0]).recip()]]), [1.2]).0, [0.0]);
}

#[test]
fn failures_name_their_iteration() {
    let error = failure(|x| ([x[0] * x[0] + 1.0], [[2.0 * x[0]]]), 0.0);
    assert!(matches!(error, NewtonError::Singular { iteration: 1, .. }), "{error}");
    // From 1 to 0 in one step.
    let error = failure(|x| ([x[0] * x[0] + 1.0], [[2.0 * x[0]]]), 1.0);
    assert!(matches!(error, NewtonError::Singular { iteration: 2, .. }), "{error}");

    // A double root, where every correction is half of the last.
    let mut x = [1.0];
    let newton = Newton { max_iterations: 5, ..Newton::default() };
    let error = newton.solve(&mut Of(|x: &[f64; 1]| ([x[0] * x[0]], [[2.0 * x[0]]])), &mut x).unwrap_err();
    assert!(matches!(error, NewtonError::IterationLimit { iterations: 5, .. }), "{error}");
    assert_eq!(x, [1.0 / 32.0], "the unknowns are where the search ended");

    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut evaluations = 0;
        let error = failure(
            |x| {
                evaluations += 1;
                ([if evaluations == 2 { bad } else { x[0] * x[0] - 2.0 }], [[2.0 * x[0]]])
            },
            1.0,
        );
        assert!(matches!(error, NewtonError::NotFinite { iteration: 2, .. }), "{error}");
        // In a Jacobian it leaves no pivot.
        let error = failure(|_| ([1.0], [[bad]]), 1.0);
        assert!(matches!(error, NewtonError::Singular { iteration: 1, .. }), "{error}");
    }
}

proptest! {
    /// What the prediction of the last correction saves costs no digits: two more iterations find hardly any.
    #[test]
    fn the_prediction_is_not_too_early(
        a in prop::array::uniform4(-0.4..0.4f64), solution in prop::array::uniform2(-2.0..2.0f64),
        away in prop::array::uniform2(-0.1..0.1f64), size in 0..12i32,
    ) {
        // Two coupled equations with the Jacobian near one, the second unknown in another unit.
        let unit = 10f64.powi(-size);
        let f = |x: f64, y: f64| [x + a[0] * x * y + a[1] * y * y * 0.5, y + a[2] * x.sin() + a[3] * x * y * 0.5];
        let level = f(solution[0], solution[1]);
        let mut equations = Of(|x: &[f64; 2]| {
            let (x, y) = (x[0], x[1] / unit);
            let value = f(x, y);
            let rows = [
                [1.0 + a[0] * y, (a[0] * x + a[1] * y) / unit],
                [a[2] * x.cos() + a[3] * y * 0.5, (1.0 + a[3] * x * 0.5) / unit],
            ];
            ([value[0] - level[0], value[1] - level[1]], rows)
        });
        let mut x = [solution[0] + away[0], (solution[1] + away[1]) * unit];
        if Newton::default().solve(&mut equations, &mut x).is_ok() {
            let accepted = x;
            for _ in 0..2 {
                let correction = equations.correction(&x).unwrap();
                x = [x[0] + correction[0], x[1] + correction[1]];
            }
            // Rounding leaves 50 * 40 ulps of one at most: ten operations of size 4, and a condition below 50. Two corrections
            // that happen to be small cost up to 1e-11 more, in one of 1e5 such problems.
            let rounding = 3e-11;
            prop_assert!((accepted[0] - x[0]).abs() <= rounding, "{:e}", accepted[0] - x[0]);
            prop_assert!((accepted[1] - x[1]).abs() <= rounding * unit, "{:e}", accepted[1] - x[1]);
        }
    }

    /// The same in one convex equation, which has no accidental small correction on the way.
    #[test]
    fn the_prediction_holds_far_from_the_root(c in 1e-3..1e3f64, start in 1e-3..1e3f64) {
        let newton = Newton { max_iterations: 100, ..Newton::default() };
        let mut x = [start];
        newton.solve(&mut Of(|x: &[f64; 1]| ([x[0] * x[0] + x[0] - c], [[2.0 * x[0] + 1.0]])), &mut x).unwrap();
        let root = 2.0 * c / (1.0 + (1.0 + 4.0 * c).sqrt());
        prop_assert!((x[0] - root).abs() <= 8.0 * f64::EPSILON * root, "{} for {root}", x[0]);
    }
}

/// The last six corrections are kept, whatever their unit; and nothing is a unit of none.
#[test]
fn a_history_keeps_the_last_corrections() {
    let mut history = History::new();
    assert_eq!((history.made(), history.last(), history.last_ratio()), (0, None, None));
    history.push(1.0);
    assert_eq!((history.last(), history.last_ratio()), (Some(1.0), None));
    for k in 1..8 {
        history.push(f64::from(-k).exp2());
    }
    let kept = |history: &History| history.iter().collect::<Vec<_>>();
    assert_eq!(kept(&history), [0.25, 0.125, 0.0625, 0.03125, 0.015625, 0.0078125]);
    assert_eq!((history.made(), history.last(), history.last_ratio()), (8, Some(0.0078125), Some(0.5)));
    assert_eq!(kept(&history.relative_to(0.125)), [2.0, 1.0, 0.5, 0.25, 0.125, 0.0625]);
    assert_eq!(kept(&history.relative_to(0.0)), kept(&history));
    assert!(history.to_string().starts_with(".. 2.5e-1, "), "{history}");
}
