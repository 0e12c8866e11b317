use crate::convergence::tolerances::{SHRINKING, SLIGHT, STALL};
use crate::convergence::{CorrectionKind, is_settled};
use lagrangian::{from_fn, mapped};

/// The fewest evaluations of the residual in an iteration: one for the first correction, and one that finds the equations met.
pub(crate) const LEAST: u32 = 2;

/// After more corrections the step is made without memory.
pub(crate) const CORRECTIONS: u32 = 8;

/// The iteration with a frozen Jacobian, from its first correction until it has converged.
pub(crate) struct Settle<const N: usize> {
    /// Relative tolerance of every component.
    pub(crate) tolerance: f64,
    /// The first correction.
    pub(crate) first: [f64; N],
}

impl<const N: usize> Settle<N> {
    /// Corrects `x` until the equations are met (`correction` then gives `None`), or until every component has converged by the rule of
    /// [`Newton`](crate::Newton) for simplified corrections. Returns the number of evaluations, including the one before the first
    /// correction; `None` if corrections do not shrink as they should.
    #[inline(always)]
    pub(crate) fn search(
        &self,
        x: &mut [f64; N],
        mut correction: impl FnMut(&[f64; N]) -> Option<[f64; N]>,
    ) -> Option<u32> {
        let (mut last, mut allowed) = (mapped(&self.first, f64::abs), SHRINKING * sup(&self.first));
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
            last = mapped(&d, f64::abs);
            allowed = SHRINKING * size;
        }
        None
    }

    /// Whether every component of `x` has converged with the correction `d`, after one with components of the sizes `last`.
    #[inline(always)]
    fn has_settled(&self, x: &[f64; N], d: &[f64; N], last: &[f64; N], rounding: bool) -> bool {
        (0..N).fold(true, |all, i| {
            let (d, x, last) = (d[i].abs(), x[i].abs(), last[i]);
            all & (is_settled(CorrectionKind::Simplified, self.tolerance, x, d, last)
                | (rounding & (d >= STALL * last)))
        })
    }
}

/// The size of the largest component; NaN is passed over.
#[inline(always)]
pub(crate) fn sup<const N: usize>(x: &[f64; N]) -> f64 {
    // A loop, since the compiler does not inline a fold over more than a few.
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

    /// `x <- x + rate (1 - x)`, as with a frozen Jacobian: corrections shrink by `1 - rate`.
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

    /// Where the equations are met nothing is added; round-off is added until it no longer shrinks.
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

    /// Corrections that shrink slowly, and NaN.
    #[test]
    fn others_are_given_up() {
        assert_eq!(search(0.8), None);
        // These shrink by enough, but there would be sixteen of them.
        assert_eq!(search(0.9), None);
        let settle = Settle { tolerance: TOLERANCE, first: [1.0] };
        assert!(settle.search(&mut [1.0], |_| Some([f64::NAN])).is_none());
    }
}
