use crate::Joint;
use lagrangian::{Constraint, Piecewise, Scalar, System};
use sleigh::TimeFunction;

/// A hinge between two bodies of the plane: a point of the one is a point of the other.
///
/// Its coordinates are `(x, y, theta)` of the first body, then of the second; the points are given in each body's own frame,
/// ahead of its reference point and to the left of it (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    first: [f64; 2],
    second: [f64; 2],
}

impl Hinge {
    /// A hinge at these points of the two bodies (m).
    #[must_use]
    pub fn new(first: [f64; 2], second: [f64; 2]) -> Self {
        Self { first, second }
    }
}

impl Joint<6, 2> for Hinge {
    #[inline(always)]
    fn position<S: Scalar>(&self, _t: S, q: &[S; 6]) -> [S; 2] {
        let point = |body: &[S], [ahead, left]: [f64; 2]| {
            let (sin, cos) = body[2].sin_cos();
            [body[0] + cos * ahead - sin * left, body[1] + sin * ahead + cos * left]
        };
        let (a, b) = (point(&q[..3], self.first), point(&q[3..], self.second));
        [a[0] - b[0], a[1] - b[1]]
    }

    fn origins(&self) -> [Option<usize>; 6] {
        [Some(0), Some(1), None, Some(0), Some(1), None]
    }
}

/// A motor between two bodies: a torque `tau(t)` (N m) on the angle of the second, and `-tau(t)` on the angle of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Motor {
    /// The torque (N m).
    pub torque: TimeFunction,
}

impl System<2, 0> for Motor {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], _v: &[S; 2]) -> S {
        S::zero()
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 0> {
        ([], [])
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, t: S, _q: &[S; 2], _v: &[S; 2]) -> Option<[S; 2]> {
        let torque = self.torque.value(t);
        Some([-torque, torque])
    }
}

impl Piecewise for Motor {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.torque.jumps(from, to)
    }
    fn piece(&self, t: f64) -> Self {
        Self { torque: self.torque.piece(t) }
    }
}
