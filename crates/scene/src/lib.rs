//! Scene files: from TOML to validated data.
//!
//! A scene is a sleigh, the state it starts in, and how to run it. [`Scene::load`] reads a bundled scene or a file,
//! [`Scene::parse`] a text; both check every key and every number, so that what they return can be run as it is. What
//! is wrong with a file comes back as a [`SceneError`] that shows the line and says what is accepted there.
//!
//! ```
//! let scene = scene::Scene::load("turnaround", &["dla"])?;
//! assert_eq!(scene.run.steps(), 800);
//!
//! let text = scene::Scene::template().replace("mass = 1.0", "mass = -1.0");
//! let error = scene::Scene::parse(&text, "heavy.toml", &["dla"]).unwrap_err();
//! assert!(error.to_string().contains("heavy.toml:6:8"));
//! # Ok::<(), scene::SceneError>(())
//! ```

mod built;
mod bundled;
mod document;
mod draw;
mod effects;
mod error;
mod fault;
mod file;
mod finding;
mod keys;
mod opening;
mod points;
mod quantity;
mod reading;
mod run;
mod scene;
mod sections;
mod settings;
mod suggest;
mod sweep;
mod systems;
mod table;
mod text;
mod time;
mod variation;

pub use self::built::{Built, BuiltScene, QUANTITIES, Quantity, SleighQuantity, StartPlace, text_quantities};
pub use self::scene::Scene;
pub use self::text::{AnyScene, BuildError, Given, TextScene};
pub use ::text::{Coordinate, FREE, Family, Moved, TextMechanics, TextModel, Varied};
pub use bundled::{Bundled, SCHEMA, bundled, bundled_texts};
pub use effects::{EFFECTS, EffectInfo, SceneEffect, TrailersSpec};
pub use error::SceneError;
pub use file::{files_of, name_of_path, path_of};
pub use finding::{Place, SceneFinding};
pub use run::{DEFAULT_METHOD, MAX_STEPS, Overrides, RunSettings};
pub use settings::{Setting, with_settings};
pub use sleigh::effects::{AnyEffect, EffectList};
pub use suggest::nearest;
pub use sweep::{Sweep, SweepError};
pub use systems::{Column, EffectPower, PARAMETERS, Rotor, SceneSystem, SleighFamily, Started};
