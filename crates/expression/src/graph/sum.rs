#![allow(clippy::float_cmp, reason = "a coefficient is one where its bits are")]

use super::{Expression, Graph, LONG, NodeKind, Number};
use crate::Function;

/// A sum that is being made.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sum {
    constant: f64,
    terms: Vec<(Expression, f64)>,
    /// Whether a constant was swallowed by another.
    swallows: bool,
}

impl Sum {
    /// Whether gathering its terms would swallow one of them: of `1e20 x + 750 x` nothing of the 750 would be left.
    pub(crate) fn swallows(&mut self) -> bool {
        self.terms.sort_by_key(|&(term, _)| term);
        let pair = |pair: &[(Expression, f64)]| pair[0].0 == pair[1].0 && swallowed(pair[0].1, pair[1].1);
        self.swallows || self.terms.windows(2).any(pair)
    }
}

/// Whether the sum of two numbers has lost more than half of the digits of the smaller one.
fn swallowed(a: f64, b: f64) -> bool {
    let (large, small) = if a.abs() < b.abs() { (b, a) } else { (a, b) };
    let left = (large + small) - large;
    (left - small).abs() > f64::EPSILON.sqrt() * small.abs()
}

impl Graph {
    /// The sum of these.
    pub fn sum(&mut self, terms: &[Expression]) -> Expression {
        let mut sum = Sum::default();
        for &term in terms {
            self.add_to(&mut sum, term, 1.0);
        }
        self.finish_sum(sum)
    }

    /// `a - b`.
    pub fn difference(&mut self, a: Expression, b: Expression) -> Expression {
        let mut sum = Sum::default();
        self.add_to(&mut sum, a, 1.0);
        self.add_to(&mut sum, b, -1.0);
        self.finish_sum(sum)
    }

    /// `c e`.
    pub fn scaled(&mut self, e: Expression, c: f64) -> Expression {
        let mut sum = Sum::default();
        self.add_to(&mut sum, e, c);
        self.finish_sum(sum)
    }

    /// `-e`.
    pub fn negated(&mut self, e: Expression) -> Expression {
        self.scaled(e, -1.0)
    }

    /// Adds `c e`.
    pub(crate) fn add_to(&mut self, sum: &mut Sum, e: Expression, c: f64) {
        if c == 0.0 {
            return;
        }
        let (content, e) = self.content(e);
        let Some(c) = exact(c, content) else {
            // Out of range: the coefficients stay apart.
            let inner = self.scaled(e, content);
            sum.terms.push((inner, c));
            return;
        };
        match self.kind(e) {
            NodeKind::Constant(x) => {
                let x = c * x.value();
                if (sum.constant + x).is_finite() || !sum.constant.is_finite() || !x.is_finite() {
                    sum.swallows |= swallowed(sum.constant, x);
                    sum.constant += x;
                } else {
                    let apart = self.constant(x);
                    sum.terms.push((apart, 1.0));
                }
            }
            NodeKind::Sum { constant, terms } if c.abs() == 1.0 && terms.len() <= LONG => {
                let total = sum.constant + c * constant.value();
                if total.is_finite() {
                    sum.swallows |= swallowed(sum.constant, c * constant.value());
                    sum.constant = total;
                    sum.terms.extend(terms.iter().map(|&(term, x)| (term, c * x.value())));
                } else {
                    sum.terms.push((e, c));
                }
            }
            _ => sum.terms.push((e, c)),
        }
    }

    /// A constant factor of an expression and the rest: the coefficient of a single term, the sign of the first of several, and what the
    /// coefficients of all have in common.
    pub(crate) fn content(&mut self, e: Expression) -> (f64, Expression) {
        let NodeKind::Sum { constant, terms } = self.kind(e) else { return (1.0, e) };
        let [(first, leading), rest @ ..] = &**terms else { return (1.0, e) };
        let leading = leading.value();
        if rest.is_empty() && *constant == Number::ZERO {
            return (leading, *first);
        }
        if terms.len() > LONG {
            return (1.0, e);
        }
        let alike = |x: &Number| x.value().abs() == leading.abs();
        // A multiple of a sum among the terms would become that sum, which is then no term.
        let plain = terms.iter().all(|&(term, _)| !matches!(self.kind(term), NodeKind::Sum { .. }));
        let common = plain && rest.iter().all(|(_, x)| alike(x)) && (*constant == Number::ZERO || alike(constant));
        let factor = if common { leading } else { leading.signum() };
        if factor == 1.0 {
            return (1.0, e);
        }
        let divided = |x: &Number| Number::new(x.value() / factor);
        let terms = terms.iter().map(|(term, x)| (*term, divided(x))).collect();
        let primitive = NodeKind::Sum { constant: divided(constant), terms };
        (factor, self.intern(primitive))
    }

    /// The expression of a sum: terms in order, equal ones gathered.
    pub(crate) fn finish_sum(&mut self, sum: Sum) -> Expression {
        let Sum { mut constant, mut terms, .. } = sum;
        gather(&mut terms);
        if terms.len() <= LONG {
            self.circles(&mut constant, &mut terms);
            self.open(&mut constant, &mut terms);
        }
        let values: Option<Vec<_>> = terms.iter().map(|&(term, c)| Some(c * self.value(term)?)).collect();
        if let Some(values) = values {
            constant += values.iter().sum::<f64>();
            terms.clear();
        }
        if !constant.is_finite() {
            return self.constant(constant);
        }
        match terms[..] {
            [] => self.constant(constant),
            [(term, 1.0)] if constant == 0.0 => term,
            _ => {
                let terms = terms.iter().map(|&(term, c)| (term, Number::new(c))).collect();
                self.intern(NodeKind::Sum { constant: Number::new(constant), terms })
            }
        }
    }

    /// Opens sums among the terms that have come to stand there once, or with the sign turned round, when terms were gathered.
    fn open(&mut self, constant: &mut f64, terms: &mut Vec<(Expression, f64)>) {
        let sum = |graph: &Self, e| matches!(graph.kind(e), NodeKind::Sum { terms, .. } if terms.len() <= LONG);
        for _ in 0..LONG {
            let Some(at) = terms.iter().position(|&(e, c)| c.abs() == 1.0 && sum(self, e)) else { break };
            let (e, c) = terms.remove(at);
            let mut opened = Sum { constant: *constant, terms: std::mem::take(terms), swallows: false };
            self.add_to(&mut opened, e, c);
            *constant = opened.constant;
            *terms = opened.terms;
            gather(terms);
        }
    }

    /// `c r sin(u)^2 + c r cos(u)^2` is `c r`, again and again.
    fn circles(&mut self, constant: &mut f64, terms: &mut Vec<(Expression, f64)>) {
        while let Some((i, j, rest)) = self.circle(terms) {
            let (_, c) = terms.remove(i.max(j));
            terms.remove(i.min(j));
            let mut sum = Sum { constant: *constant, terms: std::mem::take(terms), swallows: false };
            self.add_to(&mut sum, rest, c);
            *constant = sum.constant;
            *terms = sum.terms;
            gather(terms);
        }
    }

    /// Two such terms, and `r`.
    fn circle(&mut self, terms: &[(Expression, f64)]) -> Option<(usize, usize, Expression)> {
        for (i, &(term, c)) in terms.iter().enumerate() {
            let NodeKind::Product(factors) = self.kind(term) else { continue };
            for &(base, halves) in factors {
                let NodeKind::Call(Function::Sin, u) = *self.kind(base) else { continue };
                let Some(cos) = self.find(&NodeKind::Call(Function::Cos, u)).filter(|_| halves >= 4) else { continue };
                let mut partner: Vec<(Expression, i32)> = factors.to_vec();
                change(&mut partner, base, -4);
                let rest = partner.clone();
                change(&mut partner, cos, 4);
                let Some(partner) = self.find(&NodeKind::Product(partner.into())) else { continue };
                if let Some(j) = terms.iter().position(|&(t, d)| t == partner && d.to_bits() == c.to_bits()) {
                    return Some((i, j, self.product_of(1.0, &rest)));
                }
            }
        }
        None
    }
}

/// `a b`, where the product of two finite numbers is one, and no digit is lost below the smallest.
pub(crate) fn exact(a: f64, b: f64) -> Option<f64> {
    let product = a * b;
    let one = |x: f64| x.abs() == 1.0;
    let fits = product.is_normal() || one(a) || one(b) || a == 0.0 || b == 0.0 || !a.is_finite() || !b.is_finite();
    fits.then_some(product)
}

/// Orders terms and gathers equal ones, as far as their coefficients are in range.
fn gather(terms: &mut Vec<(Expression, f64)>) {
    terms.sort_by_key(|&(term, _)| term);
    terms.dedup_by(|(term, c), (kept, total)| {
        let gathered = term == kept && (*total + *c).is_finite();
        if gathered {
            *total += *c;
        }
        gathered
    });
    terms.retain(|&(_, c)| c != 0.0);
}

/// Adds to the exponent of a factor in an ordered list.
fn change(factors: &mut Vec<(Expression, i32)>, base: Expression, by: i32) {
    match factors.binary_search_by_key(&base, |&(b, _)| b) {
        Ok(at) => {
            factors[at].1 += by;
            if factors[at].1 == 0 {
                factors.remove(at);
            }
        }
        Err(at) => factors.insert(at, (base, by)),
    }
}
