use crate::effect::{add_all, sum};
use crate::{
    AdmissibleBasis, ClosedStep, ClosedStepError, Constraint, Effect, Motion, MotionError, OwnAxes, Push, Scalar,
    Start, System, velocity_of,
};

/// A body with the effects that act on it: again a [`System`], on the body's coordinates and constraints.
///
/// `With { body, effects: () }` compiles to the bare body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct With<B, E> {
    /// The body.
    pub body: B,
    /// What acts on it.
    pub effects: E,
}

/// The effects of a body.
struct Pushing<'a, B, E>(&'a With<B, E>);

impl<B, E: Effect<B, N>, const N: usize> Push<N> for Pushing<'_, B, E> {
    #[inline(always)]
    fn push<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let Self(With { body, effects }) = self;
        if E::MANY { called(|| effects.whole_force(body, t, q, v)) } else { effects.whole_force(body, t, q, v) }
    }

    #[inline(always)]
    fn brake<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let Self(With { body, effects }) = self;
        if E::MANY { called(|| effects.force(body, t, q, v)) } else { effects.force(body, t, q, v) }
    }
}

/// A function that stays one.
#[inline(never)]
fn called<T>(f: impl FnOnce() -> T) -> T {
    f()
}

impl<B: System<N, M>, E: Effect<B, N>, const N: usize, const M: usize> System<N, M> for With<B, E> {
    const MOVING: bool = B::MOVING;

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        let bare = self.body.lagrangian(t, q, v);
        match self.effects.lagrangian(&self.body, t, q, v) {
            Some(term) => bare + term,
            None => bare,
        }
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.body.constraint(t, q)
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        add_all(self.body.force(t, q, v), self.effects.force(&self.body, t, q, v))
    }

    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        self.body.admissible_basis(t, q)
    }

    #[inline(always)]
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.body.holonomic(t, q)
    }

    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; M]> {
        self.body.nonlinear(t, q, v)
    }

    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        self.body.angles()
    }

    /// The body's own and its response to the effects, where both are known by hand.
    #[inline]
    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Motion<N, M>, MotionError> {
        if self.effects.is_none() {
            return self.body.motion(t, q, v);
        }
        match self.effects.whole_force(&self.body, t, q, v).and_then(|push| self.body.response(t, q, &push)) {
            Some(response) => Ok(self.body.motion(t, q, v)? + response),
            None => Motion::automatic(self, t, q, v),
        }
    }

    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N]) -> Option<[S; N]> {
        let bare = self.body.reduced_motion(t, q, xi)?;
        if self.effects.is_none() {
            return Some(bare);
        }
        let push = self.effects.whole_force(&self.body, t, q, &velocity_of(&self.body, t, q, xi).ok()?)?;
        let response = self.body.reduced_response(t, q, &push)?;
        Some(sum(&bare, &response))
    }

    #[inline(always)]
    fn own_axes(&self) -> Option<OwnAxes> {
        self.body.own_axes()?.pushed(self.effects.in_own_axes(&self.body)?)
    }

    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        self.body.reconstruction()
    }

    #[inline(always)]
    fn stands_alone(&self) -> bool {
        self.effects.is_none() && self.body.stands_alone()
    }

    #[inline(always)]
    fn response(&self, t: f64, q: &[f64; N], force: &[f64; N]) -> Option<Motion<N, M>> {
        self.body.response(t, q, force)
    }

    #[inline(always)]
    fn reduced_response<S: Scalar>(&self, t: S, q: &[S; N], force: &[S; N]) -> Option<[S; N]> {
        self.body.reduced_response(t, q, force)
    }

    #[inline(always)]
    fn closed_step(&self, t: f64, h: f64, start: Start<'_, N>) -> Option<Result<ClosedStep<N, M>, ClosedStepError>> {
        if self.effects.is_none() {
            return self.body.closed_step(t, h, start);
        }
        self.body.pushed_step(t, h, start, &Pushing(self)).map(Ok)
    }
}
