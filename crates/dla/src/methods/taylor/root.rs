/// Parts of an interval that are looked at for one root.
const MOST_LOOKS: u32 = 2_000;

/// The first point in `(0, 1]` from which on a polynomial is negative; `None` if there is none. Its coefficients stand from the constant one
/// on, and it counts as positive at 0.
///
/// A polynomial on an interval lies within the hull of its Bernstein coefficients (Farouki 2012, Comput. Aided Geom. Design 29, 379-419):
/// an interval without a negative one has no root, and any other is divided until it is as short as rounding.
pub(super) fn first_negative(coefficients: &[f64]) -> Option<f64> {
    let degree = coefficients.len().checked_sub(1)?;
    let mut waiting = vec![(0.0, 1.0, bernstein(coefficients))];
    for _ in 0..MOST_LOOKS {
        let (from, to, mut ordinates) = waiting.pop()?;
        if !ordinates.iter().any(|b| *b < 0.0) {
            continue;
        }
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to || to - from <= f64::EPSILON * to {
            return Some(to);
        }
        // De Casteljau: the ordinates of both halves.
        let mut after = vec![0.0; degree + 1];
        let mut before = Vec::with_capacity(degree + 1);
        for k in 0..=degree {
            before.push(ordinates[0]);
            after[degree - k] = ordinates[degree - k];
            for i in 0..degree - k {
                ordinates[i] = 0.5 * (ordinates[i] + ordinates[i + 1]);
            }
        }
        waiting.push((middle, to, after));
        waiting.push((from, middle, before));
    }
    // Roots beside one another without end: the first of them lies before all that waits.
    waiting.last().map(|(from, ..)| *from)
}

/// The Bernstein coefficients on `[0, 1]` of a polynomial by its powers: `b_i = sum_(k <= i) binom(i, k)/binom(n, k) c_k`.
fn bernstein(coefficients: &[f64]) -> Vec<f64> {
    let degree = coefficients.len() - 1;
    let ordinate = |i: usize| {
        let (mut sum, mut ratio) = (0.0, 1.0);
        for (k, c) in coefficients.iter().enumerate().take(i + 1) {
            sum += ratio * c;
            ratio *= (i - k) as f64 / (degree - k).max(1) as f64;
        }
        sum
    };
    (0..=degree).map(ordinate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The coefficients of `(x - r_0) (x - r_1) ..`, times a sign so that it is positive at 0.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let mut all = vec![1.0];
        for root in roots {
            let mut next = vec![0.0; all.len() + 1];
            for (k, c) in all.iter().enumerate() {
                next[k + 1] += c;
                next[k] -= root * c;
            }
            all = next;
        }
        let sign = all[0].signum();
        all.iter().map(|c| sign * c).collect()
    }

    #[test]
    fn a_polynomial_without_a_root_in_the_interval_stays_positive() {
        assert_eq!(first_negative(&with_roots(&[1.5, -0.3, -2.0])), None);
        assert_eq!(first_negative(&[1.0]), None);
        // Touched, not crossed.
        assert_eq!(first_negative(&[0.25, -1.0, 1.0]), None);
        // From zero upward.
        assert_eq!(first_negative(&[0.0, 1.0]), None);
    }

    proptest! {
        /// Of several roots in an interval, and others outside, the first, however near the next one is.
        #[test]
        fn the_first_root_is_found(first in 0.01..0.9f64, apart in 1e-6..0.5f64, others in proptest::collection::vec(1.5..4.0f64, 0..8)) {
            let mut roots = vec![first, first + apart];
            roots.extend(others);
            let found = first_negative(&with_roots(&roots)).unwrap();
            // A polynomial is known to rounding, and its root to that over the slope, which the nearest root makes small.
            prop_assert!((found - first).abs() < 1e-12 / apart, "{found} instead of {first}");
        }
    }
}
