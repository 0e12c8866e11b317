use crate::Function;

/// An expression of a [`Graph`](crate::Graph): a number for it, which means nothing in another graph.
///
/// Two expressions of a graph that are equal after simplification are the same number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Expression(pub(crate) u32);

impl Expression {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A number that can be compared and hashed: by its bits, with one zero and one `NaN`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Number(u64);

impl Number {
    pub(crate) const ZERO: Self = Self(0);

    pub(crate) fn new(x: f64) -> Self {
        // The sum takes the sign off zero.
        Self(if x.is_nan() { f64::NAN } else { x + 0.0 }.to_bits())
    }

    pub(crate) fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// What an expression is made of. Parts have smaller numbers than the whole.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum NodeKind {
    Constant(Number),
    Variable(u32),
    /// A constant and terms with their coefficients, by their numbers; no term is a constant, or a multiple of another.
    Sum {
        constant: Number,
        terms: Box<[(Expression, Number)]>,
    },
    /// Factors with exponents in halves, by their numbers: a root has the exponent one.
    Product(Box<[(Expression, i32)]>),
    /// A power whose exponent is no half of a whole number, or a large one.
    Power(Expression, Number),
    /// A function; of one argument, that stands in both places.
    Call(Function, [Expression; 2]),
}

impl NodeKind {
    pub(crate) const NOT_A_NUMBER: Self = Self::Constant(Number(f64::NAN.to_bits()));

    /// The expressions that it is made of.
    pub(crate) fn parts(&self) -> Parts<'_> {
        match self {
            Self::Constant(_) | Self::Variable(_) => Parts::Few([].iter()),
            Self::Sum { terms, .. } => Parts::Terms(terms.iter()),
            Self::Product(factors) => Parts::Factors(factors.iter()),
            Self::Power(base, _) => Parts::Few(std::slice::from_ref(base).iter()),
            Self::Call(function, arguments) => Parts::Few(arguments[..function.arguments()].iter()),
        }
    }

    /// This node with the numbers of its parts mapped by `to`.
    pub(crate) fn moved(&self, to: impl Fn(Expression) -> Expression) -> Self {
        match self {
            Self::Constant(_) | Self::Variable(_) => self.clone(),
            Self::Sum { constant, terms } => {
                Self::Sum { constant: *constant, terms: terms.iter().map(|&(e, c)| (to(e), c)).collect() }
            }
            Self::Product(factors) => Self::Product(factors.iter().map(|&(e, halves)| (to(e), halves)).collect()),
            Self::Power(base, p) => Self::Power(to(*base), *p),
            Self::Call(function, arguments) => Self::Call(*function, arguments.map(to)),
        }
    }

    /// How much of the limit it takes.
    pub(crate) fn size(&self) -> usize {
        1 + match self {
            Self::Sum { terms, .. } => terms.len(),
            Self::Product(factors) => factors.len(),
            _ => 0,
        }
    }
}

/// The parts of an expression one after another.
pub(crate) enum Parts<'a> {
    Few(std::slice::Iter<'a, Expression>),
    Terms(std::slice::Iter<'a, (Expression, Number)>),
    Factors(std::slice::Iter<'a, (Expression, i32)>),
}

impl Iterator for Parts<'_> {
    type Item = Expression;
    fn next(&mut self) -> Option<Expression> {
        match self {
            Self::Few(parts) => parts.next().copied(),
            Self::Terms(terms) => terms.next().map(|&(term, _)| term),
            Self::Factors(factors) => factors.next().map(|&(base, _)| base),
        }
    }
}
