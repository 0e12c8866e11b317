use super::collocation::LaneCollocation;
use super::stages::LaneStages;
use super::state::{accumulate, loaded, store};
use super::{GaussEnsemble, LANES};
use lagrangian::simd::{Pack, Simd};

/// Eight trajectories of a collocation in registers.
#[repr(align(64))]
pub(super) struct EightLanes<Si: Simd, const R: usize, const S: usize, const N: usize> {
    pub(super) simd: Si,
    pub(super) q: [Pack<Si, R>; N],
    rest: [Pack<Si, R>; N],
    pub(super) xi: [Pack<Si, R>; N],
    pub(super) stages: LaneStages<Si, R, S, N>,
    pub(super) velocity: [[Pack<Si, R>; S]; N],
    pub(super) acceleration: [[Pack<Si, R>; S]; N],
    /// The number of iterations of the last step; zero where there is no predictor.
    pub(super) iterations: u32,
}

impl<Si: Simd, const R: usize, const S: usize, const N: usize> EightLanes<Si, R, S, N> {
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
        Self { simd, q, rest, xi, stages: LaneStages::still(&q, &xi), velocity, acceleration, iterations }
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
        of.iterations[LANES * register] = self.iterations;
    }

    /// From the slopes to the end of the step, with compensated sums; the first `free` quasi-velocities count.
    #[inline(always)]
    pub(super) fn end(&mut self, collocation: &LaneCollocation<S>, free: usize) {
        for k in 0..N {
            accumulate(&mut self.q[k], &mut self.rest[k], collocation.increment(&self.velocity[k]));
        }
        for k in 0..free {
            self.xi[k] += collocation.increment(&self.acceleration[k]);
        }
    }

    /// Adds a number to all of each lane: zero, or NaN.
    #[inline(always)]
    pub(super) fn lose(&mut self, lost: &[f64; LANES]) {
        let lost = Pack::load(self.simd, lost);
        for k in 0..N {
            (self.q[k], self.xi[k]) = (self.q[k] + lost, self.xi[k] + lost);
        }
    }
}
