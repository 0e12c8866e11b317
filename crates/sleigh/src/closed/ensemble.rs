use super::lanes::{ClosedLaneStep, bounds, frame, impulse_unit, prepared, step};
use super::{ClosedForm, ClosedStart, Memory};
use crate::Sleigh;
use dla::ensemble::{BLOCK, LANES, Row, accumulate, loaded, store};
use dla::{Ensemble, LaneState};
use lagrangian::simd::{Kernel, Pack, Simd, dispatch_widest};
use lagrangian::{System, added, from_fn};

/// The first steps have no frame before them, and are made twice: as few as leave a frame behind.
const FIRST: u64 = 4;

/// `W` free sleighs by the midpoint discrete Lagrange-d'Alembert map in closed form: eights in the widest registers of the machine.
///
/// What a trajectory gives does not depend on its neighbours.
#[derive(Debug, Clone, Copy)]
pub struct ClosedEnsemble<const W: usize> {
    sleighs: [Sleigh; W],
    step: f64,
    prepared: [Row<W>; 4],
    run: LaneSteps<W>,
    begun: bool,
}

/// What a block of steps changes.
#[derive(Debug, Clone, Copy)]
struct LaneSteps<const W: usize> {
    state: LaneState<3, W>,
    frame: [Row<W>; 6],
    largest: Row<W>,
    bad: [bool; W],
}

impl<const W: usize> ClosedEnsemble<W> {
    /// The sleighs with steps of length `h` (s), at these states.
    #[must_use]
    pub fn new(sleighs: [Sleigh; W], h: f64, state: LaneState<3, W>) -> Self {
        const { assert!(W.is_multiple_of(LANES), "trajectories go in eights") };
        let each: [[f64; 4]; W] = from_fn(|lane| prepared(&sleighs[lane], h));
        let prepared = from_fn(|k| Row(from_fn(|lane| each[lane][k])));
        let frame = [Row([f64::NAN; W]); 6];
        let run = LaneSteps { state, frame, largest: Row::ZERO, bad: [false; W] };
        Self { sleighs, step: h, prepared, run, begun: false }
    }

    /// The largest force of the blade on a lane, averaged over a step (N).
    #[must_use]
    pub fn largest_multiplier(&self, lane: usize) -> f64 {
        self.run.largest.0[lane] * (impulse_unit(&self.sleighs[lane]) / self.step.abs())
    }

    /// Makes a block again from its beginning, and takes of it the lanes whose steps were not good: by wide steps, and where
    /// these are not good either by the map of one sleigh.
    #[cold]
    fn repair(&mut self, steps: u64, before: &LaneSteps<W>) {
        let mut wide = *before;
        dispatch_widest(LaneBlock::<true, _> { prepared: &self.prepared, steps, run: &mut wide });
        let Self { sleighs, step, run, .. } = self;
        for lane in 0..W {
            if run.bad[lane] {
                run.take(lane, &wide);
                if run.bad[lane] {
                    run.take(lane, before);
                    if one_by_one(&sleighs[lane], *step, steps, lane, run).is_none() {
                        run.state.lose(lane);
                    }
                }
            }
        }
    }
}

impl<const W: usize> Ensemble<3, W> for ClosedEnsemble<W> {
    fn state(&self) -> &LaneState<3, W> {
        &self.run.state
    }

    fn advance(&mut self, steps: u64) {
        let mut made = 0;
        while made < steps {
            let block = if self.begun { BLOCK } else { FIRST }.min(steps - made);
            self.begun = true;
            let before = self.run;
            dispatch_widest(LaneBlock::<false, _> { prepared: &self.prepared, steps: block, run: &mut self.run });
            if self.run.bad.contains(&true) {
                self.repair(block, &before);
            }
            self.run.state.wrap();
            made += block;
        }
    }
}

/// Steps of all lanes; those that were not good are marked.
struct LaneBlock<'a, const WIDE: bool, const W: usize> {
    prepared: &'a [Row<W>; 4],
    steps: u64,
    run: &'a mut LaneSteps<W>,
}

/// Eight trajectories in registers.
struct EightSleighs<S: Simd, const K: usize> {
    prepared: [Pack<S, K>; 4],
    q: [Pack<S, K>; 3],
    rest: [Pack<S, K>; 3],
    xi: [Pack<S, K>; 3],
    frame: [Pack<S, K>; 6],
    largest: Pack<S, K>,
    doubts: [Pack<S, K>; 2],
    lowest: Pack<S, K>,
}

impl<S: Simd, const K: usize> EightSleighs<S, K> {
    #[inline(always)]
    fn step<const WIDE: bool>(&mut self) {
        let ClosedLaneStep { increment, xi, frame, impulse, doubts, positive } =
            step::<WIDE, S, K>(&self.prepared, &self.xi, &self.frame);
        for k in 0..3 {
            accumulate(&mut self.q[k], &mut self.rest[k], increment[k]);
        }
        (self.xi, self.frame) = (xi, frame);
        self.largest = self.largest.max_abs(impulse);
        for k in 0..2 {
            self.doubts[k] = self.doubts[k].max_abs(doubts[k]);
        }
        if WIDE {
            self.lowest = self.lowest.min(positive);
        }
    }
}

impl<const WIDE: bool, const W: usize> Kernel for LaneBlock<'_, WIDE, W> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const K: usize>(self, simd: S) {
        let (mut r, bounds) = (0, bounds::<WIDE>());
        // Two whose steps do not wait for each other, where each has registers of its own.
        while !WIDE && K == 1 && r + 1 < W / LANES {
            let (mut one, mut other) = (self.eight::<S, K>(simd, r), self.eight::<S, K>(simd, r + 1));
            for _ in 0..self.steps {
                one.step::<WIDE>();
                other.step::<WIDE>();
            }
            self.run.end(r, &one, bounds);
            self.run.end(r + 1, &other, bounds);
            r += 2;
        }
        while r < W / LANES {
            let mut one = self.eight::<S, K>(simd, r);
            for _ in 0..self.steps {
                one.step::<WIDE>();
            }
            self.run.end(r, &one, bounds);
            r += 1;
        }
    }
}

impl<const WIDE: bool, const W: usize> LaneBlock<'_, WIDE, W> {
    #[inline(always)]
    fn eight<S: Simd, const K: usize>(&self, simd: S, r: usize) -> EightSleighs<S, K> {
        let LaneSteps { state, frame: before, largest, .. } = &*self.run;
        let q = loaded(simd, &state.q, r);
        let [largest] = loaded(simd, &[*largest], r);
        EightSleighs {
            prepared: loaded(simd, self.prepared, r),
            q,
            rest: loaded(simd, &state.rest, r),
            xi: loaded(simd, &state.xi, r),
            frame: frame(&q, &loaded(simd, before, r)),
            largest,
            doubts: [Pack::splat(simd, 0.0); 2],
            lowest: Pack::splat(simd, 1.0),
        }
    }
}

impl<const W: usize> LaneSteps<W> {
    /// Puts eights back after their steps, which were good where their doubts are within the bounds.
    #[inline(always)]
    fn end<S: Simd, const K: usize>(&mut self, r: usize, eight: &EightSleighs<S, K>, bounds: [f64; 2]) {
        let Self { state, frame, largest, bad } = self;
        for k in 0..3 {
            store(&mut state.q[k], r, &eight.q[k]);
            store(&mut state.rest[k], r, &eight.rest[k]);
            store(&mut state.xi[k], r, &eight.xi[k]);
        }
        (0..6).for_each(|k| store(&mut frame[k], r, &eight.frame[k]));
        store(largest, r, &eight.largest);
        let (doubts, lowest) = (eight.doubts.map(|doubt| doubt.row()), eight.lowest.row());
        for i in 0..LANES {
            let lane = LANES * r + i;
            // A step that is not a number leaves none behind, whatever the larger of that and a number is here.
            let sure = (0..2).all(|k| doubts[k][i] <= bounds[k]);
            let good = sure && lowest[i] > 0.0 && state.is_finite(lane);
            bad[lane] = !good;
        }
    }

    fn take(&mut self, lane: usize, other: &Self) {
        self.state.take(lane, &other.state);
        (0..6).for_each(|k| self.frame[k].0[lane] = other.frame[k].0[lane]);
        self.largest.0[lane] = other.largest.0[lane];
        self.bad[lane] = other.bad[lane];
    }
}

/// Steps of one lane by the map of one sleigh; none where a step has no solution.
#[cold]
#[inline(never)]
fn one_by_one<const W: usize>(sleigh: &Sleigh, h: f64, steps: u64, lane: usize, run: &mut LaneSteps<W>) -> Option<()> {
    let (LaneSteps { state, frame, largest, .. }, unit) = (run, impulse_unit(sleigh));
    for _ in 0..steps {
        let (q, xi) = (state.q(lane), state.xi(lane));
        let v = sleigh.admissible_basis(0.0, &q)?.combine(&xi);
        // Nothing is remembered, so that the steps are the same wherever a block of them begins.
        let mut memory = Memory::EMPTY;
        let start = ClosedStart { xi: Some(xi), ..ClosedStart::new(&q, &v, &mut memory) };
        let step = sleigh.closed_step(0.0, h, start)?.ok()?;
        if !step.xi.iter().all(|x| x.is_finite()) {
            return None;
        }
        for k in 0..3 {
            (state.q[k].0[lane], state.rest[k].0[lane]) = added(q[k], step.increment[k] + state.rest[k].0[lane]);
            state.xi[k].0[lane] = step.xi[k];
        }
        let impulse = step.impulses[0][0] + step.impulses[1][0];
        largest.0[lane] = largest.0[lane].max((impulse / unit).abs());
    }
    // What the next step would extrapolate from is not known.
    (0..6).for_each(|k| frame[k].0[lane] = f64::NAN);
    Some(())
}
