use crate::{Expression, Function, Graph};
use scalar::{Scalar, ScalarFunction, assigning_operators};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that is an expression: a model evaluated on these, within [`trace`], becomes a formula.
///
/// A model has no comparisons of its scalars, so the operations that it makes are the same for all numbers.
///
/// ```
/// use expression::{Graph, Names, Symbol, trace};
/// use scalar::Scalar;
/// fn model<S: Scalar>(x: S) -> S {
///     (x * 2.0).sin() + 1.0
/// }
/// let (formula, graph) = trace(Graph::new(), || model(Symbol::variable(0)).expression());
/// assert_eq!(graph.text(formula?, &Names::of(["x"])?)?, "sin(2*x) + 1");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symbol(Expression);

thread_local! {
    /// The graph of the trace that the thread is in.
    static TRACED: RefCell<Option<Traced>> = const { RefCell::new(None) };
}

struct Traced {
    graph: Graph,
    untraced: Option<&'static str>,
}

/// Runs a model on symbols, whose expressions are made in the graph. The result is an error, with the reason, if some operation has no
/// expression.
pub fn trace<T>(graph: Graph, model: impl FnOnce() -> T) -> (Result<T, &'static str>, Graph) {
    /// Puts back what was traced before, also if the model panics.
    struct Before(Option<Traced>);
    impl Drop for Before {
        fn drop(&mut self) {
            TRACED.set(self.0.take());
        }
    }
    let before = Before(TRACED.replace(Some(Traced { graph, untraced: None })));
    let made = model();
    let traced = TRACED.take();
    drop(before);
    let Traced { graph, untraced } = traced.unwrap_or(Traced { graph: Graph::new(), untraced: None });
    (untraced.map_or(Ok(made), Err), graph)
}

impl Symbol {
    /// The variable of this number.
    #[must_use]
    pub fn variable(k: u32) -> Self {
        Self::made(|graph| graph.variable(k))
    }

    /// The expression in the graph of the trace.
    #[must_use]
    pub fn expression(self) -> Expression {
        self.0
    }

    /// Outside of a trace all symbols are alike.
    fn made(make: impl FnOnce(&mut Graph) -> Expression) -> Self {
        TRACED.with_borrow_mut(|traced| match traced {
            Some(traced) => Self(make(&mut traced.graph)),
            None => Self(Graph::new().constant(f64::NAN)),
        })
    }

    fn call(self, function: Function) -> Self {
        Self::made(|graph| graph.call(function, &[self.0]))
    }

    fn with(self, other: Self, function: Function) -> Self {
        Self::made(|graph| graph.call(function, &[self.0, other.0]))
    }

    /// A number of which no formula is known.
    fn untraced(reason: &'static str) -> Self {
        TRACED.with_borrow_mut(|traced| {
            if let Some(traced) = traced {
                traced.untraced.get_or_insert(reason);
            }
        });
        Self::constant(f64::NAN)
    }
}

impl Neg for Symbol {
    type Output = Self;
    fn neg(self) -> Self {
        Self::made(|graph| graph.negated(self.0))
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident |$graph:ident, $a:ident, $b:ident| $value:expr;)*) => {$(
        impl $operator for Symbol {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self.0, other.0);
                Self::made(|$graph| $value)
            }
        }
        impl $operator<f64> for Symbol {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.$method(Self::constant(other))
            }
        }
    )*};
}
operators! {
    Add add |graph, a, b| graph.sum(&[a, b]);
    Sub sub |graph, a, b| graph.difference(a, b);
    Mul mul |graph, a, b| graph.product(&[a, b]);
    Div div |graph, a, b| graph.quotient(a, b);
}
assigning_operators!([] Symbol);

/// Functions of one number, by name.
macro_rules! functions {
    ($($method:ident $function:ident;)*) => {$(
        fn $method(self) -> Self {
            self.call(Function::$function)
        }
    )*};
}

impl Scalar for Symbol {
    fn constant(x: f64) -> Self {
        Self::made(|graph| graph.constant(x))
    }
    fn sin_cos(self) -> (Self, Self) {
        (self.call(Function::Sin), self.call(Function::Cos))
    }
    functions! {
        exp Exp;
        ln Log;
        sqrt Sqrt;
        tan Tan;
        asin Asin;
        acos Acos;
        atan Atan;
        sinh Sinh;
        cosh Cosh;
        tanh Tanh;
        abs Abs;
        sign Sign;
    }
    fn powi(self, n: i32) -> Self {
        self.powf(f64::from(n))
    }
    fn powf(self, p: f64) -> Self {
        Self::made(|graph| graph.power(self.0, p))
    }
    fn recip(self) -> Self {
        Self::constant(1.0) / self
    }
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        f.expressed(self).unwrap_or_else(|| {
            Self::untraced("series need formulas, and a function that is told by its value and its derivatives is none")
        })
    }
    /// Where one is chosen by the sign of a number that is known, that one; else there is no formula.
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        let known = TRACED.with_borrow(|traced| traced.as_ref().and_then(|traced| traced.graph.value(self.0)));
        match known {
            Some(x) => {
                if x > 0.0 {
                    then
                } else {
                    otherwise
                }
            }
            None if then == otherwise => then,
            None => Self::untraced(
                "series need formulas, and a choice between two by a sign is none: take `min`, `max` or `abs`",
            ),
        }
    }
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        components.iter().fold(Self::zero(), |sum, &x| sum + x * x).sqrt()
    }
    fn atan2(self, x: Self) -> Self {
        self.with(x, Function::Atan2)
    }
    fn min(self, other: Self) -> Self {
        self.with(other, Function::Min)
    }
    fn max(self, other: Self) -> Self {
        self.with(other, Function::Max)
    }
    fn is_zero(&self) -> bool {
        TRACED.with_borrow(|traced| traced.as_ref().and_then(|traced| traced.graph.value(self.0)) == Some(0.0))
    }
}
