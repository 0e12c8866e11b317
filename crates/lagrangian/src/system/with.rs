use crate::{AdmissibleBasis, Constraint, Effect, Motion, Reduced, ReducedError, Scalar, System, velocity_of};
use crate::{add_all, sum};

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

    #[inline(always)]
    fn reduced(&self) -> impl Reduced<N, M> {
        self
    }
}

/// Whether anything may be known of a body.
#[inline(always)]
fn any<R: Reduced<N, M>, const N: usize, const M: usize>(_: &R) -> bool {
    R::ANY
}

impl<B: System<N, M>, E: Effect<B, N>, const N: usize, const M: usize> Reduced<N, M> for With<B, E> {
    /// The body's own and its response to the effects, where both are known.
    #[inline]
    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<Motion<N, M>> {
        let bare = self.body.reduced().motion(t, q, v)?;
        if self.effects.is_none() {
            return Some(bare);
        }
        let push = self.effects.whole_force(&self.body, t, q, v)?;
        Some(bare + self.body.reduced().response(t, q, &push)?)
    }

    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N]) -> Option<[S; N]> {
        if N == M {
            return Some([S::zero(); N]);
        }
        if self.effects.is_none() {
            return self.body.reduced().reduced_motion(t, q, xi);
        }
        // Known when the program is compiled: what acts is then not asked.
        if !any(&self.body.reduced()) {
            return None;
        }
        let push = self.effects.whole_force(&self.body, t, q, &velocity_of(&self.body, t, q, xi).ok()?)?;
        self.body.reduced().pushed_motion(t, q, xi, &push)
    }

    #[inline(always)]
    fn velocity<S: Scalar>(
        &self,
        t: S,
        q: &[S; N],
        xi: &[S; N],
        derived: impl FnOnce() -> Result<[S; N], ReducedError>,
    ) -> Result<[S; N], ReducedError> {
        self.body.reduced().velocity(t, q, xi, derived)
    }

    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        self.body.reduced().reconstruction()
    }

    #[inline(always)]
    fn stands_alone(&self) -> bool {
        self.effects.is_none() && self.body.reduced().stands_alone()
    }

    #[inline(always)]
    fn response(&self, t: f64, q: &[f64; N], force: &[f64; N]) -> Option<Motion<N, M>> {
        self.body.reduced().response(t, q, force)
    }

    #[inline(always)]
    fn pushed_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N], force: &[S; N]) -> Option<[S; N]> {
        if self.effects.is_none() {
            return self.body.reduced().pushed_motion(t, q, xi, force);
        }
        let push = self.effects.whole_force(&self.body, t, q, &velocity_of(&self.body, t, q, xi).ok()?)?;
        self.body.reduced().pushed_motion(t, q, xi, &sum(&push, force))
    }
}
