#![allow(clippy::float_cmp, reason = "turns are the same where their bits are")]

use super::{Expression, Graph, NodeKind, bit};
use crate::Function;
use crate::interval::Interval;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The change of an expression if a variable grows by a whole turn, `2 pi`.
#[derive(Debug, Clone, PartialEq)]
pub enum Turned {
    /// No change: the expression has the period `2 pi`.
    Same,
    /// The value changes.
    Changed,
    /// The form of the expression does not tell. It has the period if the sum of these parts, each times its factor, has the period.
    Open(Vec<(Expression, f64)>),
}

/// The change of a part of an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
enum PartTurned {
    /// The part grows by this number of turns.
    By(f64),
    /// The value changes, whatever the other variables are.
    Changed,
    /// The form of the part does not tell.
    Open,
}

impl PartTurned {
    const SAME: Self = Self::By(0.0);

    /// Whether the value changes for certain.
    fn changes(self) -> bool {
        self == Self::Changed || matches!(self, Self::By(turns) if turns != 0.0)
    }
}

impl Graph {
    /// What an expression does where a variable grows by `2 pi`, as far as its form tells: angles in sines, cosines and tangents with whole
    /// factors, sums in which turns cancel.
    ///
    /// ```
    /// use expression::{Graph, Names, Turned, parse};
    /// let names = Names::of(["a", "x"])?;
    /// let mut graph = Graph::new();
    /// let variables = [0, 1].map(|k| graph.variable(k));
    /// for (text, turned) in [("x^2*cos(2*a - x)", Turned::Same), ("x^2*a", Turned::Changed), ("sin(a/2)", Turned::Changed)] {
    ///     let e = graph.build(&parse(text, &names)?, &variables)?;
    ///     assert_eq!(graph.turned(e, 0), turned);
    /// }
    /// let e = graph.build(&parse("x + sin(a/2)*cos(a/2)", &names)?, &variables)?;
    /// assert!(matches!(graph.turned(e, 0), Turned::Open(parts) if parts.len() == 1));
    /// # Ok::<(), expression::Error>(())
    /// ```
    #[must_use]
    pub fn turned(&self, e: Expression, variable: u32) -> Turned {
        let bits = bit(variable);
        if self.bits(e) & bits == 0 {
            return Turned::Same;
        }
        let mut known: HashMap<Expression, PartTurned> = HashMap::new();
        for part in self.reached(&[e], |e| self.bits(e) & bits != 0) {
            let turned = self.part_turned(part, variable, &|e| known.get(&e).copied().unwrap_or(PartTurned::SAME));
            known.insert(part, turned);
        }
        let of = |e: Expression| known.get(&e).copied().unwrap_or(PartTurned::SAME);
        match of(e) {
            PartTurned::SAME => Turned::Same,
            PartTurned::Open => Turned::Open(self.open_parts(e, &|e| of(e) != PartTurned::SAME)),
            PartTurned::By(_) | PartTurned::Changed => Turned::Changed,
        }
    }

    /// Whether a sum of parts may be the same after a turn of a variable at all these places, which say the values of the variables by their
    /// numbers: its values before and after have a number in common, but for rounding.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["a"])?;
    /// let mut graph = Graph::new();
    /// let a = graph.variable(0);
    /// let mut same = |text| Ok::<_, expression::Error>({
    ///     let e = graph.build(&parse(text, &names)?, &[a])?;
    ///     graph.may_be_same(&[(e, 1.0)], 0, &[vec![0.3], vec![20.0]])
    /// });
    /// assert!(same("sin(a/2)^2")? && !same("sin(a/2)")?);
    /// # Ok::<(), expression::Error>(())
    /// ```
    #[must_use]
    pub fn may_be_same(&self, parts: &[(Expression, f64)], variable: u32, places: &[Vec<f64>]) -> bool {
        let roots: Vec<Expression> = parts.iter().map(|part| part.0).collect();
        let reached = self.reached(&roots, |_| true);
        let mut values: HashMap<Expression, Interval> = HashMap::new();
        places.iter().all(|place| {
            let mut change = Interval::at(0.0);
            for (turns, sign) in [(0.0, -1.0), (1.0, 1.0)] {
                let input = |k: u32| {
                    let x = place.get(k as usize).copied().unwrap_or(0.0);
                    if k == variable {
                        Interval::near(TAU).scaled(turns).plus(Interval::at(x))
                    } else {
                        Interval::at(x)
                    }
                };
                for &e in &reached {
                    let value = Interval::of(self.kind(e), input, |e| values[&e]);
                    values.insert(e, value);
                }
                for &(part, c) in parts {
                    change = change.plus(values[&part].scaled(sign * c));
                }
            }
            change.has_zero()
        })
    }

    fn part_turned(&self, e: Expression, variable: u32, of: &dyn Fn(Expression) -> PartTurned) -> PartTurned {
        use PartTurned::{By, Changed, Open};
        const SAME: PartTurned = PartTurned::SAME;
        let certain = |changes: bool| if changes { Changed } else { Open };
        match self.kind(e) {
            NodeKind::Constant(_) => SAME,
            NodeKind::Variable(k) => By(if *k == variable { 1.0 } else { 0.0 }),
            NodeKind::Sum { terms, .. } => {
                let (mut turns, mut size, mut others) = (0.0, 0.0, Vec::new());
                for &(term, c) in terms {
                    match of(term) {
                        By(by) => {
                            turns += c.value() * by;
                            size += (c.value() * by).abs();
                        }
                        other => others.push(other),
                    }
                }
                let cancel = turns.abs() <= ROUNDING * size;
                match others[..] {
                    [] => By(if cancel { 0.0 } else { turns }),
                    [one] if cancel => one,
                    _ => Open,
                }
            }
            NodeKind::Product(factors) => {
                let mut others = factors.iter().map(|&(base, halves)| (of(base), halves)).filter(|(of, _)| *of != SAME);
                match (others.next(), others.next()) {
                    (None, _) => SAME,
                    // The square of what changes its sign is the same.
                    (Some((one, halves)), None) => certain(one.changes() && (one != Changed || halves % 4 != 0)),
                    _ => Open,
                }
            }
            NodeKind::Power(base, _) => {
                if of(*base) == SAME {
                    SAME
                } else {
                    certain(of(*base).changes())
                }
            }
            NodeKind::Call(function, [a, b]) => match (function, of(*a), of(*b)) {
                (_, SAME, SAME) => SAME,
                (Function::Sin | Function::Cos, By(turns), _) => {
                    if whole(turns) {
                        SAME
                    } else {
                        Changed
                    }
                }
                (Function::Tan, By(turns), _) => {
                    if whole(2.0 * turns) {
                        SAME
                    } else {
                        Changed
                    }
                }
                (
                    Function::Sin
                    | Function::Cos
                    | Function::Tan
                    | Function::Atan2
                    | Function::Floor
                    | Function::Where
                    | Function::Unless,
                    ..,
                ) => Open,
                (Function::Min | Function::Max, By(first), By(last)) => {
                    if first == last {
                        By(first)
                    } else {
                        Changed
                    }
                }
                (Function::Min | Function::Max, ..) => Open,
                // Even functions, and one with two values.
                (Function::Abs | Function::Cosh | Function::Sign, of, _) => certain(of != Changed && of.changes()),
                // All others have no value twice.
                (_, of, _) => certain(of.changes()),
            },
        }
    }

    /// The parts, with their factors, whose sum must have the period. Terms and factors around them have it.
    fn open_parts(&self, e: Expression, may_change: &dyn Fn(Expression) -> bool) -> Vec<(Expression, f64)> {
        let mut whole = e;
        loop {
            let parts: Vec<(Expression, f64)> = match self.kind(whole) {
                NodeKind::Sum { terms, .. } => {
                    terms.iter().filter(|(term, _)| may_change(*term)).map(|&(term, c)| (term, c.value())).collect()
                }
                NodeKind::Product(factors) => {
                    let open: Vec<_> = factors.iter().filter(|(base, _)| may_change(*base)).collect();
                    if let [&(base, 2)] = open[..] { vec![(base, 1.0)] } else { vec![(whole, 1.0)] }
                }
                _ => vec![(whole, 1.0)],
            };
            match parts[..] {
                [(one, _)] if one != whole => whole = one,
                _ => return parts,
            }
        }
    }
}

/// The rounding of a sum of turns, beside the size of its terms.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

fn whole(turns: f64) -> bool {
    (turns - turns.round()).abs() <= ROUNDING * turns.abs()
}
