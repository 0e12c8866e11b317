use crate::Scalar;

/// Something that acts on a body: it adds to the Lagrangian or to the forces, on the body's own coordinates.
///
/// What it does not add it leaves `None`, and then nothing is computed. What changes coordinates or constraints is
/// another body. Effects compose: `()` is none of them, a tuple several known ones, a `Vec` as many as a file names. In
/// the angles of the body an effect must have the period `2 pi`.
pub trait Effect<B, const N: usize> {
    /// Whether it may be many kinds of effects, which of them a program knows only when it runs: what asks for all of them is much code,
    /// and better called than inlined where numbers are not in registers.
    const MANY: bool = false;

    /// What the effect adds to `L(t, q, v)` (J); a potential `V` adds `-V`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _body: &B, _t: S, _q: &[S; N], _v: &[S; N]) -> Option<S> {
        None
    }

    /// What the effect adds to the generalised forces.
    #[inline(always)]
    fn force<S: Scalar>(&self, _body: &B, _t: S, _q: &[S; N], _v: &[S; N]) -> Option<[S; N]> {
        None
    }

    /// The derivative `dL/dq` of what the effect adds to the Lagrangian, by hand: for a term without velocities, as a
    /// potential is. The equations of motion of a body that knows its own then need no automatic ones.
    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> EffectSlope<S, N> {
        match self.lagrangian(body, t, q, &[S::zero(); N]) {
            Some(_) => EffectSlope::Unknown,
            None => EffectSlope::Nothing,
        }
    }

    /// The whole generalised force, `dL/dq` by hand plus the added forces; `None` if the slope is not known by hand.
    #[inline(always)]
    fn whole_force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.slope(body, t, q).with_force(self.force(body, t, q, v))
    }

    /// Whether the effect may add to the forces. If false, [`force`](Self::force) adds nothing at any time and state, so that a caller
    /// interested in brakes need not evaluate it.
    #[inline(always)]
    fn has_force(&self) -> bool {
        true
    }

    /// Whether there is no effect at all, so that the body's own closed forms hold.
    #[inline(always)]
    fn is_none(&self) -> bool {
        false
    }
}

/// What [`Effect::slope`] knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EffectSlope<S, const N: usize> {
    /// The effect adds nothing to the Lagrangian.
    Nothing,
    /// The derivative, by hand.
    Known([S; N]),
    /// There is one, and it is not known by hand.
    Unknown,
}

impl<S: Scalar, const N: usize> EffectSlope<S, N> {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Unknown, _) | (_, Self::Unknown) => Self::Unknown,
            (Self::Nothing, slope) | (slope, Self::Nothing) => slope,
            (Self::Known(a), Self::Known(b)) => Self::Known(sum(&a, &b)),
        }
    }

    /// The whole generalised force of an effect with this slope and the given force; `None` if the slope is not known.
    #[inline(always)]
    pub(crate) fn with_force(self, force: Option<[S; N]>) -> Option<[S; N]> {
        match (self, force) {
            (Self::Unknown, _) => None,
            (Self::Nothing, force) => Some(force.unwrap_or([S::zero(); N])),
            (Self::Known(slope), None) => Some(slope),
            (Self::Known(slope), Some(force)) => Some(sum(&slope, &force)),
        }
    }
}

/// No effect.
impl<B, const N: usize> Effect<B, N> for () {
    #[inline(always)]
    fn has_force(&self) -> bool {
        false
    }
    #[inline(always)]
    fn is_none(&self) -> bool {
        true
    }
}

#[inline(always)]
fn add<S: Scalar>(a: Option<S>, b: Option<S>) -> Option<S> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (a, b) => a.or(b),
    }
}

/// `a + b`, place by place.
#[inline(always)]
pub(crate) fn sum<S: Scalar, const N: usize>(a: &[S; N], b: &[S; N]) -> [S; N] {
    S::array(
        #[inline(always)]
        |i| a[i] + b[i],
    )
}

#[inline(always)]
pub(crate) fn add_all<S: Scalar, const N: usize>(a: Option<[S; N]>, b: Option<[S; N]>) -> Option<[S; N]> {
    match (a, b) {
        (Some(a), Some(b)) => Some(sum(&a, &b)),
        (a, b) => a.or(b),
    }
}

macro_rules! tuple_of_effects {
    ($($effect:ident $index:tt),+) => {
        impl<B, const N: usize, $($effect: Effect<B, N>),+> Effect<B, N> for ($($effect,)+) {
            #[inline(always)]
            fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
                let sum = None;
                $(let sum = add(sum, self.$index.lagrangian(body, t, q, v));)+
                sum
            }
            #[inline(always)]
            fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
                let sum = None;
                $(let sum = add_all(sum, self.$index.force(body, t, q, v));)+
                sum
            }
            #[inline(always)]
            fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> EffectSlope<S, N> {
                EffectSlope::Nothing$(.and(self.$index.slope(body, t, q)))+
            }
            #[inline(always)]
            fn has_force(&self) -> bool {
                $(self.$index.has_force())||+
            }
            #[inline(always)]
            fn is_none(&self) -> bool {
                $(self.$index.is_none())&&+
            }
        }
    };
}
tuple_of_effects!(E0 0);
tuple_of_effects!(E0 0, E1 1);
tuple_of_effects!(E0 0, E1 1, E2 2);
tuple_of_effects!(E0 0, E1 1, E2 2, E3 3);
tuple_of_effects!(E0 0, E1 1, E2 2, E3 3, E4 4);
tuple_of_effects!(E0 0, E1 1, E2 2, E3 3, E4 4, E5 5);

impl<B, E: Effect<B, N>, const N: usize> Effect<B, N> for Vec<E> {
    const MANY: bool = true;

    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        S::over(
            self,
            None,
            #[inline(always)]
            |sum, effect| add(sum, effect.lagrangian(body, t, q, v)),
        )
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        S::over(
            self,
            None,
            #[inline(always)]
            |sum, effect| add_all(sum, effect.force(body, t, q, v)),
        )
    }
    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> EffectSlope<S, N> {
        S::over(
            self,
            EffectSlope::Nothing,
            #[inline(always)]
            |sum, effect| sum.and(effect.slope(body, t, q)),
        )
    }
    /// Slope and force of each in one pass.
    #[inline(always)]
    fn whole_force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        // Which effects there are is known in a run alone.
        S::over(
            self,
            Some([S::zero().carried_as(t); N]),
            #[inline(always)]
            |all, effect| match (all, effect.whole_force(body, t, q, v)) {
                (Some(all), Some(force)) => Some(S::array(
                    #[inline(always)]
                    |i| all[i] + force[i].carried_as(t),
                )),
                _ => None,
            },
        )
    }
    #[inline(always)]
    fn has_force(&self) -> bool {
        self.iter().any(Effect::has_force)
    }
    #[inline(always)]
    fn is_none(&self) -> bool {
        self.iter().all(Effect::is_none)
    }
}
