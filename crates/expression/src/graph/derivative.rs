use super::product::Product;
use super::sum::Sum;
use super::{Expression, Graph, NodeKind, bit};
use crate::Function;

impl Graph {
    /// The derivative in a variable.
    ///
    /// The derivatives of `abs`, `min` and `max` are written with `sign`, at a corner as the mean of the two sides; the derivative of
    /// `sign` is zero, and that of a choice the derivative of what is chosen. A length (the root of a sum of squares) and an angle of `atan2` have the derivative zero at a zero vector, by
    /// `inverse`. A positive power of an expression with corners, as `max(0, x)^1.5`, has the derivative zero where its base is zero.
    /// Elsewhere the rules of differentiation hold: at a zero of another root the derivative is infinite or NaN.
    ///
    /// Each derivative is computed once and kept.
    pub fn derivative(&mut self, e: Expression, variable: u32) -> Expression {
        let (bits, derivatives) = (bit(variable), &self.derivatives);
        let unknown = |e: Expression| self.bits(e) & bits != 0 && !derivatives.contains_key(&(e, variable));
        for part in self.reached(&[e], unknown) {
            let derivative = self.rule(part, variable);
            self.derivatives.insert((part, variable), derivative);
        }
        self.known(e, variable)
    }

    /// The derivatives in these variables.
    pub fn gradient(&mut self, e: Expression, variables: &[u32]) -> Vec<Expression> {
        variables.iter().map(|&k| self.derivative(e, k)).collect()
    }

    /// The derivatives of several expressions, a row for each.
    pub fn jacobian(&mut self, expressions: &[Expression], variables: &[u32]) -> Vec<Vec<Expression>> {
        expressions.iter().map(|&e| self.gradient(e, variables)).collect()
    }

    /// The second derivatives: a row for each of `rows`, in it one for each of `columns`.
    pub fn hessian(&mut self, e: Expression, rows: &[u32], columns: &[u32]) -> Vec<Vec<Expression>> {
        // The order of two derivatives is the same for a pair and for the pair turned round, so that both are one expression.
        let second = |graph: &mut Self, a: u32, b: u32| {
            let first = graph.derivative(e, a.min(b));
            graph.derivative(first, a.max(b))
        };
        rows.iter().map(|&a| columns.iter().map(|&b| second(self, a, b)).collect()).collect()
    }

    fn known(&mut self, e: Expression, variable: u32) -> Expression {
        match self.derivatives.get(&(e, variable)) {
            Some(&derivative) => derivative,
            None => self.constant(0.0),
        }
    }

    /// The rule for one expression, the derivatives of its parts being known.
    fn rule(&mut self, e: Expression, variable: u32) -> Expression {
        match self.kind(e).clone() {
            NodeKind::Constant(_) => self.constant(0.0),
            NodeKind::Variable(k) => self.constant(if k == variable { 1.0 } else { 0.0 }),
            NodeKind::Sum { terms, .. } => {
                let mut sum = Sum::default();
                for &(term, c) in &terms {
                    let derivative = self.known(term, variable);
                    self.add_to(&mut sum, derivative, c.value());
                }
                self.finish_sum(sum)
            }
            NodeKind::Product(factors) => {
                let mut sum = Sum::default();
                for &(base, halves) in &factors {
                    let inner = self.known(base, variable);
                    if self.value(inner) != Some(0.0) {
                        let mut product = Product::default();
                        for &(other, h) in &factors {
                            if other != base {
                                self.multiply(&mut product, other, h);
                            } else if h == 1 && (self.is_square(base) || self.is_flat(base)) {
                                let length = self.power(base, 0.5);
                                let inverse = self.call(Function::Inverse, &[length]);
                                self.multiply(&mut product, inverse, 2);
                            } else {
                                self.multiply(&mut product, base, h - 2);
                            }
                        }
                        self.multiply(&mut product, inner, 2);
                        let term = self.finish_product(product);
                        self.add_to(&mut sum, term, 0.5 * f64::from(halves));
                    }
                }
                self.finish_sum(sum)
            }
            NodeKind::Power(base, p) => {
                let (p, inner) = (p.value(), self.known(base, variable));
                let slope = if 0.0 < p && p < 1.0 && self.is_flat(base) {
                    let inverse = self.call(Function::Inverse, &[base]);
                    self.product(&[e, inverse])
                } else {
                    self.power(base, p - 1.0)
                };
                let product = self.product(&[slope, inner]);
                self.scaled(product, p)
            }
            NodeKind::Call(Function::Atan2, [y, x]) => {
                let [dy, dx] = [y, x].map(|part| self.known(part, variable));
                let (a, b) = (self.product(&[x, dy]), self.product(&[y, dx]));
                let [y, x] = [y, x].map(|part| self.power(part, 2.0));
                let (turned, square) = (self.difference(a, b), self.sum(&[x, y]));
                let inverse = self.call(Function::Inverse, &[square]);
                self.product(&[turned, inverse])
            }
            NodeKind::Call(function @ (Function::Min | Function::Max), [a, b]) => {
                let [da, db] = [a, b].map(|part| self.known(part, variable));
                let (apart, mean) = (self.difference(a, b), self.sum(&[da, db]));
                let (sign, half) = (self.call(Function::Sign, &[apart]), self.difference(da, db));
                let turned = self.product(&[sign, half]);
                let twice =
                    if function == Function::Max { self.sum(&[mean, turned]) } else { self.difference(mean, turned) };
                self.scaled(twice, 0.5)
            }
            NodeKind::Call(function @ (Function::Where | Function::Unless), [condition, chosen]) => {
                let inner = self.known(chosen, variable);
                self.call(function, &[condition, inner])
            }
            NodeKind::Call(function, [u, _]) => {
                let (slope, inner) = (self.slope(function, u, e), self.known(u, variable));
                self.product(&[slope, inner])
            }
        }
    }

    /// The derivative of a function of one argument in that, where its value is `f`.
    fn slope(&mut self, function: Function, u: Expression, f: Expression) -> Expression {
        let square = |graph: &mut Self, e, c: f64| {
            let (square, one) = (graph.power(e, 2.0), graph.constant(1.0));
            let scaled = graph.scaled(square, c);
            graph.sum(&[one, scaled])
        };
        match function {
            Function::Sin => self.call(Function::Cos, &[u]),
            Function::Cos => {
                let sin = self.call(Function::Sin, &[u]);
                self.negated(sin)
            }
            Function::Tan => square(self, f, 1.0),
            Function::Asin | Function::Acos => {
                // 1 - u^2 in factors: near 1 the square has lost digits.
                let one = self.constant(1.0);
                let [above, below] = [self.sum(&[one, u]), self.difference(one, u)];
                let product = self.product(&[above, below]);
                let slope = self.power(product, -0.5);
                if function == Function::Acos { self.negated(slope) } else { slope }
            }
            Function::Atan => {
                let square = square(self, u, 1.0);
                self.power(square, -1.0)
            }
            Function::Sinh => self.call(Function::Cosh, &[u]),
            Function::Cosh => self.call(Function::Sinh, &[u]),
            // Its digits are lost where it is small; but of a friction tanh(1000 v) the cosine is out of range soon.
            Function::Tanh => square(self, f, -1.0),
            Function::Exp => f,
            Function::Log => self.power(u, -1.0),
            Function::Abs => self.call(Function::Sign, &[u]),
            Function::Sqrt => {
                let inverse = self.power(u, -0.5);
                self.scaled(inverse, 0.5)
            }
            Function::Inverse => {
                let square = self.power(f, 2.0);
                self.negated(square)
            }
            Function::Sign
            | Function::Floor
            | Function::Where
            | Function::Unless
            | Function::Atan2
            | Function::Min
            | Function::Max => self.constant(0.0),
        }
    }
}
