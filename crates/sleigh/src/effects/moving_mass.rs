use crate::checks::positive;
use crate::{SleighBody, SleighError, TimeFunction};
use lagrangian::{Effect, Piecewise, Scalar};

/// A point of mass `m_p` that is moved along a given path `r(t) = (r_x(t), r_y(t))` in the body, measured from the blade's
/// contact point along `e` and `n`: it adds `m_p/2 |P' + omega (r_x n - r_y e) + r_x' e + r_y' n|^2`.
///
/// Moving it to and fro can accelerate the sleigh without bound (Bizyaev, Borisov and Mamaev 2018, arXiv 1801.05273).
#[derive(Debug, Clone, PartialEq)]
pub struct MovingMass {
    mass: f64,
    position: [TimeFunction; 2],
}

impl MovingMass {
    /// The point of mass `m_p` (kg) at the body position `(r_x(t), r_y(t))` (m).
    ///
    /// # Errors
    /// [`SleighError`] names a mass that is not positive, a number that is not finite, or a position from a table with
    /// more than one entry: a mass cannot jump.
    pub fn new(mass: f64, x: impl Into<TimeFunction>, y: impl Into<TimeFunction>) -> Result<Self, SleighError> {
        let mass = positive("mass", mass)?;
        let position = [x.into().finite("x")?, y.into().finite("y")?];
        for function in &position {
            if matches!(function, TimeFunction::Table(table) if table.times().len() > 1) {
                return Err(SleighError::Table { problem: "a mass cannot jump from one place to another".to_owned() });
            }
        }
        Ok(Self { mass, position })
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for MovingMass {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        let (sin, cos) = q[2].sin_cos();
        let [rx, ry] = [self.position[0].value(t), self.position[1].value(t)];
        let along = cos * v[0] + sin * v[1] - v[2] * ry + self.position[0].slope(t);
        let across = cos * v[1] - sin * v[0] + v[2] * rx + self.position[1].slope(t);
        Some((along * along + across * across) * (0.5 * self.mass))
    }
}

impl Piecewise for MovingMass {
    fn piece(&self, t: f64) -> Self {
        Self { mass: self.mass, position: self.position.piece(t) }
    }
}
