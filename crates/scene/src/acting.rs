use crate::SceneEffect;
use lagrangian::{Effect, Piecewise, Scalar};
use sleigh::effects::{Bowl, Drag, EggCrate, Hills, MovingMass, Slope, Thrust, Torque};
use sleigh::{Sleigh, SleighBody, SleighError};

/// An effect of a scene that acts on the coordinates there are: one type for a list of them.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "each arm is the effect of its name")]
pub enum Acting {
    Slope(Slope),
    Bowl(Bowl),
    EggCrate(EggCrate),
    Hills(Hills),
    Drag(Drag),
    Thrust(Thrust),
    Torque(Torque),
    MovingMass(MovingMass),
}

/// The same text for whichever effect it is.
macro_rules! each {
    ($self:ident, $effect:ident => $result:expr) => {
        match $self {
            Acting::Slope($effect) => $result,
            Acting::Bowl($effect) => $result,
            Acting::EggCrate($effect) => $result,
            Acting::Hills($effect) => $result,
            Acting::Drag($effect) => $result,
            Acting::Thrust($effect) => $result,
            Acting::Torque($effect) => $result,
            Acting::MovingMass($effect) => $result,
        }
    };
}

/// On whichever body, an effect acts on the sleigh that it is: so that of every one there is but one to compile.
impl<B: SleighBody, const N: usize> Effect<B, N> for Acting {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        self.lagrangian_on(body.sleigh(), t, q, v)
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.force_on(body.sleigh(), t, q, v)
    }
    #[inline(always)]
    fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> lagrangian::Slope<S, N> {
        self.slope_on(body.sleigh(), t, q)
    }
    #[inline(always)]
    fn whole_force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.whole_force_on(body.sleigh(), t, q, v)
    }
    #[inline(always)]
    fn in_own_axes(&self, body: &B) -> Option<lagrangian::OwnPush> {
        each!(self, effect => Effect::<B, N>::in_own_axes(effect, body))
    }
}

impl Acting {
    #[inline(always)]
    fn lagrangian_on<S: Scalar, const N: usize>(&self, sleigh: &Sleigh, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
        S::apart(
            #[inline(always)]
            || each!(self, effect => effect.lagrangian(sleigh, t, q, v)),
        )
    }
    #[inline(always)]
    fn force_on<S: Scalar, const N: usize>(&self, sleigh: &Sleigh, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        S::apart(
            #[inline(always)]
            || each!(self, effect => effect.force(sleigh, t, q, v)),
        )
    }
    #[inline(always)]
    fn slope_on<S: Scalar, const N: usize>(&self, sleigh: &Sleigh, t: S, q: &[S; N]) -> lagrangian::Slope<S, N> {
        S::apart(
            #[inline(always)]
            || each!(self, effect => Effect::<Sleigh, N>::slope(effect, sleigh, t, q)),
        )
    }
    #[inline(always)]
    fn whole_force_on<S: Scalar, const N: usize>(
        &self,
        sleigh: &Sleigh,
        t: S,
        q: &[S; N],
        v: &[S; N],
    ) -> Option<[S; N]> {
        S::apart(
            #[inline(always)]
            || each!(self, effect => effect.whole_force(sleigh, t, q, v)),
        )
    }
}

impl Piecewise for Acting {
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
            Self::Thrust(effect) => Self::Thrust(effect.piece(t)),
            Self::Torque(effect) => Self::Torque(effect.piece(t)),
            Self::MovingMass(effect) => Self::MovingMass(effect.piece(t)),
        }
    }
}

impl Acting {
    /// Of an effect that acts on the coordinates there are; `None` of one that makes another body.
    pub(crate) fn of(effect: &SceneEffect) -> Result<Option<Self>, SleighError> {
        Ok(Some(match effect {
            SceneEffect::Slope { gravity } => Self::Slope(Slope::new(*gravity)?),
            SceneEffect::Bowl { stiffness, center } => Self::Bowl(Bowl::new(*stiffness, *center)?),
            SceneEffect::EggCrate { height, wave_number } => Self::EggCrate(EggCrate::new(*height, *wave_number)?),
            SceneEffect::Hills { hills } => Self::Hills(Hills::new(hills.iter().copied().map(Into::into).collect())?),
            SceneEffect::Drag { along, turning } => Self::Drag(Drag::new(*along, *turning)?),
            SceneEffect::Thrust { force } => Self::Thrust(Thrust::new(force.build()?)?),
            SceneEffect::Torque { torque } => Self::Torque(Torque::new(torque.build()?)?),
            SceneEffect::MovingMass { mass, x, y } => Self::MovingMass(MovingMass::new(*mass, x.build()?, y.build()?)?),
            SceneEffect::Trailers(_)
            | SceneEffect::Flywheel { .. }
            | SceneEffect::Servo { .. }
            | SceneEffect::Tracer { .. }
            | SceneEffect::Turntable { .. } => return Ok(None),
        }))
    }

    /// Whether it belongs to the ground, which every blade of a train runs on.
    pub(crate) fn is_ground(&self) -> bool {
        matches!(self, Self::Slope(_) | Self::Bowl(_) | Self::EggCrate(_) | Self::Hills(_))
    }

    /// The name of its kind, where it feeds or drains the energy; `None` for a potential.
    #[must_use]
    pub fn powered(&self) -> Option<&'static str> {
        match self {
            Self::Slope(_) | Self::Bowl(_) | Self::EggCrate(_) | Self::Hills(_) => None,
            Self::Drag(_) => Some("drag"),
            Self::Thrust(_) => Some("thrust"),
            Self::Torque(_) => Some("torque"),
            Self::MovingMass(_) => Some("moving_mass"),
        }
    }
}
