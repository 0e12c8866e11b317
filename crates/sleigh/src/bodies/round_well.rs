use crate::checks::finite;
use crate::series::{InOwnAxes, Origin, OwnAxes};
use crate::{Sleigh, SleighError, SleighState};
use lagrangian::{AdmissibleBasis, Constraint, Reduced, Scalar, System};

/// The Chaplygin sleigh in a round well, in its own axes: what is left of the motion when its symmetry is taken out.
///
/// `V = k/2 |P + b e - c|^2` draws the point `b` ahead of the blade (m) to the centre `c`; `b = a` is the centre of mass, as of
/// a [`Bowl`](crate::effects::Bowl) of equal stiffnesses. A turn about the centre changes nothing, so that the heading is needed
/// nowhere: `q = (X, Y, theta)` with the blade's place in the axes of the sleigh, `(X, Y) = R(-theta) (P - c)`, and
///
/// `X' = u + omega Y`, `Y' = -omega X`, `u' = a omega^2 - k/m (X + b)`, `omega' = -(m a / J) u omega - k b/J Y`.
///
/// No sine is left, and the energy is of second degree in `(X, Y, u, omega)`: Gauss methods keep it to rounding whatever the step
/// (Hairer, Lubich and Wanner 2006, theorem IV.2.1), which on the plane they do not. The reduction is that of Bloch, Krishnaprasad,
/// Marsden and Murray 1996, Arch. Rational Mech. Anal. 136, 21-99, with the circle as the group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundWell {
    sleigh: Sleigh,
    stiffness: f64,
    center: [f64; 2],
    ahead: f64,
    /// `k/m` and `k b/J`.
    pulls: [f64; 2],
}

impl RoundWell {
    /// The sleigh in a well of this stiffness (N/m) about the point `center` (m), which draws its centre of mass.
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn new(sleigh: Sleigh, stiffness: f64, center: [f64; 2]) -> Result<Self, SleighError> {
        Self::drawing(sleigh, stiffness, center, sleigh.offset())
    }

    /// The same of a well that draws the point `ahead` (m) of the blade; zero is the blade itself.
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn drawing(sleigh: Sleigh, stiffness: f64, center: [f64; 2], ahead: f64) -> Result<Self, SleighError> {
        finite("stiffness", [stiffness])?;
        finite("ahead", [ahead])?;
        let pulls = [stiffness / sleigh.mass(), stiffness * ahead / sleigh.pivot_inertia()];
        Ok(Self { sleigh, stiffness, center: finite("center", center)?, ahead, pulls })
    }

    /// The coordinates and velocities of a state.
    #[must_use]
    pub fn coordinates(&self, state: &SleighState) -> ([f64; 3], [f64; 3]) {
        let SleighState { x, y, heading, speed, turn_rate } = *state;
        let (sin, cos) = heading.sin_cos();
        let (x, y) = (x - self.center[0], y - self.center[1]);
        let (along, across) = (cos * x + sin * y, cos * y - sin * x);
        ([along, across, heading], [speed + turn_rate * across, -turn_rate * along, turn_rate])
    }

    /// The state of coordinates and velocities.
    #[must_use]
    pub fn state(&self, &[along, across, heading]: &[f64; 3], v: &[f64; 3]) -> SleighState {
        let (sin, cos) = heading.sin_cos();
        let [x, y] = [self.center[0] + cos * along - sin * across, self.center[1] + sin * along + cos * across];
        SleighState { x, y, heading, speed: v[0] - v[2] * across, turn_rate: v[2] }
    }
}

impl System<3, 1> for RoundWell {
    /// That of the sleigh with the velocity of the blade in its own axes, `(X' - omega Y, Y' + omega X)`, less `V`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, t: S, &[x, y, _]: &[S; 3], v: &[S; 3]) -> S {
        let own = [v[0] - v[2] * y, v[1] + v[2] * x, v[2]];
        let ahead = x + self.ahead;
        self.sleigh.lagrangian(t, &[S::zero(); 3], &own) - (ahead * ahead + y * y) * (0.5 * self.stiffness)
    }

    /// The blade does not slip: `Y' + omega X = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[S::zero(), S::constant(1.0), q[0]]], [S::zero()])
    }

    /// Drive along the blade, and pivot about it.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, zero], [q[1], -q[0], one]]))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }

    #[inline(always)]
    fn reduced(&self) -> impl Reduced<3, 1> {
        self
    }
}

impl Reduced<3, 1> for RoundWell {
    /// That of the free sleigh, and the pull of the well.
    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3]) -> Option<[S; 3]> {
        let [along, turn, none] = self.sleigh.reduced_motion(t, q, xi)?;
        Some([along - (q[0] + self.ahead) * self.pulls[0], turn - q[1] * self.pulls[1], none])
    }
}

impl InOwnAxes for RoundWell {
    fn own_axes(&self) -> Option<OwnAxes> {
        let [k, torque] = self.pulls;
        Some(OwnAxes {
            origin: Origin::Coordinates,
            along: [-k * self.ahead, -k],
            turning: [0.0, -torque],
            ..self.sleigh.own_axes()?
        })
    }
}
