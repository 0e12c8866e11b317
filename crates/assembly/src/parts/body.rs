use lagrangian::{Constraint, Scalar, System};

/// A free rigid body of the plane, `q = (x, y, theta)` its mass centre (m) and heading (rad).
///
/// Without a mass it is a part that counts by its inertia alone, and its place must be held by joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the mass centre (kg m^2).
    pub inertia: f64,
}

impl System<3, 0> for Body {
    /// `L = m/2 (x'^2 + y'^2) + I/2 theta'^2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass) + v[2] * v[2] * (0.5 * self.inertia)
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 3]) -> Constraint<S, 3, 0> {
        ([], [])
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

/// What turns about its own centre: a rotor, an axle. `q` is its angle in space (rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorElement {
    /// Moment of inertia (kg m^2).
    pub inertia: f64,
}

impl System<1, 0> for RotorElement {
    /// `L = I/2 q'^2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * (0.5 * self.inertia)
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 0> {
        ([], [])
    }

    /// It counts its turns itself: what it is joined to may compare its angle with another.
    #[inline(always)]
    fn angles(&self) -> [bool; 1] {
        [false]
    }
}
