#![allow(clippy::float_cmp, reason = "a side is -1, 0 or 1")]

use crate::graph::NodeKind;
use crate::interval::{Interval, sign};
use crate::{Error, Expression, Function, Graph, Tape};
use std::collections::HashMap;

/// The times at which `abs`, `sign`, `min`, `max` and choices of time turn from one side to the other, in some expressions.
///
/// Between two of them the expressions are smooth, and each such function has a side: the sign of its argument, or of `a - b` for
/// `min(a, b)` and `max(a, b)`. [`Corners::of`] writes the expressions with variables for the sides, so that all pieces have the same
/// formulas.
///
/// ```
/// use expression::{Corners, Graph, Names, parse};
/// let names = Names::of(["t"])?;
/// let mut graph = Graph::new();
/// let t = graph.variable(0);
/// let e = graph.build(&parse("max(0, 2 - t) + sign(t - 1.05)", &names)?, &[t])?;
/// let (corners, pieces) = Corners::of(&mut graph, &[e], 0, 1)?.expect("there are two");
/// assert_eq!(corners.between(0.0, 10.0).expect("they are few"), [1.05, 2.0]);
/// assert_eq!(corners.sides(1.5), [-1.0, 1.0]);
/// assert_eq!(graph.variables(pieces[0]), [0, 1, 2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Corners {
    /// The arguments and their slopes with all their parts, parts first.
    kinds: Box<[NodeKind]>,
    /// Where each argument and its slope stand there.
    arguments: Box<[[usize; 2]]>,
    tape: Tape,
}

/// Maximum number of corners in a run, and of parts of the run that are searched for them.
const MOST: usize = 100_000;
const LOOKS: usize = 10_000_000;

impl Corners {
    /// Finds the corners of some expressions in the variable `time`. Returns them with the expressions in which a variable for the side,
    /// from `first` on, replaces each corner. Returns `None` if time alone decides on no corner.
    ///
    /// # Errors
    /// [`Error::GraphFull`].
    pub fn of(
        graph: &mut Graph,
        expressions: &[Expression],
        time: u32,
        first: u32,
    ) -> Result<Option<(Self, Vec<Expression>)>, Error> {
        let (mut arguments, mut by) = (Vec::new(), HashMap::new());
        for call in graph.reached(expressions, |_| true) {
            let NodeKind::Call(function, [a, b]) = *graph.kind(call) else { continue };
            let argument = match function {
                Function::Abs | Function::Sign | Function::Where | Function::Unless => a,
                Function::Min | Function::Max => graph.difference(a, b),
                Function::Floor => {
                    let turned = graph.scaled(a, std::f64::consts::PI);
                    graph.call(Function::Sin, &[turned])
                }
                _ => continue,
            };
            if graph.variables(argument) != [time] {
                continue;
            }
            let place = arguments.iter().position(|other| *other == argument).unwrap_or(arguments.len());
            if place == arguments.len() {
                arguments.push(argument);
            }
            let side = graph.variable(first + place as u32);
            let [a, b] = [a, b].map(|part| graph.rebuilt(part, &mut by));
            let piece = match function {
                Function::Sign => side,
                Function::Abs => graph.product(&[side, a]),
                Function::Where | Function::Unless => graph.call(function, &[side, b]),
                Function::Floor => graph.floor_beside(a, side),
                _ => {
                    let (sum, difference) = (graph.sum(&[a, b]), graph.difference(a, b));
                    let turned = graph.product(&[side, difference]);
                    let turned = if function == Function::Max { turned } else { graph.negated(turned) };
                    let twice = graph.sum(&[sum, turned]);
                    graph.scaled(twice, 0.5)
                }
            };
            by.insert(call, piece);
        }
        if arguments.is_empty() {
            return Ok(None);
        }
        let pieces = expressions.iter().map(|&e| graph.rebuilt(e, &mut by)).collect();
        let slopes: Vec<Expression> = arguments.iter().map(|&e| graph.derivative(e, time)).collect();
        let reached = graph.reached(&[&arguments[..], &slopes].concat(), |_| true);
        let place = |e: Expression| reached.binary_search(&e).unwrap_or(0);
        let there = |e: Expression| Expression(place(e) as u32);
        let corners = Self {
            kinds: reached.iter().map(|&e| graph.kind(e).moved(there)).collect(),
            arguments: arguments.iter().zip(&slopes).map(|(&e, &slope)| [place(e), place(slope)]).collect(),
            tape: Tape::new(graph, &arguments)?,
        };
        Ok(Some((corners, pieces)))
    }

    /// How many sides there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.arguments.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.arguments.is_empty()
    }

    /// The sides at a time: -1, 1, or 0 where an argument vanishes.
    #[must_use]
    pub fn sides(&self, t: f64) -> Vec<f64> {
        let (mut scratch, mut sides) = (vec![0.0; self.tape.scratch()], vec![0.0; self.len()]);
        // There is room, and no variable but the time.
        let _ = self.tape.evaluate_with(|_| t, &mut scratch, |k, x| sides[k] = sign(x));
        sides
    }

    /// The times in an interval at which a side turns, in order; `None` if there are too many to find.
    #[must_use]
    pub fn between(&self, from: f64, to: f64) -> Option<Vec<f64>> {
        let mut search = Search {
            corners: self,
            values: vec![Interval::at(0.0); self.kinds.len()],
            scratch: vec![0.0; self.tape.scratch()],
            least: 1e-11 * (to - from) + 8.0 * f64::EPSILON * from.abs().max(to.abs()),
            looks: LOOKS / self.kinds.len().max(1),
        };
        let mut times = Vec::new();
        for k in 0..self.len() {
            search.turns(k, from, to, &mut times)?;
        }
        times.retain(|t| from < *t && *t < to);
        times.sort_by(f64::total_cmp);
        times.dedup_by(|b, a| *b - *a <= search.least);
        Some(times)
    }
}

/// A search for the times at which sides turn.
struct Search<'a> {
    corners: &'a Corners,
    values: Vec<Interval>,
    scratch: Vec<f64>,
    /// No shorter part of the run is looked at.
    least: f64,
    /// How often parts may still be looked at.
    looks: usize,
}

impl Search<'_> {
    /// The values of an argument and of its slope between two times.
    fn look(&mut self, k: usize, from: f64, to: f64) -> [Interval; 2] {
        for (place, kind) in self.corners.kinds.iter().enumerate() {
            self.values[place] = Interval::of(kind, |_| Interval::new(from, to), |e| self.values[e.index()]);
        }
        self.corners.arguments[k].map(|place| self.values[place])
    }

    fn side(&mut self, k: usize, t: f64) -> f64 {
        let mut side = 0.0;
        let told = |i: usize, x: f64| {
            if i == k {
                side = sign(x);
            }
        };
        let _ = self.corners.tape.evaluate_with(|_| t, &mut self.scratch, told);
        side
    }

    /// Adds the times in an interval at which a side turns; `None` if there are too many.
    fn turns(&mut self, k: usize, from: f64, to: f64, times: &mut Vec<f64>) -> Option<()> {
        let mut waiting = vec![(from, to)];
        // A part in which the argument is zero, or rounding, at least at its ends.
        let mut open: Option<(f64, f64)> = None;
        while let Some((from, to)) = waiting.pop() {
            self.looks = self.looks.checked_sub(1)?;
            let [value, slope] = self.look(k, from, to);
            if !value.has_zero() || value == Interval::at(0.0) {
                continue;
            }
            let short = to - from <= self.least;
            if slope.has_zero() && !short {
                let middle = 0.5 * (from + to);
                waiting.extend([(middle, to), (from, middle)]);
                continue;
            }
            // The argument rises, or falls, or the part is as short as a point.
            let [before, after] = [from, to].map(|t| self.side(k, t));
            let (from, to) = match (before == 0.0, after == 0.0) {
                _ if short || before.is_nan() || after.is_nan() => (from, to),
                (true, true) => (from, to),
                (true, false) => (from, self.turn(k, from, to, before)),
                (false, true) => (self.turn(k, from, to, before), to),
                (false, false) => {
                    if before != after {
                        times.push(self.turn(k, from, to, before));
                    }
                    continue;
                }
            };
            open = match open {
                Some((begin, end)) if from - end <= self.least => Some((begin, to)),
                other => {
                    self.close(k, other, times);
                    Some((from, to))
                }
            };
            if times.len() > MOST {
                return None;
            }
        }
        self.close(k, open, times);
        Some(())
    }

    /// Adds the time at which a side turns in a part in which the argument is zero or rounding, if it is another behind that part than
    /// before: an argument that touches zero does not turn.
    fn close(&mut self, k: usize, part: Option<(f64, f64)>, times: &mut Vec<f64>) {
        let Some((from, to)) = part else { return };
        let (from, to) = (from - self.least, to + self.least);
        let sides = [from, to].map(|t| match self.side(k, t) {
            // Of a zero that is rounding nothing is known.
            0.0 if self.look(k, t, t)[0] != Interval::at(0.0) => f64::NAN,
            side => side,
        });
        let [before, after] = sides;
        if before != after && !before.is_nan() && !after.is_nan() {
            times.push(self.turn(k, from, to, before));
        }
    }

    /// The first time at which the side is no longer that before.
    fn turn(&mut self, k: usize, mut from: f64, mut to: f64, before: f64) -> f64 {
        loop {
            let middle = 0.5 * (from + to);
            if middle <= from || middle >= to {
                // An argument that begins with zero turns there.
                return if before == 0.0 { from } else { to };
            }
            *(if self.side(k, middle) == before { &mut from } else { &mut to }) = middle;
        }
    }
}
