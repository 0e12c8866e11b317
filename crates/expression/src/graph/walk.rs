use super::{Expression, Graph, NodeKind, Number};
use std::collections::HashMap;

impl Graph {
    /// The roots and all their parts, each part before the expressions made of it. If `enter` refuses an expression, it is left out and
    /// its parts are not visited through it.
    pub(crate) fn reached(&self, roots: &[Expression], mut enter: impl FnMut(Expression) -> bool) -> Vec<Expression> {
        let mut seen = vec![false; self.kinds.len()];
        let mut waiting = roots.to_vec();
        let mut reached = Vec::new();
        while let Some(e) = waiting.pop() {
            if let Some(seen) = seen.get_mut(e.index()).filter(|seen| !**seen) {
                *seen = true;
                if enter(e) {
                    reached.push(e);
                    waiting.extend(self.kind(e).parts());
                }
            }
        }
        reached.sort_unstable();
        reached
    }

    /// The variables that an expression depends on, in order.
    #[must_use]
    pub fn variables(&self, e: Expression) -> Vec<u32> {
        let variable = |e| if let &NodeKind::Variable(k) = self.kind(e) { Some(k) } else { None };
        let mut variables: Vec<u32> = self.reached(&[e], |_| true).into_iter().filter_map(variable).collect();
        variables.sort_unstable();
        variables
    }

    /// Whether this is a sum of squares that may all vanish: its root is a length.
    pub(crate) fn is_square(&self, e: Expression) -> bool {
        let square =
            |e| matches!(self.kind(e), NodeKind::Product(factors) if factors.iter().all(|&(_, h)| h > 0 && h % 4 == 0));
        match self.kind(e) {
            NodeKind::Sum { constant, terms } => {
                *constant == Number::ZERO && terms.iter().all(|&(term, c)| c.value() > 0.0 && square(term))
            }
            _ => square(e),
        }
    }

    /// Whether the expression may be zero in a whole region, or at a corner, as `max(0, x)` and `abs(x)`: with it its slope is zero there.
    pub(crate) fn is_flat(&self, e: Expression) -> bool {
        self.bits(e) & super::CORNER != 0
    }

    /// The expression with others in place of variables.
    pub fn substitute(&mut self, e: Expression, meanings: &[(u32, Expression)]) -> Expression {
        let there = |&(k, meaning): &(u32, Expression)| Some((self.find(&NodeKind::Variable(k))?, meaning));
        let mut by = meanings.iter().rev().filter_map(there).collect();
        self.rebuilt(e, &mut by)
    }

    /// The expression with each part that is a key of `by` replaced. Parts rebuilt on the way are added to `by`.
    pub(crate) fn rebuilt(&mut self, e: Expression, by: &mut HashMap<Expression, Expression>) -> Expression {
        for part in self.reached(&[e], |e| !by.contains_key(&e)) {
            let new = |e: Expression| by.get(&e).copied().unwrap_or(e);
            let replaced = match self.kind(part).clone() {
                NodeKind::Constant(_) | NodeKind::Variable(_) => part,
                NodeKind::Sum { constant, terms } => {
                    let terms: Vec<_> = terms.iter().map(|&(term, c)| (new(term), c.value())).collect();
                    let mut sum = super::sum::Sum::default();
                    let constant = self.constant(constant.value());
                    self.add_to(&mut sum, constant, 1.0);
                    for (term, c) in terms {
                        self.add_to(&mut sum, term, c);
                    }
                    self.finish_sum(sum)
                }
                NodeKind::Product(factors) => {
                    let factors: Vec<_> = factors.iter().map(|&(base, h)| (new(base), h)).collect();
                    self.product_of(1.0, &factors)
                }
                NodeKind::Power(base, p) => self.power(new(base), p.value()),
                NodeKind::Call(function, [a, b]) => self.call(function, &[new(a), new(b)]),
            };
            by.insert(part, replaced);
        }
        by.get(&e).copied().unwrap_or(e)
    }
}
