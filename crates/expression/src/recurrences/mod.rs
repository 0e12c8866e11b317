//! The solution of differential equations as a Taylor series, by recurrences over the operations of their right-hand sides.

mod expansion;
mod lowered;
mod schedule;
mod values;

pub use expansion::{Expansion, MOST_ORDERS};

use crate::tape::Program;
use crate::{Error, Expression, Function, Graph};
use lowered::Lowered;

/// The recurrences of the Taylor coefficients of `x' = f(t, x)`.
///
/// Each operation of `f` gives its coefficient of order `k` from those of its operands, and from its own of lower orders (Jorba and Zou 2005,
/// Experimental Mathematics 14, 99-117, section 2). All of them have one form: a combination of coefficients of order `k`, with factors that
/// are known from order 0, and of a sum over products `sum_(0 < i < k) a_i b_(k - i)`, which is known before order `k` begins. So a product is
/// `x_k = b_0 a_k + a_0 b_k + sum`, and a quotient `x_k = (a_k - x_0 b_k - sum)/b_0`.
///
/// ```
/// use expression::{Expansion, Graph, Recurrences};
/// // x' = y, y' = -x, from (0, 1): the sine.
/// let mut graph = Graph::new();
/// let [x, y] = [1, 2].map(|k| graph.variable(k));
/// let rates = [y, graph.negated(x)];
/// let recurrences = Recurrences::new(&graph, &rates, &[1, 2])?;
/// let mut series = Expansion::new(&recurrences);
/// series.expand(&recurrences, (0.0, &[0.0, 1.0], &[]), 1.0, 5);
/// assert_eq!(series.coefficients(3), [-1.0 / 6.0, 0.0]);
/// # Ok::<(), expression::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Recurrences {
    /// Each operation after those that it needs.
    operations: Box<[SeriesOperation]>,
    /// Operations with the same number of terms, one after another.
    runs: Box<[Run]>,
    /// The place of the result of each.
    results: Box<[u32]>,
    /// The places of the terms of all operations: coefficients, and behind them sums.
    terms: Box<[u32]>,
    /// The places of both factors of the sums over products, by eights; in the last blocks the left factors are weighted by their order.
    sums: Box<[[[u32; WIDE]; 2]]>,
    /// How many blocks have no weights.
    plain: usize,
    corners: Box<[Corner]>,
    sudden: bool,
    /// Places whose value is a constant.
    constants: Box<[(u32, f64)]>,
    places: usize,
    inputs: usize,
    /// The variable of each unknown.
    variables: Box<[u32]>,
    /// The place of its rate.
    rates: Box<[u32]>,
}

/// Sums over products that are computed side by side.
const WIDE: usize = 8;

/// Operations with the same number of terms, or that pick their term.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Run {
    terms: usize,
    picks: bool,
    end: usize,
}

/// An operation with the place of its result.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SeriesOperation {
    to: u32,
    /// The number of its terms.
    terms: u32,
    kind: Kind,
}

/// What an operation computes, from numbers in places.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// `alpha a + gamma`.
    Scaled { a: u32, alpha: f64, gamma: f64 },
    /// `a + beta b`.
    Sum { a: u32, b: u32, beta: f64 },
    /// `a b`.
    Product { a: u32, b: u32 },
    /// `c + beta a b`, with `beta` 1 or -1.
    SumOfProduct { a: u32, b: u32, c: u32, beta: f64 },
    /// `a^2`.
    Square { a: u32 },
    /// `1 / b`; if `flat`, zero where `b` is.
    Inverse { b: u32, flat: bool },
    /// `a / b`; if `flat`, zero where `b` is.
    Quotient { a: u32, b: u32, flat: bool },
    /// The square root of `a`; if `flat`, its coefficients are zero where `a` is.
    Root { a: u32, flat: bool },
    /// The function of `a` that begins with `start` and has the slope `beta b`.
    Integral { a: u32, b: u32, beta: f64, start: Start },
    /// The absolute value or the sign of `a`, or the smaller or larger of `a` and `b`, by the side of a corner.
    Choice { a: u32, b: u32, corner: u32 },
    /// `a` or zero, by the side of a corner. Where zero is chosen, `a` may have no value.
    Pick { a: u32, corner: u32 },
}

/// The value of an integral at order 0.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Start {
    Zero,
    /// A function of the argument, and of a second one.
    Call(Function, u32),
    Real(f64),
    Whole(i32),
}

/// Where a choice turns.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Corner {
    /// The number that changes its sign there.
    argument: u32,
    function: Function,
}

impl Recurrences {
    /// The recurrences of these rates, of the unknowns in these variables; variable 0 is time, and any other variable is constant.
    ///
    /// # Errors
    /// [`Error::GraphFull`] where the graph had no room for all that it was asked for.
    pub fn new(graph: &Graph, rates: &[Expression], variables: &[u32]) -> Result<Self, Error> {
        let most = variables.iter().fold(0, |most, &k| most.max(k + 1)).max(1);
        Ok(Lowered::of(Program::new(graph, rates)?, most).scheduled(variables))
    }

    /// How many unknowns there are.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.variables.len()
    }

    /// How many operations an order takes.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.operations.len()
    }

    /// Whether a function of time may change within an interval of which nothing tells before, such as `exp` or `tanh`.
    #[must_use]
    pub fn is_sudden(&self) -> bool {
        self.sudden
    }

    /// Whether a function may jump at a corner, as `sign` does.
    #[must_use]
    pub fn jumps(&self, corner: usize) -> bool {
        let jumps = |corner: &Corner| matches!(corner.function, Function::Sign | Function::Where | Function::Unless);
        self.corners.get(corner).is_some_and(jumps)
    }

    /// How many corners there are: functions such as `abs`, smooth on each side.
    #[must_use]
    pub fn corners(&self) -> usize {
        self.corners.len()
    }
}
