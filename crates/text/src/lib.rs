//! Systems from text: coordinates, a Lagrangian, constraints and forces, written as formulas.
//!
//! 1. [`Words`] are the texts of a system, as a file or a program has them.
//! 2. A [`TextModel`] is what they mean: checked, derived and put on tapes. A [`TextError`] says which text is wrong, in which column, and
//!    what is known there.
//! 3. A [`TextStart`] is the admissible state that is nearest to a given one.
//! 4. [`TextMechanics`] is the system from a start on. It has one of a few shapes, of which the smallest that has room is filled up: with
//!    coordinates of unit mass that rest, and with constraints that hold them. An evaluation costs no more for it. A system for which no
//!    shape has room keeps its own size, as the one element of an assembly.
//!
//! ```
//! use text::{TextModel, Unit, Words};
//!
//! let mut words = Words::default();
//! for (name, unit) in [("x", Unit::other("m")), ("y", Unit::other("m")), ("theta", Unit::Angle)] {
//!     words.coordinates.push((name.to_owned(), unit));
//! }
//! words.parameters.push(("m".to_owned(), 2.0));
//! words.lagrangian = "m/2*(x'^2 + y'^2) + theta'^2/2".to_owned();
//! words.constraints.push("y'*cos(theta) - x'*sin(theta)".to_owned());
//! let model = TextModel::new(&words)?;
//! let start = model.start(&[None; 3], &[Some(1.0), None, Some(0.5)])?;
//! assert_eq!(start.v, [1.0, 0.0, 0.5]);
//!
//! words.lagrangian.push_str(" - m*g*x");
//! let error = TextModel::new(&words).unwrap_err();
//! assert_eq!(error.column(), Some(36));
//! assert!(error.to_string().contains("no name `g` is known here"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod any;
mod element;
mod family;
mod functions;
mod geometry;
mod model;
mod multipliers;
mod reduced;
mod slices;
mod start;
mod start_along;
mod system;
mod tapes;
mod written;

pub use any::TextMechanics;
pub use expression::formulas::{Entry, Problem, TextError, Unit, Words};
pub use family::{FREE, Family, FamilySystem};
pub use functions::TextFunctions;
pub use geometry::Geometry;
pub use model::{Coordinate, TextModel};
pub use start::{Moved, StartError, TextStart};
pub use start_along::Varied;
pub use system::TextSystem;
pub use written::WrittenEquations;
