use super::LANES;
use crate::convergence::tolerances::{OF_ROW, SLOWEST, STALL_OF_FIXED_POINT};

/// Which of eight lanes still iterate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settling {
    /// The largest next change, as estimated and relative, with which a lane has converged.
    settled: f64,
    open: [bool; LANES],
    /// The last changes; none yet.
    before: Option<[f64; LANES]>,
}

impl Settling {
    #[inline(always)]
    pub(super) fn to(settled: f64) -> Self {
        Self { settled, open: [true; LANES], before: None }
    }

    /// Tests the changes of an iteration against the sizes of what changed; whether any lane iterates on. A lane that has converged is not
    /// tested again.
    #[inline(always)]
    pub(super) fn look(&mut self, moved: &[f64; LANES], size: &[f64; LANES]) -> bool {
        let (first, before) = (self.before.is_none(), self.before.unwrap_or([0.0; LANES]));
        let mut any = false;
        for lane in 0..LANES {
            let (moved, size, before) = (moved[lane], size[lane], before[lane]);
            // Linear convergence: the next change is predicted by the contraction factor, which is never taken below a bound. At round-off
            // changes stall.
            let slowest = SLOWEST * before;
            let next = moved * if moved > slowest { moved } else { slowest };
            let stalls = (moved <= OF_ROW * size) & (moved >= STALL_OF_FIXED_POINT * before) & !first;
            let shrinks = (next <= self.settled * size * before) & (moved <= 0.5 * before);
            // A comparison with NaN is false.
            self.open[lane] &= (moved > self.settled * size) & !shrinks & !stalls;
            any |= self.open[lane];
        }
        self.before = Some(*moved);
        any
    }

    /// Zero in every lane, and NaN where a lane that still iterates changes by more than round-off.
    #[inline(always)]
    pub(super) fn lost(&self, size: &[f64; LANES]) -> [f64; LANES] {
        let before = self.before.unwrap_or([0.0; LANES]);
        lagrangian::from_fn(
            #[inline(always)]
            |lane| if self.open[lane] && before[lane] > OF_ROW * size[lane] { f64::NAN } else { 0.0 },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The changes of every lane, iteration by iteration, of numbers of size one; how many are tested.
    fn looks(lanes: impl Fn(i32) -> [f64; LANES]) -> (i32, Settling) {
        let mut settling = Settling::to(1e-17);
        let made = (1..60).find(|k| !settling.look(&lanes(*k), &[1.0; LANES])).unwrap_or(60);
        (made, settling)
    }

    /// With changes of `0.1^k` that of `1e-17`, which may be left, is expected from the one before.
    #[test]
    fn the_slowest_lane_counts() {
        let (quick, _) = looks(|k| [0.1f64.powi(k); LANES]);
        assert!((16..=17).contains(&quick), "{quick}");
        let slow = |k: i32| lagrangian::from_fn(|lane| if lane == 3 { 0.4f64.powi(k) } else { 0.1f64.powi(k) });
        assert!((42..=43).contains(&looks(slow).0));
    }

    /// Round-off goes up and down, in each lane at other times: each has converged by its first rise.
    #[test]
    fn rounding_ends_an_iteration() {
        let (made, settling) = looks(|k| {
            lagrangian::from_fn(|lane| {
                let rounding = if (k + lane as i32) % 2 == 0 { 1e-16 } else { 3e-16 };
                f64::max(0.01f64.powi(k), rounding)
            })
        });
        assert!((9..12).contains(&made), "{made}");
        assert!(!settling.lost(&[1.0; LANES]).iter().any(|x| x.is_nan()));
    }

    /// A lane that does not converge is lost, and no other; so is one with NaN.
    #[test]
    fn a_lane_that_goes_on_is_lost() {
        let (made, settling) = looks(|k| {
            let mut moved = [0.1f64.powi(k); LANES];
            (moved[2], moved[5]) = (1.0, f64::NAN);
            moved
        });
        assert_eq!(made, 60);
        let lost = settling.lost(&[1.0; LANES]).map(f64::is_nan);
        assert_eq!(lost, lagrangian::from_fn(|lane| lane == 2));
    }
}
