use super::eight::EightLanes;
use super::settling::Settling;
use super::stages::StageSlope;
use super::{GaussEnsemble, LANES, Systems};
use lagrangian::System;
use lagrangian::simd::{Pack, Simd, apart};

/// A step of the eight trajectories of one register.
pub(super) struct LaneStep<'a, Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> {
    of: &'a GaussEnsemble<Sys, Each, S, W, N, M>,
    register: usize,
    first: bool,
    /// The times of its beginning, and of its stages.
    t: f64,
    times: [f64; S],
}

/// Iterations after which a step fails.
const MOST: u32 = 100;

/// So many iterations of a step have a convergence test, if the step takes as many as the last one.
const SEEN: u32 = 3;

impl<'a, Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> LaneStep<'a, Sys, Each, S, W, N, M>
where
    Sys: System<N, M>,
    Each: Systems<Sys, W>,
{
    /// The step after so many.
    #[inline(always)]
    pub(super) fn after(made: u64, of: &'a GaussEnsemble<Sys, Each, S, W, N, M>, register: usize) -> Self {
        let (t0, h) = of.schedule;
        let t = t0 + made as f64 * h;
        let mut times = [t; S];
        for i in 0..S {
            times[i] = t + of.collocation.nodes[i] * h;
        }
        Self { of, register, first: made == 0, t, times }
    }

    /// Makes it; how many iterations it took.
    #[inline(always)]
    pub(super) fn make<Si: Simd, const R: usize>(&self, eight: &mut EightLanes<Si, R, S, N>) -> u32 {
        let Self { of, .. } = self;
        apart(
            eight.simd,
            #[inline(always)]
            || if self.first { self.begin(eight) } else { self.begin_after_another(eight) },
        );
        let unseen = eight.iterations.saturating_sub(SEEN);
        let mut settling = Settling::to(of.settled);
        let (mut iterations, mut size) = (0, [0.0; LANES]);
        let mut open = true;
        while open && iterations < MOST {
            iterations += 1;
            for k in 0..N - M {
                of.collocation.integrate(eight.xi[k], &eight.acceleration[k], &mut eight.stages.xi[k]);
            }
            self.coordinates::<true, _, _>(eight, &of.order.iterated[0]);
            self.coordinates::<false, _, _>(eight, &of.order.iterated[1]);
            if iterations <= unseen {
                self.accelerations::<false, _, _>(eight, &self.times);
            } else {
                let [moved, sizes] = self.accelerations::<true, _, _>(eight, &self.times);
                size = sizes.row();
                open = settling.look(&moved.row(), &size);
            }
        }
        apart(
            eight.simd,
            #[inline(always)]
            || {
                self.coordinates::<true, _, _>(eight, &of.order.quadratures[0]);
                self.coordinates::<false, _, _>(eight, &of.order.quadratures[1]);
            },
        );
        eight.end(&of.collocation, N - M);
        eight.iterations = if open { 0 } else { iterations };
        if open {
            eight.lose(&settling.lost(&size));
        }
        iterations
    }

    /// The slopes of a first step: zero.
    #[inline(always)]
    fn begin<Si: Simd, const R: usize>(&self, eight: &mut EightLanes<Si, R, S, N>) {
        let angles = self.of.systems.of(0).angles();
        for k in 0..N {
            if angles[k] {
                eight.stages.turn(k);
            }
        }
        self.accelerations::<false, _, _>(eight, &[self.t; S]);
    }

    /// The predictor: the slopes of the last step continued to this one, and the coordinates from which velocities are computed.
    #[inline(always)]
    fn begin_after_another<Si: Simd, const R: usize>(&self, eight: &mut EightLanes<Si, R, S, N>) {
        let collocation = &self.of.collocation;
        for k in 0..N - M {
            collocation.extrapolate(&mut eight.acceleration[k]);
        }
        let angles = self.of.systems.of(0).angles();
        for k in 0..N {
            if self.of.order.carried[k] {
                collocation.extrapolate(&mut eight.velocity[k]);
                collocation.integrate(eight.q[k], &eight.velocity[k], &mut eight.stages.q[k]);
                if angles[k] {
                    eight.stages.turn(k);
                }
            }
        }
    }

    /// The chosen coordinates of the stages, of those that are angles or of the others.
    #[inline(always)]
    fn coordinates<const ANGLES: bool, Si: Simd, const R: usize>(
        &self,
        eight: &mut EightLanes<Si, R, S, N>,
        chosen: &[bool; N],
    ) {
        let mut any = false;
        for k in 0..N {
            any |= chosen[k];
        }
        if !any {
            return;
        }
        let (angles, velocity) = (self.of.systems.of(0).angles(), &mut eight.velocity);
        eight.stages.slopes(
            StageSlope::Velocity,
            &self.of.systems,
            self.register,
            &self.times,
            #[inline(always)]
            |i, found| {
                for k in 0..N {
                    if angles[k] == ANGLES {
                        velocity[k][i] = found[k];
                    }
                }
            },
        );
        for k in 0..N {
            if chosen[k] {
                self.of.collocation.integrate(eight.q[k], &eight.velocity[k], &mut eight.stages.q[k]);
                if ANGLES {
                    eight.stages.turn(k);
                }
            }
        }
    }

    /// The accelerations of the stages at these times; their changes and sizes, where the iteration has a test.
    #[inline(always)]
    fn accelerations<const LOOK: bool, Si: Simd, const R: usize>(
        &self,
        eight: &mut EightLanes<Si, R, S, N>,
        times: &[f64; S],
    ) -> [Pack<Si, R>; 2] {
        let zero = Pack::splat(eight.simd, 0.0);
        let (mut moved, mut size) = (zero, zero);
        let acceleration = &mut eight.acceleration;
        eight.stages.slopes(
            StageSlope::Acceleration,
            &self.of.systems,
            self.register,
            times,
            #[inline(always)]
            |i, found| {
                for k in 0..N - M {
                    if LOOK {
                        moved = moved.max_abs(found[k] - acceleration[k][i]);
                        size = size.max_abs(found[k]);
                    }
                    acceleration[k][i] = found[k];
                }
            },
        );
        [moved, size]
    }
}
