use super::collocation::LaneCollocation;
use super::eight::EightLanes;
use super::order::Order;
use super::state::Row;
use super::step::LaneStep;
use super::{BLOCK, Ensemble, LANES, LaneState, Systems};
use crate::convergence::tolerances::LEFT;
use lagrangian::System;
use lagrangian::simd::{Kernel, Simd, dispatch_widest};
use std::marker::PhantomData;

/// `W` trajectories by Gauss collocation with `S` stages, an even number: the method [`Gauss`](crate::Gauss), eight
/// trajectories to a register.
///
/// Stages are found by fixed-point iteration, with the collocation polynomial of the step before as predictor; within an iteration angles
/// come before what depends on them. It ends where in each of the eight lanes the next change would be round-off. Coordinates
/// that nothing depends on are quadratures, made at the end of a step.
///
/// One system for all ([`Same`](super::Same)) is evaluated in registers; where each has its own
/// ([`Each`](super::Each)), the lanes are gathered one by one.
#[derive(Debug, Clone)]
pub struct GaussEnsemble<Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> {
    pub(super) systems: Each,
    pub(super) collocation: LaneCollocation<S>,
    pub(super) order: Order<N>,
    /// Time of the start, and length of a step (s).
    pub(super) schedule: (f64, f64),
    pub(super) state: LaneState<N, W>,
    /// The slopes of the last step, velocities and accelerations, and how many iterations it took, by the first lane of each register.
    pub(super) slopes: [[[Row<W>; S]; N]; 2],
    pub(super) iterations: [u32; W],
    made: u64,
    sweeps: u64,
    /// Relative changes of the accelerations that may still be to come: a sixteenth of rounding, or more where less is wanted.
    pub settled: f64,
    of: PhantomData<Sys>,
}

impl<Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> GaussEnsemble<Sys, Each, S, W, N, M>
where
    Sys: System<N, M>,
    Each: Systems<Sys, W>,
{
    /// The systems at these states at time `t0` (s), with steps of length `h` (s). None where a system has no reduced equations
    /// by hand, or no basis of its admissible velocities.
    #[must_use]
    pub fn new(systems: Each, (t0, h): (f64, f64), state: LaneState<N, W>) -> Option<Self> {
        const { assert!(W.is_multiple_of(LANES), "trajectories go in eights") };
        Some(Self {
            order: Order::of(&systems, t0, &state)?,
            systems,
            collocation: LaneCollocation::new(h),
            schedule: (t0, h),
            state,
            slopes: [[[Row::ZERO; S]; N]; 2],
            iterations: [0; W],
            made: 0,
            sweeps: 0,
            settled: LEFT,
            of: PhantomData,
        })
    }

    /// Iterations made so far, of eight trajectories each.
    #[must_use]
    pub fn sweeps(&self) -> u64 {
        self.sweeps
    }
}

impl<Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> Ensemble<N, W>
    for GaussEnsemble<Sys, Each, S, W, N, M>
where
    Sys: System<N, M>,
    Each: Systems<Sys, W>,
{
    fn state(&self) -> &LaneState<N, W> {
        &self.state
    }

    fn advance(&mut self, steps: u64) {
        let end = self.made + steps;
        while self.made < end {
            let steps = BLOCK.min(end - self.made);
            dispatch_widest(GaussLaneSteps { of: self, steps });
            self.made += steps;
            self.state.wrap();
        }
    }
}

/// Steps of all lanes, of one register after another.
struct GaussLaneSteps<'a, Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> {
    of: &'a mut GaussEnsemble<Sys, Each, S, W, N, M>,
    steps: u64,
}

impl<Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> Kernel
    for GaussLaneSteps<'_, Sys, Each, S, W, N, M>
where
    Sys: System<N, M>,
    Each: Systems<Sys, W>,
{
    type Output = ();

    #[inline(always)]
    fn run<Si: Simd, const R: usize>(self, simd: Si) {
        let Self { of, steps } = self;
        for register in 0..W / LANES {
            let mut eight = EightLanes::<Si, R, S, N>::load(simd, of, register);
            for made in of.made..of.made + steps {
                of.sweeps += u64::from(LaneStep::after(made, of, register).make(&mut eight));
            }
            eight.store(of, register);
        }
    }
}
