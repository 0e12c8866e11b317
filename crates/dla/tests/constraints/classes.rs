//! What the constraints of a system are at a point.

use crate::support::Two;
use lagrangian::{Classification, Constraint, RowKind, Rows, Scalar, System, classify};
use test_systems::{CompoundPendulum, IsokineticParticle, KnifeEdge, Model, RollingDisk, SleighOnArm, TurntableBall};

fn at_start<Mo: Model<N, M>, const N: usize, const M: usize>(model: &Mo) -> Classification<M> {
    let (q, v) = model.start();
    classify(model, 0.0, &q, &v)
}

#[test]
fn classes_of_the_models() {
    let edge = at_start(&KnifeEdge { m: 1.0, I: 0.5, g: 1.0 });
    assert_eq!((edge.kinds, edge.rank, edge.brackets), ([RowKind::Linear], 1, 1));
    assert!(!edge.integrable() && edge.regular && edge.consistent && edge.dependence.involved.is_empty());
    // Two admissible fields have one bracket.
    let disk = at_start(&RollingDisk { m: 1.0, R: 1.0, I: 1.0, J: 1.0 });
    assert_eq!((disk.rank, disk.brackets), (2, 1));

    let pendulum = CompoundPendulum::new(1.3, 0.4, 0.9, 9.81);
    assert_eq!(at_start(&pendulum).kinds, [RowKind::Position; 2]);
    let pseudo = at_start(&pendulum.pseudo_holonomic());
    assert_eq!(pseudo.kinds, [RowKind::Linear; 2]);
    assert!(pseudo.integrable());

    // One admissible field has no bracket: with the arm the blade is integrable, as the planimeter's path shows.
    let sleigh = at_start(&SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0));
    assert_eq!(sleigh.kinds, [RowKind::Linear, RowKind::Position]);
    assert!(sleigh.integrable());

    let ball = at_start(&TurntableBall::new(1.3, 0.6, 0.2, 1.7));
    assert_eq!(ball.kinds, [RowKind::Affine, RowKind::Affine, RowKind::Position]);
    assert_eq!((ball.rank, ball.brackets), (3, 2));

    let particle = at_start(&IsokineticParticle::new(1.3, 0.8, 1.0));
    assert_eq!((particle.kinds, particle.rank), ([RowKind::Nonlinear], 1));
    assert!(!particle.integrable());
}

/// A point in the plane with the row `(c, s)`, `c x' + s y' + b = 0`.
#[derive(Clone, Copy)]
pub(crate) struct Row<F>(F);

trait Rule {
    fn row<S: Scalar>(&self, t: S, q: &[S; 2]) -> ([S; 2], S);
}

impl<F: Rule> System<2, 1> for Row<F> {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        let (a, b) = self.0.row(t, q);
        ([a], [b])
    }
    /// A function of which the rows below are not the rate.
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 2]) -> Option<[Option<S>; 1]> {
        Some([Some(q[0])])
    }
}

/// `x' = t`, a motion along leaves in space and time; and `x' = y`, which is not.
#[derive(Clone, Copy)]
pub(crate) struct Along;
#[derive(Clone, Copy)]
pub(crate) struct Across;
/// `sin(t) x' + cos(t) y' = 0`, integrable at every time, and not in time.
#[derive(Clone, Copy)]
pub(crate) struct Turning;
/// `x x' = 0`.
#[derive(Clone, Copy)]
pub(crate) struct Vanishing;

impl Rule for Along {
    fn row<S: Scalar>(&self, t: S, _q: &[S; 2]) -> ([S; 2], S) {
        ([S::constant(1.0), S::zero()], -t)
    }
}
impl Rule for Across {
    fn row<S: Scalar>(&self, _t: S, q: &[S; 2]) -> ([S; 2], S) {
        ([S::constant(1.0), S::zero()], -q[1])
    }
}
impl Rule for Turning {
    fn row<S: Scalar>(&self, t: S, _q: &[S; 2]) -> ([S; 2], S) {
        let (sin, cos) = t.sin_cos();
        ([sin, cos], S::zero())
    }
}
impl Rule for Vanishing {
    fn row<S: Scalar>(&self, _t: S, q: &[S; 2]) -> ([S; 2], S) {
        ([q[0], S::zero()], S::zero())
    }
}

#[test]
fn time_counts_as_a_coordinate() {
    let at = |q, v| {
        (
            classify(&Two::from(Row(Along)), 0.3, q, v),
            classify(&Two::from(Row(Across)), 0.3, q, v),
            classify(&Two::from(Row(Turning)), 0.3, q, v),
        )
    };
    let (along, across, turning) = at(&[0.2, 0.5], &[0.3, 0.0]);
    assert_eq!([along.brackets, across.brackets, turning.brackets], [0, 1, 1]);
}

#[test]
fn rows_that_vanish_or_do_not_belong() {
    let here = classify(&Two::from(Row(Vanishing)), 0.0, &[0.0, 1.0], &[0.0; 2]);
    assert_eq!((here.rank, here.regular, here.dependence.involved), (0, false, Rows::none().with(0)));
    let beside = classify(&Two::from(Row(Vanishing)), 0.0, &[1e-200, 1.0], &[0.0; 2]);
    assert_eq!((beside.rank, beside.regular), (1, true));
    assert_eq!(classify(&Two::from(Row(Across)), 0.0, &[0.2, 0.5], &[0.5, 0.0]).mismatched, Rows::none().with(0));
    assert_eq!(classify(&Two::from(Row(Along)), 0.0, &[0.2, 0.5], &[0.0, 0.0]).mismatched, Rows::none());
}
