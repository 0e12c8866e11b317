use super::product::Product;
use super::sum::Sum;
use super::{Expression, Graph};
use crate::syntax::{Action, too_few};
use crate::{Error, Syntax};

/// An operand whose sum or product may still go on: a chain is gathered once, not at every link.
enum Operand {
    Done(Expression),
    Sum(Sum),
    Product(Product),
}

impl Graph {
    /// The expression of a text. `meanings` are those of the names by their position: variables, constants, or expressions that a name
    /// abbreviates.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["x", "m", "c"])?;
    /// let mut graph = Graph::new();
    /// let x = graph.variable(0);
    /// let cos = graph.build(&parse("cos(x)", &names)?, &[x])?;
    /// let m = graph.constant(2.0);
    /// let e = graph.build(&parse("m/2*x*c", &names)?, &[x, m, cos])?;
    /// assert_eq!(e, graph.product(&[x, cos]));
    /// # Ok::<(), expression::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::TooFew`] meanings, a part that is [not finite](Error::NotFinite) whatever the variables are, [`Error::GraphFull`].
    pub fn build(&mut self, syntax: &Syntax, meanings: &[Expression]) -> Result<Expression, Error> {
        let mut stack: Vec<Operand> = Vec::new();
        for step in &syntax.steps {
            let operand = match step.action {
                Action::Number(x) => Operand::Done(self.constant(x)),
                Action::Name(k) => Operand::Done(*meanings.get(k).ok_or_else(|| too_few(k + 1, meanings.len()))?),
                action => {
                    let b = if action.operands() == 2 { stack.pop() } else { None };
                    let a = stack.pop();
                    let b = b.map(|b| self.done(b, step.column)).transpose()?;
                    match a {
                        Some(a) => self.applied(action, a, b, step.column)?,
                        None => Operand::Done(self.constant(f64::NAN)),
                    }
                }
            };
            stack.push(operand);
        }
        let last = stack.pop().unwrap_or(Operand::Done(Expression(u32::MAX)));
        let column = syntax.steps.last().map_or(1, |step| step.column);
        let done = self.done(last, column)?;
        self.check()?;
        Ok(done)
    }

    fn applied(&mut self, action: Action, a: Operand, b: Option<Expression>, column: usize) -> Result<Operand, Error> {
        Ok(match (action, b) {
            (Action::Add | Action::Subtract, Some(b)) => {
                let mut sum = match a {
                    Operand::Sum(sum) => sum,
                    other => {
                        let (first, mut sum) = (self.done(other, column)?, Sum::default());
                        self.add_to(&mut sum, first, 1.0);
                        sum
                    }
                };
                self.add_to(&mut sum, b, if action == Action::Add { 1.0 } else { -1.0 });
                Operand::Sum(sum)
            }
            (Action::Multiply | Action::Divide, Some(b)) => {
                let mut product = match a {
                    Operand::Product(product) => product,
                    other => {
                        let (first, mut product) = (self.done(other, column)?, Product::default());
                        self.multiply(&mut product, first, 2);
                        product
                    }
                };
                self.multiply(&mut product, b, if action == Action::Multiply { 2 } else { -2 });
                Operand::Product(product)
            }
            (action, b) => {
                let a = self.done(a, column)?;
                let e = match (action, b) {
                    (Action::Negate, _) => self.negated(a),
                    (Action::Power, Some(b)) => self.raised(a, b),
                    (Action::Call(function), Some(b)) => self.call(function, &[a, b]),
                    (Action::Call(function), None) => self.call(function, &[a]),
                    _ => a,
                };
                Operand::Done(self.finite(e, column)?)
            }
        })
    }

    fn done(&mut self, operand: Operand, column: usize) -> Result<Expression, Error> {
        let e = match operand {
            Operand::Done(e) => e,
            Operand::Sum(sum) => self.finish_sum(sum),
            Operand::Product(product) => self.finish_product(product),
        };
        self.finite(e, column)
    }

    fn finite(&self, e: Expression, column: usize) -> Result<Expression, Error> {
        self.check()?;
        match self.value(e) {
            Some(x) if !x.is_finite() => Err(Error::NotFinite { column, value: x.to_string() }),
            _ => Ok(e),
        }
    }
}
