mod path;
mod reduced;

use crate::{Sleigh, SleighError, SleighState};
use path::{Path, rotated};
use reduced::ReducedSleigh;
use std::f64::consts::PI;

/// The motion of the free sleigh in closed form, at any time before or after its start.
///
/// With `k = sqrt(J/m)` (m) the gyration radius about the blade, `U = sqrt(2 E/m)` (m/s) the speed that all the energy
/// would give, `kappa = a U m/J` [1/s], `sigma = k/|a|` and the Gudermannian `gd(s) = 2 atan(tanh(s/2))`,
///
/// ```text
/// u     = U tanh s,                 s = kappa (t - t0),   tanh(-kappa t0) = u0/U
/// omega = sign(omega0) (U/k) sech s
/// theta = theta0 + sign(omega0) (k/a) [gd s - gd(-kappa t0)]
/// x' = u cos theta,   y' = u sin theta
/// ```
///
/// for either sign of `a`; `a = 0` gives a circle and `omega0 = 0` a straight line. The centre of mass swings from
/// behind the direction of travel to ahead of it, once, and the blade's path has a cusp where `u = 0`.
///
/// The relative errors of `omega` and of the change of `theta`, and the error of `u` relative to `U`, are near rounding for spins and
/// offsets however small and times however long. The same holds for the error of the displacement relative to the length of the path,
/// but for the rounding of the angle itself once the blade has turned many times. The cost of [`at`](Self::at) depends neither on the
/// time nor on the number of turns.
///
/// S. A. Chaplygin, On the theory of motion of nonholonomic systems: the reducing-multiplier theorem, 1911;
/// Ju. I. Neimark and N. A. Fufaev, Dynamics of Nonholonomic Systems, 1972; A. M. Bloch, Nonholonomic Mechanics and
/// Control, 2nd ed. 2015, section 1.7.
///
/// ```
/// use sleigh::{Exact, Sleigh, SleighState};
///
/// // Backwards, with a spin that can hardly be seen: the sleigh turns over and leaves forwards.
/// let sleigh = Sleigh::new(1.0, 3.0, 1.0)?;
/// let motion = Exact::new(&sleigh, &SleighState { speed: -1.0, turn_rate: 1e-8, ..SleighState::default() })?;
/// let end = motion.at(400.0);
/// assert!((end.speed - 1.0).abs() < 1e-12);
/// assert!((end.heading - motion.turning_angle()).abs() < 1e-7);
/// # Ok::<(), sleigh::SleighError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Exact {
    sleigh: Sleigh,
    start: SleighState,
    /// Without spin there is none: the line is straight.
    turning: Option<(ReducedSleigh, Path)>,
}

impl Exact {
    /// The motion of `sleigh` that is in the state `start` at time zero.
    ///
    /// # Errors
    /// [`SleighError::NotFinite`] names the state variable that is not finite, or the derived quantity that is too large.
    pub fn new(sleigh: &Sleigh, start: &SleighState) -> Result<Self, SleighError> {
        let variables = [
            ("x", start.x),
            ("y", start.y),
            ("heading", start.heading),
            ("speed", start.speed),
            ("turn rate", start.turn_rate),
        ];
        for (quantity, value) in variables {
            if !value.is_finite() {
                return Err(SleighError::NotFinite { quantity, value });
            }
        }
        let turning = if start.turn_rate == 0.0 {
            None
        } else {
            let reduced = ReducedSleigh::new(sleigh, start.speed, start.turn_rate)?;
            let path = Path::new(&reduced);
            Some((reduced, path))
        };
        Ok(Self { sleigh: *sleigh, start: *start, turning })
    }

    /// The state at the finite time `t` (s), negative before the start.
    #[must_use]
    pub fn at(&self, t: f64) -> SleighState {
        let start = &self.start;
        let Some((reduced, path)) = &self.turning else {
            let [x, y] = rotated([start.speed * t, 0.0], start.heading);
            return SleighState { x: start.x + x, y: start.y + y, ..*start };
        };
        let moment = reduced.at(t);
        let [x, y] = rotated(path.displacement(reduced, t, &moment), start.heading);
        SleighState {
            x: start.x + x,
            y: start.y + y,
            heading: start.heading + moment.turn,
            speed: moment.speed,
            turn_rate: moment.turn_rate,
        }
    }

    /// By how much the heading turns from the far past to the far future (rad), in absolute value:
    /// `pi sqrt(J / (m a^2))`, whatever the energy.
    ///
    /// Infinite for a balanced sleigh, and zero for the straight line without spin.
    #[must_use]
    pub fn turning_angle(&self) -> f64 {
        self.turning.as_ref().map_or(0.0, |(reduced, _)| PI * reduced.gyration_per_offset.abs())
    }

    /// `E = m u^2/2 + J omega^2/2` (J), constant: the constraint does no work.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let SleighState { speed, turn_rate, .. } = self.start;
        0.5 * (self.sleigh.mass() * speed * speed + self.sleigh.pivot_inertia() * turn_rate * turn_rate)
    }
}
