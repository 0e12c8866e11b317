//! Expressions as a list of operations.

mod cost;
mod operation;
mod pairs;
mod plan;
mod program;
mod registers;
mod rust;

pub use cost::Cost;

use crate::function::{flat_power, length};
use crate::{Error, Expression, Graph};
pub(crate) use operation::{Instruction, Operation};
pub(crate) use program::Program;
use scalar::Scalar;

/// A list of operations for some expressions, evaluated on any [`Scalar`]: on numbers, dual numbers, and numbers side by side.
///
/// What expressions have in common is computed once: equal parts, common factors of sums, pairs that several sums or products contain,
/// sine and cosine together. Places for results are used again as soon as they are free.
///
/// ```
/// use expression::{Graph, Names, Tape, parse};
/// let names = Names::of(["x", "y"])?;
/// let mut graph = Graph::new();
/// let variables = [0, 1].map(|k| graph.variable(k));
/// let e = graph.build(&parse("x^2*sin(y)", &names)?, &variables)?;
/// let mut outputs = vec![e];
/// outputs.extend(graph.gradient(e, &[0, 1]));
/// let tape = Tape::new(&graph, &outputs)?;
///
/// let (mut scratch, mut result) = (vec![0.0; tape.scratch()], [0.0; 3]);
/// tape.evaluate(&[3.0, 0.5], &mut scratch, &mut result)?;
/// assert_eq!(result, [9.0 * 0.5_f64.sin(), 6.0 * 0.5_f64.sin(), 9.0 * 0.5_f64.cos()]);
/// # Ok::<(), expression::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Tape {
    instructions: Box<[Instruction]>,
    constants: Box<[f64]>,
    inputs: usize,
    scratch: usize,
    outputs: usize,
}

impl Tape {
    /// The operations for these expressions.
    ///
    /// # Errors
    /// [`Error::GraphFull`] where the graph had no room for all that it was asked for.
    pub fn new(graph: &Graph, outputs: &[Expression]) -> Result<Self, Error> {
        Ok(registers::assigned(Program::new(graph, outputs)?, outputs.len()))
    }

    /// How many inputs are read: one more than the largest number of a variable.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// How many numbers an evaluation needs room for.
    #[must_use]
    pub fn scratch(&self) -> usize {
        self.scratch
    }

    /// How many expressions are computed.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Computes the expressions from the values of the variables, by their numbers. Nothing is allocated, and the scratch may hold
    /// anything.
    ///
    /// Inlined, so that a caller on numbers side by side, as `lagrangian::Lanes`, is compiled for vector registers
    /// (`lagrangian::vectorized`).
    ///
    /// # Errors
    /// [`Error::TooFew`] inputs, numbers of scratch, or outputs; more are left alone.
    #[inline(always)]
    pub fn evaluate<S: Scalar>(&self, inputs: &[S], scratch: &mut [S], outputs: &mut [S]) -> Result<(), Error> {
        if inputs.len() < self.inputs || scratch.len() < self.scratch || outputs.len() < self.outputs {
            return Err(self.too_few(inputs.len(), scratch.len(), outputs.len()));
        }
        self.evaluate_with(|k| inputs[k], scratch, |k, value| outputs[k] = value)
    }

    /// As [`evaluate`](Self::evaluate), for values that do not lie in a row: `input` gives the value of a variable by its number,
    /// `output` takes the value of an expression, each once, in any order.
    ///
    /// # Errors
    /// [`Error::TooFew`] numbers of scratch.
    #[inline(always)]
    pub fn evaluate_with<S: Scalar>(
        &self,
        input: impl Fn(usize) -> S,
        scratch: &mut [S],
        mut output: impl FnMut(usize, S),
    ) -> Result<(), Error> {
        let x = scratch;
        if x.len() < self.scratch {
            return Err(self.too_few(self.inputs, x.len(), self.outputs));
        }
        let x = &mut x[..self.scratch];
        for (k, place) in x[..self.inputs].iter_mut().enumerate() {
            *place = input(k);
        }
        let constants = &*self.constants;
        for &Instruction { to, operation } in &self.instructions {
            let value = match operation {
                Operation::Constant { k } => S::constant(constants[k as usize]),
                Operation::Add { a, b } => x[a as usize] + x[b as usize],
                Operation::Subtract { a, b } => x[a as usize] - x[b as usize],
                Operation::Multiply { a, b } => x[a as usize] * x[b as usize],
                Operation::Divide { a, b } => x[a as usize] / x[b as usize],
                Operation::Negate { a } => -x[a as usize],
                Operation::Invert { a } => x[a as usize].recip(),
                Operation::Plus { a, k } => x[a as usize] + constants[k as usize],
                Operation::From { a, k } => -x[a as usize] + constants[k as usize],
                Operation::Times { a, k } => x[a as usize] * constants[k as usize],
                Operation::PlusTimes { a, b, k } => x[a as usize] + x[b as usize] * constants[k as usize],
                Operation::PlusProduct { a, b, c } => x[c as usize] + x[a as usize] * x[b as usize],
                Operation::MinusProduct { a, b, c } => x[c as usize] - x[a as usize] * x[b as usize],
                Operation::Square { a } => x[a as usize].squared(),
                Operation::Length { a } => length(x[a as usize]),
                Operation::Whole { a, n } => x[a as usize].powi(n),
                Operation::Real { a, k } => x[a as usize].powf(constants[k as usize]),
                Operation::Flat { a, k } => flat_power(x[a as usize], constants[k as usize]),
                Operation::SinCos { a, cos } => {
                    let both = x[a as usize].sin_cos();
                    x[cos as usize] = both.1;
                    both.0
                }
                Operation::Call { function, a, b } => function.of(x[a as usize], x[b as usize]),
                Operation::Output { a } => {
                    output(to as usize, x[a as usize]);
                    continue;
                }
            };
            x[to as usize] = value;
        }
        Ok(())
    }

    #[cold]
    fn too_few(&self, inputs: usize, scratch: usize, outputs: usize) -> Error {
        let all = [("inputs", self.inputs, inputs), ("numbers of scratch", self.scratch, scratch)];
        let short = all.into_iter().find(|(_, expected, found)| found < expected);
        let (what, expected, found) = short.unwrap_or(("outputs", self.outputs, outputs));
        Error::TooFew { what, expected, found }
    }
}
