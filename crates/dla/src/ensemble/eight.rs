use super::settling::Settling;
use super::stages::{Slope, Stages};
use super::state::{loaded, store};
use super::{GaussEnsemble, LANES, Systems};
use lagrangian::System;
use lagrangian::simd::{Pack, Simd};

/// Eight trajectories of a collocation in registers.
#[repr(align(64))]
pub(super) struct Eight<Si: Simd, const R: usize, const S: usize, const N: usize> {
    simd: Si,
    q: [Pack<Si, R>; N],
    rest: [Pack<Si, R>; N],
    xi: [Pack<Si, R>; N],
    stages: Stages<Si, R, S, N>,
    velocity: [[Pack<Si, R>; S]; N],
    acceleration: [[Pack<Si, R>; S]; N],
    /// Of the last step.
    iterations: u32,
}

/// Iterations after which a step is given up.
const MOST: u32 = 100;

/// So many iterations of a step are looked at, if it takes as many as the one before.
const SEEN: u32 = 3;

impl<Si: Simd, const R: usize, const S: usize, const N: usize> Eight<Si, R, S, N> {
    /// The trajectories of one register of the ensemble.
    #[inline(always)]
    pub(super) fn load<Sys, Each, const W: usize, const M: usize>(
        simd: Si,
        of: &GaussEnsemble<Sys, Each, S, W, N, M>,
        register: usize,
    ) -> Self {
        let [q, rest, xi] = [
            loaded(simd, &of.state.q, register),
            loaded(simd, &of.state.rest, register),
            loaded(simd, &of.state.xi, register),
        ];
        let none = [[Pack::splat(simd, 0.0); S]; N];
        let (mut velocity, mut acceleration) = (none, none);
        for k in 0..N {
            velocity[k] = loaded(simd, &of.slopes[0][k], register);
            acceleration[k] = loaded(simd, &of.slopes[1][k], register);
        }
        let iterations = of.iterations[LANES * register];
        Self { simd, q, rest, xi, stages: Stages::still(&q, &xi), velocity, acceleration, iterations }
    }

    /// Puts them back.
    #[inline(always)]
    pub(super) fn store<Sys, Each, const W: usize, const M: usize>(
        &self,
        of: &mut GaussEnsemble<Sys, Each, S, W, N, M>,
        register: usize,
    ) {
        for k in 0..N {
            store(&mut of.state.q[k], register, &self.q[k]);
            store(&mut of.state.rest[k], register, &self.rest[k]);
            store(&mut of.state.xi[k], register, &self.xi[k]);
            for i in 0..S {
                store(&mut of.slopes[0][k][i], register, &self.velocity[k][i]);
                store(&mut of.slopes[1][k][i], register, &self.acceleration[k][i]);
            }
        }
        of.iterations[LANES * register..][..LANES].fill(self.iterations);
    }

    /// Makes a step; how many iterations it took.
    #[inline(always)]
    pub(super) fn step<Sys, Each, const W: usize, const M: usize>(
        &mut self,
        of: &GaussEnsemble<Sys, Each, S, W, N, M>,
        register: usize,
        made: u64,
    ) -> u32
    where
        Sys: System<N, M>,
        Each: Systems<Sys, W>,
    {
        let (t0, h) = of.schedule;
        let t = t0 + made as f64 * h;
        let mut times = [t; S];
        for i in 0..S {
            times[i] = t + of.collocation.nodes[i] * h;
        }
        let at = (register, &times);
        if made == 0 {
            self.begin(of, register, t);
        } else {
            self.begin_after(of);
        }
        let unseen = self.iterations.saturating_sub(SEEN);
        let mut settling = Settling::to(of.settled);
        let (mut iterations, mut size) = (0, [0.0; LANES]);
        let mut open = true;
        while open && iterations < MOST {
            iterations += 1;
            for k in 0..N - M {
                of.collocation.integrate(self.xi[k], &self.acceleration[k], &mut self.stages.xi[k]);
            }
            self.coordinates::<_, _, true, W, M>(of, at, &of.order.iterated[0]);
            self.coordinates::<_, _, false, W, M>(of, at, &of.order.iterated[1]);
            if iterations <= unseen {
                self.accelerations::<_, _, false, W, M>(of, at);
            } else {
                let [moved, sizes] = self.accelerations::<_, _, true, W, M>(of, at);
                size = sizes.row();
                open = settling.look(&moved.row(), &size);
            }
        }
        self.iterations = iterations;
        self.coordinates::<_, _, true, W, M>(of, at, &of.order.quadratures[0]);
        self.coordinates::<_, _, false, W, M>(of, at, &of.order.quadratures[1]);
        self.end(of);
        if open {
            let lost = Pack::load(self.simd, &settling.lost(&size));
            for k in 0..N {
                (self.q[k], self.xi[k]) = (self.q[k] + lost, self.xi[k] + lost);
            }
        }
        iterations
    }

    /// The slopes of a first step: nothing changes.
    #[inline(always)]
    fn begin<Sys, Each, const W: usize, const M: usize>(
        &mut self,
        of: &GaussEnsemble<Sys, Each, S, W, N, M>,
        register: usize,
        t: f64,
    ) where
        Sys: System<N, M>,
        Each: Systems<Sys, W>,
    {
        let angles = of.systems.of(0).angles();
        for k in 0..N {
            if angles[k] {
                self.stages.turn(k);
            }
        }
        let acceleration = &mut self.acceleration;
        self.stages.slopes(
            Slope::Acceleration,
            &of.systems,
            register,
            &[t; S],
            #[inline(always)]
            |i, found| {
                for k in 0..N - M {
                    acceleration[k][i] = found[k];
                }
            },
        );
    }

    /// The slopes of a step as those of the last one go on, and the coordinates from which velocities are found.
    #[inline(always)]
    fn begin_after<Sys, Each, const W: usize, const M: usize>(&mut self, of: &GaussEnsemble<Sys, Each, S, W, N, M>)
    where
        Sys: System<N, M>,
        Each: Systems<Sys, W>,
    {
        for k in 0..N - M {
            of.collocation.extrapolate(&mut self.acceleration[k]);
        }
        let angles = of.systems.of(0).angles();
        for k in 0..N {
            if of.order.carried[k] {
                of.collocation.extrapolate(&mut self.velocity[k]);
                of.collocation.integrate(self.q[k], &self.velocity[k], &mut self.stages.q[k]);
                if angles[k] {
                    self.stages.turn(k);
                }
            }
        }
    }

    /// The chosen coordinates of the stages, of those that are angles or of the others.
    #[inline(always)]
    fn coordinates<Sys, Each, const ANGLES: bool, const W: usize, const M: usize>(
        &mut self,
        of: &GaussEnsemble<Sys, Each, S, W, N, M>,
        (register, times): (usize, &[f64; S]),
        chosen: &[bool; N],
    ) where
        Sys: System<N, M>,
        Each: Systems<Sys, W>,
    {
        let mut any = false;
        for k in 0..N {
            any |= chosen[k];
        }
        if !any {
            return;
        }
        let (angles, velocity) = (of.systems.of(0).angles(), &mut self.velocity);
        self.stages.slopes(
            Slope::Velocity,
            &of.systems,
            register,
            times,
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
                of.collocation.integrate(self.q[k], &self.velocity[k], &mut self.stages.q[k]);
                if ANGLES {
                    self.stages.turn(k);
                }
            }
        }
    }

    /// The accelerations of the stages; how far they have moved and how large they are, where that is looked at.
    #[inline(always)]
    fn accelerations<Sys, Each, const LOOK: bool, const W: usize, const M: usize>(
        &mut self,
        of: &GaussEnsemble<Sys, Each, S, W, N, M>,
        (register, times): (usize, &[f64; S]),
    ) -> [Pack<Si, R>; 2]
    where
        Sys: System<N, M>,
        Each: Systems<Sys, W>,
    {
        let zero = Pack::splat(self.simd, 0.0);
        let (mut moved, mut size) = (zero, zero);
        let acceleration = &mut self.acceleration;
        self.stages.slopes(
            Slope::Acceleration,
            &of.systems,
            register,
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

    /// From the slopes to the end of the step, with compensated sums.
    #[inline(always)]
    fn end<Sys, Each, const W: usize, const M: usize>(&mut self, of: &GaussEnsemble<Sys, Each, S, W, N, M>) {
        for k in 0..N {
            let increment = of.collocation.increment(&self.velocity[k]) + self.rest[k];
            let sum = self.q[k] + increment;
            self.rest[k] = increment - (sum - self.q[k]);
            self.q[k] = sum;
        }
        for k in 0..N - M {
            self.xi[k] = self.xi[k] + of.collocation.increment(&self.acceleration[k]);
        }
    }
}
