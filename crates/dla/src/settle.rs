use std::array::from_fn;

/// Corrections shrink by at least as much, or their derivatives are not good enough.
pub(crate) const SHRINKING: f64 = 0.125;

/// How a search with derivatives of another point goes on until it has settled.
pub(crate) struct Settle {
    /// Relative tolerance of every component.
    pub(crate) tolerance: f64,
    /// How large the first correction may be.
    pub(crate) most: f64,
}

impl Settle {
    /// Improves `x` until every component is settled by the rule of [`Newton`](crate::Newton) for simplified corrections, and
    /// says in how many. None where they do not shrink as they should.
    #[inline(always)]
    pub(crate) fn search<const N: usize>(
        &self,
        x: &mut [f64; N],
        mut correction: impl FnMut(&[f64; N]) -> [f64; N],
    ) -> Option<u32> {
        /// More are not worth it.
        const CORRECTIONS: u32 = 8;
        /// Corrections below this part of the unknowns are taken for rounding where they do not shrink. Where rounding is
        /// larger, the general search sees it.
        const ROUNDING: f64 = 64.0 * f64::EPSILON;
        let (mut last, mut allowed) = ([0.0; N], self.most);
        for made in 1..=CORRECTIONS {
            let d = correction(x);
            let moved = from_fn(|i| x[i] + d[i]);
            let size = sup(&d);
            let rounding = size <= ROUNDING * sup(&moved);
            if !(size <= allowed || rounding) {
                return None;
            }
            // What is within the tolerance anyway is a check alone, which nothing then waits for.
            if rounding && (0..N).fold(true, |all, i| all & (d[i].abs() <= self.tolerance * x[i].abs())) {
                return Some(made);
            }
            *x = moved;
            // The first has none before it to be compared with.
            if made > 1 && self.has_settled(x, &d, &last, rounding) {
                return Some(made);
            }
            last = d.map(f64::abs);
            allowed = SHRINKING * size;
        }
        None
    }

    /// Whether every component of `x` has settled with the correction `d`, after one with components of the sizes `last`.
    #[inline(always)]
    fn has_settled<const N: usize>(&self, x: &[f64; N], d: &[f64; N], last: &[f64; N], rounding: bool) -> bool {
        (0..N).fold(true, |all, i| {
            let (d, x, last) = (d[i].abs(), x[i].abs(), last[i]);
            let size = self.tolerance * x;
            // As the corrections have shrunk the next one will be within the tolerance.
            let predicted = (d <= x) & (2.0 * d * d <= size * last);
            all & ((d <= size) | predicted | (rounding & (d >= 0.25 * last)))
        })
    }
}

/// The size of the largest component; what is not a number is passed over.
#[inline(always)]
pub(crate) fn sup<const N: usize>(x: &[f64; N]) -> f64 {
    x.iter().fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTLE: Settle = Settle { tolerance: 4.0 * f64::EPSILON, most: 1.0 };

    /// `x <- x + rate (1 - x)`, with the derivative of another point: corrections shrink by `1 - rate`.
    fn search(rate: f64, settle: &Settle) -> Option<(u32, f64)> {
        let mut x = [0.9, 1e-3 * 0.9];
        let made = settle.search(&mut x, |x| [rate * (1.0 - x[0]), rate * (1e-3 - x[1])])?;
        Some((made, f64::max((x[0] - 1.0).abs(), (1e3 * x[1] - 1.0).abs())))
    }

    #[test]
    fn every_component_settles() {
        for rate in [1.0, 0.999, 0.99] {
            let (made, error) = search(rate, &SETTLE).unwrap();
            println!("rate {rate}: {made} corrections, error {error:e}");
            assert!(error <= 4.0 * SETTLE.tolerance);
        }
        assert!(search(0.99, &SETTLE).unwrap().0 > search(1.0, &SETTLE).unwrap().0);
    }

    /// A correction that the tolerance allows to be left is left, where that is so in every component.
    #[test]
    fn checks_are_not_added() {
        let start = [0.5, 1e-3];
        let ulps = |part: f64| [part * 0.5 * f64::EPSILON, part * 1e-3 * f64::EPSILON];
        let mut x = start;
        assert_eq!((SETTLE.search(&mut x, |_| ulps(3.0)), x), (Some(1), start));
        // Rounding that is more in one of them is added until it is seen not to shrink.
        let [d, _] = ulps(3.0);
        let [_, more] = ulps(5.0);
        let made = SETTLE.search(&mut x, |_| [d, more]);
        assert_eq!((made, x), (Some(2), [start[0] + d + d, start[1] + more + more]));
    }

    /// Corrections that shrink slowly, or the first of which is large, and such as are no numbers.
    #[test]
    fn others_are_given_up() {
        assert_eq!(search(0.8, &SETTLE), None);
        // These shrink by enough, but there would be sixteen of them.
        assert_eq!(search(0.9, &SETTLE), None);
        assert_eq!(search(0.99, &Settle { most: 0.09, ..SETTLE }), None);
        assert!(SETTLE.search(&mut [1.0], |_| [f64::NAN]).is_none());
    }
}
