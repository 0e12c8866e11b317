use crate::TextModel;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// A state that meets all constraints.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TextStart {
    /// The coordinates.
    pub q: Vec<f64>,
    /// Their rates.
    pub v: Vec<f64>,
    /// What was given otherwise.
    pub moved: Vec<Moved>,
    /// Which coordinates, and which rates, were left out.
    pub left_out: [Vec<bool>; 2],
}

/// A number of a start that the constraints do not admit.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// The name of the coordinate or rate.
    pub name: String,
    /// What was given.
    pub from: f64,
    /// What it is now.
    pub to: f64,
}

/// Why there is no start.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StartError {
    /// A function is infinite, or not a number.
    #[error("{what} is {value} at the start")]
    NotFinite {
        /// Which function.
        what: String,
        /// Its value.
        value: f64,
    },
    /// No configuration nearby meets the constraints on positions.
    #[error(
        "no configuration near the start satisfies the constraints on positions: the residual stays at \
        {missed:.1e}"
    )]
    Positions {
        /// The largest residual.
        missed: f64,
    },
    /// No velocity meets the constraints.
    #[error(
        "no velocity at the start satisfies all constraints: the constraints contradict one another, and the \
        residual stays at {missed:.1e}"
    )]
    Velocities {
        /// The largest residual.
        missed: f64,
    },
    /// A vector of a basis that was given is not admissible.
    #[error("vector {} of the basis is not admissible at the start: the residual of constraint {} is {residual:.1e}, \
        not zero", vector + 1, constraint + 1)]
    Basis {
        /// Which vector.
        vector: usize,
        /// Which constraint it does not meet.
        constraint: usize,
        /// By how much.
        residual: f64,
    },
}

/// Residuals below this fraction of the sizes of their terms are rounding.
const ROUNDING: f64 = 1e-13;
/// Directions in which the constraints are weaker than this fraction of the strongest direction do not count.
const WEAK: f64 = 1e-10;
/// A given number counts as moved if it changes by more than this fraction.
const NOTED: f64 = 1e-9;

impl TextModel {
    /// The admissible state nearest to a given one at time zero, in the kinetic metric. `None` stands for a number that is left out.
    ///
    /// Rates that are left out get the smallest values that meet the constraints together with the given rates, each measured by its own
    /// inertia. If there are none, all rates move, and [`TextStart::moved`] names them. Coordinates that are left out are zero, unless
    /// constraints on positions need other values; given coordinates move only if these cannot meet the constraints alone.
    ///
    /// # Errors
    /// [`StartError`] if there is no such state nearby, a function of the system is not finite there, or a given basis is not admissible.
    pub fn start(&self, q: &[Option<f64>], v: &[Option<f64>]) -> Result<TextStart, StartError> {
        let n = self.coordinates.len();
        let given = |x: &[Option<f64>]| -> Vec<Option<f64>> { (0..n).map(|i| x.get(i).copied().flatten()).collect() };
        let (given_q, given_v) = (given(q), given(v));
        let free = |given: &[Option<f64>]| -> Vec<usize> { (0..n).filter(|&i| given[i].is_none()).collect() };
        let (left_out, slack) = (free(&given_q), free(&given_v));
        let all: Vec<usize> = (0..n).collect();

        let first = DVector::from_iterator(n, given_q.iter().map(|x| x.unwrap_or(0.0)));
        let mut place = first.clone();
        if !self.onto_positions(&mut place, &left_out) {
            place = first;
            if !self.onto_positions(&mut place, &all) {
                return Err(StartError::Positions { missed: self.positions_at(0.0, place.as_slice()).amax() });
            }
        }
        let mut rate = DVector::from_iterator(n, given_v.iter().map(|x| x.unwrap_or(0.0)));
        self.check_finite(&place, &rate)?;
        let (a, b) = self.rows_at(0.0, place.as_slice());
        let mass = self.mass_at(0.0, place.as_slice(), rate.as_slice());
        // Of rates that are left out each is to be small, whatever the mass matrix says of several together; it has nothing to say of a rate
        // that no constraint asks for. Where all move, they move as by an impulse of the constraints.
        let each = DMatrix::from_diagonal(&mass.diagonal());
        for (moving, metric) in [(&slack, &each), (&all, &mass)] {
            for _ in 0..2 {
                move_onto(&a, &b, metric, &mut rate, moving);
            }
            if missed(&a, &b, &rate).is_none() {
                break;
            }
        }
        // What is rounding beside the others is nothing, if the constraints are met without.
        let rounding = f64::EPSILON * 64.0 * rate.amax();
        let without = rate.map(|x| if x.abs() <= rounding { 0.0 } else { x });
        if missed(&a, &b, &without).is_none() {
            rate = without;
        }
        if let Some(missed) = missed(&a, &b, &rate) {
            return Err(StartError::Velocities { missed });
        }
        self.check_basis(&a, &place)?;

        let names = self.coordinates.iter().map(|coordinate| &coordinate.name);
        let rates = names.clone().map(|name| format!("{name}'"));
        let numbers = names.cloned().chain(rates).zip(given_q.iter().chain(&given_v)).zip(place.iter().chain(&rate));
        let moved = numbers.filter_map(|((name, given), &to)| {
            let from = (*given)?;
            let changed = (to - from).abs() > NOTED * from.abs().max(1.0);
            changed.then_some(Moved { name, from, to })
        });
        let moved = moved.collect();
        let left_out = [&given_q, &given_v].map(|given| given.iter().map(Option::is_none).collect());
        Ok(TextStart { q: place.as_slice().to_vec(), v: rate.as_slice().to_vec(), moved, left_out })
    }

    /// The rates of an admissible state with the rate of coordinate `i` set to `value`. The other rates change as little as the constraints
    /// admit, in the kinetic metric at time zero. Returns `None` if the constraints do not admit the value.
    #[must_use]
    pub fn with_rate(&self, q: &[f64], v: &[f64], i: usize, value: f64) -> Option<Vec<f64>> {
        let mut rate = DVector::from_column_slice(v);
        *rate.as_mut_slice().get_mut(i)? = value;
        let others: Vec<usize> = (0..v.len()).filter(|&k| k != i).collect();
        let ((a, b), mass) = (self.rows_at(0.0, q), self.mass_at(0.0, q, v));
        for _ in 0..2 {
            move_onto(&a, &b, &mass, &mut rate, &others);
        }
        missed(&a, &b, &rate).is_none().then(|| rate.as_slice().to_vec())
    }

    /// Moves some coordinates until the constraints on positions are met. Returns whether they are.
    fn onto_positions(&self, q: &mut DVector<f64>, moving: &[usize]) -> bool {
        const TRIES: usize = 50;
        if self.positions == 0 {
            return true;
        }
        let mut before = f64::INFINITY;
        for _ in 0..TRIES {
            let (a, _) = self.rows_at(0.0, q.as_slice());
            let a = a.rows(self.velocities, self.positions).into_owned();
            let g = self.positions_at(0.0, q.as_slice());
            let mass = self.mass_at(0.0, q.as_slice(), &vec![0.0; q.len()]);
            let Some(change) = least(&select(&a, moving), &metric(&mass, moving), &-&g) else { return false };
            for (&i, change) in moving.iter().zip(&change) {
                q[i] += change;
            }
            let (size, step) = (q.amax().max(1.0), if moving.is_empty() { 0.0 } else { change.amax() });
            // Newton's method ends in rounding: corrections that are small and no longer shrink.
            if step <= f64::EPSILON * size || (step <= 1e-12 * size && step >= 0.5 * before) {
                // What is left is small where a correction of that size would be.
                let slope = a.amax().max(f64::MIN_POSITIVE);
                return self.positions_at(0.0, q.as_slice()).amax() <= 1e-12 * slope * size;
            }
            if !step.is_finite() {
                return false;
            }
            before = step;
        }
        false
    }

    fn check_finite(&self, q: &DVector<f64>, v: &DVector<f64>) -> Result<(), StartError> {
        let (q, v) = (q.as_slice(), v.as_slice());
        let (a, b) = self.rows_at(0.0, q);
        let rows = (0..a.nrows()).map(|k| (format!("constraint {}", k + 1), a.row(k).sum() + b[k]));
        let lagrangian = ("the Lagrangian".to_owned(), self.lagrangian_at(0.0, q, v));
        let mass = ("the mass matrix".to_owned(), self.mass_at(0.0, q, v).sum());
        let wrong = std::iter::once(lagrangian).chain([mass]).chain(rows).find(|(_, value)| !value.is_finite());
        wrong.map_or(Ok(()), |(what, value)| Err(StartError::NotFinite { what, value }))
    }

    fn check_basis(&self, a: &DMatrix<f64>, q: &DVector<f64>) -> Result<(), StartError> {
        let n = self.coordinates.len();
        let Some(basis) = &self.basis else { return Ok(()) };
        let mut vectors = DMatrix::<f64>::zeros(n, n - a.nrows());
        let at = crate::tapes::TapePoint::new(0.0, q.as_slice(), &[]);
        basis.evaluate(n, at, |k, x| vectors[(k % n, k / n)] = x);
        for (vector, w) in vectors.column_iter().enumerate() {
            for (constraint, row) in a.row_iter().enumerate() {
                let (residual, size) = (row.dot(&w.transpose()), row.amax() * w.amax());
                // A comparison with what is not a number is false.
                let meets = residual.abs() <= WEAK * size.max(f64::MIN_POSITIVE);
                if !meets {
                    return Err(StartError::Basis { vector, constraint, residual });
                }
            }
        }
        Ok(())
    }
}

/// Some columns of a matrix.
fn select(a: &DMatrix<f64>, columns: &[usize]) -> DMatrix<f64> {
    a.select_columns(columns)
}

/// The part of the mass matrix for some coordinates.
fn metric(mass: &DMatrix<f64>, of: &[usize]) -> DMatrix<f64> {
    mass.select_columns(of).select_rows(of)
}

/// Changes the `moving` rates so that the constraints `A v + b = 0` are met, or missed as little as possible.
fn move_onto(a: &DMatrix<f64>, b: &DVector<f64>, mass: &DMatrix<f64>, v: &mut DVector<f64>, moving: &[usize]) {
    let residual = -(a * &*v + b);
    if let Some(change) = least(&select(a, moving), &metric(mass, moving), &residual) {
        for (&i, change) in moving.iter().zip(&change) {
            v[i] += change;
        }
    }
}

/// The largest residual of the constraints; `None` if all residuals are rounding.
fn missed(a: &DMatrix<f64>, b: &DVector<f64>, v: &DVector<f64>) -> Option<f64> {
    let residuals = a * v + b;
    // Beside the largest terms that the row might have: a rate that is to vanish leaves terms of rounding only.
    let size = |k: usize| a.row(k).amax() * v.amax() + b[k].abs();
    let all_meet = residuals.iter().enumerate().all(|(k, residual)| residual.abs() <= ROUNDING * size(k));
    (!all_meet).then(|| residuals.amax())
}

/// The shortest solution `u` of `A u = r` in the metric `mass`, by least squares if there is no solution. If `mass` is not positive
/// definite, lengths are Euclidean.
pub(crate) fn least(a: &DMatrix<f64>, mass: &DMatrix<f64>, r: &DVector<f64>) -> Option<DVector<f64>> {
    if a.ncols() == 0 || a.nrows() == 0 {
        return Some(DVector::zeros(a.ncols()));
    }
    if !a.iter().chain(r).all(|x| x.is_finite()) {
        return None;
    }
    // `u = L^-T z` of length `|z|`.
    let root = mass.clone().cholesky().map(|factor| factor.l());
    let scaled = match &root {
        Some(root) => root.solve_lower_triangular(&a.transpose())?.transpose(),
        None => a.clone(),
    };
    let svd = scaled.svd(true, true);
    let z = svd.solve(r, WEAK * svd.singular_values.amax()).ok()?;
    match root {
        Some(root) => root.tr_solve_lower_triangular(&z),
        None => Some(z),
    }
}
