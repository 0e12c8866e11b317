use crate::function::power;
use crate::{Error, Function};
use scalar::Scalar;

/// A parsed text with resolved names: numbers, names and operations, with operands before their operation.
///
/// Steps form a list and not a tree, so no function on them recurs, however deep the text is.
#[derive(Debug, Clone, PartialEq)]
pub struct Syntax {
    pub(crate) steps: Vec<SyntaxStep>,
}

/// A number, a name or an operation, and its column in the text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SyntaxStep {
    pub(crate) column: usize,
    pub(crate) action: Action,
}

/// What a step does with the operands before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Action {
    Number(f64),
    /// By its position in the table.
    Name(usize),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Call(Function),
    /// The first less the multiples of the second that are in it.
    Modulo,
    /// The second of three where the first is positive, else the third; the other way round if `turned`.
    Choose {
        turned: bool,
    },
}

impl Action {
    /// How many operands it takes.
    pub(crate) fn operands(self) -> usize {
        match self {
            Self::Number(_) | Self::Name(_) => 0,
            Self::Negate => 1,
            Self::Call(function) => function.arguments(),
            Self::Choose { .. } => 3,
            _ => 2,
        }
    }
}

/// A number, and again without derivatives where no name stands in it: exponents are told from that.
#[derive(Debug, Clone, Copy)]
struct Operand<S> {
    value: S,
    constant: Option<f64>,
}

impl Syntax {
    /// Evaluates the text in its own order of operations, without simplification. `values` has one value for each name, by its position.
    ///
    /// Tests compare every other evaluation with this one; it allocates. `a^b` is a product or a root if `b` is a constant of the text,
    /// else `exp(b log(a))`, which is NaN for negative `a`.
    ///
    /// # Errors
    /// [`Error::TooFew`] values.
    pub fn evaluate<S: Scalar>(&self, values: &[S]) -> Result<S, Error> {
        let mut stack: Vec<Operand<S>> = Vec::new();
        for step in &self.steps {
            let pushed = match step.action {
                Action::Number(x) => Operand { value: S::constant(x), constant: Some(x) },
                Action::Name(k) => {
                    let value = *values.get(k).ok_or_else(|| too_few(k + 1, values.len()))?;
                    Operand { value, constant: None }
                }
                Action::Choose { turned } => {
                    let lost = Operand { value: S::constant(f64::NAN), constant: None };
                    let [otherwise, then, condition] = [(); 3].map(|()| stack.pop().unwrap_or(lost));
                    let [then, otherwise] = if turned { [otherwise, then] } else { [then, otherwise] };
                    let known = condition.constant.map(|x| if x > 0.0 { then.constant } else { otherwise.constant });
                    let value = condition.value.where_positive(then.value, otherwise.value);
                    Operand { value, constant: known.flatten() }
                }
                action => {
                    let b = if action.operands() == 2 { stack.pop() } else { None };
                    let a = stack.pop().unwrap_or(Operand { value: S::constant(f64::NAN), constant: None });
                    let b = b.unwrap_or(a);
                    let constant = a.constant.zip(b.constant).map(|(a, b)| applied(action, a, b, Some(b)));
                    Operand { value: applied(action, a.value, b.value, b.constant), constant }
                }
            };
            stack.push(pushed);
        }
        Ok(stack.pop().map_or(S::constant(f64::NAN), |last| last.value))
    }

    /// The positions of the names that occur, in order.
    #[must_use]
    pub fn names(&self) -> Vec<usize> {
        let name = |step: &SyntaxStep| if let Action::Name(k) = step.action { Some(k) } else { None };
        let mut names: Vec<usize> = self.steps.iter().filter_map(name).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// The first function that jumps, as `sign` or `if`: its column.
    #[must_use]
    pub fn first_jump(&self) -> Option<usize> {
        let jumps = |step: &&SyntaxStep| {
            matches!(
                step.action,
                Action::Call(Function::Sign | Function::Floor | Function::Where | Function::Unless)
                    | Action::Choose { .. }
                    | Action::Modulo
            )
        };
        self.steps.iter().filter(jumps).map(|step| step.column).min()
    }
}

pub(crate) fn too_few(expected: usize, found: usize) -> Error {
    Error::TooFew { what: "values", expected, found }
}

fn applied<S: Scalar>(action: Action, a: S, b: S, constant: Option<f64>) -> S {
    match action {
        Action::Number(_) | Action::Name(_) | Action::Choose { .. } => a,
        Action::Negate => -a,
        Action::Add => a + b,
        Action::Subtract => a - b,
        Action::Multiply => a * b,
        Action::Divide => a / b,
        Action::Power => match constant {
            Some(b) => power(a, b),
            None => (b * a.ln()).exp(),
        },
        Action::Modulo => a - b * Function::Floor.of(a / b, b),
        Action::Call(function) => function.of(a, b),
    }
}
