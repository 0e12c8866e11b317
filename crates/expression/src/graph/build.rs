use super::product::Product;
use super::sum::Sum;
use super::{Expression, Graph};
use crate::syntax::{Action, too_few};
use crate::{Error, Syntax};

/// An operand whose sum or product may still go on: a chain is gathered once, not at every link.
enum BuiltOperand {
    Done(Expression),
    Sum(Sum),
    Product(Product),
}

impl Graph {
    /// The expression of a text. `meanings` gives for each name, by its position, a variable, a constant, or the expression that the name
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
        let mut stack: Vec<(BuiltOperand, usize)> = Vec::new();
        for step in &syntax.steps {
            let operand = match step.action {
                Action::Number(x) => BuiltOperand::Done(self.constant(x)),
                Action::Name(k) => {
                    let meaning = meanings.get(k).ok_or_else(|| too_few(k + 1, meanings.len()))?;
                    BuiltOperand::Done(*meaning)
                }
                Action::Choose { turned } => {
                    let mut parts = [self.constant(f64::NAN); 3];
                    for part in parts.iter_mut().rev() {
                        if let Some(operand) = stack.pop() {
                            *part = self.done(operand)?;
                        }
                    }
                    let [condition, then, otherwise] = parts;
                    let [then, otherwise] = if turned { [otherwise, then] } else { [then, otherwise] };
                    BuiltOperand::Done(self.chosen(condition, then, otherwise))
                }
                action => {
                    let last = if action.operands() == 2 { stack.pop() } else { None };
                    match stack.pop() {
                        Some(first) => self.applied(action, first, last)?,
                        None => BuiltOperand::Done(self.constant(f64::NAN)),
                    }
                }
            };
            stack.push((operand, step.column));
        }
        let last = stack.pop().unwrap_or((BuiltOperand::Sum(Sum::default()), 1));
        self.done(last)
    }

    /// An operation on its first operand and its last, if it has two. What is done is done in the order of the text.
    fn applied(
        &mut self,
        action: Action,
        first: (BuiltOperand, usize),
        last: Option<(BuiltOperand, usize)>,
    ) -> Result<BuiltOperand, Error> {
        Ok(match (action, first, last) {
            (Action::Add | Action::Subtract, first, Some(last)) => {
                let mut sum = match first {
                    (BuiltOperand::Sum(sum), _) => sum,
                    other => {
                        let (first, mut sum) = (self.done(other)?, Sum::default());
                        self.add_to(&mut sum, first, 1.0);
                        sum
                    }
                };
                let last = self.done(last)?;
                self.add_to(&mut sum, last, if action == Action::Add { 1.0 } else { -1.0 });
                BuiltOperand::Sum(sum)
            }
            (Action::Multiply | Action::Divide, first, Some(last)) => {
                let mut product = match first {
                    (BuiltOperand::Product(product), _) => product,
                    other => {
                        let (first, mut product) = (self.done(other)?, Product::default());
                        self.multiply(&mut product, first, 2);
                        product
                    }
                };
                let last = self.done(last)?;
                self.multiply(&mut product, last, if action == Action::Multiply { 2 } else { -2 });
                BuiltOperand::Product(product)
            }
            (action, first, last) => {
                let a = self.done(first)?;
                let b = last.map_or(Ok(a), |last| self.done(last))?;
                BuiltOperand::Done(match action {
                    Action::Negate => self.negated(a),
                    Action::Power => self.raised(a, b),
                    Action::Call(function) => self.call(function, &[a, b]),
                    Action::Modulo => self.modulo(a, b),
                    _ => a,
                })
            }
        })
    }

    fn done(&mut self, (operand, column): (BuiltOperand, usize)) -> Result<Expression, Error> {
        let e = match operand {
            BuiltOperand::Done(e) => e,
            BuiltOperand::Sum(sum) => self.finish_sum(sum),
            BuiltOperand::Product(product) => self.finish_product(product),
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
