use crate::State;
use crate::state::wrapped;
use lagrangian::simd::{Pack, Simd};
use lagrangian::{added, array, from_fn};
use std::f64::consts::PI;

/// One number of each of `W` trajectories.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Row<const W: usize>(pub [f64; W]);

impl<const W: usize> Row<W> {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; W]);
}

/// Configurations and quasi-velocities of `W` trajectories: what [`State`] is for one.
///
/// The rounding errors of the coordinates are kept and added again (Kahan 1965), and angles stay within a turn or a little more
/// of zero.
#[derive(Debug, Clone, Copy)]
pub struct LaneState<const N: usize, const W: usize> {
    /// Configurations.
    pub q: [Row<W>; N],
    /// Their rounding errors.
    pub rest: [Row<W>; N],
    turns: [Row<W>; N],
    angles: [bool; N],
    /// Quasi-velocities.
    pub xi: [Row<W>; N],
}

impl<const N: usize, const W: usize> LaneState<N, W> {
    /// The trajectories at the given configurations and quasi-velocities; `angles` says which coordinates are angles. Where
    /// there are fewer of them than lanes, the last one is repeated; without any all is zero.
    #[must_use]
    pub fn new(starts: &[([f64; N], [f64; N])], angles: [bool; N]) -> Self {
        let start = |lane: usize| starts.get(lane).or(starts.last()).copied().unwrap_or(([0.0; N], [0.0; N]));
        let q = from_fn(|k| Row(from_fn(|lane| start(lane).0[k])));
        let xi = from_fn(|k| Row(from_fn(|lane| start(lane).1[k])));
        let mut state = Self { q, rest: [Row::ZERO; N], turns: [Row::ZERO; N], angles, xi };
        state.wrap();
        state
    }

    /// The configuration of a lane: what a system is evaluated at.
    #[must_use]
    pub fn q(&self, lane: usize) -> [f64; N] {
        self.q.map(|q| q.0[lane])
    }

    /// The quasi-velocities of a lane.
    #[must_use]
    pub fn xi(&self, lane: usize) -> [f64; N] {
        self.xi.map(|xi| xi.0[lane])
    }

    /// The state of a lane, with its velocity.
    #[must_use]
    pub fn lane(&self, lane: usize, v: [f64; N]) -> State<N> {
        let each = |rows: &[Row<W>; N]| rows.map(|row| row.0[lane]);
        State::assembled([each(&self.q), each(&self.rest), each(&self.turns)], self.angles, v, each(&self.xi))
    }

    /// Whether a lane is still a state, and not lost to a step that it did not have.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        self.q.iter().chain(&self.xi).all(|row| row.0[lane].is_finite())
    }

    /// Makes a lane no state.
    pub fn lose(&mut self, lane: usize) {
        self.q.iter_mut().chain(&mut self.xi).for_each(|row| row.0[lane] = f64::NAN);
    }

    /// Takes a lane of another state.
    pub fn take(&mut self, lane: usize, other: &Self) {
        for k in 0..N {
            self.q[k].0[lane] = other.q[k].0[lane];
            self.rest[k].0[lane] = other.rest[k].0[lane];
            self.turns[k].0[lane] = other.turns[k].0[lane];
            self.xi[k].0[lane] = other.xi[k].0[lane];
        }
    }

    /// Takes full turns out of the angles.
    pub fn wrap(&mut self) {
        for k in 0..N {
            if self.angles[k] && self.q[k].0.iter().fold(false, |any, q| any | (q.abs() > PI)) {
                for lane in 0..W {
                    let turns;
                    (self.q[k].0[lane], self.rest[k].0[lane], turns) = wrapped(self.q[k].0[lane], self.rest[k].0[lane]);
                    self.turns[k].0[lane] += turns;
                }
            }
        }
    }
}

/// Adds an increment to a number whose rounding error is kept.
#[inline(always)]
pub fn accumulate<S: Simd, const K: usize>(q: &mut Pack<S, K>, rest: &mut Pack<S, K>, increment: Pack<S, K>) {
    (*q, *rest) = added(*q, increment + *rest);
}

/// Eight numbers of each row, those of the register `r`.
#[inline(always)]
pub fn loaded<S: Simd, const K: usize, const W: usize, const L: usize>(
    simd: S,
    rows: &[Row<W>; L],
    r: usize,
) -> [Pack<S, K>; L] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::load(simd, &rows[k].0.as_chunks().0[r]),
    )
}

/// Puts eight numbers into a row.
#[inline(always)]
pub fn store<S: Simd, const K: usize, const W: usize>(row: &mut Row<W>, r: usize, x: &Pack<S, K>) {
    row.0.as_chunks_mut().0[r] = x.row();
}
