//! A basis of the admissible velocities that holds everywhere, where the constraints allow to see one.

use crate::Formulas;
use expression::{Expression, Graph, Tape};

/// How sums and products are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Written {
    /// As they come.
    Plainly,
    /// Multiplied out, so that what cancels does.
    Expanded,
    /// The shorter of the two, each by itself.
    Shorter,
}

impl Written {
    /// Products of more terms than these stay.
    const MOST: usize = 400;

    pub(crate) fn of(self, graph: &mut Graph, e: Expression) -> Expression {
        match self {
            Self::Plainly => e,
            Self::Expanded => graph.expanded(e, Self::MOST),
            Self::Shorter => {
                let expanded = graph.expanded(e, Self::MOST);
                if work(graph, &[expanded]) < work(graph, &[e]) { expanded } else { e }
            }
        }
    }
}

impl Formulas {
    /// A basis of the admissible velocities: the one that the texts give, else one that is derived. None where none is seen that holds
    /// everywhere.
    ///
    /// The vectors of the coordinates are made admissible row by row. A row whose product with a vector is a number solves for that
    /// vector, as `x' - r phi'` does for `x'`. Of a row whose products with two vectors are a sine and a cosine, as those of a blade, these two
    /// are turned: the one that the row forbids goes, the other stays.
    pub fn whole_basis(&mut self) -> Option<Vec<Vec<Expression>>> {
        self.whole_basis_as(Written::Plainly)
    }

    pub(crate) fn whole_basis_as(&mut self, written: Written) -> Option<Vec<Vec<Expression>>> {
        let n = self.n;
        if let Some(given) = &self.basis {
            return Some(given.chunks(n).map(<[Expression]>::to_vec).collect());
        }
        let (zero, one) = (self.graph.constant(0.0), self.graph.constant(1.0));
        let mut vectors: Vec<Vec<Expression>> =
            (0..n).map(|k| (0..n).map(|i| if i == k { one } else { zero }).collect()).collect();
        let first_parameter = self.parameter(0);
        for row in 0..self.m {
            let row = &self.rows[row * n..(row + 1) * n];
            let graph = &mut self.graph;
            let across: Vec<Expression> = vectors
                .iter()
                .map(|w| {
                    let across = dot(graph, row, w);
                    written.of(graph, across)
                })
                .collect();
            vectors = solved(graph, first_parameter, &across, &vectors).or_else(|| turned(graph, &across, &vectors))?;
        }
        for e in vectors.iter_mut().flatten() {
            *e = written.of(&mut self.graph, *e);
        }
        Some(vectors)
    }
}

/// The vectors without one along which the row is a number, and along which the others are corrected.
fn solved(
    graph: &mut Graph,
    first_parameter: u32,
    across: &[Expression],
    vectors: &[Vec<Expression>],
) -> Option<Vec<Vec<Expression>>> {
    // Rather a number than a product of parameters.
    let fixed = |graph: &Graph, e: Expression| graph.value(e).is_some_and(|x| x != 0.0);
    let known = |graph: &Graph, e: Expression| {
        graph.value(e) != Some(0.0) && graph.variables(e).iter().all(|&k| k >= first_parameter)
    };
    let pivot =
        across.iter().position(|&e| fixed(graph, e)).or_else(|| across.iter().position(|&e| known(graph, e)))?;
    let mut rest = Vec::new();
    for (k, vector) in vectors.iter().enumerate().filter(|(k, _)| *k != pivot) {
        let factor = graph.quotient(across[k], across[pivot]);
        rest.push(less(graph, vector, factor, &vectors[pivot]));
    }
    Some(rest)
}

/// The vectors with two turned in their plane, one of which goes.
fn turned(graph: &mut Graph, across: &[Expression], vectors: &[Vec<Expression>]) -> Option<Vec<Vec<Expression>>> {
    for i in 0..across.len() {
        for j in i + 1..across.len() {
            if [i, j].iter().any(|&k| graph.value(across[k]) == Some(0.0)) {
                continue;
            }
            let squares = [i, j].map(|k| graph.power(across[k], 2.0));
            let square = graph.sum(&squares);
            if !graph.value(square).is_some_and(|x| x > 0.0) {
                continue;
            }
            let pair = |graph: &mut Graph, a: Expression, b: Expression| -> Vec<Expression> {
                (0..vectors[i].len())
                    .map(|k| {
                        let terms = [graph.product(&[a, vectors[i][k]]), graph.product(&[b, vectors[j][k]])];
                        graph.sum(&terms)
                    })
                    .collect()
            };
            let opposite = graph.negated(across[i]);
            let (along, forbidden) = (pair(graph, across[j], opposite), pair(graph, across[i], across[j]));
            let mut rest = vec![along];
            for k in (0..vectors.len()).filter(|k| *k != i && *k != j) {
                let factor = graph.quotient(across[k], square);
                rest.push(less(graph, &vectors[k], factor, &forbidden));
            }
            return Some(rest);
        }
    }
    None
}

/// `a - factor b`.
fn less(graph: &mut Graph, a: &[Expression], factor: Expression, b: &[Expression]) -> Vec<Expression> {
    a.iter()
        .zip(b)
        .map(|(&a, &b)| {
            let term = graph.product(&[factor, b]);
            graph.difference(a, term)
        })
        .collect()
}

/// How much an evaluation takes, in operations; an angle takes as much as some twenty.
pub(crate) fn work(graph: &Graph, all: &[Expression]) -> usize {
    Tape::new(graph, all).map_or(usize::MAX, |tape| tape.cost().total() + 20 * tape.cost().angles)
}

/// The product of two vectors.
pub(crate) fn dot(graph: &mut Graph, a: &[Expression], b: &[Expression]) -> Expression {
    let terms: Vec<Expression> = a.iter().zip(b).map(|(&a, &b)| graph.product(&[a, b])).collect();
    graph.sum(&terms)
}
