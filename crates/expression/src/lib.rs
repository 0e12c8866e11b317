//! Expressions from text, knowing no mechanics.
mod error;
mod function;
mod graph;
mod limits;
mod names;
mod parser;
mod syntax;
mod tape;
mod tokens;
pub use error::Error;
pub use function::Function;
pub use graph::{Expression, Graph};
pub use limits::Limits;
pub use names::{Names, nearest};
pub use parser::{parse, parse_within};
pub use syntax::Syntax;
pub use tape::{Cost, Tape};
