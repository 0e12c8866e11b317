use expression::{Expansion, MOST_ORDERS};
use lagrangian::linear::larger;

/// How long polynomials are, for an error of a tolerance in each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pace {
    pub(super) order: usize,
    /// The first term that is left out (octaves), relative to the size of its unknown.
    left_out: f64,
}

/// The first term that is left out, in tolerances: errors of many steps add up.
const SHARE: f64 = 0.01;

impl Pace {
    /// The order whose steps cost least. Terms fall off as powers of the step over the radius of convergence, and the time of a step grows
    /// about as its order; if the time grew as the square of the order, half of this order would be best (Jorba and Zou 2005, section 3.1).
    pub(super) fn of(epsilon: f64) -> Self {
        let epsilon = epsilon.max(1e-24);
        let order = (-0.7 * epsilon.ln()).ceil() + 3.0;
        Self { order: (order as usize).clamp(4, MOST_ORDERS), left_out: (SHARE * epsilon).log2() }
    }

    /// The longest step, in units of the series: the radius of convergence is where the last two terms have the size `1 + |y|` of their
    /// unknowns (the same, section 3.2). Infinite if both vanish.
    pub(super) fn longest(self, series: &Expansion<f64>) -> f64 {
        let p = series.order();
        let [mut before, mut last] = [0.0f64; 2];
        let terms = series.coefficients(p - 1).iter().zip(series.coefficients(p));
        for (y, (c, d)) in series.coefficients(0).iter().zip(terms) {
            let part = 1.0 / (1.0 + y.abs());
            (before, last) = (larger(before, c.abs() * part), larger(last, d.abs() * part));
        }
        let p = p as f64;
        let radius = -(before.log2() / (p - 1.0)).max(last.log2() / p);
        (radius + self.left_out / (p + 1.0)).exp2()
    }
}
