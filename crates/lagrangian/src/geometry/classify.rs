use crate::linear::Lu;
use crate::{
    Constraint, Dependence, RowSpace, Rows, Scalar, SeldomNumber, System, from_fn, mapped, mass_matrix, position_rows,
    reaction_rows,
};

/// What a row of a constraint is at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// `A v = 0`.
    Linear,
    /// `A v + b = 0`, where `b` or one of its derivatives is not zero.
    Affine,
    /// The rate of a function of the positions, as [`System::holonomic`] says.
    Position,
    /// `phi(t, q, v) = 0`, as [`System::nonlinear`] says.
    Nonlinear,
}

/// What the constraints of a system are at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Classification<const M: usize> {
    /// What each row is.
    pub kinds: [RowKind; M],
    /// How many rows are independent.
    pub rank: usize,
    /// Which rows depend on which.
    pub dependence: Dependence<M>,
    /// Whether the rank is the same nearby, to first order. It drops at the point where this is false.
    pub regular: bool,
    /// Whether rows that depend on one another ask for the same.
    pub consistent: bool,
    /// How many dimensions the brackets `[X, Y]` of admissible velocity fields add to the admissible velocities, time
    /// counted as a coordinate; none where the rows that are affine are integrable.
    pub brackets: usize,
    /// Rows of [`RowKind::Position`] that are not the rates of their functions: an error of the system.
    pub mismatched: Rows,
}

impl<const M: usize> Classification<M> {
    /// Whether the admissible velocities are those along leaves `g(q, t) = const` (Frobenius).
    ///
    /// A statement about the point: where the rank drops, or where the brackets vanish at a point alone, it does not hold
    /// nearby.
    #[must_use]
    pub fn integrable(&self) -> bool {
        self.brackets == 0 && !self.kinds.contains(&RowKind::Nonlinear)
    }
}

/// Says what the constraints of a system are at a point: their kinds, their rank, which depend on which, and by the brackets
/// of admissible fields whether they are integrable.
///
/// With the rows as one-forms `alpha_k = A_k dq + b_k dt` the brackets are `alpha_k([X, Y]) = -d alpha_k(X, Y)` on admissible
/// `X`, `Y`. (Bloch 2015, Nonholonomic Mechanics and Control, section 2.5; Frobenius 1877.) Derivatives are automatic;
/// values below the rounding of their terms count as zero.
#[must_use]
pub fn classify<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Classification<M> {
    let space = row_space(system, t, q, v, RowSpace::<N, M>::ROUNDING);
    let kinds = kinds(system, t, q, v);
    Classification {
        kinds,
        rank: space.rank(),
        dependence: *space.dependence(),
        regular: rank_is_constant(system, t, q, v, &space),
        consistent: rows_are_consistent(system, t, q, v, space.dependence()),
        brackets: brackets(system, t, q, &kinds, &space),
        mismatched: mismatched(system, t, q),
    }
}

/// The span of the rows along which the constraints act, in the kinetic metric.
#[must_use]
pub fn row_space<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    tolerance: f64,
) -> RowSpace<N, M> {
    let (_, mass) = mass_matrix(system, t, q, v);
    RowSpace::new(&reaction_rows(system, t, q, v), &mass, tolerance)
}

/// Independent rows that imply the others, where rows depend on one another, do so nearby, and agree; none elsewhere.
#[cold]
#[inline(never)]
#[must_use]
pub fn redundant_rows<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Option<Rows> {
    let space = row_space::<_, N, M>(system, t, q, v, RowSpace::<N, M>::ROUNDING);
    let found = space.dependence();
    let redundant =
        space.rank() < M && rank_is_constant(system, t, q, v, &space) && rows_are_consistent(system, t, q, v, found);
    redundant.then_some(found.independent)
}

/// Whether the rank of the constraint is the same nearby, to first order: a combination of rows that vanishes at the point
/// has derivatives within the span.
#[must_use]
pub fn rank_is_constant<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    space: &RowSpace<N, M>,
) -> bool {
    let fixed_v = mapped(v, SeldomNumber::fixed);
    // Along time, and along one coordinate after another.
    stay_within(space, &reaction_rows(system, SeldomNumber::moving(t, 1.0), &mapped(q, SeldomNumber::fixed), &fixed_v))
        && (0..N).all(|j| {
            let in_q = SeldomNumber::along_one(q, j);
            stay_within(space, &reaction_rows(system, SeldomNumber::fixed(t), &in_q, &fixed_v))
        })
}

/// Whether the vanishing combinations of rows have rates within the span.
fn stay_within<const N: usize, const M: usize>(space: &RowSpace<N, M>, rows: &[[SeldomNumber; N]; M]) -> bool {
    let Dependence { independent, combination, .. } = space.dependence();
    (0..M).filter(|k| !independent.contains(*k)).all(|k| {
        let mut sum = mapped(&rows[k], SeldomNumber::rate);
        let (_, mut terms) = space.outside(&sum);
        for l in independent.iter() {
            let part = mapped(&rows[l], |a| a.rate() * combination[k][l]);
            sum = from_fn(|i| sum[i] - part[i]);
            terms += space.outside(&part).1;
        }
        space.outside(&sum).0 <= RowSpace::<N, M>::ROUNDING * terms
    })
}

/// Whether rows that depend on one another ask for the same: with the rows also the `b` are combined.
#[must_use]
pub fn rows_are_consistent<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    dependence: &Dependence<M>,
) -> bool {
    // A row that is not affine asks for its value at the velocity.
    let (_, mut b) = system.constraint(t, q);
    if let Some(phi) = system.nonlinear(t, q, v) {
        b = from_fn(|k| phi[k].unwrap_or(b[k]));
    }
    // Of what the values are sums, the velocity tells more than they do themselves.
    let rows = reaction_rows(system, t, q, v);
    let size = |k: usize| (0..N).fold(f64::abs(b[k]), |sum, i| sum + (rows[k][i] * v[i]).abs());
    (0..M).filter(|k| !dependence.independent.contains(*k)).all(|k| {
        let (mut sum, mut terms) = (b[k], size(k));
        for l in dependence.independent.iter() {
            let weight = dependence.combination[k][l];
            sum -= weight * b[l];
            terms += weight.abs() * size(l);
        }
        sum.abs() <= RowSpace::<N, M>::ROUNDING * terms
    })
}

fn kinds<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> [RowKind; M] {
    let g = system.holonomic(t, q).unwrap_or([None; M]);
    let phi = system.nonlinear(t, q, v).unwrap_or([None; M]);
    let RowsInPlace { b, b_q, .. } = RowsInPlace::at(system, t, q);
    let (_, later) = system.constraint(SeldomNumber::moving(t, 1.0), &mapped(q, SeldomNumber::fixed));
    from_fn(|k| match (phi[k], g[k]) {
        (Some(_), _) => RowKind::Nonlinear,
        (None, Some(_)) => RowKind::Position,
        _ if b[k] == 0.0 && b_q[k].iter().all(|x| *x == 0.0) && later[k].is_zero() => RowKind::Linear,
        _ => RowKind::Affine,
    })
}

fn mismatched<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N]) -> Rows {
    let Some(g) = system.holonomic(t, q) else { return Rows::none() };
    let ((a, b), (expected, rate)) = (system.constraint(t, q), position_rows(system, t, q));
    let far = |x: f64, y: f64, size: f64| (x - y).abs() > RowSpace::<N, M>::ROUNDING * size;
    (0..M)
        .filter(|k| {
            let size = crate::linear::largest(&a[*k]).max(crate::linear::largest(&expected[*k]));
            let rates = b[*k].abs().max(rate[*k].abs());
            g[*k].is_some() && ((0..N).any(|i| far(a[*k][i], expected[*k][i], size)) || far(b[*k], rate[*k], rates))
        })
        .collect()
}

/// A constraint with its derivatives in the coordinates.
struct RowsInPlace<const N: usize, const M: usize> {
    a: [[f64; N]; M],
    b: [f64; M],
    /// `dA_k/dq`, row `i` the derivatives of `A_ki`; not in an array, which of many coordinates would fill a stack.
    a_q: Vec<[[f64; N]; N]>,
    b_q: [[f64; N]; M],
}

impl<const N: usize, const M: usize> RowsInPlace<N, M> {
    fn at<Sys: System<N, M>>(system: &Sys, t: f64, q: &[f64; N]) -> Self {
        let (a, b) = system.constraint(t, q);
        let mut all = Self { a, b, a_q: vec![[[0.0; N]; N]; M], b_q: [[0.0; N]; M] };
        for j in 0..N {
            let (a, b) = system.constraint(SeldomNumber::fixed(t), &SeldomNumber::along_one(q, j));
            for k in 0..M {
                all.b_q[k][j] = b[k].rate();
                for i in 0..N {
                    all.a_q[k][i][j] = a[k][i].rate();
                }
            }
        }
        all
    }
}

/// The rank of the two-forms `d alpha_k` on pairs of admissible fields, `(0, w)` and `(1, v_b)` in time and space.
fn brackets<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    kinds: &[RowKind; M],
    space: &RowSpace<N, M>,
) -> usize {
    let RowsInPlace { a, b, a_q: in_q, b_q } = RowsInPlace::at(system, t, q);
    let (in_t, _) = system.constraint(SeldomNumber::moving(t, 1.0), &mapped(q, SeldomNumber::fixed));
    let here: Constraint<f64, N, M> = (a, b);
    let rows: Vec<usize> = space.dependence().independent.iter().filter(|k| kinds[*k] != RowKind::Nonlinear).collect();
    let drift = particular(&here, &rows);
    let kernel = space.kernel();
    let fields = &kernel[..N - space.rank()];
    let mut forms: Vec<Vec<f64>> = Vec::new();
    for &k in &rows {
        let mut form = Vec::new();
        for (a, y) in fields.iter().enumerate() {
            // d alpha (X, w) for X another field, and for X = (1, v_b).
            let others = fields[..a].iter().map(|x| (0.0, x)).chain([(1.0, &drift)]);
            for (time, x) in others {
                let (mut sum, mut terms) = (0.0, 0.0);
                let mut add = |part: f64| {
                    sum += part;
                    terms += part.abs();
                };
                for i in 0..N {
                    for j in 0..N {
                        // (dA_j/dq_i - dA_i/dq_j) x_i y_j.
                        add(in_q[k][j][i] * x[i] * y[j]);
                        add(-in_q[k][i][j] * x[i] * y[j]);
                    }
                    add(time * in_t[k][i].rate() * y[i]);
                    add(-time * b_q[k][i] * y[i]);
                }
                form.push(if f64::abs(sum) <= RowSpace::<N, M>::ROUNDING * terms { 0.0 } else { sum });
            }
        }
        forms.push(form);
    }
    rank(forms)
}

/// The shortest velocity with `A v + b = 0` in the given rows, which are independent.
fn particular<const N: usize, const M: usize>((a, b): &Constraint<f64, N, M>, rows: &[usize]) -> [f64; N] {
    let gram: [[f64; M]; M] = from_fn(|k| {
        from_fn(|l| match rows.contains(&k) && rows.contains(&l) {
            true => (0..N).map(|i| a[k][i] * a[l][i]).sum(),
            false => f64::from(u8::from(k == l)),
        })
    });
    let right: [f64; M] = from_fn(|k| if rows.contains(&k) { -b[k] } else { 0.0 });
    let eta = Lu::new(gram).map_or([0.0; M], |lu| lu.solve(right));
    from_fn(|i| rows.iter().map(|k| a[*k][i] * eta[*k]).sum())
}

/// The rank of a few rows, each relative to its own size, to half of the digits.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let size = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
    for row in &mut rows {
        let size = size(row);
        row.iter_mut().for_each(|x| *x /= if size > 0.0 { size } else { 1.0 });
    }
    let mut rank = 0;
    while let Some(best) = (0..rows.len()).max_by(|i, j| size(&rows[*i]).total_cmp(&size(&rows[*j]))) {
        let axis = rows.swap_remove(best);
        let length = size(&axis);
        if length <= f64::EPSILON.sqrt() {
            break;
        }
        rank += 1;
        for row in &mut rows {
            let along: f64 = row.iter().zip(&axis).map(|(x, y)| x * y).sum::<f64>() / (length * length);
            row.iter_mut().zip(&axis).for_each(|(x, y)| *x -= along * y);
        }
    }
    rank
}
