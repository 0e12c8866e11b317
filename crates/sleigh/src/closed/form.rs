use super::{Memory, free, pushed};
use crate::{Flywheel, Guided, Sleigh};
use dla::ClosedStepError;
use lagrangian::{Effect, Scalar, System, With, called};

/// A body whose step by the midpoint discrete Lagrange-d'Alembert map may be known in closed form.
///
/// The step agrees with the general step of [`Dla`](dla::Dla) to round-off, but is faster and keeps more digits.
pub trait ClosedForm<const N: usize, const M: usize>: System<N, M> {
    /// Whether [`closed_step`](Self::closed_step) gives anything.
    fn has_closed_form(&self) -> bool;

    /// One step of length `h` (s) from the time `t` (s); `None` if the general step must be made.
    fn closed_step(
        &self,
        t: f64,
        h: f64,
        start: ClosedStart<'_, N>,
    ) -> Option<Result<ClosedStep<N, M>, ClosedStepError>>;

    /// Whether [`pushed_step`](Self::pushed_step) gives anything.
    #[inline(always)]
    fn has_pushed_form(&self) -> bool {
        false
    }

    /// The closed step under effects, whose force is taken in the middle of the step at the mean velocity.
    ///
    /// Returns `None`, so that the general step is made, if the force is not known by hand, the solution is not found quickly, or the
    /// force may overshoot.
    #[inline(always)]
    fn pushed_step<E: Effect<Self, N>>(
        &self,
        _t: f64,
        _h: f64,
        _start: ClosedStart<'_, N>,
        _effects: &E,
    ) -> Option<ClosedStep<N, M>>
    where
        Self: Sized,
    {
        None
    }
}

impl ClosedForm<3, 1> for Sleigh {
    #[inline(always)]
    fn has_closed_form(&self) -> bool {
        true
    }

    #[inline(always)]
    fn closed_step(
        &self,
        _t: f64,
        h: f64,
        start: ClosedStart<'_, 3>,
    ) -> Option<Result<ClosedStep<3, 1>, ClosedStepError>> {
        Some(free::step(self, h, start))
    }

    #[inline(always)]
    fn has_pushed_form(&self) -> bool {
        true
    }

    #[inline(always)]
    fn pushed_step<E: Effect<Self, 3>>(
        &self,
        t: f64,
        h: f64,
        start: ClosedStart<'_, 3>,
        effects: &E,
    ) -> Option<ClosedStep<3, 1>> {
        pushed::step(self, (t, h), start, effects)
    }
}

/// No closed form is known.
impl<const K: usize, const M: usize> ClosedForm<3, M> for Guided<K>
where
    Self: System<3, M>,
{
    #[inline(always)]
    fn has_closed_form(&self) -> bool {
        false
    }

    #[inline(always)]
    fn closed_step(
        &self,
        _t: f64,
        _h: f64,
        _start: ClosedStart<'_, 3>,
    ) -> Option<Result<ClosedStep<3, M>, ClosedStepError>> {
        None
    }
}

/// On a free bearing: the closed form of the body, while the rotor keeps its absolute rate.
impl<B: ClosedForm<3, M>, const M: usize> ClosedForm<4, M> for Flywheel<B> {
    #[inline(always)]
    fn has_closed_form(&self) -> bool {
        self.torque().is_none() && M == 1 && self.body().has_closed_form()
    }

    #[inline(always)]
    fn closed_step(
        &self,
        t: f64,
        h: f64,
        start: ClosedStart<'_, 4>,
    ) -> Option<Result<ClosedStep<4, M>, ClosedStepError>> {
        if self.torque().is_some() || M != 1 {
            return None;
        }
        let of_body = |[x, y, theta, _]: [f64; 4]| [x, y, theta];
        let ClosedStart { q, v, xi, memory } = start;
        let spin = xi.map_or_else(|| v[2] + v[3], |xi| xi[2]);
        let (q, v, xi) = (of_body(*q), of_body(*v), xi.map(of_body));
        let body = self.body().closed_step(t, h, ClosedStart { q: &q, v: &v, xi, memory })?;
        let with_rotor = |[x, y, theta]: [f64; 3], rotor| [x, y, theta, rotor];
        Some(body.map(|step| ClosedStep {
            increment: with_rotor(step.increment, h * spin - step.increment[2]),
            velocity: with_rotor(step.velocity, spin - step.velocity[2]),
            xi: [step.xi[0], step.xi[1], spin, 0.0],
            impulses: step.impulses,
            iterations: step.iterations,
        }))
    }
}

impl<B: ClosedForm<N, M>, E: Effect<B, N>, const N: usize, const M: usize> ClosedForm<N, M> for With<B, E> {
    #[inline(always)]
    fn has_closed_form(&self) -> bool {
        if self.effects.is_none() { self.body.has_closed_form() } else { self.body.has_pushed_form() }
    }

    #[inline(always)]
    fn closed_step(
        &self,
        t: f64,
        h: f64,
        start: ClosedStart<'_, N>,
    ) -> Option<Result<ClosedStep<N, M>, ClosedStepError>> {
        if self.effects.is_none() {
            return self.body.closed_step(t, h, start);
        }
        self.body.pushed_step(t, h, start, &self.effects).map(Ok)
    }
}

/// The start of a step in closed form. The numbers of `memory` change the step by round-off at most.
#[derive(Debug)]
pub struct ClosedStart<'a, const N: usize> {
    /// The configuration.
    pub q: &'a [f64; N],
    /// The velocity.
    pub v: &'a [f64; N],
    /// The same velocity in the system's basis of admissible velocities, if known. A step may read either.
    pub xi: Option<[f64; N]>,
    /// Numbers left by the step before, replaced by numbers for the next step. After a step that fails they are of no use.
    pub memory: &'a mut Memory,
}

impl<'a, const N: usize> ClosedStart<'a, N> {
    /// A start with this configuration, velocity and memory.
    #[must_use]
    pub fn new(q: &'a [f64; N], v: &'a [f64; N], memory: &'a mut Memory) -> Self {
        Self { q, v, xi: None, memory }
    }
}

/// The result of a step in closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedStep<const N: usize, const M: usize> {
    /// The increment `q1 - q0`.
    pub increment: [f64; N],
    /// The velocity `v1` at the end, admissible at `q1`.
    pub velocity: [f64; N],
    /// The same velocity as quasi-velocities in the system's basis of admissible velocities at `q1`.
    pub xi: [f64; N],
    /// Impulses of the constraints at the two ends of the step, `A(q0)' impulses[0] + A(q1)' impulses[1]` in all.
    pub impulses: [[f64; M]; 2],
    /// Newton iterations taken.
    pub iterations: u32,
}

/// The whole force of the effects at `(t, q, v)`; `None` if it is not known by hand.
#[inline(always)]
pub(super) fn push<E: Effect<Sleigh, 3>, S: Scalar>(
    effects: &E,
    sleigh: &Sleigh,
    t: S,
    q: &[S; 3],
    v: &[S; 3],
) -> Option<[S; 3]> {
    if E::MANY { called(|| effects.whole_force(sleigh, t, q, v)) } else { effects.whole_force(sleigh, t, q, v) }
}

/// The part of the force that may depend on the velocity; `None` if there is none.
#[inline(always)]
pub(super) fn brake<E: Effect<Sleigh, 3>, S: Scalar>(
    effects: &E,
    sleigh: &Sleigh,
    t: S,
    q: &[S; 3],
    v: &[S; 3],
) -> Option<[S; 3]> {
    // A question once for all effects: within their loop the sines of a drag would be computed for those that are none.
    if !effects.has_force() {
        return None;
    }
    if E::MANY { called(|| effects.force(sleigh, t, q, v)) } else { effects.force(sleigh, t, q, v) }
}
