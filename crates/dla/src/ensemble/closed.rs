use super::state::Row;
use super::{Ensemble, LaneState};
use lagrangian::{Abreast, ClosedLaneStep, ClosedLanes, System, array, vectorized};
use std::array::from_fn;

/// After so many steps frames are found anew from the configurations, so that their rounding does not add up, and angles are
/// wrapped.
const BLOCK: u64 = 64;

/// The first steps have no frame before them, and are made twice: as few as leave a frame behind.
const FIRST: u64 = 4;

/// Lanes of a vector register.
const LANES: usize = 8;

/// `W = 8 R` trajectories of the midpoint discrete Lagrange-d'Alembert map in closed form, each with a system of its own: `R`
/// registers interleaved, so that one computes while another waits for its own numbers.
///
/// What a trajectory gives does not depend on its neighbours.
#[derive(Debug, Clone, Copy)]
pub struct ClosedEnsemble<
    Sys,
    const R: usize,
    const W: usize,
    const N: usize,
    const M: usize,
    const P: usize,
    const F: usize,
> {
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
    bad: Row<W>,
}

impl<Sys, const R: usize, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize>
    ClosedEnsemble<Sys, R, W, N, M, P, F>
where
    Sys: System<N, M> + ClosedLanes<N, M, P, F> + Copy,
{
    /// The systems with steps of length `h` (s), at these states.
    #[must_use]
    pub fn new(systems: [Sys; W], h: f64, state: LaneState<N, W>) -> Self {
        const { assert!(W == LANES * R, "R registers have 8 R lanes") };
        let each: [[f64; P]; W] = from_fn(|lane| systems[lane].prepared(h));
        let prepared = from_fn(|k| Row(from_fn(|lane| each[lane][k])));
        let frame = [Row([f64::NAN; W]); F];
        Self {
            systems,
            step: h,
            prepared,
            run: Run { state, frame, largest: [Row::ZERO; M], bad: Row::ZERO },
            begun: false,
        }
    }

    /// The largest force of each constraint on a lane, averaged over a step (N).
    #[must_use]
    pub fn largest_multiplier(&self, lane: usize) -> [f64; M] {
        from_fn(|k| self.run.largest[k].0[lane] / self.step.abs())
    }
}

impl<Sys, const R: usize, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize> Ensemble<N, W>
    for ClosedEnsemble<Sys, R, W, N, M, P, F>
where
    Sys: System<N, M> + ClosedLanes<N, M, P, F> + Copy,
{
    fn state(&self) -> &LaneState<N, W> {
        &self.run.state
    }

    fn advance(&mut self, steps: u64) {
        let Self { systems, step, prepared, run, begun } = self;
        vectorized(
            #[inline(always)]
            || {
                let mut made = 0;
                while made < steps {
                    let block = if *begun { BLOCK } else { FIRST }.min(steps - made);
                    *begun = true;
                    run.find_frames::<Sys, P>();
                    let before = *run;
                    run.block::<Sys, false, R, P>(prepared, block);
                    if run.any_bad() {
                        repair::<Sys, R, W, N, M, P, F>(systems, *step, prepared, block, &before, run);
                    }
                    run.state.wrap();
                    made += block;
                }
            },
        );
    }
}

impl<const W: usize, const N: usize, const M: usize, const F: usize> Run<W, N, M, F> {
    #[inline(always)]
    fn find_frames<Sys: ClosedLanes<N, M, P, F>, const P: usize>(&mut self) {
        for lane in 0..W {
            let frame = Sys::frame(&from_fn(|k| self.state.q[k].0[lane]), &from_fn(|k| self.frame[k].0[lane]));
            for k in 0..F {
                self.frame[k].0[lane] = frame[k];
            }
            self.bad.0[lane] = 0.0;
        }
    }

    /// Steps of all lanes; those that were not good are marked.
    #[inline(always)]
    fn block<Sys: ClosedLanes<N, M, P, F>, const WIDE: bool, const R: usize, const P: usize>(
        &mut self,
        prepared: &[Row<W>; P],
        steps: u64,
    ) {
        for _ in 0..steps {
            for i in 0..LANES {
                let prepared = loaded(prepared, i);
                let xi = loaded(&self.state.xi, i);
                let frame = loaded(&self.frame, i);
                let ClosedLaneStep { increment, xi, frame, impulse, good } =
                    Sys::step::<WIDE, R>(&prepared, &xi, &frame);
                for k in 0..N {
                    let (q, rest) = (load(&self.state.q[k], i), load(&self.state.rest[k], i));
                    let increment = increment[k] + rest;
                    let sum = q + increment;
                    store(&mut self.state.rest[k], i, &(increment - (sum - q)));
                    store(&mut self.state.q[k], i, &sum);
                    store(&mut self.state.xi[k], i, &xi[k]);
                }
                for k in 0..F {
                    store(&mut self.frame[k], i, &frame[k]);
                }
                for k in 0..M {
                    let (before, now) = (load::<R, W>(&self.largest[k], i), impulse[k].abs());
                    let larger: [f64; R] = array(
                        0.0,
                        #[inline(always)]
                        |r| if now.of[r] > before.of[r] { now.of[r] } else { before.of[r] },
                    );
                    store(&mut self.largest[k], i, &Abreast::new(larger));
                }
                let bad = load::<R, W>(&self.bad, i);
                let bad: [f64; R] = array(
                    1.0,
                    #[inline(always)]
                    |r| if good[r] { bad.of[r] } else { 1.0 },
                );
                store(&mut self.bad, i, &Abreast::new(bad));
            }
        }
    }

    #[inline(always)]
    fn any_bad(&self) -> bool {
        self.bad.0.iter().fold(0.0, |any, bad| any + bad) != 0.0
    }

    fn take(&mut self, lane: usize, other: &Self) {
        self.state.take(lane, &other.state);
        (0..F).for_each(|k| self.frame[k].0[lane] = other.frame[k].0[lane]);
        (0..M).for_each(|k| self.largest[k].0[lane] = other.largest[k].0[lane]);
        self.bad.0[lane] = other.bad.0[lane];
    }
}

/// The numbers of lane `i` of each register.
#[inline(always)]
fn load<const R: usize, const W: usize>(row: &Row<W>, i: usize) -> Abreast<R> {
    Abreast::new(array(
        0.0,
        #[inline(always)]
        |r| row.0[i + LANES * r],
    ))
}

/// Those of some rows.
#[inline(always)]
fn loaded<const R: usize, const W: usize, const K: usize>(rows: &[Row<W>; K], i: usize) -> [Abreast<R>; K] {
    array(
        Abreast::new([0.0; R]),
        #[inline(always)]
        |k| load(&rows[k], i),
    )
}

#[inline(always)]
fn store<const R: usize, const W: usize>(row: &mut Row<W>, i: usize, x: &Abreast<R>) {
    for r in 0..R {
        row.0[i + LANES * r] = x.of[r];
    }
}

/// Makes a block again from its beginning, and takes of it the lanes whose steps were not good: by wide steps, and where these
/// are not good either by the map of one system.
#[inline(always)]
fn repair<Sys, const R: usize, const W: usize, const N: usize, const M: usize, const P: usize, const F: usize>(
    systems: &[Sys; W],
    h: f64,
    prepared: &[Row<W>; P],
    steps: u64,
    before: &Run<W, N, M, F>,
    run: &mut Run<W, N, M, F>,
) where
    Sys: System<N, M> + ClosedLanes<N, M, P, F>,
{
    let mut wide = *before;
    wide.block::<Sys, true, R, P>(prepared, steps);
    for lane in 0..W {
        if run.bad.0[lane] != 0.0 {
            run.take(lane, &wide);
            if run.bad.0[lane] != 0.0 {
                run.take(lane, before);
                if one_by_one(&systems[lane], h, steps, lane, run).is_none() {
                    run.state.lose(lane);
                }
            }
        }
    }
}

/// Steps of one lane by the map of one system; none where a step has no solution.
#[cold]
#[inline(never)]
fn one_by_one<Sys: System<N, M>, const W: usize, const N: usize, const M: usize, const F: usize>(
    system: &Sys,
    h: f64,
    steps: u64,
    lane: usize,
    run: &mut Run<W, N, M, F>,
) -> Option<()> {
    let Run { state, frame, largest, .. } = run;
    for _ in 0..steps {
        let (q, xi) = (state.q(lane), state.xi(lane));
        let step = system.closed_step(0.0, h, &q, &[0.0; N], Some(xi), None)?.ok()?;
        for k in 0..N {
            let increment = step.increment[k] + state.rest[k].0[lane];
            let sum = q[k] + increment;
            state.rest[k].0[lane] = increment - (sum - q[k]);
            (state.q[k].0[lane], state.xi[k].0[lane]) = (sum, step.xi[k]);
        }
        for k in 0..M {
            let impulse = step.impulses[0][k] + step.impulses[1][k];
            largest[k].0[lane] = largest[k].0[lane].max(impulse.abs());
        }
    }
    // What the next step would extrapolate from is not known.
    (0..F).for_each(|k| frame[k].0[lane] = f64::NAN);
    Some(())
}
