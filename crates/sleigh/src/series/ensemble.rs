use super::coefficients::ORDER;
use super::crossing::{MAX_STEPS, SeriesEnd};
use super::eight::{Axes, EightSeries};
use super::pace::{Interval, LOOKED_AT, SeriesPace, size};
use super::place::{increment, place};
use super::{InOwnAxes, OwnAxes};
use dla::ensemble::LANES;
use dla::{Ensemble, LaneState, Systems};
use lagrangian::simd::{Kernel, Pack, Simd, dispatch_widest};
use lagrangian::two_sum;

/// `W` trajectories by Taylor series, each with steps of its own within a step of the schedule: the method
/// [`Taylor`](super::Taylor), eight trajectories to a register.
///
/// Eight go on until the last of them has crossed the interval. One whose tolerance is not met is lost, and the others go on.
#[derive(Debug, Clone)]
pub struct TaylorEnsemble<const W: usize> {
    axes: [OwnAxes; W],
    pace: SeriesPace,
    h: f64,
    state: LaneState<3, W>,
}

impl<const W: usize> TaylorEnsemble<W> {
    /// The systems at these states, with steps of the schedule of length `h` (s) and the tolerance `epsilon` of
    /// [`Taylor::of`](super::Taylor::of). None where a system is not of [second degree in its own axes](InOwnAxes).
    #[must_use]
    pub fn new<Sys: InOwnAxes>(
        systems: &impl Systems<Sys, W>,
        (h, epsilon): (f64, f64),
        state: LaneState<3, W>,
    ) -> Option<Self> {
        const { assert!(W.is_multiple_of(LANES), "trajectories go in eights") };
        let mut axes = [systems.of(0).own_axes()?; W];
        for (lane, axes) in axes.iter_mut().enumerate() {
            *axes = systems.of(lane).own_axes()?;
        }
        Some(Self { axes, pace: SeriesPace::new(epsilon), h, state })
    }
}

impl<const W: usize> Ensemble<3, W> for TaylorEnsemble<W> {
    fn state(&self) -> &LaneState<3, W> {
        &self.state
    }

    fn advance(&mut self, steps: u64) {
        for _ in 0..steps {
            for first in (0..W).step_by(LANES) {
                let lanes: [usize; LANES] = lagrangian::from_fn(|i| first + i);
                let (axes, places) = (lanes.map(|lane| self.axes[lane]), lanes.map(|lane| self.place(lane)));
                let starts = lagrangian::from_fn(|i| {
                    let ([u, omega, _], [x, y]) = (self.state.xi(lanes[i]), places[i]);
                    [omega, u, y, x]
                });
                let crossed = dispatch_widest(LaneCrossing { axes: &axes, starts, pace: self.pace, whole: self.h });
                for (i, crossed) in crossed.iter().enumerate() {
                    self.arrive(lanes[i], places[i], crossed.as_ref());
                }
            }
            self.state.wrap();
        }
    }
}

impl<const W: usize> TaylorEnsemble<W> {
    fn place(&self, lane: usize) -> [f64; 2] {
        place(self.axes[lane].origin, &self.state.q(lane))
    }

    fn arrive(&mut self, lane: usize, start: [f64; 2], crossed: Option<&SeriesEnd>) {
        let Some(crossed) = crossed.filter(|crossed| crossed.end.iter().all(|x| x.is_finite())) else {
            return self.state.lose(lane);
        };
        let increment = increment(self.axes[lane].origin, &self.state.q(lane), start, crossed);
        for k in 0..3 {
            let (q, rest) = (&mut self.state.q[k].0[lane], &mut self.state.rest[k].0[lane]);
            (*q, *rest) = two_sum(*q, increment[k] + *rest);
        }
        (self.state.xi[0].0[lane], self.state.xi[1].0[lane]) = (crossed.end[1], crossed.end[0]);
    }
}

/// An interval to be crossed by eight trajectories; those that do not are none in the result.
struct LaneCrossing<'a> {
    axes: &'a [OwnAxes; LANES],
    /// `(omega, u, Y, X)` of each.
    starts: [[f64; 4]; LANES],
    pace: SeriesPace,
    whole: f64,
}

impl Kernel for LaneCrossing<'_> {
    type Output = [Option<SeriesEnd>; LANES];

    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> Self::Output {
        let Self { axes, starts, pace, whole } = self;
        let axes = Axes::<S, R>::load(simd, axes);
        let mut z = [Pack::splat(simd, 0.0); 4];
        for k in 0..4 {
            let mut row = [0.0; LANES];
            for lane in 0..LANES {
                row[lane] = starts[lane][k];
            }
            z[k] = Pack::load(simd, &row);
        }
        // Turns are sums of many, with their rounding.
        let (mut intervals, mut turns) = ([Interval::new(whole); LANES], [(0.0, 0.0); LANES]);
        let (mut lost, mut crossed) = ([false; LANES], [None; LANES]);
        for _ in 0..MAX_STEPS {
            let mut series = EightSeries::about(z);
            series.expand(&axes);
            let (omega, u) = (z[0].row(), z[1].row());
            let [looked_at, before, last] = [LOOKED_AT, LOOKED_AT - 1, ORDER].map(|k| series.largest(k).row());
            let (mut steps, mut arrives) = ([0.0; LANES], [false; LANES]);
            for lane in 0..LANES {
                if lost[lane] || crossed[lane].is_some() {
                    continue;
                }
                let terms = [looked_at[lane], before[lane], last[lane]];
                let full = pace.longest(size(omega[lane], u[lane]), terms);
                match intervals[lane].go_on(full) {
                    Some((h, last)) => (steps[lane], arrives[lane]) = (h, last),
                    None => lost[lane] = true,
                }
            }
            let (next, by) = series.after(Pack::load(simd, &steps));
            z = next;
            let ([omega, u, y, x], by) = (z.map(|z| z.row()), by.row());
            for lane in 0..LANES {
                turns[lane] = two_sum(turns[lane].0, turns[lane].1 + by[lane]);
                if arrives[lane] {
                    let end = [omega[lane], u[lane], y[lane], x[lane]];
                    crossed[lane] = Some(SeriesEnd { end, turn: turns[lane].0 });
                }
            }
            if (0..LANES).all(|lane| lost[lane] || crossed[lane].is_some()) {
                break;
            }
        }
        crossed
    }
}
