mod crossing;
pub(crate) mod pace;
pub(crate) mod place;
pub(crate) mod series;

use crate::{OneStep, State, StepError, StepReport};
use crossing::Crossing;
pub(crate) use crossing::{Crossed, MAX_STEPS};
use lagrangian::simd::in_fours;
use lagrangian::{System, velocity_of};
use place::{increment, place};

/// Taylor series of the reduced motion in the body's own axes, with steps of its own within a step of the schedule, as many as a
/// tolerance asks for: what a motion of second degree costs least by.
///
/// Where the equations are [of second degree in axes that turn with the body](System::own_axes), a coefficient of the series is a
/// sum of products of those before, of all four unknowns in one register; twenty of them take 130 ns. The velocity is
/// on the constraint by construction. The method is explicit: neither symmetric nor variational, and it keeps energy and momenta to
/// its tolerance only. For long runs see [`Gauss`](crate::Gauss).
///
/// Systems without such equations are refused with [`StepError::Unsupported`].
///
/// (Jorba and Zou 2005, Experimental Mathematics 14, 99-117.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taylor {
    tolerance: f64,
}

impl Taylor {
    /// The order of the method.
    pub const ORDER: usize = series::ORDER;
    /// Steps within an interval before it is given up.
    pub const MAX_STEPS: u32 = MAX_STEPS;

    /// The method with the tolerance `epsilon`: the error of a step is kept near `epsilon (1 + |(u, omega)|)`, as far as the terms of
    /// the series fall off evenly. Rounding is larger where it is below some `1e-15`; it is taken to be no less than `1e-31`.
    #[must_use]
    pub fn new(epsilon: f64) -> Self {
        Self { tolerance: epsilon }
    }
}

impl<Sys: System<3, 1>> OneStep<Sys, 3, 1> for Taylor {
    #[inline]
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<3>) -> Result<StepReport<1>, StepError> {
        let Some(axes) = system.own_axes() else {
            return Err(StepError::Unsupported {
                reason: "series need equations of second degree in axes that turn with the body",
            });
        };
        let (q0, [u, omega, _]) = (*state.q(), state.quasi_velocities(system, t)?);
        let place = place(axes.origin, &q0);
        let start = [omega, u, place[1], place[0]];
        let crossed = in_fours(Crossing { axes, start, whole: h, tolerance: self.tolerance })?;
        let increment = increment(axes.origin, &q0, place, &crossed);
        let xi1 = [crossed.end[1], crossed.end[0], 0.0];
        state.stays_finite(&increment, &xi1)?;
        // The velocity is on the constraint at the heading without its turns, of which there may be many.
        let mut moved = *state;
        moved.advance(&increment, [0.0; 3], None);
        let v1 = velocity_of(system, t + h, moved.q(), &xi1)?;
        moved.stays_finite(&[0.0; 3], &v1)?;
        moved.advance(&[0.0; 3], v1, Some(xi1));
        *state = moved;
        Ok(StepReport::of(0))
    }
}
