//! The systems of scenes: a sleigh with what guides it, its rotor and its effects, or a train, as objects whose sizes are known at run time.
//!
//! They are compiled here, once, so that a user of a scene has an object to ask, and compiles no system.

mod columns;
mod family;
mod of_scene;
mod power;
mod scene_system;
mod train;

pub use columns::Column;
pub use family::{PARAMETERS, SleighFamily};
pub use power::EffectPower;
pub(crate) use scene_system::{Guiding, system};
pub use scene_system::{Rotor, SceneSystem, Started};
