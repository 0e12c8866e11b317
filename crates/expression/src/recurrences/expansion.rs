use super::{Recurrences, Run, WIDE};
use scalar::Scalar;

/// The highest order of a series.
pub const MOST_ORDERS: usize = 32;

/// The most terms of an operation.
pub(super) const MOST_TERMS: usize = 4;

/// `1/k`.
const RECIPROCALS: [f64; MOST_ORDERS + 1] = {
    let (mut all, mut k) = ([0.0; MOST_ORDERS + 1], 1);
    while k < all.len() {
        all[k] = 1.0 / k as f64;
        k += 1;
    }
    all
};

/// The Taylor coefficients of the unknowns of some [`Recurrences`], and room for those of all operations.
///
/// Time is in units of a chosen length: the coefficient of order `k` belongs to the power `k` of the time since the start in these units,
/// so that coefficients neither overflow nor underflow, however fast the motion.
#[derive(Debug, Clone)]
pub struct Expansion<S> {
    /// The value of each place.
    pub(super) values: Vec<S>,
    /// The coefficient of the present order of each place, and behind them the sums over products.
    present: Vec<S>,
    /// The factors of the terms of all operations.
    pub(super) factors: Vec<S>,
    /// Both factors of the sums over products, by blocks, each with its orders.
    orders: Vec<[[[S; WIDE]; MOST_ORDERS]; 2]>,
    /// What is known of the sums of the next order before those of the present order are.
    begun: Vec<[S; WIDE]>,
    /// The coefficients of the unknowns, order by order, and of the arguments of corners.
    unknowns: Vec<S>,
    pub(super) arguments: Vec<S>,
    order: usize,
    /// The places of lengths, and what else has no series where it vanishes, that are zero at order 0.
    pub(super) vanishing: Vec<u32>,
    leaves: bool,
}

impl<S: Scalar> Expansion<S> {
    /// Room for the series of these recurrences.
    #[must_use]
    pub fn new(of: &Recurrences) -> Self {
        let zero = S::zero();
        Self {
            values: vec![zero; of.places],
            present: vec![zero; of.places + WIDE * of.sums.len()],
            factors: vec![zero; of.terms.len() + MOST_TERMS],
            orders: vec![[[[zero; WIDE]; MOST_ORDERS]; 2]; of.sums.len()],
            begun: vec![[zero; WIDE]; of.sums.len()],
            unknowns: vec![zero; of.unknowns() * (MOST_ORDERS + 1)],
            arguments: vec![zero; of.corners() * MOST_ORDERS],
            order: 0,
            vanishing: Vec::new(),
            leaves: false,
        }
    }

    /// Expands the solution that is at `x` at the time `t`, up to an order of at most [`MOST_ORDERS`], with `unit` as the unit of time.
    ///
    /// `sides` are those of the corners, by the sign of their arguments: where one is missing or zero, it is the sign at `t`.
    pub fn expand(&mut self, of: &Recurrences, at: (S, &[S], &[S]), unit: f64, order: usize) {
        self.expand_with(of, at, unit, order, |_| S::zero());
    }

    /// As [`expand`](Self::expand), with the values of the variables that are no unknowns, by their numbers.
    pub fn expand_with(
        &mut self,
        of: &Recurrences,
        (t, x, sides): (S, &[S], &[S]),
        unit: f64,
        order: usize,
        others: impl Fn(usize) -> S,
    ) {
        let (n, order) = (of.unknowns(), order.min(MOST_ORDERS));
        (self.order, self.leaves) = (order, false);
        self.vanishing.clear();
        for (k, place) in self.values[..of.inputs].iter_mut().enumerate() {
            *place = if k == 0 { t } else { others(k) };
        }
        for (place, x) in of.variables.iter().zip(x) {
            self.values[*place as usize] = *x;
        }
        for &(place, x) in &of.constants {
            self.values[place as usize] = S::constant(x);
        }
        self.unknowns[..n].copy_from_slice(&x[..n]);
        self.evaluate(of, sides);
        for (j, &place) in of.rates.iter().enumerate() {
            self.unknowns[n + j] = self.values[place as usize] * unit;
        }
        self.begin_sums(1);
        for k in 1..order {
            self.present[0] = if k == 1 { S::constant(unit) } else { S::zero() };
            for (&place, x) in of.variables.iter().zip(&self.unknowns[k * n..]) {
                self.present[place as usize] = *x;
            }
            self.end_sums(of, k);
            self.begin_sums(k + 1);
            self.combine(of);
            self.keep(of, k);
            let by = unit * RECIPROCALS[k + 1];
            for (j, &place) in of.rates.iter().enumerate() {
                self.unknowns[(k + 1) * n + j] = self.present[place as usize] * by;
            }
        }
    }

    /// The order of the series.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// The coefficients of an order, of all unknowns.
    #[must_use]
    pub fn coefficients(&self, order: usize) -> &[S] {
        let n = self.unknowns.len() / (MOST_ORDERS + 1);
        &self.unknowns[order * n..(order + 1) * n]
    }

    /// The coefficients of the argument of a corner, up to the order below that of the series, from the constant one on.
    pub fn argument(&self, corner: usize) -> impl Iterator<Item = S> {
        let corners = self.arguments.len() / MOST_ORDERS;
        self.arguments.iter().skip(corner).step_by(corners.max(1)).take(self.order).copied()
    }

    /// Whether a length begins with zero and does not stay there: its coefficients, which are not known, count as zero.
    #[must_use]
    pub fn leaves_zero(&self) -> bool {
        self.leaves
    }

    /// The sums over products of order `k`: what [`begin_sums`](Self::begin_sums) has begun, with the coefficients of order `k - 1`.
    #[inline(always)]
    fn end_sums(&mut self, of: &Recurrences, k: usize) {
        let sums = &mut self.present[of.places..];
        for (block, (sums, [left, right])) in sums.chunks_exact_mut(WIDE).zip(&self.orders).enumerate() {
            let mut sum = self.begun[block];
            if k > 1 {
                sum = added(sum, &left[1], &right[k - 1]);
            }
            if k > 2 {
                sum = added(sum, &left[k - 1], &right[1]);
            }
            let part = if block < of.plain { 1.0 } else { RECIPROCALS[k] };
            for j in 0..WIDE {
                sums[j] = sum[j] * part;
            }
        }
    }

    /// Begins the sums over products of order `k` before those of order `k - 1` are known: the coefficients of that order follow from one
    /// another, and the processor adds up while it waits for them.
    #[inline(always)]
    fn begin_sums(&mut self, k: usize) {
        for (begun, [left, right]) in self.begun.iter_mut().zip(&self.orders) {
            let mut sum = [S::zero(); WIDE];
            if k > 3 {
                for (a, b) in left[2..k - 1].iter().zip(right[2..k - 1].iter().rev()) {
                    sum = added(sum, a, b);
                }
            }
            *begun = sum;
        }
    }

    /// The coefficients of the present order of all operations.
    #[inline(always)]
    fn combine(&mut self, of: &Recurrences) {
        let (mut first, mut at) = (0, 0);
        for &Run { terms, picks, end } in &of.runs {
            let results = &of.results[first..end];
            let last = at + terms * results.len();
            let (places, factors) = (&of.terms[at..last], &self.factors[at..last]);
            match terms {
                1 if picks => picked(&mut self.present, results, places, factors),
                1 => combined::<S, 1>(&mut self.present, results, places, factors),
                2 => combined::<S, 2>(&mut self.present, results, places, factors),
                3 => combined::<S, 3>(&mut self.present, results, places, factors),
                _ => combined::<S, 4>(&mut self.present, results, places, factors),
            }
            (first, at) = (end, last);
        }
    }

    /// Keeps the coefficients of order `k` for the sums of later orders.
    #[inline(always)]
    fn keep(&mut self, of: &Recurrences, k: usize) {
        let present = &self.present;
        for (block, ([left, right], places)) in self.orders.iter_mut().zip(&of.sums).enumerate() {
            let weight = if block < of.plain { 1.0 } else { k as f64 };
            for j in 0..WIDE {
                left[k][j] = present[places[0][j] as usize] * weight;
                right[k][j] = present[places[1][j] as usize];
            }
        }
        let corners = of.corners.len();
        for (at, corner) in of.corners.iter().enumerate() {
            self.arguments[k * corners + at] = present[corner.argument as usize];
        }
        self.leaves |= self.vanishing.iter().any(|place| !present[*place as usize].is_zero());
    }
}

/// Coefficients that are picked, or zero.
#[cold]
fn picked<S: Scalar>(present: &mut [S], results: &[u32], places: &[u32], factors: &[S]) {
    for ((result, place), factor) in results.iter().zip(places).zip(factors) {
        present[*result as usize] = factor.where_positive(present[*place as usize], S::zero());
    }
}

/// `sum + a b`, eight times.
#[inline(always)]
fn added<S: Scalar>(mut sum: [S; WIDE], a: &[S; WIDE], b: &[S; WIDE]) -> [S; WIDE] {
    for j in 0..WIDE {
        sum[j] = a[j].times_plus(b[j], sum[j]);
    }
    sum
}

/// Combinations of `T` terms. The first term is the one that is waited for longest, so it is added last.
#[inline(always)]
fn combined<S: Scalar, const T: usize>(present: &mut [S], results: &[u32], places: &[u32], factors: &[S]) {
    let (places, _) = places.as_chunks::<T>();
    let (factors, _) = factors.as_chunks::<T>();
    for ((result, places), factors) in results.iter().zip(places).zip(factors) {
        let mut sum = present[places[T - 1] as usize] * factors[T - 1];
        for j in (0..T - 1).rev() {
            sum = present[places[j] as usize].times_plus(factors[j], sum);
        }
        present[*result as usize] = sum;
    }
}
