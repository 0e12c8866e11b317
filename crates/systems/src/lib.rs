//! The systems of scenes: a sleigh with what guides it, its rotor and its effects, as objects whose sizes are known at run time.
//!
//! They are compiled here, once, so that whoever has a scene has an object to ask, and compiles no system.
//!
//! ```
//! use sleigh::{Sleigh, SleighState, effects::Bowl};
//! use systems::{AnyEffect, Guiding, system};
//!
//! let sleigh = Sleigh::new(1.0, 1.0, 0.5)?;
//! let bowl = AnyEffect::Bowl(Bowl::new([0.1, 0.1], [0.0, 0.0])?);
//! let start = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: -1.0, turn_rate: 0.1 };
//! let started = system(Guiding::None(sleigh), None, vec![bowl], &start)?;
//! assert_eq!(started.v, [-1.0, 0.0, 0.1]);
//! # Ok::<(), sleigh::SleighError>(())
//! ```

mod any_effect;
mod columns;
mod effect_list;
mod family;
mod power;
mod system;
mod train;

pub use any_effect::AnyEffect;
pub use columns::Column;
pub use effect_list::EffectList;
pub use family::{PARAMETERS, SleighFamily};
pub use power::EffectPower;
pub use system::{Guiding, Rotor, SceneSystem, Started, system};
pub use train::train;
