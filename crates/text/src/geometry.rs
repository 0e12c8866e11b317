//! What the constraints of a system are at its start.

use crate::{TextModel, TextStart};
use expression::formulas::Formulas;
use expression::{Expression, Graph, Tape};
use lagrangian::Pivots;
use nalgebra::DMatrix;

/// The rank of the constraints at a place, and how the directions that they admit grow by Lie brackets.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Number of independent constraints.
    pub rank: usize,
    /// The growth vector `r_1 <= r_2 <= ..` of the admissible directions at a fixed time: `r_k` is the rank of all brackets of up to `k`
    /// fields. It ends with the first rank that is the number of coordinates or does not grow, or before brackets that are too large.
    pub growth: Vec<usize>,
    /// Number of coordinates.
    pub coordinates: usize,
}

/// Maximum number of fields in a bracket.
const DEPTH: usize = 4;
/// Singular values below this fraction of the largest count as zero: exact derivatives leave rounding.
const TOLERANCE: f64 = 1e-10;
/// Maximum number of brackets.
const MOST: usize = 400;

impl Geometry {
    /// Whether the constraints can be integrated to constraints on positions, in words.
    #[must_use]
    pub fn integrability(&self) -> String {
        match (self.growth.first(), self.growth.get(1)) {
            (Some(first), Some(second)) if second > first => "no: the constraints are nonholonomic".to_owned(),
            (Some(&first), None) if first == self.coordinates => "yes: nothing is constrained".to_owned(),
            (Some(_), Some(_)) => "yes, at the start: brackets of admissible directions are admissible".to_owned(),
            _ => "not known: the brackets of admissible directions are too large".to_owned(),
        }
    }

    /// The growth vector in words.
    #[must_use]
    pub fn growth_told(&self) -> String {
        let numbers: Vec<String> = self.growth.iter().map(ToString::to_string).collect();
        let whole = match self.growth.last() {
            Some(&last) if last == self.coordinates => ": every place nearby is reached",
            _ => "",
        };
        format!("({}){whole}", numbers.join(", "))
    }
}

impl TextModel {
    /// The geometry of the constraints at a start.
    #[must_use]
    pub fn geometry(&self, start: &TextStart) -> Geometry {
        let n = self.coordinates.len();
        let (rows, _) = self.rows_at(0.0, &start.q);
        let rank = rank(&rows);
        let mut formulas = Formulas::clone(&self.formulas);
        let basis: Vec<Field> = match &formulas.basis {
            Some(given) => given.chunks(n).map(<[Expression]>::to_vec).collect(),
            None => {
                let pivots: Vec<_> = Pivots::best(&rows, &self.sizes(0.0, &start.q)).order().collect();
                formulas.eliminated_basis(&pivots)
            }
        };
        let mut fields = Fields { graph: formulas.graph, n, q: &start.q };
        Geometry { rank, growth: fields.growth(&basis), coordinates: n }
    }
}

fn rank(a: &DMatrix<f64>) -> usize {
    if a.is_empty() || !a.iter().all(|x| x.is_finite()) {
        return 0;
    }
    let values = a.clone().singular_values();
    values.iter().filter(|&&value| value > TOLERANCE * values.amax()).count()
}

/// Vector fields as formulas.
struct Fields<'a> {
    graph: Graph,
    n: usize,
    q: &'a [f64],
}

type Field = Vec<Expression>;

impl Fields<'_> {
    /// The Lie bracket `[X, Y] = DY X - DX Y`.
    fn bracket(&mut self, x: &[Expression], y: &[Expression]) -> Field {
        let graph = &mut self.graph;
        let along = |graph: &mut Graph, f: Expression, x: &[Expression]| {
            let terms: Vec<Expression> = x
                .iter()
                .enumerate()
                .map(|(j, &x)| {
                    let slope = graph.derivative(f, 1 + j as u32);
                    graph.product(&[slope, x])
                })
                .collect();
            graph.sum(&terms)
        };
        (0..self.n)
            .map(|i| {
                let (ahead, back) = (along(graph, y[i], x), along(graph, x[i], y));
                graph.difference(ahead, back)
            })
            .collect()
    }

    /// The values of fields, one in each column; `None` if they are too large or not finite.
    fn values(&self, fields: &[Field]) -> Option<DMatrix<f64>> {
        self.graph.check().ok()?;
        let tape = Tape::new(&self.graph, &fields.concat()).ok()?;
        let mut values = DMatrix::zeros(self.n, fields.len());
        let mut scratch = vec![0.0; tape.scratch()];
        let input = |k: usize| if k == 0 { 0.0 } else { self.q.get(k - 1).copied().unwrap_or(0.0) };
        tape.evaluate_with(input, &mut scratch, |k, x| values[(k % self.n, k / self.n)] = x).ok()?;
        values.iter().all(|x: &f64| x.is_finite()).then_some(values)
    }

    fn growth(&mut self, basis: &[Field]) -> Vec<usize> {
        let mut growth = Vec::new();
        let (mut all, mut last) = (basis.to_vec(), basis.to_vec());
        for depth in 1..=DEPTH {
            let Some(values) = self.values(&all) else { break };
            let dimension = rank(&values);
            let stopped = growth.last() == Some(&dimension);
            growth.push(dimension);
            if dimension == self.n || stopped || depth == DEPTH || basis.len() * last.len() > MOST {
                break;
            }
            let mut longer = Vec::new();
            for (i, x) in basis.iter().enumerate() {
                for (j, y) in last.iter().enumerate() {
                    // Of two single fields one order is enough.
                    if depth > 1 || i < j {
                        longer.push(self.bracket(x, y));
                    }
                }
            }
            all.extend(longer.iter().cloned());
            last = longer;
        }
        growth
    }
}
