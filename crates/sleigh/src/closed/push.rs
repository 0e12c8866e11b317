use lagrangian::{Effect, Scalar, With, called};

/// A generalised force.
pub trait Push<const N: usize> {
    /// The force at `(t, q, v)`; `None` if it is not known by hand.
    fn push<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]>;

    /// The part of the force that may depend on the velocity; `None` if there is none.
    fn brake<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]>;
}

/// The effects of a body.
pub(super) struct Pushing<'a, B, E>(pub(super) &'a With<B, E>);

impl<B, E: Effect<B, N>, const N: usize> Push<N> for Pushing<'_, B, E> {
    #[inline(always)]
    fn push<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let Self(With { body, effects }) = self;
        if E::MANY { called(|| effects.whole_force(body, t, q, v)) } else { effects.whole_force(body, t, q, v) }
    }

    #[inline(always)]
    fn brake<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let Self(With { body, effects }) = self;
        // A question once for all effects: within their loop the sines of a drag would be computed for those that are none.
        if !effects.has_force() {
            return None;
        }
        if E::MANY { called(|| effects.force(body, t, q, v)) } else { effects.force(body, t, q, v) }
    }
}
