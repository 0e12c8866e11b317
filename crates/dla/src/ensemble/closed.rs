use super::state::{Row, accumulate, loaded, store};
use super::{BLOCK, Ensemble, LANES, LaneState};
use lagrangian::simd::{Kernel, Pack, Simd, dispatch_widest};
use lagrangian::{ClosedLaneStep, ClosedLanes, Memory, Start, System, added, from_fn};
use std::marker::PhantomData;

/// The first steps have no frame before them, and are made twice: as few as leave a frame behind.
const FIRST: u64 = 4;

/// `W` trajectories of the midpoint discrete Lagrange-d'Alembert map in closed form, each with a system of its own: eights in
/// the widest registers of the machine.
///
/// What a trajectory gives does not depend on its neighbours.
#[derive(Debug, Clone, Copy)]
pub struct ClosedEnsemble<Sys, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize> {
    systems: [Sys; W],
    step: f64,
    prepared: [Row<W>; P],
    run: Run<W, N, M, F>,
    begun: bool,
}

/// What a block of steps changes.
#[derive(Debug, Clone, Copy)]
struct Run<const W: usize, const N: usize, const M: usize, const F: usize> {
    state: LaneState<N, W>,
    frame: [Row<W>; F],
    largest: [Row<W>; M],
    bad: [bool; W],
}

impl<Sys, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize>
    ClosedEnsemble<Sys, W, N, M, P, F>
where
    Sys: System<N, M> + ClosedLanes<N, M, P, F> + Copy,
{
    /// The systems with steps of length `h` (s), at these states.
    #[must_use]
    pub fn new(systems: [Sys; W], h: f64, state: LaneState<N, W>) -> Self {
        const { assert!(W.is_multiple_of(LANES), "trajectories go in eights") };
        let each: [[f64; P]; W] = from_fn(|lane| systems[lane].prepared(h));
        let prepared = from_fn(|k| Row(from_fn(|lane| each[lane][k])));
        let frame = [Row([f64::NAN; W]); F];
        Self {
            systems,
            step: h,
            prepared,
            run: Run { state, frame, largest: [Row::ZERO; M], bad: [false; W] },
            begun: false,
        }
    }

    /// The largest force of each constraint on a lane, averaged over a step (N).
    #[must_use]
    pub fn largest_multiplier(&self, lane: usize) -> [f64; M] {
        let units = self.systems[lane].impulse_units();
        from_fn(|k| self.run.largest[k].0[lane] * (units[k] / self.step.abs()))
    }

    /// Makes a block again from its beginning, and takes of it the lanes whose steps were not good: by wide steps, and where
    /// these are not good either by the map of one system.
    #[cold]
    fn repair(&mut self, steps: u64, before: &Run<W, N, M, F>) {
        let mut wide = *before;
        dispatch_widest(Block::<Sys, true, _, _, _, _, _>::new(&self.prepared, steps, &mut wide));
        let Self { systems, step, run, .. } = self;
        for lane in 0..W {
            if run.bad[lane] {
                run.take(lane, &wide);
                if run.bad[lane] {
                    run.take(lane, before);
                    let units = systems[lane].impulse_units();
                    if one_by_one(&systems[lane], (*step, units), steps, lane, run).is_none() {
                        run.state.lose(lane);
                    }
                }
            }
        }
    }
}

impl<Sys, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize> Ensemble<N, W>
    for ClosedEnsemble<Sys, W, N, M, P, F>
where
    Sys: System<N, M> + ClosedLanes<N, M, P, F> + Copy,
{
    fn state(&self) -> &LaneState<N, W> {
        &self.run.state
    }

    fn advance(&mut self, steps: u64) {
        let mut made = 0;
        while made < steps {
            let block = if self.begun { BLOCK } else { FIRST }.min(steps - made);
            self.begun = true;
            let before = self.run;
            dispatch_widest(Block::<Sys, false, _, _, _, _, _>::new(&self.prepared, block, &mut self.run));
            if self.run.bad.contains(&true) {
                self.repair(block, &before);
            }
            self.run.state.wrap();
            made += block;
        }
    }
}

/// Steps of all lanes; those that were not good are marked.
struct Block<'a, Sys, const WIDE: bool, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize>
{
    prepared: &'a [Row<W>; P],
    steps: u64,
    run: &'a mut Run<W, N, M, F>,
    of: PhantomData<Sys>,
}

impl<'a, Sys, const WIDE: bool, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize>
    Block<'a, Sys, WIDE, W, N, M, P, F>
{
    fn new(prepared: &'a [Row<W>; P], steps: u64, run: &'a mut Run<W, N, M, F>) -> Self {
        Self { prepared, steps, run, of: PhantomData }
    }
}

/// Eight trajectories in registers.
struct Eight<S: Simd, const K: usize, const N: usize, const M: usize, const P: usize, const F: usize> {
    prepared: [Pack<S, K>; P],
    q: [Pack<S, K>; N],
    rest: [Pack<S, K>; N],
    xi: [Pack<S, K>; N],
    frame: [Pack<S, K>; F],
    largest: [Pack<S, K>; M],
    doubts: [Pack<S, K>; 2],
    lowest: Pack<S, K>,
}

impl<S: Simd, const K: usize, const N: usize, const M: usize, const P: usize, const F: usize> Eight<S, K, N, M, P, F> {
    #[inline(always)]
    fn step<Sys: ClosedLanes<N, M, P, F>, const WIDE: bool>(&mut self) {
        let ClosedLaneStep { increment, xi, frame, impulse, doubts, positive } =
            Sys::step::<WIDE, Pack<S, K>>(&self.prepared, &self.xi, &self.frame);
        for k in 0..N {
            accumulate(&mut self.q[k], &mut self.rest[k], increment[k]);
        }
        (self.xi, self.frame) = (xi, frame);
        for k in 0..M {
            self.largest[k] = self.largest[k].max_abs(impulse[k]);
        }
        for k in 0..2 {
            self.doubts[k] = self.doubts[k].max_abs(doubts[k]);
        }
        if WIDE {
            self.lowest = self.lowest.min(positive);
        }
    }
}

impl<Sys, const WIDE: bool, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize> Kernel
    for Block<'_, Sys, WIDE, W, N, M, P, F>
where
    Sys: ClosedLanes<N, M, P, F>,
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd, const K: usize>(self, simd: S) {
        let (mut r, bounds) = (0, Sys::bounds::<WIDE>());
        // Two whose steps do not wait for each other, where each has registers of its own.
        while !WIDE && K == 1 && r + 1 < W / LANES {
            let (mut one, mut other) = (self.eight::<S, K>(simd, r), self.eight::<S, K>(simd, r + 1));
            for _ in 0..self.steps {
                one.step::<Sys, WIDE>();
                other.step::<Sys, WIDE>();
            }
            self.run.end(r, &one, bounds);
            self.run.end(r + 1, &other, bounds);
            r += 2;
        }
        while r < W / LANES {
            let mut one = self.eight::<S, K>(simd, r);
            for _ in 0..self.steps {
                one.step::<Sys, WIDE>();
            }
            self.run.end(r, &one, bounds);
            r += 1;
        }
    }
}

impl<Sys, const WIDE: bool, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize>
    Block<'_, Sys, WIDE, W, N, M, P, F>
where
    Sys: ClosedLanes<N, M, P, F>,
{
    #[inline(always)]
    fn eight<S: Simd, const K: usize>(&self, simd: S, r: usize) -> Eight<S, K, N, M, P, F> {
        let Run { state, frame, largest, .. } = &*self.run;
        let q = loaded(simd, &state.q, r);
        Eight {
            prepared: loaded(simd, self.prepared, r),
            q,
            rest: loaded(simd, &state.rest, r),
            xi: loaded(simd, &state.xi, r),
            frame: Sys::frame(&q, &loaded(simd, frame, r)),
            largest: loaded(simd, largest, r),
            doubts: [Pack::splat(simd, 0.0); 2],
            lowest: Pack::splat(simd, 1.0),
        }
    }
}

impl<const W: usize, const N: usize, const M: usize, const F: usize> Run<W, N, M, F> {
    /// Puts eights back after their steps, which were good where their doubts are within the bounds.
    #[inline(always)]
    fn end<S: Simd, const K: usize, const P: usize>(
        &mut self,
        r: usize,
        eight: &Eight<S, K, N, M, P, F>,
        bounds: [f64; 2],
    ) {
        let Self { state, frame, largest, bad } = self;
        for k in 0..N {
            store(&mut state.q[k], r, &eight.q[k]);
            store(&mut state.rest[k], r, &eight.rest[k]);
            store(&mut state.xi[k], r, &eight.xi[k]);
        }
        (0..F).for_each(|k| store(&mut frame[k], r, &eight.frame[k]));
        (0..M).for_each(|k| store(&mut largest[k], r, &eight.largest[k]));
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
        (0..F).for_each(|k| self.frame[k].0[lane] = other.frame[k].0[lane]);
        (0..M).for_each(|k| self.largest[k].0[lane] = other.largest[k].0[lane]);
        self.bad[lane] = other.bad[lane];
    }
}

/// Steps of one lane by the map of one system; none where a step has no solution.
#[cold]
#[inline(never)]
fn one_by_one<Sys: System<N, M>, const W: usize, const N: usize, const M: usize, const F: usize>(
    system: &Sys,
    (h, units): (f64, [f64; M]),
    steps: u64,
    lane: usize,
    run: &mut Run<W, N, M, F>,
) -> Option<()> {
    let Run { state, frame, largest, .. } = run;
    for _ in 0..steps {
        let (q, xi) = (state.q(lane), state.xi(lane));
        let v = system.admissible_basis(0.0, &q)?.combine(&xi);
        // Nothing is remembered, so that the steps are the same wherever a block of them begins.
        let mut memory = Memory::EMPTY;
        let start = Start { xi: Some(xi), ..Start::new(&q, &v, &mut memory) };
        let step = system.closed_step(0.0, h, start)?.ok()?;
        if !step.xi.iter().all(|x| x.is_finite()) {
            return None;
        }
        for k in 0..N {
            (state.q[k].0[lane], state.rest[k].0[lane]) = added(q[k], step.increment[k] + state.rest[k].0[lane]);
            state.xi[k].0[lane] = step.xi[k];
        }
        for k in 0..M {
            let impulse = step.impulses[0][k] + step.impulses[1][k];
            largest[k].0[lane] = largest[k].0[lane].max((impulse / units[k]).abs());
        }
    }
    // What the next step would extrapolate from is not known.
    (0..F).for_each(|k| frame[k].0[lane] = f64::NAN);
    Some(())
}
