use super::operation::{Instruction, Operation};
use super::program::Program;
use crate::{Error, Expression, Function, Graph};
use std::fmt::Write;

/// How tightly a piece of Rust binds: a sum, a product, a sign, or what stands before a method.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum RustLevel {
    Sum,
    Product,
    Sign,
    Word,
}

/// A result that is used once stands in the text of who uses it, up to this length; any other has a name.
const INLINE: usize = 60;

impl Graph {
    /// The body of a Rust function that is generic in its scalar `S: Scalar`, and ends with the array of these expressions.
    /// `variables` say where the values of the variables are, by their numbers: `q[0]`.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["x", "y"])?;
    /// let mut graph = Graph::new();
    /// let variables = [0, 1].map(|k| graph.variable(k));
    /// let e = graph.build(&parse("2*sin(x*y) + x", &names)?, &variables)?;
    /// let slope = graph.derivative(e, 0);
    /// assert_eq!(
    ///     graph.rust(&[e, slope], &["q[0]", "q[1]"])?,
    ///     "let x0 = (q[0] * q[1]).sin_cos();\n[q[0] + x0.0 * 2.0, q[1] * x0.1 * 2.0 + 1.0]\n"
    /// );
    /// # Ok::<(), expression::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::TooFew`] variables, [`Error::GraphFull`].
    pub fn rust(&self, outputs: &[Expression], variables: &[&str]) -> Result<String, Error> {
        let (mut body, results) = self.rust_pieces(outputs, variables, variables.len())?;
        let _ = writeln!(body, "[{}]", results.join(", "));
        Ok(body)
    }

    /// The statements of such a body, and behind them a piece of Rust for each of the expressions. The variables from `first_number` on
    /// are numbers: plain `f64`, as are all parts that depend on them alone.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["x", "m"])?;
    /// let mut graph = Graph::new();
    /// let variables = [0, 1].map(|k| graph.variable(k));
    /// let e = graph.build(&parse("sqrt(m)*x^2", &names)?, &variables)?;
    /// let (statements, results) = graph.rust_pieces(&[e, variables[1]], &["q[0]", "self.m"], 1)?;
    /// assert_eq!(statements, "");
    /// assert_eq!(results, ["q[0].squared() * self.m.sqrt()", "S::constant(self.m)"]);
    /// # Ok::<(), expression::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`rust`](Self::rust).
    pub fn rust_pieces(
        &self,
        outputs: &[Expression],
        variables: &[&str],
        first_number: usize,
    ) -> Result<(String, Vec<String>), Error> {
        let program = Program::new(self, outputs)?;
        let (expected, found) = (program.inputs as usize, variables.len());
        if found < expected {
            return Err(Error::TooFew { what: "variables", expected, found });
        }
        let reads = program.reads();
        let mut places = vec![RustPiece::word(String::new(), false); program.places as usize];
        for (k, (place, variable)) in places.iter_mut().zip(&variables[..expected]).enumerate() {
            *place = RustPiece::word((*variable).to_owned(), k >= first_number);
        }
        // What stands there twice has a name.
        let mut twice = vec![false; program.places as usize];
        for instruction in &program.instructions {
            if let Operation::Length { a }
            | Operation::Flat { a, .. }
            | Operation::Call { function: Function::Inverse, a, .. } = instruction.operation
            {
                twice[a as usize] = true;
            }
        }
        let (mut body, mut results, mut names) = (String::new(), Vec::new(), 0);
        for &Instruction { to, operation } in &program.instructions {
            let piece = written(operation, &places, &program.constants);
            if let Operation::Output { .. } = operation {
                results.push(piece.scalar(RustLevel::Sum));
                continue;
            }
            let both = if let Operation::SinCos { cos, .. } = operation { Some(cos) } else { None };
            if both.is_none() && !twice[to as usize] && reads[to as usize] == 1 && piece.text.len() <= INLINE {
                places[to as usize] = piece;
                continue;
            }
            // A string takes what is written to it.
            let _ = writeln!(body, "let x{names} = {};", piece.text);
            let named = |part: &str| RustPiece::word(format!("x{names}{part}"), piece.number);
            places[to as usize] = named(if both.is_some() { ".0" } else { "" });
            if let Some(cos) = both {
                places[cos as usize] = named(".1");
            }
            names += 1;
        }
        Ok((body, results))
    }
}

/// A piece of Rust.
#[derive(Debug, Clone)]
struct RustPiece {
    text: String,
    level: RustLevel,
    /// Whether it is a plain `f64`.
    number: bool,
}

impl RustPiece {
    fn word(text: String, number: bool) -> Self {
        Self { text, level: RustLevel::Word, number }
    }

    /// The text, in parentheses if it binds less tightly than `least`.
    fn at(&self, least: RustLevel) -> String {
        if self.level < least { format!("({})", self.text) } else { self.text.clone() }
    }

    /// The text as a scalar of type `S`.
    fn scalar(&self, least: RustLevel) -> String {
        if self.number { format!("S::constant({})", self.text) } else { self.at(least) }
    }
}

/// An operation in Rust.
///
/// The scalar stands first in an operation on a scalar and a number. A constant of the program is a plain number only if all other operands
/// are plain numbers.
fn written(operation: Operation, places: &[RustPiece], constants: &[f64]) -> RustPiece {
    let of = |place: u32| &places[place as usize];
    let k = |k: u32| number(constants[k as usize]);
    let negative = |k: u32| constants[k as usize] < 0.0;
    let opposite = |k: u32| number(-constants[k as usize]);
    let piece = |text: String, level: RustLevel, number: bool| RustPiece { text, level, number };
    let method =
        |a: &RustPiece, call: &str| piece(format!("{}.{call}", a.at(RustLevel::Word)), RustLevel::Word, a.number);
    // `a + b`, `a - b`, `a * b`.
    let plus = |a: &RustPiece, b: &RustPiece| {
        let (a, b) = if a.number && !b.number { (b, a) } else { (a, b) };
        piece(format!("{} + {}", a.at(RustLevel::Sum), b.at(RustLevel::Product)), RustLevel::Sum, a.number)
    };
    let minus = |a: &RustPiece, b: &RustPiece| {
        if a.number && !b.number {
            piece(format!("-{} + {}", b.at(RustLevel::Word), a.at(RustLevel::Product)), RustLevel::Sum, false)
        } else {
            piece(format!("{} - {}", a.at(RustLevel::Sum), b.at(RustLevel::Product)), RustLevel::Sum, a.number)
        }
    };
    let times = |a: &RustPiece, b: &RustPiece| {
        let (a, b) = if a.number && !b.number { (b, a) } else { (a, b) };
        piece(format!("{} * {}", a.at(RustLevel::Product), b.at(RustLevel::Sign)), RustLevel::Product, a.number)
    };
    match operation {
        Operation::Constant { k: c } => piece(k(c), if negative(c) { RustLevel::Sign } else { RustLevel::Word }, true),
        Operation::Add { a, b } => plus(of(a), of(b)),
        Operation::Subtract { a, b } => minus(of(a), of(b)),
        Operation::Multiply { a, b } => times(of(a), of(b)),
        Operation::Divide { a, b } => {
            let (a, b) = (of(a), of(b));
            if a.number && !b.number {
                times(&method(b, "recip()"), a)
            } else {
                piece(format!("{} / {}", a.at(RustLevel::Product), b.at(RustLevel::Sign)), RustLevel::Product, a.number)
            }
        }
        Operation::Negate { a } => piece(format!("-{}", of(a).at(RustLevel::Word)), RustLevel::Sign, of(a).number),
        Operation::Plus { a, k: c } => {
            let (sign, c) = if negative(c) { ("-", opposite(c)) } else { ("+", k(c)) };
            piece(format!("{} {sign} {c}", of(a).at(RustLevel::Sum)), RustLevel::Sum, of(a).number)
        }
        Operation::From { a, k: c } => {
            let (sign, c) = if negative(c) { ("-", opposite(c)) } else { ("+", k(c)) };
            piece(format!("-{} {sign} {c}", of(a).at(RustLevel::Word)), RustLevel::Sum, of(a).number)
        }
        Operation::Times { a, k: c } => {
            piece(format!("{} * {}", of(a).at(RustLevel::Product), k(c)), RustLevel::Product, of(a).number)
        }
        Operation::PlusTimes { a, b, k: c } => {
            let scaled =
                |c: String| piece(format!("{} * {c}", of(b).at(RustLevel::Product)), RustLevel::Product, of(b).number);
            if negative(c) { minus(of(a), &scaled(opposite(c))) } else { plus(of(a), &scaled(k(c))) }
        }
        Operation::PlusProduct { a, b, c } => plus(of(c), &times(of(a), of(b))),
        Operation::MinusProduct { a, b, c } => minus(of(c), &times(of(a), of(b))),
        Operation::Invert { a } => method(of(a), "recip()"),
        Operation::Square { a } => method(of(a), "squared()"),
        Operation::Length { a } => {
            let (text, a) = (of(a).at(RustLevel::Word), of(a));
            method(a, &format!("where_positive({text}.sqrt(), {text} * 0.0)"))
        }
        Operation::Whole { a, n } => method(of(a), &format!("powi({n})")),
        Operation::Real { a, k: c } => method(of(a), &format!("powf({})", k(c))),
        Operation::Flat { a, k: c } => {
            let (text, a) = (of(a).at(RustLevel::Word), of(a));
            let power = if k(c) == "0.5" { "sqrt()".to_owned() } else { format!("powf({})", k(c)) };
            method(&method(a, "abs()"), &format!("where_positive({text}.{power}, {text} * 0.0)"))
        }
        Operation::SinCos { a, .. } => method(of(a), "sin_cos()"),
        Operation::Call { function, a, b } => {
            let name = if function == Function::Log { "ln" } else { function.name() };
            let a = of(a);
            if function == Function::Inverse {
                let text = a.at(RustLevel::Word);
                return method(&method(a, "abs()"), &format!("where_positive({text}.recip(), {text} * 0.0)"));
            }
            if function.arguments() < 2 {
                return method(a, &format!("{name}()"));
            }
            let b = of(b);
            if matches!(function, Function::Where | Function::Unless) {
                let (zero, chosen) = ("S::zero()".to_owned(), b.scalar(RustLevel::Sum));
                let both = if function == Function::Where { [chosen, zero] } else { [zero, chosen] };
                let call = format!("{}.where_positive({})", a.scalar(RustLevel::Word), both.join(", "));
                return piece(call, RustLevel::Word, false);
            }
            if a.number && b.number {
                // Of two constants and numbers the first may be a literal, which has no methods.
                let call = format!("Scalar::{name}({}, {})", a.at(RustLevel::Sum), b.at(RustLevel::Sum));
                return piece(call, RustLevel::Word, true);
            }
            let first = RustPiece {
                text: a.scalar(RustLevel::Sum),
                level: if a.number { RustLevel::Word } else { a.level },
                number: false,
            };
            method(&first, &format!("{name}({})", b.scalar(RustLevel::Sum)))
        }
        Operation::Output { a } => of(a).clone(),
    }
}

fn number(x: f64) -> String {
    if x.is_nan() {
        "f64::NAN".to_owned()
    } else if x.is_infinite() {
        if x > 0.0 { "f64::INFINITY" } else { "f64::NEG_INFINITY" }.to_owned()
    } else {
        format!("{x:?}")
    }
}
