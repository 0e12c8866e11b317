mod adaptive;
mod doubt;
mod ending;
mod lanes;
mod memory;
mod pace;
mod packs;
mod rule;
mod secants;

pub use adaptive::GaussAdaptive;
pub(crate) use lanes::collocate;
pub use lanes::{Collocation, CollocationOutcome};

use crate::branch;
use crate::convergence::FixedPoint;
use crate::convergence::tolerances::{LEFT, NOISE, OF_ROW};
use crate::positions::{affine_only, onto_positions};
use crate::{MeanPower, Mechanics, OneStep, StackUse, Stage, State, StepError, StepReport, power};
use ending::Ending;
use lagrangian::linear::larger;
use lagrangian::{PowerSources, from_fn};
use lanes::StageSlopes;
use memory::GaussMemory;
use rule::GaussRule;
use secants::Secants;

/// Gauss collocation on the constraint: the reduced equations `q' = W xi + v_b`, `xi' = ..` in the basis of admissible
/// velocities, with `s` stages, of order `2 s`.
///
/// Symmetric, and on the constraint by construction. Stages are found by fixed-point iteration until their changes are round-off; it
/// converges for steps below the time constants of the motion. If it does not converge, the solution is followed from a step of length
/// zero, by an iteration that its own secants accelerate; if that does not converge either, the step fails.
///
/// If a system knows its reduced equations by hand ([`System::reduced`](lagrangian::System::reduced)), up to eight stages are computed at
/// once, in the vector registers of the machine, beginning with the polynomial of the step before; otherwise one after another. The two
/// agree to round-off. Vector registers multiply and add with one rounding, so the last bits depend on the machine.
///
/// Constraints on positions that are of second degree hold by themselves. Onto all other ones the end of the step is projected, in the
/// kinetic metric. The projection moves it by the error of the step, so the order stays, and the symmetry holds to that error only.
///
/// (The book, (4.6); Hairer, Lubich and Wanner 2006, section II.1.3; the stopping rule as in Antonana, Makazaga and Murua 2017, Numer.
/// Algorithms 76, 861-880.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gauss {
    pub(crate) rule: &'static GaussRule,
    /// Whether all stages may be computed at once.
    together: bool,
    memory: GaussMemory,
    /// The sources whose work is reported.
    sources: PowerSources,
    /// Iterations after which the step fails.
    pub max_iterations: u32,
}

/// The slopes of the stages, in the first places.
#[derive(Clone, Copy)]
struct StagesInTurn<const N: usize> {
    velocity: [[f64; N]; 8],
    acceleration: [[f64; N]; 8],
}

impl<const N: usize> StagesInTurn<N> {
    /// The slopes of the first `stages` stages, one stage after the other.
    fn numbers(&self, stages: usize) -> Vec<f64> {
        let both = self.velocity.iter().zip(&self.acceleration).take(stages);
        both.flat_map(|(velocity, acceleration)| velocity.iter().chain(acceleration)).copied().collect()
    }

    /// The slopes of which these are the [`numbers`](Self::numbers).
    fn of(numbers: &[f64]) -> Self {
        let mut stages = Self { velocity: [[0.0; N]; 8], acceleration: [[0.0; N]; 8] };
        let places = stages.velocity.iter_mut().zip(&mut stages.acceleration);
        for ((velocity, acceleration), numbers) in places.zip(numbers.chunks_exact(2 * N)) {
            velocity.copy_from_slice(&numbers[..N]);
            acceleration.copy_from_slice(&numbers[N..]);
        }
        stages
    }
}

impl Gauss {
    /// The method with `S` stages, from one to eight. The number is a value of the method and no part of its type: a step is compiled
    /// once for all of them.
    #[must_use]
    pub fn new<const S: usize>() -> Self {
        Self {
            rule: GaussRule::gauss::<S>(),
            together: true,
            memory: GaussMemory::NONE,
            sources: PowerSources::NONE,
            max_iterations: 100,
        }
    }

    /// The number of stages.
    #[must_use]
    pub fn stages(&self) -> usize {
        self.rule.stages
    }

    /// The method with every stage computed by itself: the same map to round-off, against which lanes are tested.
    #[must_use]
    pub fn one_by_one(self) -> Self {
        Self { together: false, ..self }
    }

    /// Computes the stages all at once and leaves their slopes in `slopes`; `None` if they must be found one by one.
    #[inline(always)]
    fn at_once<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        state: &State<N>,
        xi0: &[f64; N],
        slopes: &mut StageSlopes<N>,
    ) -> Option<TakenStep<N>> {
        if !self.together {
            return None;
        }
        let rule = self.rule;
        let before =
            self.memory.rows(state).filter(|_| self.memory.is_of_length(h)).zip(rule.continued(rule.stages - 1, 0));
        let ending = Ending {
            left: LEFT,
            rounding: OF_ROW,
            noise: NOISE,
            limit: self.max_iterations,
            hopeless: 2.0,
            untested: self.memory.untested(),
        };
        let q0 = state.q();
        match system.collocate(Collocation { rule, t, h, q0, xi0, before, ending, counts: None, slopes })? {
            CollocationOutcome::Found(found) => TakenStep::at_once(&found),
            CollocationOutcome::Unknown | CollocationOutcome::Failed => None,
        }
    }

    /// Computes the stages one after another. If the iteration does not converge and `followed` is set, follows them from a step of length
    /// zero.
    fn in_turn<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        (q0, xi0): (&[f64; N], &[f64; N]),
        (slopes, followed): (&mut StageSlopes<N>, bool),
    ) -> Result<TakenStep<N>, StepError> {
        let start = system.reduced_slope(t, q0, xi0)?;
        let begin = StagesInTurn { velocity: [start.velocity; 8], acceleration: [start.acceleration; 8] };
        let mut stages = begin;
        let iterations = match self.solve(system, (t, h), (q0, xi0), &mut stages, None) {
            Ok(iterations) => iterations,
            Err(error) if !followed => return Err(error),
            Err(error) => {
                stages = begin;
                self.follow(system, (t, h), (q0, xi0), &mut stages).ok_or(error)?
            }
        };
        let increment = self.sum(h, |j| self.rule.weights[j], &stages.velocity);
        let gain = self.sum(h, |j| self.rule.weights[j], &stages.acceleration);
        let count = self.stages();
        let by_rows = |slopes: &[[f64; N]; 8]| from_fn(|k| from_fn(|i| if i < count { slopes[i][k] } else { 0.0 }));
        *slopes = StageSlopes { velocity: by_rows(&stages.velocity), acceleration: by_rows(&stages.acceleration) };
        Ok(TakenStep { increment, gain, iterations })
    }

    /// The work (J) over a step from `q0` by these slopes of its stages; `None` if no source is measured. It is one more unknown
    /// `w' = P(t, q, v)` of the collocation, and has its order.
    #[inline(always)]
    fn work<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        q0: &[f64; N],
        slopes: &StageSlopes<N>,
    ) -> Option<f64> {
        self.sources.any().then(|| self.integrated(system, step, q0, slopes))
    }

    #[inline(never)]
    fn integrated<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        q0: &[f64; N],
        slopes: &StageSlopes<N>,
    ) -> f64 {
        let GaussRule { nodes, weights, columns, stages, .. } = self.rule;
        let mut mean = MeanPower::default();
        for i in 0..*stages {
            let way = |k: usize| (0..*stages).map(|j| columns[j][i] * slopes.velocity[k][j]).sum::<f64>();
            let (q, v) = (from_fn(|k| q0[k] + h * way(k)), from_fn(|k| slopes.velocity[k][i]));
            mean.add(weights[i], power(system, self.sources, t + nodes[i] * h, (&q, &v)));
        }
        h * mean.mean()
    }

    /// The sum `h sum_j factors(j) slopes[j]` over the stages.
    #[inline(always)]
    fn sum<const N: usize>(&self, h: f64, factor: impl Fn(usize) -> f64, slopes: &[[f64; N]; 8]) -> [f64; N] {
        from_fn(|i| h * (0..self.stages()).map(|j| factor(j) * slopes[j][i]).sum::<f64>())
    }

    /// Follows the branch of solutions that begins with a step of length zero to its end, and leaves the stages there in `stages`; returns
    /// the number of iterations. `None` if the branch leads to a step that turns too far or does not resolve the motion.
    #[cold]
    #[inline(never)]
    fn follow<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        start: (&[f64; N], &[f64; N]),
        stages: &mut StagesInTurn<N>,
    ) -> Option<u32> {
        /// Maximum number of parts in which a branch is followed: a motion that blows up has no branch.
        const MOST: u32 = 6;
        let (mut iterations, mut parts) = (0, 0);
        *stages = branch::followed(stages, 0.5, |part, stages| {
            parts += 1;
            if parts > MOST {
                return None;
            }
            let h = part * h;
            iterations += self.solve(system, (t, h), start, stages, Some(Secants::default())).ok()?;
            let mean = self.sum(1.0, |j| self.rule.weights[j], &stages.velocity);
            let near = branch::turn_of(system, (t, h), start.0, &mean) <= branch::NEAR;
            (near && self.resolves(&stages.velocity) && self.resolves(&stages.acceleration)).then_some(())
        })?;
        Some(iterations)
    }

    /// Whether slopes are smooth along the step: a polynomial of the degree of the method follows them.
    fn resolves<const N: usize>(&self, slopes: &[[f64; N]; 8]) -> bool {
        /// Largest relative error of a step whose motion is resolved: about the power `2 s / (s - 1)` of the highest Legendre coefficient
        /// relative to the slope. A single stage tells no error.
        const ERROR: f64 = 1.1e-3;
        /// Least unit for a slope, relative to the largest slope.
        const SMALL: f64 = 1e-3;
        let count = self.stages();
        let rough = ERROR.powf((count as f64 - 1.0) / (2.0 * count as f64));
        let size = |i: usize| slopes[..count].iter().fold(0.0, |most, slope| larger(most, slope[i]));
        let all = (0..N).map(size).fold(0.0, larger);
        let highest = self.sum(1.0, |j| self.rule.highest[j], slopes);
        (0..N).all(|i| highest[i].abs() < rough * larger(size(i), SMALL * all) || all == 0.0)
    }

    /// Iterates the slopes of the stages, with secants or without, until they change by round-off only; returns the number of iterations.
    #[inline]
    fn solve<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        (q0, xi0): (&[f64; N], &[f64; N]),
        stages: &mut StagesInTurn<N>,
        mut secants: Option<Secants>,
    ) -> Result<u32, StepError> {
        // With secants an iteration converges soon or not at all.
        let limit = if secants.is_some() { self.max_iterations.min(24) } else { self.max_iterations };
        let mut convergence = FixedPoint::<2, N>::new(limit).in_units([1.0, h.abs()]);
        loop {
            let before = secants.as_ref().map(|_| stages.numbers(self.stages()));
            let mut seen = [[(0.0f64, 0.0f64); N]; 2];
            for i in 0..self.stages() {
                let a = |j: usize| self.rule.columns[j][i];
                let (dq, dxi) = (self.sum(h, a, &stages.velocity), self.sum(h, a, &stages.acceleration));
                let (q, xi) = (from_fn(|k| q0[k] + dq[k]), from_fn(|k| xi0[k] + dxi[k]));
                let fail = |source| StepError::Newton { stage: Stage::Collocation, source };
                // The start has a slope, so a stage without one means that the iteration diverged.
                let slope = system.reduced_slope(t + self.rule.nodes[i] * h, &q, &xi);
                let slope = slope.map_err(|_| fail(convergence.lost()))?;
                let new = [slope.velocity, slope.acceleration];
                let old = [stages.velocity[i], stages.acceleration[i]];
                for (seen, (new, old)) in seen.iter_mut().zip(new.iter().zip(&old)) {
                    for k in 0..N {
                        let (change, size) = seen[k];
                        seen[k] = (larger(change, (new[k] - old[k]).abs()), larger(size, new[k].abs()));
                    }
                }
                (stages.velocity[i], stages.acceleration[i]) = (slope.velocity, slope.acceleration);
            }
            let settled = convergence.see(seen, || system.reduced_rounding(t, q0, xi0, h).unwrap_or([[0.0; N]; 2]));
            let settled = settled.map_err(|source| StepError::Newton { stage: Stage::Collocation, source })?;
            if let Some(iterations) = settled {
                return Ok(iterations);
            }
            if let Some((secants, before)) = secants.as_mut().zip(before) {
                let mut next = stages.numbers(self.stages());
                secants.next(&before, &mut next, 2 * N);
                *stages = StagesInTurn::of(&next);
            }
        }
    }
}

/// A step, its stages found.
struct TakenStep<const N: usize> {
    increment: [f64; N],
    gain: [f64; N],
    iterations: u32,
}

impl<const N: usize> TakenStep<N> {
    /// The step of stages that were found at once; `None` if they are not finite.
    #[inline(always)]
    fn at_once(found: &lanes::Found<N>) -> Option<Self> {
        let lanes::Found { increment, gain, iterations, .. } = *found;
        let finite = increment.iter().chain(&gain).all(|x| x.is_finite());
        finite.then_some(Self { increment, gain, iterations })
    }

    /// Moves the state.
    #[inline(always)]
    fn apply<const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        t1: f64,
        xi0: &[f64; N],
        state: &mut State<N>,
    ) -> Result<(), StepError> {
        let xi1 = from_fn(|i| xi0[i] + self.gain[i]);
        let increment = onto_positions(system, t1, state, self.increment, state.v())?;
        let v1 = system.velocity_of(t1, &state.ahead(&increment), &xi1)?;
        state.stays_finite(&increment, &v1)?;
        state.advance(&increment, v1, Some(xi1));
        Ok(())
    }
}

/// For any number of stages: their slopes are few numbers.
pub(crate) const USE: StackUse = StackUse { squares: 38, rows: 20 };

impl<const N: usize, const M: usize> OneStep<N, M> for Gauss {
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>());
        }
        affine_only(system, t, state)?;
        let xi0 = state.quasi_velocities(system, t)?;
        let mut slopes = StageSlopes::ZERO;
        let taken = match self.at_once(system, (t, h), state, &xi0, &mut slopes) {
            Some(taken) => taken,
            None => self.in_turn(system, (t, h), (state.q(), &xi0), (&mut slopes, true))?,
        };
        let work = self.work(system, (t, h), state.q(), &slopes);
        taken.apply(system, t + h, &xi0, state)?;
        if self.together {
            self.memory.keep(&slopes, taken.iterations, (h, 0), state);
        }
        Ok(StepReport { work, ..StepReport::of(taken.iterations) })
    }

    fn memory(&self) -> Vec<f64> {
        self.memory.save()
    }

    fn recall(&mut self, memory: &[f64], _state: &State<N>) {
        self.memory = GaussMemory::load(memory);
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.sources = sources;
    }
}
