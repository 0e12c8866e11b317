use super::Tape;
use super::operation::Operation;
use crate::Function;

/// How many operations of each kind an evaluation takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Sums, differences and changes of sign.
    pub sums: usize,
    /// Products and squares.
    pub products: usize,
    /// Quotients.
    pub quotients: usize,
    /// Square roots.
    pub roots: usize,
    /// Powers that are neither products nor roots.
    pub powers: usize,
    /// Sines, cosines, tangents and their inverses; a sine with its cosine is one.
    pub angles: usize,
    /// Exponentials, logarithms and hyperbolic functions.
    pub exponentials: usize,
    /// `abs`, `sign`, `min`, `max`, and choices.
    pub choices: usize,
}

impl Cost {
    /// All operations.
    #[must_use]
    pub fn total(&self) -> usize {
        let &Self { sums, products, quotients, roots, powers, angles, exponentials, choices } = self;
        sums + products + quotients + roots + powers + angles + exponentials + choices
    }
}

impl Tape {
    /// What an evaluation takes.
    #[must_use]
    pub fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        for instruction in &self.instructions {
            let place = match instruction.operation {
                Operation::Constant { .. } | Operation::Output { .. } => continue,
                Operation::PlusTimes { .. } | Operation::PlusProduct { .. } | Operation::MinusProduct { .. } => {
                    cost.products += 1;
                    &mut cost.sums
                }
                Operation::Add { .. }
                | Operation::Subtract { .. }
                | Operation::Negate { .. }
                | Operation::Plus { .. }
                | Operation::From { .. } => &mut cost.sums,
                Operation::Multiply { .. } | Operation::Times { .. } | Operation::Square { .. } => &mut cost.products,
                Operation::Divide { .. } | Operation::Invert { .. } => &mut cost.quotients,
                Operation::Length { .. } => &mut cost.roots,
                Operation::Whole { .. } | Operation::Real { .. } | Operation::Flat { .. } => &mut cost.powers,
                Operation::SinCos { .. } => &mut cost.angles,
                Operation::Call { function, .. } => match function {
                    Function::Sqrt => &mut cost.roots,
                    Function::Inverse => &mut cost.quotients,
                    Function::Exp | Function::Log | Function::Sinh | Function::Cosh | Function::Tanh => {
                        &mut cost.exponentials
                    }
                    Function::Abs
                    | Function::Sign
                    | Function::Floor
                    | Function::Where
                    | Function::Unless
                    | Function::Min
                    | Function::Max => &mut cost.choices,
                    _ => &mut cost.angles,
                },
            };
            *place += 1;
        }
        cost
    }
}
