use super::{Expression, Graph, NodeKind};
use crate::Function;

impl Graph {
    /// A function of its arguments: those that are missing are the first, those that are too many are left out.
    pub fn call(&mut self, function: Function, arguments: &[Expression]) -> Expression {
        let Some(&first) = arguments.first() else { return self.constant(f64::NAN) };
        let last = if function.arguments() == 1 { first } else { arguments.get(1).copied().unwrap_or(first) };
        if let (Some(a), Some(b)) = (self.value(first), self.value(last)) {
            return self.constant(function.of(a, b));
        }
        match function {
            Function::Where | Function::Unless => {
                match self.value(first).map(|x| (x > 0.0) == (function == Function::Where)) {
                    Some(true) => last,
                    Some(false) => self.constant(0.0),
                    None if self.value(last) == Some(0.0) => last,
                    None => self.called(function, [first, last]),
                }
            }
            Function::Sqrt => self.power(first, 0.5),
            // Even and odd functions.
            Function::Cos | Function::Cosh | Function::Abs => {
                let (_, e) = self.without_sign(first);
                if function == Function::Abs && matches!(self.kind(e), NodeKind::Call(Function::Abs, _)) {
                    return e;
                }
                self.called(function, [e, e])
            }
            Function::Sin
            | Function::Tan
            | Function::Asin
            | Function::Atan
            | Function::Sinh
            | Function::Tanh
            | Function::Inverse
            | Function::Sign => {
                let (negative, e) = self.without_sign(first);
                let called = self.called(function, [e, e]);
                if negative { self.negated(called) } else { called }
            }
            Function::Exp => match *self.kind(first) {
                NodeKind::Call(Function::Log, [u, _]) => u,
                _ => self.called(function, [first; 2]),
            },
            Function::Log => match *self.kind(first) {
                NodeKind::Call(Function::Exp, [u, _]) => u,
                _ => self.called(function, [first; 2]),
            },
            Function::Min | Function::Max if first == last => first,
            Function::Min | Function::Max => self.called(function, [first.min(last), first.max(last)]),
            Function::Acos | Function::Atan2 | Function::Floor => self.called(function, [first, last]),
        }
    }

    /// `then` where the condition is positive, elsewhere `otherwise`; the one that is not chosen may have no value there.
    pub fn chosen(&mut self, condition: Expression, then: Expression, otherwise: Expression) -> Expression {
        if then == otherwise {
            return then;
        }
        let then = self.call(Function::Where, &[condition, then]);
        let otherwise = self.call(Function::Unless, &[condition, otherwise]);
        self.sum(&[then, otherwise])
    }

    /// `a - b floor(a/b)`, which has the sign of `b`.
    pub fn modulo(&mut self, a: Expression, b: Expression) -> Expression {
        let ratio = self.quotient(a, b);
        let whole = self.call(Function::Floor, &[ratio]);
        let multiple = self.product(&[b, whole]);
        self.difference(a, multiple)
    }

    /// `floor(a)` where its jumps have the side `side`, the sign of `sin(pi a)`: the formula has no jump near those of the function.
    pub(crate) fn floor_beside(&mut self, a: Expression, side: Expression) -> Expression {
        // Two jumps further it is the same again: 2 floor((a + side/2)/2) + (1 - side)/2.
        let half = self.scaled(side, 0.5);
        let (moved, one) = (self.sum(&[a, half]), self.constant(0.5));
        let middle = self.scaled(moved, 0.5);
        let whole = self.call(Function::Floor, &[middle]);
        let twice = self.scaled(whole, 2.0);
        let rest = self.difference(one, half);
        self.sum(&[twice, rest])
    }

    fn called(&mut self, function: Function, arguments: [Expression; 2]) -> Expression {
        self.intern(NodeKind::Call(function, arguments))
    }

    /// Whether the first coefficient is negative, and the expression with all of them turned round if so.
    fn without_sign(&mut self, e: Expression) -> (bool, Expression) {
        let negative =
            matches!(self.kind(e), NodeKind::Sum { terms, .. } if terms.first().is_some_and(|t| t.1.value() < 0.0));
        (negative, if negative { self.negated(e) } else { e })
    }
}
