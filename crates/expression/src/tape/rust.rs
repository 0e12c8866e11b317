use super::operation::{Instruction, Operation};
use super::program::Program;
use crate::{Error, Expression, Function, Graph};
use std::fmt::Write;

/// How tightly a piece of Rust binds: a sum, a product, a sign, or what stands before a method.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum Level {
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
        let program = Program::new(self, outputs)?;
        let (expected, found) = (program.inputs as usize, variables.len());
        if found < expected {
            return Err(Error::TooFew { what: "variables", expected, found });
        }
        let reads = program.reads();
        let mut places: Vec<(String, Level)> = vec![(String::new(), Level::Word); program.places as usize];
        for (place, variable) in places.iter_mut().zip(&variables[..expected]) {
            place.0 = (*variable).to_owned();
        }
        // What stands there twice has a name.
        let mut twice = vec![false; program.places as usize];
        for instruction in &program.instructions {
            if let Operation::Length { a } | Operation::Call { function: Function::Inverse, a, .. } =
                instruction.operation
            {
                twice[a as usize] = true;
            }
        }
        let (mut body, mut results, mut names) = (String::new(), Vec::new(), 0);
        for &Instruction { to, operation } in &program.instructions {
            let (text, level) = written(operation, &places, &program.constants);
            if let Operation::Output { .. } = operation {
                results.push(text);
                continue;
            }
            let both = if let Operation::SinCos { cos, .. } = operation { Some(cos) } else { None };
            if both.is_none() && !twice[to as usize] && reads[to as usize] == 1 && text.len() <= INLINE {
                places[to as usize] = (text, level);
                continue;
            }
            // A string takes what is written to it.
            let _ = writeln!(body, "let x{names} = {text};");
            places[to as usize] = (format!("x{names}{}", if both.is_some() { ".0" } else { "" }), Level::Word);
            if let Some(cos) = both {
                places[cos as usize] = (format!("x{names}.1"), Level::Word);
            }
            names += 1;
        }
        let _ = writeln!(body, "[{}]", results.join(", "));
        Ok(body)
    }
}

/// An operation in Rust, and how tightly it binds.
fn written(operation: Operation, places: &[(String, Level)], constants: &[f64]) -> (String, Level) {
    let at = |place: u32, least: Level| {
        let (text, level) = &places[place as usize];
        if *level < least { format!("({text})") } else { text.clone() }
    };
    let k = |k: u32| constants[k as usize];
    let method = |a: u32, call: &str| (format!("{}.{call}", at(a, Level::Word)), Level::Word);
    let (sum, product) = (|text| (text, Level::Sum), |text| (text, Level::Product));
    match operation {
        Operation::Constant { k: c } => (format!("S::constant({})", number(k(c))), Level::Word),
        Operation::Add { a, b } => sum(format!("{} + {}", at(a, Level::Sum), at(b, Level::Product))),
        Operation::Subtract { a, b } => sum(format!("{} - {}", at(a, Level::Sum), at(b, Level::Product))),
        Operation::Multiply { a, b } => product(format!("{} * {}", at(a, Level::Product), at(b, Level::Sign))),
        Operation::Divide { a, b } => product(format!("{} / {}", at(a, Level::Product), at(b, Level::Sign))),
        Operation::Negate { a } => (format!("-{}", at(a, Level::Word)), Level::Sign),
        Operation::Plus { a, k: c } if k(c) < 0.0 => sum(format!("{} - {}", at(a, Level::Sum), number(-k(c)))),
        Operation::Plus { a, k: c } => sum(format!("{} + {}", at(a, Level::Sum), number(k(c)))),
        Operation::From { a, k: c } if k(c) < 0.0 => sum(format!("-{} - {}", at(a, Level::Word), number(-k(c)))),
        Operation::From { a, k: c } => sum(format!("-{} + {}", at(a, Level::Word), number(k(c)))),
        Operation::Times { a, k: c } => product(format!("{} * {}", at(a, Level::Product), number(k(c)))),
        Operation::PlusTimes { a, b, k: c } => {
            let (sign, c) = if k(c) < 0.0 { ("-", -k(c)) } else { ("+", k(c)) };
            sum(format!("{} {sign} {} * {}", at(a, Level::Sum), at(b, Level::Product), number(c)))
        }
        Operation::PlusProduct { a, b, c } => {
            sum(format!("{} + {} * {}", at(c, Level::Sum), at(a, Level::Product), at(b, Level::Sign)))
        }
        Operation::MinusProduct { a, b, c } => {
            sum(format!("{} - {} * {}", at(c, Level::Sum), at(a, Level::Product), at(b, Level::Sign)))
        }
        Operation::Invert { a } => method(a, "recip()"),
        Operation::Square { a } => method(a, "squared()"),
        Operation::Length { a } => {
            let a = at(a, Level::Word);
            (format!("{a}.where_positive({a}.sqrt(), {a} * 0.0)"), Level::Word)
        }
        Operation::Whole { a, n } => method(a, &format!("powi({n})")),
        Operation::Real { a, k: c } => method(a, &format!("powf({})", number(k(c)))),
        Operation::SinCos { a, .. } => method(a, "sin_cos()"),
        Operation::Call { function, a, b } => {
            let name = if function == Function::Log { "ln" } else { function.name() };
            if function == Function::Inverse {
                let a = at(a, Level::Word);
                return (format!("{a}.abs().where_positive({a}.recip(), {a} * 0.0)"), Level::Word);
            }
            let second = if function.arguments() == 2 { at(b, Level::Sum) } else { String::new() };
            method(a, &format!("{name}({second})"))
        }
        Operation::Output { a } => (at(a, Level::Sum), Level::Sum),
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
