//! The equations of motion in a basis of the admissible velocities.

use super::Formulas;
use super::basis::{Written, dot, work};
use crate::{Expression, Graph};

/// The equations of motion in a basis of the admissible velocities, `q' = W xi + v_b` and `xi' = f(t, q, xi)`.
///
/// The quasi-velocity `k` has the variable of the rate of coordinate `k`.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedFormulas {
    /// The vectors of the basis.
    pub basis: Vec<Vec<Expression>>,
    /// The rates of the coordinates.
    pub velocity: Vec<Expression>,
    /// The accelerations of the quasi-velocities.
    pub acceleration: Vec<Expression>,
    /// Number of quadratures that give the configuration from the quasi-velocities over time; `None` if they do not suffice.
    pub reconstruction: Option<u32>,
    /// Whether the accelerations depend on neither time nor configuration.
    pub stands_alone: bool,
}

impl Formulas {
    /// The reduced equations in a basis that holds everywhere (book, (1.5)), if there is one:
    /// `W' L_vv W xi' = W' (L_q + F - d/dt L_v at frozen xi)`, solved symbolically.
    ///
    /// They are written in several ways, with products as they arise or multiplied out; the shortest is taken.
    pub fn reduced(&mut self) -> Option<ReducedFormulas> {
        let mut best: Option<(usize, ReducedFormulas)> = None;
        for of_basis in [Written::Expanded, Written::Plainly] {
            for written in [Written::Shorter, Written::Expanded, Written::Plainly] {
                let Some(reduced) = self.reduced_as(of_basis, written) else { continue };
                let all = [reduced.velocity.clone(), reduced.acceleration.clone()].concat();
                let work = work(&self.graph, &all);
                if best.as_ref().is_none_or(|(least, _)| work < *least) {
                    best = Some((work, reduced));
                }
            }
        }
        Some(best?.1)
    }

    fn reduced_as(&mut self, of_basis: Written, written: Written) -> Option<ReducedFormulas> {
        let basis = self.whole_basis_as(of_basis)?;
        self.reduced_along(basis, written)
    }

    /// The reduced equations in a basis of the admissible velocities, each entry written in its shorter way: quicker to derive than the
    /// shortest of [`reduced`](Self::reduced). Returns `None` if they are too large. A run waits for the derivation; without it,
    /// evaluating the equations by numbers makes a step a few times as long.
    pub fn reduced_in(&mut self, basis: Vec<Vec<Expression>>) -> Option<ReducedFormulas> {
        /// The terms and factors of a derivation of about a second.
        const MOST: usize = 320_000;
        self.graph.set_limit(MOST);
        self.reduced_along(basis, Written::Shorter)
    }

    /// The velocity `W xi + v_b` in a basis of the admissible velocities; `None` if its formulas are too large.
    pub fn velocity_in(&mut self, basis: &[Vec<Expression>]) -> Option<Vec<Expression>> {
        let velocity = self.velocity(basis);
        self.graph.check().ok()?;
        Some(velocity)
    }

    /// The rates of the coordinates, with the quasi-velocities in the variables of rates.
    fn velocity(&mut self, basis: &[Vec<Expression>]) -> Vec<Expression> {
        let (rates, shift) = (self.rates(), self.shift());
        let graph = &mut self.graph;
        let xi: Vec<Expression> = rates[..basis.len()].iter().map(|&k| graph.variable(k)).collect();
        let column = |i: usize| basis.iter().map(|w| w[i]).collect::<Vec<_>>();
        (0..self.n)
            .map(|i| {
                let along = dot(graph, &column(i), &xi);
                graph.sum(&[along, shift[i]])
            })
            .collect()
    }

    fn reduced_along(&mut self, basis: Vec<Vec<Expression>>, written: Written) -> Option<ReducedFormulas> {
        let n = self.n;
        let rates = self.rates();
        let places: Vec<u32> = (0..n).map(|i| self.coordinate(i)).collect();
        let v = self.velocity(&basis);
        let graph = &mut self.graph;
        let at: Vec<(u32, Expression)> = rates.iter().copied().zip(v.iter().copied()).collect();
        let turning: Vec<Expression> = v.iter().map(|&v_i| rate(graph, v_i, &places, &v)).collect();

        let momenta = graph.gradient(self.lagrangian, &rates);
        let slopes = graph.gradient(self.lagrangian, &places);
        let mut balance = Vec::new();
        let mut mass = Vec::new();
        for i in 0..n {
            let row: Vec<Expression> = graph.gradient(momenta[i], &rates);
            let row: Vec<Expression> = row.into_iter().map(|e| graph.substitute(e, &at)).collect();
            // The momentum's rate at frozen velocity, and by the turning of the velocity.
            let transport: Vec<Expression> =
                graph.gradient(momenta[i], &places).into_iter().map(|e| graph.substitute(e, &at)).collect();
            let by_time = graph.derivative(momenta[i], 0);
            let by_time = graph.substitute(by_time, &at);
            let (moved, turned) = (dot(graph, &transport, &v), dot(graph, &row, &turning));
            let change = graph.sum(&[by_time, moved, turned]);
            let mut push = graph.substitute(slopes[i], &at);
            if let Some(force) = &self.force {
                let force = graph.substitute(force[i], &at);
                push = graph.sum(&[push, force]);
            }
            balance.push(graph.difference(push, change));
            mass.push(row);
        }
        let right: Vec<Expression> = basis
            .iter()
            .map(|w| {
                let right = dot(graph, w, &balance);
                written.of(graph, right)
            })
            .collect();
        let matrix: Vec<Vec<Expression>> = basis
            .iter()
            .map(|w| {
                let row: Vec<Expression> = (0..n)
                    .map(|j| {
                        let column: Vec<Expression> = mass.iter().map(|row| row[j]).collect();
                        dot(graph, &column, w)
                    })
                    .collect();
                basis
                    .iter()
                    .map(|other| {
                        let entry = dot(graph, &row, other);
                        written.of(graph, entry)
                    })
                    .collect()
            })
            .collect();
        let acceleration = solve(graph, matrix, right);

        let here = |graph: &Graph, e: Expression| graph.variables(e).into_iter().any(|k| k <= n as u32);
        let stands_alone = acceleration.iter().all(|&e| !here(graph, e));
        let reconstruction = cascade(graph, &v, n);
        graph.check().ok()?;
        Some(ReducedFormulas { basis, velocity: v, acceleration, reconstruction, stands_alone })
    }

    /// The shortest velocity that meets the affine constraint, `v_b = -A' (A A')^-1 b`.
    fn shift(&mut self) -> Vec<Expression> {
        let (n, m) = (self.n, self.m);
        let graph = &mut self.graph;
        let zero = graph.constant(0.0);
        if self.level.iter().all(|&b| graph.value(b) == Some(0.0)) {
            return vec![zero; n];
        }
        let row = |k: usize| &self.rows[k * n..(k + 1) * n];
        let gram: Vec<Vec<Expression>> = (0..m).map(|k| (0..m).map(|l| dot(graph, row(k), row(l))).collect()).collect();
        let level: Vec<Expression> = self.level.iter().map(|&b| graph.negated(b)).collect();
        let eta = solve(graph, gram, level);
        (0..n)
            .map(|i| {
                let column: Vec<Expression> = (0..m).map(|k| row(k)[i]).collect();
                dot(graph, &column, &eta)
            })
            .collect()
    }
}

/// The rate of an expression of time and configuration along a velocity, at constant quasi-velocities.
fn rate(graph: &mut Graph, e: Expression, places: &[u32], v: &[Expression]) -> Expression {
    let slopes = graph.gradient(e, places);
    let (moved, by_time) = (dot(graph, &slopes, v), graph.derivative(e, 0));
    graph.sum(&[moved, by_time])
}

/// The solution of equations with a symmetric positive matrix, by elimination without pivots.
fn solve(graph: &mut Graph, mut matrix: Vec<Vec<Expression>>, mut right: Vec<Expression>) -> Vec<Expression> {
    let k = right.len();
    for p in 0..k {
        for i in p + 1..k {
            let factor = graph.quotient(matrix[i][p], matrix[p][p]);
            for j in p + 1..k {
                let term = graph.product(&[factor, matrix[p][j]]);
                matrix[i][j] = graph.difference(matrix[i][j], term);
            }
            let term = graph.product(&[factor, right[p]]);
            right[i] = graph.difference(right[i], term);
        }
    }
    for p in (0..k).rev() {
        for j in p + 1..k {
            let term = graph.product(&[matrix[p][j], right[j]]);
            right[p] = graph.difference(right[p], term);
        }
        right[p] = graph.quotient(right[p], matrix[p][p]);
    }
    right
}

/// Number of quadratures that give all coordinates; `None` if rates of coordinates depend on one another in a circle.
fn cascade(graph: &Graph, v: &[Expression], n: usize) -> Option<u32> {
    let needs: Vec<Vec<usize>> = v
        .iter()
        .map(|&v| {
            graph.variables(v).into_iter().filter(|&k| (1..=n as u32).contains(&k)).map(|k| k as usize - 1).collect()
        })
        .collect();
    let mut after: Vec<Option<u32>> = vec![None; n];
    for quadratures in 0..=n as u32 {
        let ready: Vec<usize> = (0..n)
            .filter(|&i| after[i].is_none() && needs[i].iter().all(|&j| after[j].is_some_and(|k| k < quadratures)))
            .collect();
        for i in ready {
            after[i] = Some(quadratures);
        }
    }
    after.into_iter().collect::<Option<Vec<u32>>>()?.into_iter().max()
}
