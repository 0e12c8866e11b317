use crate::start::least;
use crate::tapes::{TapePoint, Tapes};
use crate::{FREE, Family, TextStart};
use lagrangian::{Dual, from_fn};
use nalgebra::{DMatrix, DVector};

/// Which number of a system or of its start varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Varied {
    /// The coordinate of that place at the start.
    Coordinate(usize),
    /// Its rate.
    Rate(usize),
    /// A free parameter of a [`Family`], by its place.
    Parameter(usize),
}

/// A number with its derivative in one direction.
type Along = Dual<f64, 1>;

/// Residuals of variations that are larger, beside their terms, say that too little may move.
const MET: f64 = 1e-8;

impl Family {
    /// The derivative of a start, coordinates and rates, in one number: how the admissible state moves that is nearest to the numbers
    /// given.
    ///
    /// As in [`TextModel::start`](crate::TextModel::start) numbers that are left out move before those that are given. Rates that are left
    /// out have the derivative of the smallest that meet the constraints; coordinates that are left out move as little as they can. Where
    /// the constraints did not admit the numbers given, the derivative is that at the state that was taken.
    #[must_use]
    pub fn start_along(&self, start: &TextStart, varied: Varied) -> (Vec<f64>, Vec<f64>) {
        let n = start.q.len();
        let unit = |place: Option<usize>| DVector::from_fn(n, |i, _| f64::from(u8::from(Some(i) == place)));
        let (place, rate, parameter) = match varied {
            Varied::Coordinate(i) => (Some(i), None, None),
            Varied::Rate(i) => (None, Some(i), None),
            Varied::Parameter(k) => (None, None, Some(k)),
        };
        let p = from_fn(|k| along(self.values[k], f64::from(u8::from(Some(k) == parameter))));
        let free =
            |left_out: &[bool], given| -> Vec<usize> { (0..n).filter(|&i| left_out[i] && Some(i) != given).collect() };
        let dq = self.places_along(start, unit(place), &free(&start.left_out[0], place), &p);
        let dv = self.rates_along(start, (&dq, unit(rate)), &free(&start.left_out[1], rate), &p);
        (dq.as_slice().to_vec(), dv.as_slice().to_vec())
    }

    /// How the coordinates move when some of them are given the variation `dq`.
    fn places_along(&self, start: &TextStart, dq: DVector<f64>, left_out: &[usize], p: &[Along; FREE]) -> DVector<f64> {
        let (n, m) = (start.q.len(), self.member.positions);
        if m == 0 {
            return dq;
        }
        let q: Vec<Along> = start.q.iter().zip(&dq).map(|(q, dq)| along(*q, *dq)).collect();
        // Along the given variation: the rates of the functions are what the others have to take back.
        let rates = derivatives(&self.free.holonomic, n, (&q, &[], p), m);
        let (a, _) = self.member.rows_at(0.0, &start.q);
        let a = a.rows(self.member.velocities, m).into_owned();
        let mass = self.member.mass_at(0.0, &start.q, &vec![0.0; n]);
        let all: Vec<usize> = (0..n).collect();
        for moving in [left_out, &all] {
            let (part, metric) = (a.select_columns(moving), mass.select_columns(moving).select_rows(moving));
            let Some(change) = least(&part, &metric, &-&rates) else { continue };
            if (&part * &change + &rates).amax() <= MET * rates.amax() || moving.len() == n {
                let mut moved = dq;
                moving.iter().zip(&change).for_each(|(&i, change)| moved[i] += change);
                return moved;
            }
        }
        dq
    }

    /// How the rates move when the coordinates have the variation `dq`, and some rates are given the variation `dv`.
    fn rates_along(
        &self,
        start: &TextStart,
        (dq, dv): (&DVector<f64>, DVector<f64>),
        left_out: &[usize],
        p: &[Along; FREE],
    ) -> DVector<f64> {
        let (n, m) = (start.q.len(), self.member.constraints());
        if m == 0 {
            return dv;
        }
        let q: Vec<Along> = start.q.iter().zip(dq).map(|(q, dq)| along(*q, *dq)).collect();
        let turning = derivatives(&self.free.constraint, n, (&q, &[], p), n * m + m);
        let da = DMatrix::from_fn(m, n, |i, j| turning[i * n + j]);
        let db = turning.rows(n * m, m).into_owned();
        let (a, _) = self.member.rows_at(0.0, &start.q);
        let v = DVector::from_column_slice(&start.v);
        // `A dv` is to be this less.
        let missing = -(&da * &v + &db + &a * &dv);

        let first = DVector::from_fn(n, |i, _| if start.left_out[1][i] { 0.0 } else { start.v[i] });
        let mass = self.member.mass_at(0.0, &start.q, first.as_slice());
        if !left_out.is_empty() {
            let seeded: Vec<Along> = first.iter().map(|v| along(*v, 0.0)).collect();
            let changes = derivatives(&self.free.mass, n, (&q, &seeded, p), n * n + n);
            let size = |i: usize| (mass[(i, i)], changes[i * n + i]);
            let each = left_out.iter().all(|&i| size(i).0 > 0.0);
            let sizes: Vec<(f64, f64)> = left_out.iter().map(|&i| if each { size(i) } else { (1.0, 0.0) }).collect();
            let (part, dpart) = (a.select_columns(left_out), da.select_columns(left_out));
            let u = DVector::from_iterator(left_out.len(), left_out.iter().map(|&i| v[i]));
            if let Some(change) = smallest_along((&part, &dpart), &sizes, &u, &missing)
                && (&part * &change - &missing).amax() <= MET * (missing.amax() + part.amax() * change.amax())
            {
                let mut moved = dv;
                left_out.iter().zip(&change).for_each(|(&i, change)| moved[i] += change);
                return moved;
            }
        }
        let change = least(&a, &mass, &missing).unwrap_or_else(|| DVector::zeros(n));
        dv + change
    }
}

/// How the shortest solution `u` of `A u = r` moves with `A`, `r` and the metric: of `W u = A' mu` and `A u = r`, where `missing` is
/// `dr - dA u`, and the metric is diagonal, `sizes` being its entries with their changes.
fn smallest_along(
    (a, da): (&DMatrix<f64>, &DMatrix<f64>),
    sizes: &[(f64, f64)],
    u: &DVector<f64>,
    missing: &DVector<f64>,
) -> Option<DVector<f64>> {
    let (m, k) = a.shape();
    // In `w = W^(1/2) u` the unknowns are of one kind.
    let roots = DVector::from_iterator(k, sizes.iter().map(|(size, _)| size.sqrt()));
    let scaled = |a: &DMatrix<f64>| DMatrix::from_fn(m, k, |i, j| a[(i, j)] / roots[j]);
    let (b, db) = (scaled(a), scaled(da));
    let w = u.component_mul(&roots);
    let svd = b.clone().svd(true, true);
    let weak = 1e-10 * svd.singular_values.amax();
    let inverse = svd.pseudo_inverse(weak).ok()?;
    let mu = inverse.transpose() * &w;
    // `dw` is `B' dmu` and this.
    let turned =
        DVector::from_fn(k, |j, _| (0..m).map(|i| db[(i, j)] * mu[i]).sum::<f64>() - sizes[j].1 / sizes[j].0 * w[j]);
    let change = &turned + &inverse * (missing - &b * &turned);
    Some(change.component_div(&roots))
}

fn along(x: f64, rate: f64) -> Along {
    Dual { re: x, eps: [rate] }
}

/// The derivatives of some formulas at time zero, along the direction that the numbers carry.
fn derivatives(
    formulas: &Tapes,
    n: usize,
    (q, v, p): (&[Along], &[Along], &[Along; FREE]),
    count: usize,
) -> DVector<f64> {
    let mut rates = DVector::zeros(count);
    formulas.evaluate(n, TapePoint { t: along(0.0, 0.0), q, v, p, sides: &[] }, |k, x| rates[k] = x.eps[0]);
    rates
}
