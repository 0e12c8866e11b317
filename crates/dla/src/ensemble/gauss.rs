use super::collocation::Collocation;
use super::state::{Row, lanes};
use super::{Ensemble, LaneState, Systems};
use crate::gauss::{LEFT, SLOWEST};
use lagrangian::{Abreast, Scalar, System, vectorized, velocity_of};
use std::array::from_fn;
use std::marker::PhantomData;

/// `W` trajectories by Gauss collocation with `S` stages, an even number: the method [`Gauss`](crate::Gauss), in lanes.
///
/// Stages are found by fixed-point iteration, from the collocation polynomial of the step before; within an iteration angles
/// come before what depends on them. It ends where in every lane the next change would be rounding. Where the reduced equations
/// do not contain the coordinates only the quasi-velocities are iterated, and the coordinates are quadratures.
#[derive(Debug, Clone)]
pub struct GaussEnsemble<Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> {
    systems: Each,
    collocation: Collocation<S>,
    schedule: (f64, f64),
    made: u64,
    alone: bool,
    state: LaneState<N, W>,
    stages: Stages<S, W, N>,
    sweeps: u64,
    /// Relative changes of the accelerations that may still be to come: a sixteenth of rounding, or more where less is wanted.
    pub settled: f64,
    of: PhantomData<Sys>,
}

/// Iterations after which a step is given up.
const MOST: u32 = 100;

#[derive(Debug, Clone)]
struct Stages<const S: usize, const W: usize, const N: usize> {
    acceleration: [[Row<W>; S]; N],
    next: [[Row<W>; S]; N],
    xi: [[Row<W>; S]; N],
    q: [[Row<W>; S]; N],
    velocity: [[Row<W>; S]; N],
    sin: [[Row<W>; S]; N],
    cos: [[Row<W>; S]; N],
}

impl<Sys, Each, const S: usize, const W: usize, const N: usize, const M: usize> GaussEnsemble<Sys, Each, S, W, N, M>
where
    Sys: System<N, M>,
    Each: Systems<Sys, W>,
{
    /// The systems at these states at time `t0` (s), with steps of length `h` (s). None where a system has no reduced equations
    /// by hand.
    #[must_use]
    pub fn new(systems: Each, (t0, h): (f64, f64), state: LaneState<N, W>) -> Option<Self> {
        let mut alone = true;
        for lane in 0..W {
            systems.of(lane).reduced_motion(t0, &state.q(lane), &state.xi(lane))?;
            alone &= systems.of(lane).stands_alone();
        }
        let zero = [[Row::ZERO; S]; N];
        let stages = Stages { acceleration: zero, next: zero, xi: zero, q: zero, velocity: zero, sin: zero, cos: zero };
        let collocation = Collocation::new(h);
        let (schedule, of) = ((t0, h), PhantomData);
        Some(Self { systems, collocation, schedule, made: 0, alone, state, stages, sweeps: 0, settled: LEFT, of })
    }

    /// Iterations made so far.
    #[must_use]
    pub fn sweeps(&self) -> u64 {
        self.sweeps
    }

    #[inline(always)]
    fn step(&mut self) {
        let (t0, h) = self.schedule;
        let t = t0 + self.made as f64 * h;
        if self.made == 0 {
            self.stages.begin(&self.state, &self.systems, t);
        } else {
            for k in 0..N - M {
                self.collocation.extrapolate(&mut self.stages.acceleration[k]);
            }
        }
        let mut before = Row([0.0; W]);
        let mut open = true;
        for sweep in 1..=MOST {
            self.sweeps += 1;
            self.quasi_velocities();
            if !self.alone {
                self.coordinates(t, h);
            }
            let (moved, size) =
                self.stages.accelerations::<Sys, Each, M>(&self.systems, &self.collocation.nodes, (t, h));
            open = false;
            for lane in 0..lanes::<W>() {
                let (moved, size, before) = (moved.0[lane], size.0[lane], before.0[lane]);
                // From change to change the factor is about the same, so that the next one is known before it is made, but not
                // believed to be smaller than it may become; in the rounding changes no longer shrink.
                let slowest = SLOWEST * before;
                let next = moved * if moved > slowest { moved } else { slowest };
                let stalls = (moved <= 1e-12 * size) & (moved >= 0.5 * before) & (sweep > 1);
                open |= (moved > self.settled * size)
                    & ((next > self.settled * size * before) | (moved > 0.5 * before))
                    & !stalls;
            }
            before = moved;
            if !open {
                break;
            }
        }
        if open {
            self.give_up(&before);
        }
        if self.alone {
            self.coordinates(t, h);
        }
        for k in 0..N {
            let increment = self.collocation.increment(&self.stages.velocity[k]);
            for lane in 0..lanes::<W>() {
                let (q, rest) = (self.state.q[k].0[lane], self.state.rest[k].0[lane]);
                let increment = increment.0[lane] + rest;
                let sum = q + increment;
                self.state.rest[k].0[lane] = increment - (sum - q);
                self.state.q[k].0[lane] = sum;
            }
        }
        for k in 0..N - M {
            let gain = self.collocation.increment(&self.stages.acceleration[k]);
            for lane in 0..W {
                self.state.xi[k].0[lane] += gain.0[lane];
            }
        }
        self.state.wrap();
        self.made += 1;
    }

    #[inline(always)]
    fn quasi_velocities(&mut self) {
        for k in 0..N - M {
            self.collocation.integrate(&self.state.xi[k], &self.stages.acceleration[k], &mut self.stages.xi[k]);
        }
    }

    /// The coordinates of the stages: angles, then what else there is.
    #[inline(always)]
    fn coordinates(&mut self, t: f64, h: f64) {
        for angles in [true, false] {
            self.stages.velocities::<Sys, Each, M>(&self.systems, &self.collocation.nodes, (t, h), angles);
            for k in 0..N {
                if self.systems.of(0).angles()[k] == angles {
                    self.collocation.integrate(&self.state.q[k], &self.stages.velocity[k], &mut self.stages.q[k]);
                    if angles {
                        self.stages.turn(k);
                    }
                }
            }
        }
    }

    /// Loses the lanes that still change.
    #[cold]
    #[inline(never)]
    fn give_up(&mut self, moved: &Row<W>) {
        for lane in 0..W {
            let size = (0..N - M)
                .flat_map(|k| self.stages.acceleration[k].iter())
                .fold(0.0, |size: f64, a| size.max(a.0[lane].abs()));
            if moved.0[lane] > 1e-12 * size {
                self.state.lose(lane);
            }
        }
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
        vectorized(
            #[inline(always)]
            || {
                for _ in 0..steps {
                    self.step();
                }
            },
        );
    }
}

impl<const S: usize, const W: usize, const N: usize> Stages<S, W, N> {
    /// The stages of a first step: nothing changes.
    #[inline(always)]
    fn begin<Sys: System<N, M>, Each: Systems<Sys, W>, const M: usize>(
        &mut self,
        state: &LaneState<N, W>,
        systems: &Each,
        t: f64,
    ) {
        for lane in 0..lanes::<W>() {
            let acceleration =
                systems.of(lane).reduced_motion(t, &state.q(lane), &state.xi(lane)).unwrap_or([f64::NAN; N]);
            for k in 0..N {
                for i in 0..S {
                    self.q[k][i].0[lane] = state.q[k].0[lane];
                    self.acceleration[k][i].0[lane] = acceleration[k];
                }
            }
        }
        (0..N).for_each(|k| self.turn(k));
    }

    /// Sine and cosine of a coordinate.
    #[inline(always)]
    fn turn(&mut self, k: usize) {
        for i in 0..S {
            for lane in 0..lanes::<W>() {
                let (sin, cos) = Abreast::new(self.q[k][i].0[lane]).sin_cos();
                (self.sin[k][i].0[lane], self.cos[k][i].0[lane]) = (sin.of, cos.of);
            }
        }
    }

    /// Configuration and quasi-velocities of a stage.
    #[inline(always)]
    fn point(&self, i: usize, lane: usize, angles: &[bool; N]) -> ([Abreast; N], [Abreast; N]) {
        let of = |rows: &[[Row<W>; S]; N], k: usize| rows[k][i].0[lane];
        let coordinate = |k: usize| {
            let q = of(&self.q, k);
            if angles[k] { Abreast::turned(q, of(&self.sin, k), of(&self.cos, k)) } else { Abreast::new(q) }
        };
        (from_fn(coordinate), from_fn(|k| Abreast::new(of(&self.xi, k))))
    }

    /// The velocities of the angles, or of the other coordinates.
    #[inline(always)]
    fn velocities<Sys: System<N, M>, Each: Systems<Sys, W>, const M: usize>(
        &mut self,
        systems: &Each,
        nodes: &[f64; S],
        (t, h): (f64, f64),
        angles: bool,
    ) {
        let which = systems.of(0).angles();
        for i in 0..S {
            let time = Abreast::constant(t + nodes[i] * h);
            for lane in 0..lanes::<W>() {
                let (q, xi) = self.point(i, lane, &which);
                let velocity = velocity_of(systems.of(lane), time, &q, &xi).unwrap_or([Abreast::constant(f64::NAN); N]);
                for k in 0..N {
                    if which[k] == angles {
                        self.velocity[k][i].0[lane] = velocity[k].of;
                    }
                }
            }
        }
    }

    /// The accelerations of the quasi-velocities, how far they have moved and how large they are.
    #[inline(always)]
    fn accelerations<Sys: System<N, M>, Each: Systems<Sys, W>, const M: usize>(
        &mut self,
        systems: &Each,
        nodes: &[f64; S],
        (t, h): (f64, f64),
    ) -> (Row<W>, Row<W>) {
        let which = systems.of(0).angles();
        for i in 0..S {
            let time = Abreast::constant(t + nodes[i] * h);
            for lane in 0..lanes::<W>() {
                let (q, xi) = self.point(i, lane, &which);
                let acceleration =
                    systems.of(lane).reduced_motion(time, &q, &xi).unwrap_or([Abreast::constant(f64::NAN); N]);
                for k in 0..N - M {
                    self.next[k][i].0[lane] = acceleration[k].of;
                }
            }
        }
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let (mut moved, mut size) = (Row::ZERO, Row::ZERO);
        for lane in 0..lanes::<W>() {
            let (mut most, mut largest) = (0.0, 0.0);
            for k in 0..N - M {
                for i in 0..S {
                    let (a, before) = (self.next[k][i].0[lane], self.acceleration[k][i].0[lane]);
                    most = larger((a - before).abs(), most);
                    largest = larger(a.abs(), largest);
                    self.acceleration[k][i].0[lane] = a;
                }
            }
            (moved.0[lane], size.0[lane]) = (most, largest);
        }
        (moved, size)
    }
}
