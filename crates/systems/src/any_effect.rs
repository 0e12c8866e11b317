use lagrangian::{Effect, Piecewise, Scalar};
use sleigh::effects::{Bowl, Drag, EggCrate, Friction, Hills, QuadraticDrag, Slope, Thrust, Torque};
use sleigh::series::{OwnPush, PushInOwnAxes};
use sleigh::{Sleigh, SleighBody};

/// An effect of a scene that acts on the existing coordinates as a potential or a force: one type for a list of effects.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "each arm is the effect of its name")]
pub enum AnyEffect {
    Slope(Slope),
    Bowl(Bowl),
    EggCrate(EggCrate),
    Hills(Hills),
    Drag(Drag),
    QuadraticDrag(QuadraticDrag),
    Friction(Friction),
    Thrust(Thrust),
    Torque(Torque),
}

/// Expands the same expression for each kind of effect.
macro_rules! each {
    ($self:ident, $effect:ident => $result:expr) => {
        match $self {
            AnyEffect::Slope($effect) => $result,
            AnyEffect::Bowl($effect) => $result,
            AnyEffect::EggCrate($effect) => $result,
            AnyEffect::Hills($effect) => $result,
            AnyEffect::Drag($effect) => $result,
            AnyEffect::QuadraticDrag($effect) => $result,
            AnyEffect::Friction($effect) => $result,
            AnyEffect::Thrust($effect) => $result,
            AnyEffect::Torque($effect) => $result,
        }
    };
}

/// An effect acts on the sleigh of a body, so that it is compiled once for all bodies.
impl<B: SleighBody, const N: usize> Effect<B, N> for AnyEffect {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        each!(self, effect => effect.lagrangian(body.sleigh(), t, q, v))
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        each!(self, effect => effect.force(body.sleigh(), t, q, v))
    }
    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> lagrangian::EffectSlope<S, N> {
        each!(self, effect => Effect::<Sleigh, N>::slope(effect, body.sleigh(), t, q))
    }
    #[inline(always)]
    fn whole_force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        each!(self, effect => effect.whole_force(body.sleigh(), t, q, v))
    }
    #[inline(always)]
    fn has_force(&self) -> bool {
        each!(self, effect => Effect::<B, N>::has_force(effect))
    }
}

impl<B: SleighBody> PushInOwnAxes<B> for AnyEffect {
    fn in_own_axes(&self, body: &B) -> Option<OwnPush> {
        each!(self, effect => effect.in_own_axes(body))
    }
}

impl Piecewise for AnyEffect {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        each!(self, effect => effect.jumps(from, to))
    }
    fn piece(&self, t: f64) -> Self {
        match self {
            Self::Slope(effect) => Self::Slope(effect.piece(t)),
            Self::Bowl(effect) => Self::Bowl(effect.piece(t)),
            Self::EggCrate(effect) => Self::EggCrate(effect.piece(t)),
            Self::Hills(effect) => Self::Hills(effect.piece(t)),
            Self::Drag(effect) => Self::Drag(effect.piece(t)),
            Self::QuadraticDrag(effect) => Self::QuadraticDrag(effect.piece(t)),
            Self::Friction(effect) => Self::Friction(effect.piece(t)),
            Self::Thrust(effect) => Self::Thrust(effect.piece(t)),
            Self::Torque(effect) => Self::Torque(effect.piece(t)),
        }
    }
}

impl AnyEffect {
    /// Whether the effect belongs to the ground, on which every blade of a train runs.
    #[must_use]
    pub fn is_ground(&self) -> bool {
        matches!(self, Self::Slope(_) | Self::Bowl(_) | Self::EggCrate(_) | Self::Hills(_))
    }

    /// The name of the kind of an effect that feeds or drains energy; `None` for a potential.
    #[must_use]
    pub fn powered(&self) -> Option<&'static str> {
        match self {
            Self::Slope(_) | Self::Bowl(_) | Self::EggCrate(_) | Self::Hills(_) => None,
            Self::Drag(_) => Some("drag"),
            Self::QuadraticDrag(_) => Some("quadratic_drag"),
            Self::Friction(_) => Some("friction"),
            Self::Thrust(_) => Some("thrust"),
            Self::Torque(_) => Some("torque"),
        }
    }
}
