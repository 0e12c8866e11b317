//! Taylor series of motions in the axes of the sleigh: an integrator of the sleigh's own.

mod coefficients;
mod crossing;
mod own_axes;
mod pace;

pub use own_axes::{InOwnAxes, OwnAxes, OwnPush, PushInOwnAxes};

use crossing::{MAX_STEPS, SeriesCrossing, SeriesEnd};
use dla::{MeanPower, Mechanics, OneStep, OwnStep, State, StepError, StepReport, power};
use lagrangian::PowerSources;
use lagrangian::quadrature::gauss_legendre;
use lagrangian::simd::in_fours;
use std::ops::ControlFlow;

/// Taylor series of the reduced motion in the body's own axes, with steps of its own within a step of the schedule, as many as a
/// tolerance asks for: what a motion of second degree costs least by.
///
/// Where the equations are [of second degree in axes that turn with the body](InOwnAxes), a coefficient of the series is a
/// sum of products of those before, of all four unknowns in one register; twenty of them take 130 ns. The velocity is
/// on the constraint by construction. The method is explicit: neither symmetric nor variational, and it keeps energy and momenta to
/// its tolerance only. For long runs see [`Gauss`](dla::Gauss).
///
/// The method holds the equations of its body, and must be driven on this body.
///
/// (Jorba and Zou 2005, Experimental Mathematics 14, 99-117.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taylor {
    axes: OwnAxes,
    tolerance: f64,
    /// The effects whose work is reported.
    sources: PowerSources,
}

impl Taylor {
    /// The order of the method.
    pub const ORDER: usize = coefficients::ORDER;
    /// Maximum number of steps in an interval.
    pub const MAX_STEPS: u32 = MAX_STEPS;

    /// The method for this body with the tolerance `epsilon`, which is raised to at least `1e-31`. The error of a step is kept near
    /// `epsilon (1 + |(u, omega)|)`, if the terms of the series fall off evenly. Below some `1e-15` rounding is larger than the tolerance.
    /// Returns `None` if the body has no equations in own axes.
    #[must_use]
    pub fn of(body: &impl InOwnAxes, epsilon: f64) -> Option<Self> {
        Some(Self::in_axes(body.own_axes()?, epsilon))
    }

    /// The method for these equations with the tolerance `epsilon`.
    #[must_use]
    pub fn in_axes(axes: OwnAxes, epsilon: f64) -> Self {
        Self { axes, tolerance: epsilon, sources: PowerSources::NONE }
    }
}

/// Number of Gauss nodes in a step: their quadrature has at least the order of the series.
const WITHIN: usize = 10;

/// Where a step begins.
struct SeriesDeparture<'a> {
    axes: OwnAxes,
    state: &'a State<3>,
    place: [f64; 2],
    /// `(omega, u, Y, X)`.
    start: [f64; 4],
}

impl<'a> SeriesDeparture<'a> {
    #[inline(always)]
    fn new(axes: OwnAxes, system: &dyn Mechanics<3, 1>, t: f64, state: &'a State<3>) -> Result<Self, StepError> {
        let (q0, [u, omega, _]) = (*state.q(), state.quasi_velocities(system, t)?);
        let place = place(axes.center, &q0);
        Ok(Self { axes, state, place, start: [omega, u, place[1], place[0]] })
    }

    /// The state at the time `t` (s), where the motion has come so far.
    #[inline(always)]
    fn moved(&self, system: &dyn Mechanics<3, 1>, t: f64, crossed: &SeriesEnd) -> Result<State<3>, StepError> {
        let Self { state, place, .. } = self;
        let increment = increment(state.q()[2], *place, crossed);
        let xi1 = [crossed.end[1], crossed.end[0], 0.0];
        state.stays_finite(&increment, &xi1)?;
        // The velocity is on the constraint at the heading without its turns, of which there may be many.
        let mut moved = **state;
        moved.advance(&increment, [0.0; 3], None);
        let v1 = system.velocity_of(t, moved.q(), &xi1)?;
        moved.stays_finite(&[0.0; 3], &v1)?;
        moved.advance(&[0.0; 3], v1, Some(xi1));
        Ok(moved)
    }
}

impl OneStep<3, 1> for Taylor {
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<3, 1>,
        t: f64,
        h: f64,
        state: &mut State<3>,
    ) -> Result<StepReport<1>, StepError> {
        let from = SeriesDeparture::new(self.axes, system, t, state)?;
        let (axes, start, tolerance) = (from.axes, from.start, self.tolerance);
        if !self.sources.any() {
            let see = |_, _| ControlFlow::Continue(());
            let crossed = in_fours(SeriesCrossing { axes, start, whole: h, tolerance, within: &[], see })?;
            *state = from.moved(system, t + h, &crossed)?;
            return Ok(StepReport::of(0));
        }
        // The power on the series of each step, which are the same with it and without.
        let (nodes, weights) = gauss_legendre::<WITHIN>();
        let (mut work, mut mean, mut begun, mut seen) = (0.0, MeanPower::default(), 0.0, 0);
        let see = |made: f64, crossed: SeriesEnd| {
            if let Some(&weight) = weights.get(seen) {
                let at = from.moved(system, t + made, &crossed);
                mean.add(weight, at.map_or(f64::NAN, |at| power(system, self.sources, t + made, (at.q(), at.v()))));
                seen += 1;
            } else {
                work += (made - begun) * mean.mean();
                (mean, begun, seen) = (MeanPower::default(), made, 0);
            }
            ControlFlow::Continue(())
        };
        let crossed = in_fours(SeriesCrossing { axes, start, whole: h, tolerance, within: &nodes, see })?;
        work += (h - begun) * mean.mean();
        *state = from.moved(system, t + h, &crossed)?;
        Ok(StepReport { work: Some(work), ..StepReport::of(0) })
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.sources = sources;
    }

    fn own_steps(
        &self,
        system: &dyn Mechanics<3, 1>,
        (t, h): (f64, f64),
        state: &State<3>,
        _memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, 3>,
    ) -> Result<(), StepError> {
        let from = SeriesDeparture::new(self.axes, system, t, state)?;
        let (axes, start, tolerance, mut failure) = (from.axes, from.start, self.tolerance, None);
        let see = |made: f64, crossed: SeriesEnd| match from.moved(system, t + made, &crossed) {
            Ok(state) => see(t + made, &state),
            Err(error) => {
                failure = Some(error);
                ControlFlow::Break(())
            }
        };
        in_fours(SeriesCrossing { axes, start, whole: h, tolerance, within: &[], see })?;
        failure.map_or(Ok(()), Err)
    }
}

/// The place `(X, Y)` in axes of this heading, from a place on the plane.
#[inline(always)]
fn turned_back([x, y]: [f64; 2], heading: f64) -> [f64; 2] {
    let (sin, cos) = heading.sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}

/// The place `(X, Y)` where a step begins, counted from `center`; without one, from there.
#[inline(always)]
fn place(center: Option<[f64; 2]>, q0: &[f64; 3]) -> [f64; 2] {
    center.map_or([0.0; 2], |[x, y]| turned_back([q0[0] - x, q0[1] - y], q0[2]))
}

/// The increment of the coordinates to the end of an interval, from the heading and the place `(X, Y)` at its beginning.
#[inline(always)]
fn increment(heading: f64, [x0, y0]: [f64; 2], crossed: &SeriesEnd) -> [f64; 3] {
    let SeriesEnd { end: [_, _, y, x], turn } = *crossed;
    // Both places in the axes of the beginning: what is common to them is not turned.
    let [x, y] = turned_back([x, y], -turn);
    let [dx, dy] = turned_back([x - x0, y - y0], -heading);
    [dx, dy, turn]
}
