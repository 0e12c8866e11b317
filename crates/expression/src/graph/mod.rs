//! Expressions that share what they have in common.

mod build;
mod call;
mod derivative;
mod expand;
mod kind;
mod product;
mod sum;
mod text;
mod turns;
mod walk;

pub use kind::Expression;
pub(crate) use kind::{NodeKind, Number};
pub use text::Statements;
pub use turns::Turned;

use crate::{Error, Function, Limits};
use indexmap::IndexSet;
use std::collections::HashMap;

/// Lists longer than this are not searched, and not opened within others: so that no text takes the square of its length.
pub(crate) const LONG: usize = 32;

/// Expressions, each of them once, simplified as they are made.
///
/// Sums and products are lists in the order in which their parts were made, so that `a + (b + c)` and `(c + a) + b` are one expression;
/// constants are folded, equal terms and factors gathered, signs brought outward, `sin(u)^2 + cos(u)^2` is 1. Products are not multiplied
/// out. Where an expression has a value as it was written, the simplified one has that value too, but for round-off; it may have a value
/// in more places (`x/x` is 1, at zero too). The same calls in the same order make the same graph, to the last bit.
///
/// ```
/// use expression::Graph;
/// let mut graph = Graph::new();
/// let [x, y] = [0, 1].map(|k| graph.variable(k));
/// let (a, b) = (graph.sum(&[x, y]), graph.sum(&[y, x]));
/// assert_eq!(a, b);
/// let square = graph.product(&[x, x]);
/// let two = graph.constant(2.0);
/// assert_eq!(square, graph.power(x, 2.0));
/// assert_eq!(graph.derivative(square, 0), graph.product(&[two, x]));
/// ```
///
/// An expression of another graph means some other expression in this one, or `NaN`.
#[derive(Debug, Clone)]
pub struct Graph {
    kinds: IndexSet<NodeKind>,
    /// The variables of each, folded into the bits that there are, and whether it has [corners](CORNER): none where the bit is not set.
    variables: Vec<u64>,
    derivatives: HashMap<(Expression, u32), Expression>,
    size: usize,
    limit: usize,
    full: bool,
    limits: Limits,
}

impl Default for Graph {
    fn default() -> Self {
        Self::new()
    }
}

impl Graph {
    /// The terms and factors that a graph may have where nothing else is said.
    pub const LIMIT: usize = 1 << 22;

    /// A graph without expressions.
    #[must_use]
    pub fn new() -> Self {
        Self::with_limit(Self::LIMIT)
    }

    /// A graph with at most `limit` terms and factors, in all expressions and their derivatives together. An expression beyond the limit
    /// is `NaN`, and [`check`](Self::check) then fails.
    #[must_use]
    pub fn with_limit(limit: usize) -> Self {
        Self {
            kinds: IndexSet::new(),
            variables: Vec::new(),
            derivatives: HashMap::new(),
            size: 0,
            limit: limit.min(u32::MAX as usize >> 1),
            full: false,
            limits: Limits::default(),
        }
    }

    /// The same graph with room for at most `more` further terms and factors, within its old limit.
    #[must_use]
    pub fn with_room(mut self, more: usize) -> Self {
        self.limit = self.limit.min(self.size.saturating_add(more));
        self
    }

    /// Checks that every expression had room.
    ///
    /// # Errors
    /// [`Error::GraphFull`].
    pub fn check(&self) -> Result<(), Error> {
        if self.full { Err(Error::GraphFull { limit: self.limit }) } else { Ok(()) }
    }

    /// Changes the limit to `limit` terms and factors in all.
    pub fn set_limit(&mut self, limit: usize) {
        self.limit = limit.min(u32::MAX as usize >> 1);
    }

    /// How many expressions there are, with all their parts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// A constant.
    pub fn constant(&mut self, x: f64) -> Expression {
        self.intern(NodeKind::Constant(Number::new(x)))
    }

    /// The variable number `k`: the tape takes its value from place `k`. A number beyond [`LIMIT`](Self::LIMIT) has no room.
    pub fn variable(&mut self, k: u32) -> Expression {
        if k as usize >= Self::LIMIT {
            self.full = true;
            return self.constant(f64::NAN);
        }
        self.intern(NodeKind::Variable(k))
    }

    /// The number of a constant expression; `None` for any other.
    #[must_use]
    pub fn value(&self, e: Expression) -> Option<f64> {
        if let NodeKind::Constant(x) = self.kind(e) { Some(x.value()) } else { None }
    }

    pub(crate) fn kind(&self, e: Expression) -> &NodeKind {
        self.kinds.get_index(e.index()).unwrap_or(&NodeKind::NOT_A_NUMBER)
    }

    /// The expression of this kind, if the graph has it.
    pub(crate) fn find(&self, kind: &NodeKind) -> Option<Expression> {
        self.kinds.get_index_of(kind).map(|k| Expression(k as u32))
    }

    /// The bits of the variables of an expression, see [`bit`].
    pub(crate) fn bits(&self, e: Expression) -> u64 {
        self.variables.get(e.index()).copied().unwrap_or(0)
    }

    pub(crate) fn intern(&mut self, kind: NodeKind) -> Expression {
        let constant = matches!(kind, NodeKind::Constant(_));
        // One constant more always has room: the one that stands for all that has none.
        if !constant && self.size + kind.size() > self.limit {
            if let Some(there) = self.find(&kind) {
                return there;
            }
            self.full = true;
            return self.constant(f64::NAN);
        }
        let size = kind.size();
        let bits = match kind {
            NodeKind::Variable(k) => bit(k),
            _ => {
                let corner = matches!(kind, NodeKind::Call(Function::Abs | Function::Min | Function::Max, _));
                kind.parts().fold(if corner { CORNER } else { 0 }, |bits, part| bits | self.bits(part))
            }
        };
        let (index, new) = self.kinds.insert_full(kind);
        if new {
            self.size += size;
            self.variables.push(bits);
        }
        Expression(index as u32)
    }
}

/// The bit of expressions that contain `abs`, `min` or `max`.
const CORNER: u64 = 1 << 63;

/// The bit of a variable in the bits of an expression.
pub(crate) fn bit(variable: u32) -> u64 {
    1 << (variable % 63)
}
