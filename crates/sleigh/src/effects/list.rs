use super::AnyEffect;
use crate::series::{OwnPush, PushInOwnAxes};
use crate::{Sleigh, SleighBody};
use dla::KnownAngle;
use lagrangian::{Effect, EffectSlope, Piecewise, Scalar};

/// A list of effects.
///
/// The effects act on the sleigh of a body, so that each function is compiled once for all bodies, in vector registers too.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EffectList(Vec<AnyEffect>);

impl From<Vec<AnyEffect>> for EffectList {
    fn from(effects: Vec<AnyEffect>) -> Self {
        Self(effects)
    }
}

impl EffectList {
    /// The effects, in their order.
    #[must_use]
    pub fn all(&self) -> &[AnyEffect] {
        &self.0
    }

    #[inline(always)]
    fn lagrangian_on<S: Scalar, const N: usize>(&self, sleigh: &Sleigh, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        S::apart(
            #[inline(always)]
            || self.0.lagrangian(sleigh, t, q, v),
        )
    }

    #[inline(always)]
    fn force_on<S: Scalar, const N: usize>(&self, sleigh: &Sleigh, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        S::apart(
            #[inline(always)]
            || self.0.force(sleigh, t, q, v),
        )
    }

    #[inline(always)]
    fn slope_on<S: Scalar, const N: usize>(&self, sleigh: &Sleigh, t: S, q: &[S; N]) -> EffectSlope<S, N> {
        S::apart(
            #[inline(always)]
            || Effect::<Sleigh, N>::slope(&self.0, sleigh, t, q),
        )
    }

    /// In registers, the force is a call, except for a body that is a sleigh alone, whose kernel is used most. A call is given the sine and
    /// cosine of the heading, which its caller needs too.
    #[inline(always)]
    fn whole_force_on<B: SleighBody, S: Scalar, const N: usize>(
        &self,
        body: &B,
        t: S,
        q: &[S; N],
        v: &[S; N],
    ) -> Option<[S; N]> {
        let sleigh = body.sleigh();
        if const { !S::IN_REGISTERS } {
            return S::apart(
                #[inline(always)]
                || self.0.whole_force(sleigh, t, q, v),
            );
        }
        if const { B::ALONE } {
            return self.0.whole_force(sleigh, t, q, v);
        }
        let (sin, cos) = q[2].sin_cos();
        let heading = S::array(
            #[inline(always)]
            |i| if i == 0 { sin } else { cos },
        );
        t.called_on(
            [*q, *v, heading],
            #[inline(always)]
            |t, [q, v, heading]| self.pointed(sleigh, t, (&q, [heading[0], heading[1]]), &v),
        )
    }

    /// The whole force for known sine and cosine of the heading.
    #[allow(clippy::manual_map, reason = "a closure may stay a call, in which the registers are not known")]
    #[inline(always)]
    fn pointed<S: Scalar, const N: usize>(
        &self,
        sleigh: &Sleigh,
        t: S,
        (q, [sin, cos]): (&[S; N], [S; 2]),
        v: &[S; N],
    ) -> Option<[S; N]> {
        let place: [_; N] = KnownAngle::array(
            #[inline(always)]
            |i| if i == 2 { KnownAngle::new(q[2], sin, cos) } else { KnownAngle::from(q[i]) },
        );
        let rates: [_; N] = KnownAngle::array(
            #[inline(always)]
            |i| KnownAngle::from(v[i]),
        );
        match self.0.whole_force(sleigh, KnownAngle::from(t), &place, &rates) {
            Some(force) => Some(S::array(
                #[inline(always)]
                |i| force[i].re,
            )),
            None => None,
        }
    }
}

impl<B: SleighBody, const N: usize> Effect<B, N> for EffectList {
    const MANY: bool = true;

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        self.lagrangian_on(body.sleigh(), t, q, v)
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.force_on(body.sleigh(), t, q, v)
    }
    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> EffectSlope<S, N> {
        self.slope_on(body.sleigh(), t, q)
    }
    #[inline(always)]
    fn whole_force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.whole_force_on(body, t, q, v)
    }
    #[inline(always)]
    fn has_force(&self) -> bool {
        Effect::<Sleigh, N>::has_force(&self.0)
    }
    #[inline(always)]
    fn is_none(&self) -> bool {
        self.0.is_empty()
    }
}

impl PushInOwnAxes for EffectList {
    fn in_own_axes(&self, sleigh: &Sleigh) -> Option<OwnPush> {
        self.0.in_own_axes(sleigh)
    }
}

impl Piecewise for EffectList {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        self.0.jumps(from, to)
    }
    fn piece(&self, t: f64) -> Self {
        Self(self.0.piece(t))
    }
}
