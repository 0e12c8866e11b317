use super::doubt::{Attempt, Doubt};
use super::ending::Ending;
use super::lanes::{Collocation, CollocationOutcome, StageSlopes};
use super::memory::GaussMemory;
use super::pace::{degree, longer, quarters_of, roughest, shorter};
use super::rule::{LONGER, quarter_octaves};
use super::{Gauss, TakenStep};
use crate::positions::affine_only;
use crate::{Mechanics, OneStep, OwnStep, State, StepError, StepReport, stops};
use lagrangian::linear::larger;
use lagrangian::{PowerSources, Smoothness, from_fn, mapped};
use std::ops::ControlFlow;

/// Gauss collocation with steps of its own within a step of the schedule, as many as a tolerance asks for.
///
/// The highest Legendre coefficient of the slopes of a step shows how smooth the motion is along it: if coefficients fall off evenly, its
/// power `2 s / (s - 1)` is about the error of the step. It is the same forward and backward in time. The defect of the equations at other
/// points is a second estimate, which detects corners, jumps, pulses and smooth functions that are as steep, unless all functions of the system are
/// polynomials, sines and cosines of the state.
/// Steps are powers of the fourth root of two (s), so that a few fixed matrices continue the polynomial of one step into the next. Stages
/// are iterated to a fraction of the tolerance, not to rounding: the method is on the constraint by construction, but it is symmetric to
/// the tolerance only, and does not keep what [`Gauss`] keeps over long runs.
///
/// (Compare Antonana, Makazaga and Murua 2017, Numer. Algorithms 76, 861-880.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussAdaptive {
    gauss: Gauss,
    tolerance: f64,
    /// The largest roughness of a step.
    aim: f64,
    /// The degree of the predictor, the polynomial by which the slopes of a step are continued to the next. The looser the tolerance, the
    /// further slopes are from it, and the lower the best degree.
    degree: usize,
    /// The next step, in quarter octaves of a second.
    quarters: Option<i32>,
    /// The doubt in steps that look smooth; `None` before the first step.
    doubt: Option<Doubt>,
}

impl GaussAdaptive {
    /// Steps tried within an interval before it is given up.
    pub const MAX_TRIES: u32 = 100_000;

    /// The method with `S` stages, from two to eight, and the tolerance `epsilon`: the error of a step is kept near `epsilon (1 + |y|)` in
    /// every component.
    #[must_use]
    pub fn new<const S: usize>(epsilon: f64) -> Self {
        let (aim, degree) = (roughest(S, epsilon), degree(S, epsilon));
        Self { gauss: Gauss::new::<S>(), tolerance: epsilon, aim, degree, quarters: None, doubt: None }
    }
}

/// A step that was made, and the length that it should have had.
struct Tried<const N: usize> {
    taken: TakenStep<N>,
    /// The step that would have met the tolerance, in quarter octaves from this one.
    longer: i32,
}

/// Quarter octaves by which a step is shortened if its stages did not converge.
const CUT_BACK: i32 = 3;
/// A step that should have been shorter by this number of quarter octaves, or more, is taken again.
const REFUSED: i32 = -3;
impl GaussAdaptive {
    /// Makes one step of length `h`. Fails with the number of quarter octaves by which the next try is to be shorter, if its stages do not
    /// converge or it is too rough. A step that has `grown` is much longer than the last.
    #[inline(always)]
    fn attempt<const N: usize, const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        ((t, h), quarters, grown): ((f64, f64), i32, bool),
        state: &State<N>,
        xi0: &[f64; N],
        slopes: &mut StageSlopes<N>,
        doubt: Doubt,
    ) -> Result<Tried<N>, i32> {
        let rule = self.gauss.rule;
        let (q0, epsilon) = (state.q(), self.tolerance);
        let counts = mapped(&[q0, xi0], |y| mapped(y, |y| h.abs() / (epsilon * (1.0 + y.abs()))));
        let memory = &self.gauss.memory;
        let apart = if memory.is_of_length(h) { 0 } else { quarters.saturating_sub(memory.quarters) };
        let before = memory.rows(state).zip(rule.continued(self.degree, apart));
        let rounding = larger(0.1, 1e-14 / epsilon);
        // A step whose stages converge slowly costs more than two shorter ones.
        let (limit, hopeless, untested) = (18, 0.9, memory.untested());
        let ending = Ending { left: 0.5, rounding, noise: rounding, limit, hopeless, untested };
        let stages = Collocation { rule, t, h, q0, xi0, before, ending, counts: Some(counts), slopes };
        let (taken, rate, roughness) = match system.collocate(stages) {
            Some(CollocationOutcome::Found(found)) => {
                (TakenStep::at_once(&found).ok_or(CUT_BACK)?, found.rate, found.roughness)
            }
            Some(CollocationOutcome::Failed) => return Err(CUT_BACK),
            Some(CollocationOutcome::Unknown) | None => {
                let taken = self.gauss.in_turn(system, (t, h), (q0, xi0), (slopes, false)).map_err(|_| CUT_BACK)?;
                (taken, 0.0, slopes.weighed(&rule.highest, &counts))
            }
        };
        if !roughness.is_finite() {
            return Err(CUT_BACK);
        }
        let longer = longer(rule.stages, roughness * epsilon / self.aim, rate, taken.iterations);
        if longer <= REFUSED {
            return Err(CUT_BACK);
        }
        let (q1, xi1) = (from_fn(|k| q0[k] + taken.increment[k]), from_fn(|k| xi0[k] + taken.gain[k]));
        let ends = [[q0, xi0], [&q1, &xi1]];
        let attempt = Attempt { rule, step: (t, h), ends, slopes, counts: &counts };
        match doubt.excess(system, &attempt, grown) {
            Some(excess) => Err(shorter(excess)),
            None => Ok(Tried { taken, longer }),
        }
    }
}

/// The length of a step cut at the end of an interval: far from every other length.
const CUT: i32 = i32::MAX / 2;

impl<const N: usize, const M: usize> OneStep<N, M> for GaussAdaptive {
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        Ok(self.step_until(system, (t, h), state, &mut |_, _| ControlFlow::Continue(()))?.0)
    }

    #[inline]
    fn step_until(
        &mut self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &mut State<N>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(StepReport<M>, Option<f64>), StepError> {
        if const { super::USE.exceeds::<N, M>() } {
            return Err(super::USE.refusal::<N, M>());
        }
        affine_only(system, step.0, state)?;
        let (quarters, start) = (self.quarters, *state);
        let found = self.cross(system, step, state, see);
        if found.is_err() {
            (self.quarters, *state) = (quarters, start);
        }
        found
    }

    fn memory(&self) -> Vec<f64> {
        let quarters = self.quarters.map(f64::from);
        quarters.into_iter().chain(self.gauss.memory.save()).collect()
    }

    fn recall(&mut self, memory: &[f64], _state: &State<N>) {
        // A number from a file may be anything.
        self.quarters = memory.first().map(|&quarters| (quarters as i32).clamp(-CUT, CUT));
        self.gauss.memory = GaussMemory::load(memory.get(1..).unwrap_or_default());
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.gauss.sources = sources;
    }

    fn own_steps(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        let (mut method, mut state) = (*self, *state);
        // The caller asks for the ends of steps, and needs no work.
        method.gauss.sources = PowerSources::NONE;
        if !memory.is_empty() {
            OneStep::<N, M>::recall(&mut method, memory, &state);
        }
        method.cross::<N, M>(system, step, &mut state, see)?;
        *memory = OneStep::<N, M>::memory(&method);
        Ok(())
    }
}

impl GaussAdaptive {
    /// Crosses an interval, and shows the inner ends of its steps to `see`; returns the time at which `see` stopped it.
    fn cross<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t0, whole): (f64, f64),
        state: &mut State<N>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(StepReport<M>, Option<f64>), StepError> {
        let (mut made, mut iterations, mut work, mut refused) = (0.0, 0, None, false);
        let mut quarters = self.quarters.unwrap_or_else(|| first(system, t0, whole, state));
        let doubt = *self.doubt.get_or_insert_with(|| Doubt::of(system.smoothness()));
        let (mut before, mut slopes) = (self.quarters, StageSlopes::ZERO);
        for tries in 1..=Self::MAX_TRIES {
            if stops() {
                return Err(StepError::Stopped);
            }
            let full = quarter_octaves(quarters);
            let rest = whole - made;
            let last = 1.01 * full >= rest.abs();
            let h = if last { rest } else { full.copysign(whole) };
            if full <= f64::EPSILON * whole.abs() {
                return Err(StepError::Tolerance { tries, step: full });
            }
            let (t, xi0) = (t0 + made, state.quasi_velocities(system, t0 + made)?);
            let grown = before.is_none_or(|before| quarters >= before.saturating_add(LONGER));
            let Tried { taken, longer } =
                match self.attempt(system, ((t, h), quarters, grown), state, &xi0, &mut slopes, doubt) {
                    Ok(tried) => tried,
                    Err(back) => {
                        quarters = if last { quarters.min(quarters_of(rest.abs())) } else { quarters } - back;
                        refused = true;
                        continue;
                    }
                };
            before = Some(quarters);
            let done = self.gauss.work(system, (t, h), state.q(), &slopes);
            taken.apply(system, t + h, &xi0, state)?;
            work = done.map(|done| done + work.unwrap_or(0.0));
            iterations += taken.iterations;
            self.gauss.memory.keep(&slopes, taken.iterations, (h, if last { CUT } else { quarters }), state);
            if last {
                // A step cut at the end of the interval says little of the next.
                self.quarters = Some(quarters + longer.min(0));
                return Ok((StepReport { work, ..StepReport::of(iterations) }, None));
            }
            made += h;
            // After a step that was too long the next one is not longer.
            quarters += if refused { longer.min(0) } else { longer };
            refused = false;
            if see(t0 + made, state).is_break() {
                self.quarters = Some(quarters);
                return Ok((StepReport { work, ..StepReport::of(iterations) }, Some(t0 + made)));
            }
        }
        Err(StepError::Tolerance { tries: Self::MAX_TRIES, step: quarter_octaves(quarters) })
    }
}

/// The first step (quarter octaves): half of the shortest time in which a velocity changes by itself, or the interval if nothing changes.
/// If functions have corners or change with time, it is a fifth of that time, or 1/32 of the interval: a system at rest may be pushed
/// later.
fn first<const N: usize, const M: usize>(system: &dyn Mechanics<N, M>, t: f64, whole: f64, state: &State<N>) -> i32 {
    let slope = state.quasi_velocities(system, t).and_then(|xi| system.reduced_slope(t, state.q(), &xi));
    let size = |x: &[f64; N]| x.iter().fold(0.0f64, |m, x| larger(m, x.abs()));
    let rate = slope.map_or(0.0, |slope| size(&slope.acceleration) / larger(size(&slope.velocity), 1e-3));
    let turning = (0..N).filter(|&i| system.angles()[i]).fold(rate, |m, i| larger(m, state.v()[i].abs()));
    let Smoothness { corners, driven, .. } = system.smoothness();
    let (part, still) = if corners || driven { (0.2, whole.abs() / 32.0) } else { (0.5, whole.abs()) };
    let step = if turning > 0.0 { (part / turning).min(whole.abs()) } else { still };
    quarters_of(step).clamp(-4000, 4000)
}
