use lagrangian::{Constraint, Piecewise, Scalar, System};
use sleigh::TimeFunction;

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
