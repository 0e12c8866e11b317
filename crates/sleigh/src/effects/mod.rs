//! What may act on a sleigh: each effect adds to the Lagrangian or to the forces, on the coordinates of the body.
//!
//! They compose as tuples or lists in [`lagrangian::With`], on any [`SleighBody`]. An [`AnyEffect`] is one of them.

mod brakes;
mod drives;
mod ground;
mod list;
mod moving_mass;

pub use brakes::{Drag, Friction, QuadraticDrag};
pub use drives::{Thrust, Torque};
pub use ground::{Bowl, EggCrate, Hill, Hills, Slope};
pub use list::EffectList;
pub use moving_mass::MovingMass;

use crate::series::{OwnPush, PushInOwnAxes};
use crate::{Sleigh, SleighBody};
use lagrangian::{Effect, EffectSlope, Piecewise, Scalar};
use serde::Serialize;

/// Makes [`AnyEffect`] of one row for each effect: its type, its name in files, and true of a potential of the ground.
macro_rules! effects {
    ($($effect:ident, $name:literal, $ground:literal;)+) => {
        /// An effect that acts on the existing coordinates as a potential or a force: one type for a list of effects.
        #[derive(Debug, Clone, PartialEq, Serialize)]
        #[serde(tag = "kind")]
        #[allow(missing_docs, reason = "each arm is the effect of its name")]
        pub enum AnyEffect {
            $(#[serde(rename = $name)] $effect($effect),)+
        }

        impl AnyEffect {
            /// The name of its kind.
            #[must_use]
            pub fn kind(&self) -> &'static str {
                match self { $(Self::$effect(_) => $name,)+ }
            }

            /// Whether the effect belongs to the ground, on which every blade of a train runs. Its power is not reported.
            #[must_use]
            pub fn is_ground(&self) -> bool {
                match self { $(Self::$effect(_) => $ground,)+ }
            }
        }

        $(impl From<$effect> for AnyEffect {
            fn from(effect: $effect) -> Self {
                Self::$effect(effect)
            }
        })+

        /// An effect acts on the sleigh of a body, so that it is compiled once for all bodies.
        impl<B: SleighBody, const N: usize> Effect<B, N> for AnyEffect {
            #[inline(always)]
            fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<S> {
                match self { $(Self::$effect(effect) => effect.lagrangian(body.sleigh(), t, q, v),)+ }
            }
            #[inline(always)]
            fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
                match self { $(Self::$effect(effect) => effect.force(body.sleigh(), t, q, v),)+ }
            }
            #[inline(always)]
            fn slope<S: Scalar>(&self, body: &B, t: S, q: &[S; N]) -> EffectSlope<S, N> {
                match self { $(Self::$effect(effect) => Effect::<Sleigh, N>::slope(effect, body.sleigh(), t, q),)+ }
            }
            #[inline(always)]
            fn whole_force<S: Scalar>(&self, body: &B, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
                match self { $(Self::$effect(effect) => effect.whole_force(body.sleigh(), t, q, v),)+ }
            }
            #[inline(always)]
            fn has_force(&self) -> bool {
                match self { $(Self::$effect(effect) => Effect::<B, N>::has_force(effect),)+ }
            }
        }

        impl PushInOwnAxes for AnyEffect {
            fn in_own_axes(&self, sleigh: &Sleigh) -> Option<OwnPush> {
                match self { $(Self::$effect(effect) => effect.in_own_axes(sleigh),)+ }
            }
        }

        impl Piecewise for AnyEffect {
            fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
                match self { $(Self::$effect(effect) => effect.jumps(from, to),)+ }
            }
            fn piece(&self, t: f64) -> Self {
                match self { $(Self::$effect(effect) => Self::$effect(effect.piece(t)),)+ }
            }
        }
    };
}

effects! {
    Slope, "slope", true;
    Bowl, "bowl", true;
    EggCrate, "egg_crate", true;
    Hills, "hills", true;
    Drag, "drag", false;
    QuadraticDrag, "quadratic_drag", false;
    Friction, "friction", false;
    Thrust, "thrust", false;
    Torque, "torque", false;
}

/// Effects that no jump cuts.
macro_rules! smooth {
    ($($effect:ty),+) => {
        $(impl Piecewise for $effect {
            fn piece(&self, _t: f64) -> Self {
                self.clone()
            }
        })+
    };
}
smooth!(Bowl, Drag, EggCrate, Friction, Hills, QuadraticDrag, Slope);
