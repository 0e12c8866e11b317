use crate::error::positive;
use crate::series::PushInOwnAxes;
use crate::{SleighBody, SleighError, TimeFunction};
use lagrangian::{Effect, Piecewise, Scalar};
use serde::Serialize;

/// A point of mass `m_p` that is moved along a given path `r(t) = (r_x(t), r_y(t))` in the body, measured from the blade's
/// contact point along `e` and `n`: it adds `m_p/2 |P' + omega (r_x n - r_y e) + r_x' e + r_y' n|^2`.
///
/// Moving it to and fro can accelerate the sleigh without bound (Bizyaev, Borisov and Mamaev 2018, arXiv 1801.05273).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MovingMass {
    /// `m_p` (kg).
    pub mass: f64,
    /// `r_x(t)` (m).
    pub x: TimeFunction,
    /// `r_y(t)` (m).
    pub y: TimeFunction,
}

impl MovingMass {
    /// The point of mass `m_p` (kg) at the body position `(r_x(t), r_y(t))` (m).
    ///
    /// # Errors
    /// [`SleighError`] names a mass that is not positive, a number that is not finite, or a position that jumps or
    /// has corners, from a table with more than one entry or from a formula: a mass and its velocity cannot jump.
    pub fn new(mass: f64, x: impl Into<TimeFunction>, y: impl Into<TimeFunction>) -> Result<Self, SleighError> {
        let mass = Self { mass: positive("mass", mass)?, x: x.into().finite("x")?, y: y.into().finite("y")? };
        for function in [&mass.x, &mass.y] {
            match function {
                TimeFunction::Table(table) if table.times().len() > 1 => {
                    let problem = "a mass cannot jump from one place to another".to_owned();
                    return Err(SleighError::Table { problem });
                }
                TimeFunction::Formula(formula) if formula.has_corners() => {
                    let problem = "it jumps or has corners, and the velocity of a mass cannot jump".to_owned();
                    return Err(SleighError::Formula { problem });
                }
                _ => {}
            }
        }
        Ok(mass)
    }

    /// `r`, `r'` and `r''`.
    #[inline(always)]
    pub(crate) fn path<S: Scalar>(&self, t: S) -> [[S; 2]; 3] {
        let [[x, vx, ax], [y, vy, ay]] = [self.x.jet(t), self.y.jet(t)];
        [[x, y], [vx, vy], [ax, ay]]
    }

    /// The kinetic energy `m_p/2 |P' + omega (r_x n - r_y e) + r_x' e + r_y' n|^2` (J); the first coordinates are `(x, y, theta)`.
    #[inline(always)]
    pub fn kinetic_energy<S: Scalar, const N: usize>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        let (sin, cos) = q[2].sin_cos();
        let Self { x, y, .. } = self;
        let along = cos * v[0] + sin * v[1] - v[2] * y.value(t) + x.slope(t);
        let across = cos * v[1] - sin * v[0] + v[2] * x.value(t) + y.slope(t);
        (along * along + across * across) * (0.5 * self.mass)
    }
}

/// As an effect it is a term of the Lagrangian, on any body. A [`Guided`](crate::Guided) body [that carries it](crate::Guided::carrying)
/// knows its equations besides.
impl<B: SleighBody, const N: usize> Effect<B, N> for MovingMass {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        Some(self.kinetic_energy(t, q, v))
    }
}

impl PushInOwnAxes for MovingMass {}

impl Piecewise for MovingMass {
    fn piece(&self, t: f64) -> Self {
        Self { mass: self.mass, x: self.x.piece(t), y: self.y.piece(t) }
    }
}
