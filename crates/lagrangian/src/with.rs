use crate::{AdmissibleBasis, ClosedStep, ClosedStepError, Constraint, Effect, Motion, MotionError, Scalar, System};
use std::array::from_fn;

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
        match (self.body.force(t, q, v), self.effects.force(&self.body, t, q, v)) {
            (Some(a), Some(b)) => Some(from_fn(|i| a[i] + b[i])),
            (a, b) => a.or(b),
        }
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

    #[inline]
    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Result<Motion<N, M>, MotionError> {
        if self.effects.is_none() { self.body.motion(t, q, v) } else { Motion::automatic(self, t, q, v) }
    }

    #[inline(always)]
    fn reduced_motion(&self, t: f64, q: &[f64; N], xi: &[f64; N]) -> Option<[f64; N]> {
        if self.effects.is_none() { self.body.reduced_motion(t, q, xi) } else { None }
    }

    #[inline(always)]
    fn closed_step(
        &self,
        t: f64,
        h: f64,
        q: &[f64; N],
        v: &[f64; N],
        xi: Option<[f64; N]>,
    ) -> Option<Result<ClosedStep<N, M>, ClosedStepError>> {
        if self.effects.is_none() { self.body.closed_step(t, h, q, v, xi) } else { None }
    }
}
