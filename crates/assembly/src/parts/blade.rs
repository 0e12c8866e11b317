use lagrangian::{Constraint, Scalar, System};

/// A blade or an axle without mass under a body, at a point of its axis and along it: it does not slip aside.
///
/// The coordinates are the body's `(x, y, theta)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blade {
    /// Distance of the blade ahead of the body's reference point (m).
    pub ahead: f64,
}

impl System<3, 1> for Blade {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], _v: &[S; 3]) -> S {
        S::zero()
    }

    /// `n . P' + d theta' = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, S::constant(self.ahead)]], [S::zero()])
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

/// A blade with a direction of its own, an angle in space: its coordinates are `(x, y, theta)` of the body, and this angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteeredBlade {
    /// Distance of the blade ahead of the body's reference point (m).
    pub ahead: f64,
}

impl System<4, 1> for SteeredBlade {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 4], _v: &[S; 4]) -> S {
        S::zero()
    }

    /// `n(beta) . (P' + d theta' n(theta)) = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Constraint<S, 4, 1> {
        let (sin, cos) = q[3].sin_cos();
        ([[-sin, cos, (q[3] - q[2]).cos() * self.ahead, S::zero()]], [S::zero()])
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 4] {
        [false, false, true, false]
    }
}
