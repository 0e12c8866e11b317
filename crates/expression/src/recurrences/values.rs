use super::expansion::{Expansion, MOST_TERMS};
use super::{Kind, Recurrences, SeriesOperation, Start};
use crate::Function;
use scalar::Scalar;

impl<S: Scalar> Expansion<S> {
    /// The values of all operations, and the factors of their terms.
    pub(super) fn evaluate(&mut self, of: &Recurrences, sides: &[S]) {
        let (mut at, one) = (0, S::constant(1.0));
        // Sine and cosine of one argument are computed together.
        let mut circle: Option<(u32, (S, S))> = None;
        let side = |corner: u32, value: &dyn Fn(u32) -> S| {
            let given = sides.get(corner as usize).copied().unwrap_or(S::zero());
            given.squared().where_positive(given, value(of.corners[corner as usize].argument).sign())
        };
        for &SeriesOperation { to, terms, kind } in &of.operations {
            let value = |place: u32| self.values[place as usize];
            let inverse =
                |by: S, flat: bool| if flat { (by * by).where_positive(by.recip(), S::zero()) } else { by.recip() };
            let mut vanishes = |place: u32, inverse: S| {
                if inverse.is_zero() {
                    self.vanishing.push(place);
                }
            };
            let (x, factors): (S, [S; MOST_TERMS]) = match kind {
                Kind::Scaled { a, alpha, gamma } => (value(a) * alpha + gamma, [S::constant(alpha), one, one, one]),
                Kind::Sum { a, b, beta } => (value(a) + value(b) * beta, [one, S::constant(beta), one, one]),
                Kind::Product { a, b } => (value(a) * value(b), [value(b), value(a), one, one]),
                Kind::SumOfProduct { a, b, c, beta } => {
                    let (a, b) = (value(a) * beta, value(b));
                    (value(c) + a * b, [b * beta, a, one, S::constant(beta)])
                }
                Kind::Square { a } => (value(a).squared(), [value(a) * 2.0, one, one, one]),
                Kind::Inverse { b, flat } => {
                    let x = inverse(value(b), flat);
                    if flat {
                        vanishes(b, x);
                    }
                    (x, [-x.squared(), -x, one, one])
                }
                Kind::Quotient { a, b, flat } => {
                    let by = inverse(value(b), flat);
                    let x = if flat { value(a) * by } else { value(a) / value(b) };
                    if flat {
                        vanishes(b, by);
                    }
                    (x, [by, -(x * by), -by, one])
                }
                Kind::Root { a, flat } => {
                    let x = value(a).sqrt();
                    let by = inverse(x * 2.0, flat);
                    if flat {
                        vanishes(a, by);
                    }
                    (x, [by, -by, one, one])
                }
                Kind::Integral { a, b, beta, start } => {
                    let x = match start {
                        Start::Zero => S::zero(),
                        Start::Call(function @ (Function::Sin | Function::Cos), _) => {
                            let known = circle.filter(|(place, _)| *place == a);
                            let (place, both) = known.unwrap_or_else(|| (a, value(a).sin_cos()));
                            circle = Some((place, both));
                            if function == Function::Sin { both.0 } else { both.1 }
                        }
                        Start::Call(function, second) => function.of(value(a), value(second)),
                        Start::Real(p) => value(a).powf(p),
                        Start::Whole(n) => value(a).powi(n),
                    };
                    // The value of the slope may follow.
                    (x, [value(b), S::constant(beta), one, one])
                }
                Kind::Pick { a, corner } => {
                    let side = side(corner, &value);
                    let function = of.corners[corner as usize].function;
                    (function.of(side, value(a)), [function.of(side, one), one, one, one])
                }
                Kind::Choice { a, b, corner } => {
                    let side = side(corner, &value);
                    let function = of.corners[corner as usize].function;
                    match function {
                        Function::Abs => (side * value(a), [side, S::zero(), one, one]),
                        Function::Sign => (side, [S::zero(), S::zero(), one, one]),
                        function => {
                            // Of equal numbers the mean.
                            let of_a = if function == Function::Max { side } else { -side };
                            let of_a = (of_a + 1.0) * 0.5;
                            let x = of_a.where_positive(
                                (-of_a + 1.0).where_positive((value(a) + value(b)) * 0.5, value(a)),
                                value(b),
                            );
                            (x, [of_a, -of_a + 1.0, one, one])
                        }
                    }
                }
            };
            self.values[to as usize] = x;
            // Those of the next operation overwrite what is too much.
            if let Some(row) = self.factors[at..].first_chunk_mut::<MOST_TERMS>() {
                *row = factors;
            }
            at += terms as usize;
        }
        let mut at = 0;
        for &SeriesOperation { kind, terms, .. } in &of.operations {
            if let Kind::Integral { b, beta, .. } = kind {
                self.factors[at] = self.values[b as usize] * beta;
            }
            at += terms as usize;
        }
        for (argument, corner) in self.arguments.iter_mut().zip(&of.corners) {
            *argument = self.values[corner.argument as usize];
        }
    }
}
