//! Expressions from text: parsed, simplified, differentiated, and evaluated on any scalar or printed as Rust.
//!
//! Mechanics is known to the module [`formulas`] alone, which says what the texts of a system mean. Elsewhere a name is a position in a table, and what it means is said by who asks: a variable, a constant, or the
//! expression that it abbreviates.
//!
//! 1. [`parse`] reads a text, with the [`Names`] that it may use, within [`Limits`]. An [`Error`] says which column is wrong, and what
//!    would be right there.
//! 2. A [`Graph`] holds expressions, each of them once, simplified as they are made; it [derives](Graph::derivative) them,
//!    [replaces](Graph::substitute) variables, and writes them as [text](Graph::text) or as [Rust](Graph::rust).
//! 3. A [`Tape`] is a list of operations for some of them, evaluated on any [`Scalar`](scalar::Scalar), and counted as a [`Cost`]; on a
//!    [`Series`] for derivatives of high order. [`Recurrences`] give the Taylor series of the solutions of differential equations.
//! 4. [`Corners`] are the times at which they are not smooth.
//!
//! ```
//! use expression::{Graph, Names, Tape, parse};
//!
//! // A skate on a slope: coordinates, rates, and a parameter that is a number.
//! let mut names = Names::of(["x", "y", "theta", "x'", "y'", "theta'", "m"])?;
//! let mut graph = Graph::new();
//! let mut meanings: Vec<_> = (0..6).map(|k| graph.variable(k)).collect();
//! meanings.push(graph.constant(2.0));
//!
//! // An abbreviation is an expression under a name.
//! let speed = graph.build(&parse("x'^2 + y_dot^2", &names)?, &meanings)?;
//! names.add("v2")?;
//! meanings.push(speed);
//!
//! let lagrangian = parse("m/2*v2 + 0.25*theta'^2 - m*9.81*sin(0.1)*x", &names)?;
//! let lagrangian = graph.build(&lagrangian, &meanings)?;
//! let momenta = graph.gradient(lagrangian, &[3, 4, 5]);
//! assert_eq!(graph.text(momenta[0], &names)?, "2*x'");
//! assert_eq!(graph.hessian(lagrangian, &[3], &[3])[0][0], meanings[6]);
//!
//! let tape = Tape::new(&graph, &momenta)?;
//! let (mut scratch, mut result) = (vec![0.0; tape.scratch()], [0.0; 3]);
//! tape.evaluate(&[0.0, 0.0, 0.0, 1.0, 2.0, 3.0], &mut scratch, &mut result)?;
//! assert_eq!((result, tape.cost().total()), ([2.0, 4.0, 1.5], 3));
//!
//! let error = parse("m/2*(x'^2 + y'^2) + thetta", &names).unwrap_err();
//! assert_eq!(error.to_string(), "no name `thetta` is known here (column 21); did you mean `theta`?");
//! # Ok::<(), expression::Error>(())
//! ```
//!
//! # What a text may say
//! Numbers (`1`, `.5`, `1.5e-3`), names (letters of any alphabet, digits, `_`; with a prime for a rate, `x'`, or `x_dot`), `+ - * /`, powers
//! with `^` or `**`, parentheses, `pi`, and the [functions](Function): `sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt abs sign
//! inverse min max`, `hypot`, `step(x)` (0 below zero, 1 above) and `if(x < 1, a, b)`. A power with an exponent that is no constant is `exp(b log(a))`, and so no number where the base is negative.

mod corners;
mod error;
pub mod formulas;
mod function;
mod graph;
mod interval;
mod named;
mod names;
mod parser;
mod recurrences;
mod series;
mod symbol;
mod syntax;
mod tape;
mod tokens;

pub use corners::Corners;
pub use error::Error;
pub use function::Function;
pub use graph::{Expression, Graph, Statements, Turned};
pub use names::{Names, nearest};
pub use parser::{Limits, parse, parse_equation, parse_within};
pub use recurrences::{Expansion, MOST_ORDERS, Recurrences};
pub use series::Series;
pub use symbol::{Symbol, trace};
pub use syntax::Syntax;
pub use tape::{Cost, Tape};
