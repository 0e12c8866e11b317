#![allow(clippy::float_cmp, reason = "a coefficient is one where its bits are")]

use super::sum::Sum;
use super::{Expression, Graph, NodeKind, Number};
use crate::Function;
use std::collections::HashMap;

impl Graph {
    /// The expression with products of sums multiplied out, and with sines and cosines of sums expanded into sines and cosines of their
    /// terms, so that terms cancel. A product stays as it is if it would have more than `most` terms, or would lose a coefficient beside
    /// a much larger one: `k (x - y) + x` with a `k` of `1e20`.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["a", "b", "m"])?;
    /// let mut graph = Graph::new();
    /// let variables = [0, 1, 2].map(|k| graph.variable(k));
    /// let e = parse("cos(a)*(m*cos(a) - b*sin(a)) + sin(a)*(m*sin(a) + b*cos(a)) + sin(a - b)*cos(b) + cos(a - b)*sin(b)", &names)?;
    /// let e = graph.build(&e, &variables)?;
    /// let expanded = graph.expanded(e, 100);
    /// assert_eq!(graph.text(expanded, &names)?, "m + sin(a)");
    /// # Ok::<(), expression::Error>(())
    /// ```
    pub fn expanded(&mut self, e: Expression, most: usize) -> Expression {
        let mut by: HashMap<Expression, Expression> = HashMap::new();
        let enter = |e: Expression| {
            matches!(
                self.kind(e),
                NodeKind::Sum { .. } | NodeKind::Product(_) | NodeKind::Call(Function::Sin | Function::Cos, _)
            )
        };
        for part in self.reached(&[e], enter) {
            let new = |e: Expression| by.get(&e).copied().unwrap_or(e);
            let expanded = match self.kind(part).clone() {
                NodeKind::Sum { constant, terms } => {
                    let mut sum = Sum::default();
                    let constant = self.constant(constant.value());
                    self.add_to(&mut sum, constant, 1.0);
                    for &(term, c) in &terms {
                        self.add_opened(&mut sum, new(term), c.value());
                    }
                    if sum.swallows() { part } else { self.finish_sum(sum) }
                }
                NodeKind::Product(factors) => {
                    let factors: Vec<_> = factors.iter().map(|&(base, halves)| (new(base), halves)).collect();
                    self.multiplied_out(&factors, most)
                }
                NodeKind::Call(function @ (Function::Sin | Function::Cos), [u, _]) => self.of_terms(function, u, part),
                _ => part,
            };
            by.insert(part, expanded);
        }
        by.get(&e).copied().unwrap_or(e)
    }

    /// The terms of a sum, or the expression itself.
    fn terms(&mut self, e: Expression) -> Vec<(Expression, f64)> {
        match self.kind(e).clone() {
            NodeKind::Sum { constant, terms } => {
                let mut terms: Vec<_> = terms.iter().map(|&(term, c)| (term, c.value())).collect();
                if constant != Number::ZERO {
                    terms.push((self.constant(constant.value()), 1.0));
                }
                terms
            }
            _ => vec![(e, 1.0)],
        }
    }

    /// Adds `c e`, term by term.
    fn add_opened(&mut self, sum: &mut Sum, e: Expression, c: f64) {
        for (term, factor) in self.terms(e) {
            self.add_to(sum, term, c * factor);
        }
    }

    fn multiplied_out(&mut self, factors: &[(Expression, i32)], most: usize) -> Expression {
        let whole = self.product_of(1.0, factors);
        let is_sum = |graph: &Self, e| matches!(graph.kind(e), NodeKind::Sum { .. });
        let open =
            |graph: &Self, (base, halves): (Expression, i32)| is_sum(graph, base) && halves > 0 && halves % 2 == 0;
        let (sums, rest): (Vec<_>, Vec<_>) = factors.iter().partition(|factor| open(self, **factor));
        let mut product = self.product_of(1.0, &rest);
        for (base, halves) in sums {
            for _ in 0..halves / 2 {
                let (a, b) = (self.terms(product), self.terms(base));
                if a.len() * b.len() > most {
                    return whole;
                }
                let mut sum = Sum::default();
                for &(x, c) in &a {
                    for &(y, d) in &b {
                        let term = self.product(&[x, y]);
                        self.add_to(&mut sum, term, c * d);
                    }
                }
                if sum.swallows() {
                    return whole;
                }
                product = self.finish_sum(sum);
            }
        }
        product
    }

    /// Sine or cosine of a sum of few terms with whole signs.
    fn of_terms(&mut self, function: Function, u: Expression, whole: Expression) -> Expression {
        let terms = match self.kind(u) {
            NodeKind::Sum { constant, terms } if *constant == Number::ZERO && (2..=3).contains(&terms.len()) => {
                terms.clone()
            }
            _ => return whole,
        };
        if terms.iter().any(|(_, c)| c.value().abs() != 1.0) {
            return whole;
        }
        let (mut sin, mut cos) = (self.constant(0.0), self.constant(1.0));
        for &(term, c) in &terms {
            let [s, k] = [Function::Sin, Function::Cos].map(|function| self.call(function, &[term]));
            let s = self.scaled(s, c.value());
            let of = |graph: &mut Self, [a, b]: [Expression; 2], [x, y]: [Expression; 2], c: f64| {
                let mut sum = Sum::default();
                let product = graph.multiplied_out(&[(a, 2), (b, 2)], usize::MAX);
                graph.add_opened(&mut sum, product, 1.0);
                let product = graph.multiplied_out(&[(x, 2), (y, 2)], usize::MAX);
                graph.add_opened(&mut sum, product, c);
                graph.finish_sum(sum)
            };
            (sin, cos) = (of(self, [sin, k], [cos, s], 1.0), of(self, [cos, k], [sin, s], -1.0));
        }
        if function == Function::Sin { sin } else { cos }
    }
}
