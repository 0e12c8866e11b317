use crate::convergence::tolerances::{SHRINKING, SLIGHT, STALL};
use crate::convergence::{Kind, is_settled};
use lagrangian::from_fn;

/// The fewest looks of a search: one for its first correction, and one that finds its equations met.
pub(crate) const LEAST: u32 = 2;

/// More corrections are not worth it.
pub(crate) const CORRECTIONS: u32 = 8;

/// How a search with derivatives of another point goes on from its first correction until it has settled.
pub(crate) struct Settle<const N: usize> {
    /// Relative tolerance of every component.
    pub(crate) tolerance: f64,
    /// The first correction.
    pub(crate) first: [f64; N],
}

impl<const N: usize> Settle<N> {
    /// Improves `x` until its equations are met, of which there is then no correction, or every component is settled by the rule
    /// of [`Newton`](crate::Newton) for simplified corrections; and says after how many looks, with that before the first
    /// correction. None where corrections do not shrink as they should.
    #[inline(always)]
    pub(crate) fn search(
        &self,
        x: &mut [f64; N],
        mut correction: impl FnMut(&[f64; N]) -> Option<[f64; N]>,
    ) -> Option<u32> {
        let (mut last, mut allowed) = (self.first.map(f64::abs), SHRINKING * sup(&self.first));
        for made in LEAST..=CORRECTIONS {
            let Some(d) = correction(x) else { return Some(made) };
            let moved = from_fn(|i| x[i] + d[i]);
            let size = sup(&d);
            let rounding = size <= SLIGHT * sup(&moved);
            if !(size <= allowed || rounding) {
                return None;
            }
            *x = moved;
            if self.has_settled(x, &d, &last, rounding) {
                return Some(made);
            }
            last = d.map(f64::abs);
            allowed = SHRINKING * size;
        }
        None
    }

    /// Whether every component of `x` has settled with the correction `d`, after one with components of the sizes `last`.
    #[inline(always)]
    fn has_settled(&self, x: &[f64; N], d: &[f64; N], last: &[f64; N], rounding: bool) -> bool {
        (0..N).fold(true, |all, i| {
            let (d, x, last) = (d[i].abs(), x[i].abs(), last[i]);
            all & (is_settled(Kind::Simplified, self.tolerance, x, d, last) | (rounding & (d >= STALL * last)))
        })
    }
}

/// The size of the largest component; what is not a number is passed over.
#[inline(always)]
pub(crate) fn sup<const N: usize>(x: &[f64; N]) -> f64 {
    // A loop, since a fold over more than a few is left a call.
    let mut most = 0.0;
    for x in x {
        most = if x.abs() > most { x.abs() } else { most };
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 4.0 * f64::EPSILON;

    /// `x <- x + rate (1 - x)`, with the derivative of another point: corrections shrink by `1 - rate`.
    fn search(rate: f64) -> Option<(u32, f64)> {
        let correction = |x: &[f64; 2]| [rate * (1.0 - x[0]), rate * (1e-3 - x[1])];
        let start = [0.9, 1e-3 * 0.9];
        let first = correction(&start);
        let mut x = from_fn(|i| start[i] + first[i]);
        let made = Settle { tolerance: TOLERANCE, first }.search(&mut x, |x| Some(correction(x)))?;
        Some((made, f64::max((x[0] - 1.0).abs(), (1e3 * x[1] - 1.0).abs())))
    }

    #[test]
    fn every_component_settles() {
        for rate in [1.0, 0.999, 0.99] {
            let (made, error) = search(rate).unwrap();
            println!("rate {rate}: {made} corrections, error {error:e}");
            assert!(error <= 4.0 * TOLERANCE);
        }
        assert!(search(0.99).unwrap().0 > search(1.0).unwrap().0);
    }

    /// Where the equations are met nothing is added, and rounding until it is seen not to shrink.
    #[test]
    fn a_search_ends() {
        let start = [0.5, 1e-3];
        let ulps = |part: f64| [part * 0.5 * f64::EPSILON, part * 1e-3 * f64::EPSILON];
        let mut x = start;
        let settle = Settle { tolerance: TOLERANCE, first: [1e-3, 1e-6] };
        assert_eq!((settle.search(&mut x, |_| None), x), (Some(2), start));
        let rounding = |_: &[f64; 2]| Some(ulps(5.0));
        let [d, e] = ulps(5.0);
        let settle = Settle { tolerance: TOLERANCE, first: [4.0 * d, 4.0 * e] };
        assert_eq!((settle.search(&mut x, rounding), x), (Some(2), [start[0] + d, start[1] + e]));
    }

    /// Corrections that shrink slowly, and such as are no numbers.
    #[test]
    fn others_are_given_up() {
        assert_eq!(search(0.8), None);
        // These shrink by enough, but there would be sixteen of them.
        assert_eq!(search(0.9), None);
        let settle = Settle { tolerance: TOLERANCE, first: [1.0] };
        assert!(settle.search(&mut [1.0], |_| Some([f64::NAN])).is_none());
    }
}
