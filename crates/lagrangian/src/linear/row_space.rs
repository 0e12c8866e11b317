use crate::linear::dot;
use crate::{Rows, from_fn, mapped};

/// The span of the rows of a constraint, in a metric that has no units: its dimension is their rank.
///
/// Rows are covectors, and compared by the inverse of the mass matrix where that is positive definite; elsewhere every
/// coordinate is measured by its own mass, and one without by the largest entry of its column. Each row counts relative to its own size. Orthogonal vectors
/// are found with the farthest row next, each made orthogonal twice. (Golub and Van Loan 2013, Matrix Computations,
/// sections 5.2.8 and 5.4.2.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowSpace<const N: usize, const M: usize> {
    /// `L` of the metric `L L'`, a lower triangle.
    metric: [[f64; N]; N],
    /// Orthonormal vectors, the first `rank` of them.
    axes: [[f64; N]; M],
    rank: usize,
    dependence: Dependence<M>,
}

/// Which rows depend on which.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dependence<const M: usize> {
    /// Rows that span all others, and do not depend on one another.
    pub independent: Rows,
    /// The rows of every linear dependence: those that are not independent, and those that they are made of.
    pub involved: Rows,
    /// How far the nearest row lies from the span of the others, relative to its size.
    pub distance: f64,
    /// Row `k` that is not independent is `sum_l combination[k][l] A_l` over the independent rows.
    pub combination: [[f64; M]; M],
}

impl<const N: usize, const M: usize> RowSpace<N, M> {
    /// What the rounding of a row may be, relative to its size: `N` entries, each rounded a few times, and up to `M` rows
    /// taken off.
    pub const ROUNDING: f64 = 8.0 * (N + M) as f64 * f64::EPSILON;

    /// The span of `rows`. One that lies nearer to the span of the others than `tolerance` times its size depends on them.
    #[must_use]
    pub fn new(rows: &[[f64; N]; M], mass: &[[f64; N]; N], tolerance: f64) -> Self {
        let metric = cholesky(mass).unwrap_or_else(|| by_coordinates(rows, mass));
        let mut rest = mapped(rows, |row| lowered(&metric, &row));
        let size = mapped(&rest, |row| norm(&row));
        for k in 0..M {
            if size[k] > 0.0 {
                rest[k] = mapped(&rest[k], |x| x / size[k]);
            }
        }
        let mut space = Self {
            metric,
            axes: [[0.0; N]; M],
            rank: 0,
            dependence: Dependence {
                independent: Rows::none(),
                involved: Rows::none(),
                distance: 1.0,
                combination: [[0.0; M]; M],
            },
        };
        let mut order = [0; M];
        // Row k is `sum_s parts[s][k] axes[s]`.
        let mut parts = [[0.0; M]; M];
        while let Some((next, distance)) = space.farthest(&rest) {
            space.dependence.distance = space.dependence.distance.min(distance);
            // What is not a number depends, too.
            if distance <= tolerance || distance.is_nan() {
                break;
            }
            let s = space.rank;
            order[s] = next;
            space.axes[s] = mapped(&rest[next], |x| x / distance);
            parts[s][next] += distance;
            space.rank += 1;
            space.dependence.independent = space.dependence.independent.with(next);
            for k in (0..M).filter(|k| !space.dependence.independent.contains(*k)) {
                for (part, axis) in parts.iter_mut().zip(&space.axes[..=s]) {
                    let along = dot(axis, &rest[k]);
                    part[k] += along;
                    rest[k] = from_fn(|i| rest[k][i] - along * axis[i]);
                }
            }
        }
        space.dependence.involve(&order[..space.rank], &parts, &size);
        space
    }

    /// The dimension of the span: the rank of the constraint.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Which rows depend on which.
    #[must_use]
    pub fn dependence(&self) -> &Dependence<M> {
        &self.dependence
    }

    /// The size of the part of a row outside of the span, and the size of the row, both in the metric.
    #[must_use]
    pub fn outside(&self, row: &[f64; N]) -> (f64, f64) {
        let mut rest = lowered(&self.metric, row);
        let size = norm(&rest);
        for _ in 0..2 {
            self.take_off(&mut rest);
        }
        (norm(&rest), size)
    }

    /// Velocities that no row of the span sees, orthonormal in the metric: the first `N - rank` of the array.
    #[must_use]
    pub fn kernel(&self) -> [[f64; N]; N] {
        let mut found = [[0.0; N]; N];
        let mut rest: [[f64; N]; N] = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
        for x in &mut rest {
            self.take_off(x);
            self.take_off(x);
        }
        for place in 0..N - self.rank {
            let next = (0..N).fold(0, |best, i| if norm(&rest[i]) > norm(&rest[best]) { i } else { best });
            let size = norm(&rest[next]);
            let axis = mapped(&rest[next], |x| x / size);
            for x in &mut rest {
                for _ in 0..2 {
                    let along = dot(&axis, x);
                    *x = from_fn(|i| x[i] - along * axis[i]);
                }
            }
            found[place] = axis;
        }
        mapped(&found, |z| raised(&self.metric, &z))
    }

    fn take_off(&self, x: &mut [f64; N]) {
        for axis in &self.axes[..self.rank] {
            let along = dot(axis, x);
            *x = from_fn(|i| x[i] - along * axis[i]);
        }
    }

    /// The row that is farthest from the span so far, and its distance; none when all rows are taken.
    fn farthest(&self, rest: &[[f64; N]; M]) -> Option<(usize, f64)> {
        (0..M)
            .filter(|k| !self.dependence.independent.contains(*k))
            .map(|k| (k, norm(&rest[k])))
            .reduce(|best, next| if next.1 > best.1 { next } else { best })
    }
}

impl<const M: usize> Dependence<M> {
    /// Finds what the dependent rows are made of, from the parts of all rows along the axes.
    fn involve(&mut self, order: &[usize], parts: &[[f64; M]; M], size: &[f64; M]) {
        for k in (0..M).filter(|k| !self.independent.contains(*k)) {
            self.involved = self.involved.with(k);
            let mut weights = [0.0; M];
            for s in (0..order.len()).rev() {
                let known: f64 = (s + 1..order.len()).map(|r| parts[s][order[r]] * weights[r]).sum();
                weights[s] = (parts[s][k] - known) / parts[s][order[s]];
                // Half of the digits: what is smaller is rounding.
                if weights[s].abs() > f64::EPSILON.sqrt() {
                    self.involved = self.involved.with(order[s]);
                }
                self.combination[k][order[s]] = weights[s] * size[k] / size[order[s]];
            }
        }
    }
}

/// The lower triangle `L` of `L L' = mass`; `None` if `mass` is not positive definite.
fn cholesky<const N: usize>(mass: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut l = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let rest = mass[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                if rest <= 4.0 * N as f64 * f64::EPSILON * mass[i][i] || !rest.is_finite() {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    Some(l)
}

/// The metric that measures every coordinate by its own mass, and one without by the largest entry of its column, the rows
/// scaled to one in the others.
fn by_coordinates<const N: usize, const M: usize>(rows: &[[f64; N]; M], mass: &[[f64; N]; N]) -> [[f64; N]; N] {
    let whole = |x: f64| if x > 0.0 && x.is_finite() { x } else { 1.0 };
    let massive = |i: &usize| mass[*i][*i] > 0.0 && mass[*i][*i].is_finite();
    let measured =
        |k: usize| (0..N).filter(massive).fold(0.0, |m: f64, i| m.max((rows[k][i] / mass[i][i].sqrt()).abs()));
    let column: [f64; N] = from_fn(|i| match massive(&i) {
        true => mass[i][i].sqrt(),
        false => whole((0..M).fold(0.0, |m: f64, k| m.max((rows[k][i] / whole(measured(k))).abs()))),
    });
    from_fn(|i| from_fn(|j| if i == j { column[i] } else { 0.0 }))
}

/// `L^-1 a` of a row.
fn lowered<const N: usize>(l: &[[f64; N]; N], a: &[f64; N]) -> [f64; N] {
    let mut x = *a;
    for i in 0..N {
        x[i] = (x[i] - (0..i).map(|j| l[i][j] * x[j]).sum::<f64>()) / l[i][i];
    }
    x
}

/// `L'^-1 z`, the velocity of the coordinates `z`.
fn raised<const N: usize>(l: &[[f64; N]; N], z: &[f64; N]) -> [f64; N] {
    let mut x = *z;
    for i in (0..N).rev() {
        x[i] = (x[i] - (i + 1..N).map(|j| l[j][i] * x[j]).sum::<f64>()) / l[i][i];
    }
    x
}

/// The length, scaled so that it neither overflows nor vanishes by its squares.
fn norm<const N: usize>(x: &[f64; N]) -> f64 {
    let size = crate::linear::largest(x);
    if size > 0.0 && size.is_finite() { size * x.iter().map(|x| (x / size).powi(2)).sum::<f64>().sqrt() } else { size }
}
