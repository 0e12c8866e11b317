//! Forces, explicit time, affine constraints, and discrete Lagrangians that a user writes.

use crate::support::{Free, Three};
use crate::systems::models::{Oscillator, Particle, Pushed};
use crate::systems::tools::{assert_order, errors, forms, run};
use dla::{DiscreteLagrangian, Dla, Form};
use lagrangian::{Constraint, Midpoint, Scalar, System, Trapezoid, constraint_residual};
use std::array::from_fn;

#[test]
fn drag_and_drive() {
    for (damping, drive) in [(0.1, 0.0), (0.0, 0.5), (0.2, 0.7)] {
        let system = Oscillator { damping, drive };
        let (oscillator, exact) = (Free::from(system), |t| system.exact(t));
        assert_order("midpoint", errors(&oscillator, Dla::midpoint(), 5.0, exact), 2.0);
        assert_order("trapezoid", errors(&oscillator, Dla::trapezoid(), 5.0, exact), 2.0);
    }
    let system = Particle { damping: 0.4, ..Particle::FREE };
    let particle = Three::from(system);
    for (form, method) in forms(Dla::midpoint()) {
        assert_order(form, errors(&particle, method, 3.0, |t| system.exact(t)), 2.0);
    }
    let mixed = Dla::new(Midpoint, Trapezoid);
    assert_order("mixed", errors(&particle, mixed, 3.0, |t| system.exact(t)), 2.0);
}

#[test]
fn an_affine_constraint_with_time() {
    let pushed = Three::from(Pushed);
    for (form, method) in forms(Dla::midpoint()) {
        assert_order(form, errors(&pushed, method, 3.0, Pushed::exact), 2.0);
    }
    assert_order("trapezoid", errors(&pushed, Dla::trapezoid(), 3.0, Pushed::exact), 2.0);
    assert_order("mixed", errors(&pushed, Dla::new(Midpoint, Trapezoid), 3.0, Pushed::exact), 2.0);
}

/// The multipliers are those of the motion: `(y x')' - sin t` for the unit mass in `z`, at the middle of the step.
#[test]
fn multipliers_are_the_forces_of_the_constraint() {
    let (h, steps) = (0.01, 300);
    let trajectory =
        run::<_, _, 3, 1>(&Three::from(Pushed), Dla::midpoint(), Pushed::exact(0.0), h * steps as f64, steps);
    for node in &trajectory.nodes()[1..] {
        let (before, after) = (Pushed::exact(node.t - h).1[2], Pushed::exact(node.t).1[2]);
        // Third derivatives below 5.
        approx::assert_abs_diff_eq!(node.multipliers.as_ref().unwrap()[0], (after - before) / h, epsilon = 5.0 * h * h);
    }
}

/// The particle with `z' = y x'` in a well without closed form.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Well;

impl Well {
    fn potential<S: Scalar>(q: &[S; 3]) -> S {
        (q[0] * q[0] + q[1].powi(4) - q[2].cos()) * 0.5
    }
}

impl System<3, 1> for Well {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        Particle::FREE.lagrangian(t, q, v) - Self::potential(q)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        Particle::FREE.constraint(t, q)
    }
}

/// `v^2 / 2 - (V(q0) + V(q1)) / 2`: the trapezoidal rule, since the mass is constant.
#[derive(Debug, Clone, Copy)]
struct Leapfrog;

impl DiscreteLagrangian<3> for Leapfrog {
    fn average<S: Scalar>(&self, t0: S, h: S, q0: &[S; 3], v: &[S; 3]) -> S {
        let q1: [S; 3] = from_fn(|i| q0[i] + h * v[i]);
        Well.lagrangian(t0, q0, v) + (Well::potential(q0) - Well::potential(&q1)) * 0.5
    }
}

/// The action by Simpson's rule.
#[derive(Debug, Clone, Copy)]
struct Simpson;

impl DiscreteLagrangian<3> for Simpson {
    fn average<S: Scalar>(&self, t0: S, h: S, q0: &[S; 3], v: &[S; 3]) -> S {
        let at = |alpha: f64| Well.lagrangian(t0 + h * alpha, &from_fn(|i| q0[i] + h * v[i] * alpha), v);
        (at(0.0) + at(0.5) * 4.0 + at(1.0)) / 6.0
    }
}

#[test]
fn discrete_lagrangians_by_hand() {
    let (well, start) = (Three::from(Well), ([0.4, 0.3, 0.2], [0.6, -0.5, 0.18]));
    assert!(constraint_residual(&well, 0.0, &start.0, &start.1)[0].abs() < 1e-16);
    let end = |steps| {
        let leapfrog = run::<_, _, 3, 1>(&well, Dla::of(Leapfrog), start, 4.0, steps);
        let by_rule = run::<_, _, 3, 1>(&well, Dla::new(Trapezoid, Midpoint), start, 4.0, steps);
        for (a, b) in leapfrog.nodes().iter().zip(by_rule.nodes()) {
            // The same equations; 160 steps with some roundings each.
            approx::assert_abs_diff_eq!(&a.q[..], &b.q[..], epsilon = 1e-12);
            approx::assert_abs_diff_eq!(&a.v[..], &b.v[..], epsilon = 1e-12);
        }
        let simpson = run::<_, _, 3, 1>(&well, Dla::of(Simpson), start, 4.0, steps);
        [leapfrog, simpson].map(|run| run.nodes()[steps as usize].q.clone())
    };
    // Differences of successive halvings: second order without knowing the limit.
    let ends = [80, 160, 320, 640].map(end);
    for method in 0..2 {
        let differences: Vec<f64> = ends
            .windows(2)
            .map(|pair| (0..3).map(|i| (pair[0][method][i] - pair[1][method][i]).abs()).fold(0.0, f64::max))
            .collect();
        let slope = (differences[0] / differences[2]).log2() / 2.0;
        assert!((slope - 2.0).abs() <= 0.05, "{slope}, {differences:?}");
    }
    // Neither has a closed form or a basis: every way of solving is the one with multipliers.
    let solved = |form| run::<_, _, 3, 1>(&well, Dla::of(Simpson).solved(form), start, 4.0, 80);
    assert_eq!(solved(Form::Best), solved(Form::Multipliers));
}
