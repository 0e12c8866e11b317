//! A basis of the admissible velocities that holds everywhere, where the constraints allow to see one.

use super::Formulas;
use crate::{Expression, Graph, Tape};

/// How sums and products are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Written {
    /// As they arise.
    Plainly,
    /// Multiplied out, so that terms cancel.
    Expanded,
    /// The shorter of the two forms, chosen for each expression.
    Shorter,
}

impl Written {
    /// Products that would have more terms are not multiplied out.
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

/// How a row of the constraints removes one of the vectors that the earlier rows admit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowElimination {
    /// The row eliminates the vector with this number.
    Solved(usize),
    /// Two vectors are turned in their plane: the row eliminates one of the results, and the other takes the first place.
    Turned(usize, usize),
}

impl Formulas {
    /// A basis of the admissible velocities: the basis in the texts, or else a derived one. Returns `None` if none is found that holds
    /// everywhere.
    ///
    /// The coordinate vectors are made admissible row by row. If the product of a row with a vector is a number, the row eliminates this
    /// vector, as `x' - r phi'` eliminates `x'`. If the products with two vectors are a sine and a cosine, as for a blade, these two
    /// vectors are turned: one result, which the row forbids, is removed, and the other stays.
    pub fn whole_basis(&mut self) -> Option<Vec<Vec<Expression>>> {
        self.whole_basis_as(Written::Plainly)
    }

    /// The elimination of each row, if a derived basis is found that holds everywhere.
    pub fn eliminations(&mut self) -> Option<Vec<RowElimination>> {
        Some(self.seen(Written::Plainly)?.1)
    }

    /// The basis that results from these eliminations, one for each row.
    pub fn basis_by(&mut self, eliminations: &[RowElimination]) -> Vec<Vec<Expression>> {
        let mut vectors = self.coordinate_vectors();
        for (row, how) in eliminations.iter().enumerate() {
            let across = self.across(row, &vectors, Written::Plainly);
            vectors = how.applied(&mut self.graph, &across, &vectors);
        }
        vectors
    }

    pub(crate) fn whole_basis_as(&mut self, written: Written) -> Option<Vec<Vec<Expression>>> {
        if let Some(given) = &self.basis {
            return Some(given.chunks(self.n).map(<[Expression]>::to_vec).collect());
        }
        let mut vectors = self.seen(written)?.0;
        for e in vectors.iter_mut().flatten() {
            *e = written.of(&mut self.graph, *e);
        }
        Some(vectors)
    }

    /// The basis that is found, with its eliminations.
    fn seen(&mut self, written: Written) -> Option<(Vec<Vec<Expression>>, Vec<RowElimination>)> {
        let mut vectors = self.coordinate_vectors();
        let mut all = Vec::new();
        let first_parameter = self.parameter(0);
        for row in 0..self.m {
            let across = self.across(row, &vectors, written);
            let graph = &mut self.graph;
            let how = solved(graph, first_parameter, &across).or_else(|| turned(graph, &across))?;
            vectors = how.applied(graph, &across, &vectors);
            all.push(how);
        }
        Some((vectors, all))
    }

    fn coordinate_vectors(&mut self) -> Vec<Vec<Expression>> {
        let (zero, one) = (self.graph.constant(0.0), self.graph.constant(1.0));
        (0..self.n).map(|k| (0..self.n).map(|i| if i == k { one } else { zero }).collect()).collect()
    }

    /// The products of a row with vectors.
    fn across(&mut self, row: usize, vectors: &[Vec<Expression>], written: Written) -> Vec<Expression> {
        let row = &self.rows[row * self.n..(row + 1) * self.n];
        let graph = &mut self.graph;
        let product = |w: &Vec<Expression>| {
            let across = dot(graph, row, w);
            written.of(graph, across)
        };
        vectors.iter().map(product).collect()
    }
}

impl RowElimination {
    /// The remaining vectors, if the row has the products `across` with all vectors.
    fn applied(self, graph: &mut Graph, across: &[Expression], vectors: &[Vec<Expression>]) -> Vec<Vec<Expression>> {
        match self {
            Self::Solved(pivot) => {
                let mut rest = Vec::new();
                for (k, vector) in vectors.iter().enumerate().filter(|(k, _)| *k != pivot) {
                    let factor = graph.quotient(across[k], across[pivot]);
                    rest.push(less(graph, vector, factor, &vectors[pivot]));
                }
                rest
            }
            Self::Turned(i, j) => {
                let pair = |graph: &mut Graph, a: Expression, b: Expression| -> Vec<Expression> {
                    let terms = |k: usize| [(a, vectors[i][k]), (b, vectors[j][k])];
                    let all = (0..vectors[i].len()).map(|k| {
                        let terms = terms(k).map(|(factor, x)| graph.product(&[factor, x]));
                        graph.sum(&terms)
                    });
                    all.collect()
                };
                let squares = [i, j].map(|k| graph.power(across[k], 2.0));
                let (square, opposite) = (graph.sum(&squares), graph.negated(across[i]));
                let (along, forbidden) = (pair(graph, across[j], opposite), pair(graph, across[i], across[j]));
                let mut rest = vec![along];
                for k in (0..vectors.len()).filter(|k| *k != i && *k != j) {
                    let factor = graph.quotient(across[k], square);
                    rest.push(less(graph, &vectors[k], factor, &forbidden));
                }
                rest
            }
        }
    }
}

impl Formulas {
    /// The basis by elimination: each row in turn is solved for the rate of a coordinate, both numbered in `order`. The basis holds as
    /// long as no pivot vanishes. Each vector has the rate one for one free coordinate, in the order of the coordinates.
    pub fn eliminated_basis(&mut self, order: &[(usize, usize)]) -> Vec<Vec<Expression>> {
        let (n, graph) = (self.n, &mut self.graph);
        let mut a: Vec<Vec<Expression>> = self.rows.chunks(n.max(1)).map(<[Expression]>::to_vec).collect();
        for &(r, c) in order {
            let pivot = a[r][c];
            for x in &mut a[r] {
                *x = graph.quotient(*x, pivot);
            }
            let row = a[r].clone();
            for (_, other) in a.iter_mut().enumerate().filter(|(i, _)| *i != r) {
                let factor = other[c];
                *other = less(graph, other, factor, &row);
            }
        }
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        let free = (0..n).filter(|i| order.iter().all(|(_, c)| c != i));
        free.map(|i| {
            let mut vector = vec![zero; n];
            vector[i] = one;
            for &(r, c) in order {
                vector[c] = graph.negated(a[r][i]);
            }
            vector
        })
        .collect()
    }
}

/// The vector whose product with the row is a number.
fn solved(graph: &Graph, first_parameter: u32, across: &[Expression]) -> Option<RowElimination> {
    // Rather a number than a product of parameters, and of numbers the first of the largest.
    let size = |e: Expression| graph.value(e).filter(|x| *x != 0.0).map(f64::abs);
    let larger = |best: Option<(usize, f64)>, (k, x): (usize, f64)| match best {
        Some((_, most)) if most >= x => best,
        _ => Some((k, x)),
    };
    let fixed = across.iter().enumerate().filter_map(|(k, &e)| Some((k, size(e)?))).fold(None, larger);
    let known = |e: Expression| graph.value(e) != Some(0.0) && graph.variables(e).iter().all(|&k| k >= first_parameter);
    let pivot = fixed.map(|(k, _)| k).or_else(|| across.iter().position(|&e| known(e)));
    pivot.map(RowElimination::Solved)
}

/// Two vectors whose products with the row are a sine and a cosine.
fn turned(graph: &mut Graph, across: &[Expression]) -> Option<RowElimination> {
    for i in 0..across.len() {
        for j in i + 1..across.len() {
            if [i, j].iter().any(|&k| graph.value(across[k]) == Some(0.0)) {
                continue;
            }
            let squares = [i, j].map(|k| graph.power(across[k], 2.0));
            let square = graph.sum(&squares);
            if graph.value(square).is_some_and(|x| x > 0.0) {
                return Some(RowElimination::Turned(i, j));
            }
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

/// Cost of an evaluation in operations; a sine or cosine counts as some twenty.
pub(crate) fn work(graph: &Graph, all: &[Expression]) -> usize {
    Tape::new(graph, all).map_or(usize::MAX, |tape| tape.cost().total() + 20 * tape.cost().angles)
}

/// The product of two vectors.
pub(crate) fn dot(graph: &mut Graph, a: &[Expression], b: &[Expression]) -> Expression {
    let terms: Vec<Expression> = a.iter().zip(b).map(|(&a, &b)| graph.product(&[a, b])).collect();
    graph.sum(&terms)
}
