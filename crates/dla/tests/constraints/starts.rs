//! Starts moved onto the constraints.

use crate::support::{One, Six, ThreeTwo, Two};
use dla::{StepError, consistent_start};
use lagrangian::{Constraint, Scalar, System, constraint_residual, position_residual, row_space};
use test_systems::{IsokineticParticle, Model, SleighOnArm, TurntableBall};

/// A start off the constraints by tenths is moved to the nearest place: the way there, in the kinetic metric, is along the
/// gradients at its end.
#[test]
fn the_nearest_start() {
    let sleigh = SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0);
    let (mut q, mut v) = sleigh.start();
    let here = consistent_start(&ThreeTwo::from(sleigh), 0.0, &q, &v).unwrap();
    assert!(here.moved <= 1e-15 && here.changed <= 1e-14, "{here:?}");

    let mut before = f64::INFINITY;
    for off in [0.3, 0.1, 0.01] {
        (q, v) = sleigh.start();
        q = [q[0] + off, q[1] - 0.5 * off, q[2] + 0.7 * off];
        v = [v[0] - off, v[1] + off, v[2] + off];
        let start = consistent_start(&ThreeTwo::from(sleigh), 0.0, &q, &v).unwrap();
        assert!(position_residual(&sleigh, 0.0, &start.q) <= 1e-15);
        assert!(constraint_residual(&sleigh, 0.0, &start.q, &start.v).iter().all(|slip| slip.abs() <= 1e-15));
        assert!(start.moved > 0.0 && start.moved < before && start.moved < 3.0 * off);
        before = start.moved;
        // `M (q1 - q)` is along `dg/dq` at the end, `M (v1 - v)` in the span of both rows.
        let mass = lagrangian::mass_matrix(&sleigh, 0.0, &q, &v).1;
        let pushed: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| mass[i][j] * (start.q[j] - q[j])).sum());
        let gradient = lagrangian::position_rows(&sleigh, 0.0, &start.q).0[1];
        let scale = pushed[0] / gradient[0];
        for i in 0..3 {
            assert!((pushed[i] - scale * gradient[i]).abs() <= 1e-13 * off, "{pushed:?}, {gradient:?}");
        }
        let mass = lagrangian::mass_matrix(&sleigh, 0.0, &start.q, &v).1;
        let kicked: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| mass[i][j] * (start.v[j] - v[j])).sum());
        let (outside, size) = row_space::<_, 3, 2>(&sleigh, 0.0, &start.q, &start.v, 1e-15).outside(&kicked);
        assert!(outside <= 1e-13 * size, "{outside:e} of {size:e}");
    }
}

/// On the circle of radius 1, with the mass 1 along `x` and 4 along `y`.
#[derive(Clone, Copy)]
pub(crate) struct Ring;

impl System<2, 1> for Ring {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1] * 4.0) * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        lagrangian::position_rows(self, t, q)
    }
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 2]) -> Option<[Option<S>; 1]> {
        Some([Some((q[0] * q[0] + q[1] * q[1] - 1.0) * 0.5)])
    }
}

/// Also from where the constraint is curved along the way: no other place of the circle is nearer.
#[test]
fn the_nearest_place_of_a_circle() {
    for q in [[0.6, 0.5], [1.2, 0.9], [-1.0, 2.0]] {
        let start = consistent_start(&Two::from(Ring), 0.0, &q, &[0.3, -0.4]).unwrap();
        let [x, y] = start.q;
        approx::assert_abs_diff_eq!(x.hypot(y), 1.0, epsilon = 1e-15);
        let length = |x: f64, y: f64| (x - q[0]).hypot(2.0 * (y - q[1]));
        approx::assert_relative_eq!(start.moved, length(x, y), max_relative = 1e-15);
        // `M (q1 - q)` has no part along the circle; its terms are of the size 8.
        approx::assert_abs_diff_eq!((x - q[0]) * y, 4.0 * (y - q[1]) * x, epsilon = 8.0 * 4.0 * f64::EPSILON);
        for k in 0..100 {
            let (sin, cos) = f64::sin_cos(0.02 * std::f64::consts::PI * f64::from(k));
            assert!(start.moved <= length(cos, sin) * (1.0 + 4.0 * f64::EPSILON), "{start:?}, {cos}, {sin}");
        }
    }
}

/// An affine one, and one that is not: the velocity is scaled to the speed.
#[test]
fn starts_of_other_classes() {
    let ball = TurntableBall::new(1.3, 0.6, 0.2, 1.7);
    let start = consistent_start(&Six::from(ball), 0.0, &[0.4, 0.1, 1.0, 0.5, 0.0, 0.2], &[0.3; 6]).unwrap();
    assert!(position_residual(&ball, 0.0, &start.q) <= 1e-15);
    assert!(constraint_residual(&ball, 0.0, &start.q, &start.v).iter().all(|slip| slip.abs() <= 1e-15));

    let particle = IsokineticParticle::new(1.3, 0.8, 1.0);
    let start = consistent_start(&Two::from(particle), 0.0, &[0.0; 2], &[0.9, 1.2]).unwrap();
    approx::assert_abs_diff_eq!(&start.v[..], &[0.48, 0.64][..], epsilon = 1e-15);
    assert_eq!(start.moved, 0.0);
}

/// `x^2 + 1 = 0`.
#[derive(Clone, Copy)]
pub(crate) struct Nowhere;

impl System<1, 1> for Nowhere {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 1]) -> Constraint<S, 1, 1> {
        lagrangian::position_rows(self, t, q)
    }
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 1]) -> Option<[Option<S>; 1]> {
        Some([Some(q[0] * q[0] + 1.0)])
    }
}

#[test]
fn no_start() {
    let outcome = consistent_start(&One::from(Nowhere), 0.0, &[0.4], &[0.0]);
    assert!(matches!(outcome, Err(StepError::Newton { .. } | StepError::Dependent(_))), "{outcome:?}");
}
