use super::reduced_point::ReducedPoint;
use crate::{MeanPower, Mechanics, OneStep, OwnStep, StackUse, State, StepError, StepReport, power, stops};
use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use lagrangian::PowerSources;
use std::cell::Cell;
use std::ops::ControlFlow;

/// The adaptive method of Dormand and Prince of order 8(5,3), from a library, on the reduced equations.
///
/// A step of the schedule is an interval that the method crosses in steps of its own, as many as the tolerance asks for. Its first step has
/// the length proposed at the end of the previous interval. The unknowns are as in [`Rk4Reduced`](crate::Rk4Reduced), with the coordinates
/// counted from the beginning of the interval. (Hairer, Norsett and Wanner 1993, section II.10; crate `differential-equations`.)
pub struct Dop853<const N: usize, const M: usize> {
    solver: Dop853Solver<N, M>,
    /// The first step (s); `None` before the first interval.
    proposed: Option<f64>,
    /// The sources whose work is reported.
    sources: PowerSources,
}

/// The weights of the stages in the end of a step (Hairer, Norsett and Wanner 1993, section II.5; their program `DOP853`).
const WEIGHTS: [f64; 12] = [
    5.429_373_411_656_876e-2,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450_312_892_752_409,
    1.891_517_899_314_500_3,
    -5.801_203_960_010_585,
    3.111_643_669_578_199e-1,
    -1.521_609_496_625_161e-1,
    2.013_654_008_040_303_5e-1,
    4.471_061_572_777_259e-2,
];

type Dop853Solver<const N: usize, const M: usize> =
    ExplicitRungeKutta<Ordinary, DormandPrince, f64, ReducedPoint<N, M>, 8, 12, 16>;

impl<const N: usize, const M: usize> Dop853<N, M> {
    /// Steps tried within an interval before it is given up.
    pub const MAX_TRIES: u32 = 100_000;
    /// Slopes in a step: eleven new stages, and the end of the step if it is accepted.
    const SLOPES: u32 = 12;

    /// The method with the tolerance `epsilon`: the estimated error of a step stays, in the root mean square of its
    /// components, below `epsilon + epsilon |y|`.
    #[must_use]
    pub fn new(epsilon: f64) -> Self {
        // The limit of the library would count over all intervals.
        let solver = Dop853Solver::dop853().rtol(epsilon).atol(epsilon).max_steps(usize::MAX);
        Self { solver, proposed: None, sources: PowerSources::NONE }
    }

    /// Crosses an interval of length `h`, shows the inner ends of its steps, and returns the number of steps tried.
    #[inline]
    fn cross(
        &mut self,
        slopes: &ReducedSlopes<'_, N, M>,
        h: f64,
        xi: [f64; N],
        mut see: impl FnMut(f64, &ReducedPoint<N, M>) -> ControlFlow<()>,
    ) -> Result<u32, StepError> {
        let solver = &mut self.solver;
        let failed = |tries, step| slopes.failure.get().unwrap_or(StepError::Tolerance { tries, step });
        solver.h0 = self.proposed.filter(|step| step.abs() < h.abs()).map_or(h, |step| step.abs().copysign(h));
        slopes.left.set(1);
        solver.init(slopes, 0.0, h, &ReducedPoint { d: [0.0; N], xi }).map_err(|_| failed(0, h))?;
        slopes.begin_step();
        for tries in 1..=Self::MAX_TRIES {
            if stops() {
                return Err(StepError::Stopped);
            }
            let (begin, full) = (solver.t(), solver.h());
            if full.abs() <= f64::EPSILON * h.abs() {
                return Err(failed(tries - 1, full));
            }
            let rest = h - begin;
            // A step that would leave a hundredth of itself over takes that too.
            let last = 1.01 * full.abs() >= rest.abs();
            if last {
                solver.set_h(rest);
            }
            slopes.left.set(Self::SLOPES);
            solver.step(slopes).map_err(|_| failed(tries, full))?;
            let accepted = solver.t().to_bits() != begin.to_bits();
            if accepted {
                slopes.failure.set(None);
                slopes.add_work(if last { rest } else { full });
                slopes.begin_step();
                if last {
                    // A step cut at the end of the interval says little of the next.
                    self.proposed = Some(full.abs().max(solver.h().abs()));
                    return Ok(tries);
                }
                if see(solver.t(), solver.y()).is_break() {
                    return Ok(tries);
                }
            }
        }
        Err(failed(Self::MAX_TRIES, solver.h()))
    }
}

impl<const N: usize, const M: usize> std::fmt::Debug for Dop853<N, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Dop853").field("proposed", &self.proposed).finish_non_exhaustive()
    }
}

/// The reduced equations as the library wants them.
struct ReducedSlopes<'a, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    t0: f64,
    q0: [f64; N],
    /// Slopes that are still used. Slopes beyond them serve the library's interpolant, which is not read.
    left: Cell<u32>,
    /// Why the last slope could not be evaluated. The library repeats such a step with a shorter length.
    failure: Cell<Option<StepError>>,
    /// The sources whose work is measured.
    sources: PowerSources,
    /// The power at the stages of the step under way, and at its end (W).
    powers: Cell<[f64; 13]>,
    /// The work over the steps accepted (J).
    work: Cell<f64>,
}

impl<'a, const N: usize, const M: usize> ReducedSlopes<'a, N, M> {
    /// The slopes for an interval from `state` at the time `t0` (s).
    #[inline]
    fn new(system: &'a dyn Mechanics<N, M>, sources: PowerSources, t0: f64, state: &State<N>) -> Self {
        let (left, failure, powers, work) = (Cell::new(0), Cell::new(None), Cell::new([0.0; 13]), Cell::new(0.0));
        Self { system, t0, q0: *state.q(), left, failure, sources, powers, work }
    }

    /// Begins a step with the power at the end of the step before.
    fn begin_step(&self) {
        if self.sources.any() {
            let [.., end] = self.powers.get();
            self.powers.set([end; 13]);
        }
    }

    /// Adds the work (J) over an accepted step of length `h` (s), as one more unknown of the method on which no step depends.
    fn add_work(&self, h: f64) {
        if self.sources.any() {
            let mut mean = MeanPower::default();
            WEIGHTS.iter().zip(self.powers.get()).for_each(|(weight, power)| mean.add(*weight, power));
            self.work.set(self.work.get() + h * mean.mean());
        }
    }

    /// The report of the steps accepted.
    fn report(&self) -> StepReport<M> {
        StepReport { work: self.sources.any().then(|| self.work.get()), ..StepReport::of(0) }
    }
}

impl<const N: usize, const M: usize> ODE<f64, ReducedPoint<N, M>> for ReducedSlopes<'_, N, M> {
    #[inline]
    fn diff(&self, t: f64, y: &ReducedPoint<N, M>, slope: &mut ReducedPoint<N, M>) {
        let Some(left) = self.left.get().checked_sub(1) else { return };
        self.left.set(left);
        let q = lagrangian::from_fn(|i| self.q0[i] + y.d[i]);
        (slope.d, slope.xi) = match self.system.reduced_slope(self.t0 + t, &q, &y.xi) {
            Ok(found) => {
                if self.sources.any() {
                    let mut powers = self.powers.get();
                    powers[(12 - left.min(12)) as usize] =
                        power(self.system, self.sources, self.t0 + t, (&q, &found.velocity));
                    self.powers.set(powers);
                }
                (found.velocity, found.acceleration)
            }
            Err(error) => {
                self.failure.set(Some(error.into()));
                // NaN fails the library's test of the error.
                ([f64::NAN; N], [f64::NAN; N])
            }
        };
    }
}

const USE: StackUse = StackUse { squares: 28, rows: 20 };

impl<const N: usize, const M: usize> OneStep<N, M> for Dop853<N, M> {
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
        let xi0 = state.quasi_velocities(system, t)?;
        let slopes = ReducedSlopes::new(system, self.sources, t, state);
        match self.cross(&slopes, h, xi0, |_, _| ControlFlow::Continue(())) {
            Ok(_) => moved::<N, M>(system, t + h, self.solver.y(), state).map(|_| slopes.report()),
            Err(StepError::Stopped) => Err(StepError::Stopped),
            Err(error) => match at_rest(system, (t, h), state, &xi0) {
                Some(point) => moved(system, t + h, &point, state),
                None => Err(error),
            },
        }
    }

    fn memory(&self) -> Vec<f64> {
        self.proposed.into_iter().collect()
    }

    fn recall(&mut self, memory: &[f64], _state: &State<N>) {
        self.proposed = memory.first().copied();
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.sources = sources;
    }

    fn step_until(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        state: &mut State<N>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(StepReport<M>, Option<f64>), StepError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>());
        }
        let (xi0, mut end, mut failure) = (state.quasi_velocities(system, t)?, None, None);
        let slopes = ReducedSlopes::new(system, self.sources, t, state);
        let crossed = self.cross(&slopes, h, xi0, |made, point| {
            let mut inner = *state;
            match moved::<N, M>(system, t + made, point, &mut inner) {
                Ok(_) if see(t + made, &inner).is_continue() => return ControlFlow::Continue(()),
                Ok(_) => end = Some(t + made),
                Err(error) => failure = Some(error),
            }
            ControlFlow::Break(())
        });
        if let Some(error) = failure {
            return Err(error);
        }
        match crossed {
            Ok(_) => {
                moved::<N, M>(system, end.unwrap_or(t + h), self.solver.y(), state).map(|_| (slopes.report(), end))
            }
            Err(StepError::Stopped) => Err(StepError::Stopped),
            Err(error) => match at_rest(system, (t, h), state, &xi0) {
                Some(point) => Ok((moved(system, t + h, &point, state)?, None)),
                None => Err(error),
            },
        }
    }

    fn own_steps(
        &self,
        system: &dyn Mechanics<N, M>,
        step: (f64, f64),
        state: &State<N>,
        memory: &mut Vec<f64>,
        see: &mut OwnStep<'_, N>,
    ) -> Result<(), StepError> {
        let (solver, proposed) = (self.solver.clone(), memory.first().copied());
        let mut method = Self { solver, proposed, sources: PowerSources::NONE };
        method.step_until(system, step, &mut { *state }, see)?;
        memory.clear();
        memory.extend(method.proposed);
        Ok(())
    }
}

/// The end of an interval in which every change is so small that its square underflows: the library measures errors by a sum of squares,
/// and refuses every step so near to rest.
#[cold]
fn at_rest<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t, h): (f64, f64),
    state: &State<N>,
    xi: &[f64; N],
) -> Option<ReducedPoint<N, M>> {
    const LEAST: f64 = 1e-130;
    let slope = system.reduced_slope(t, state.q(), xi).ok()?;
    let rests = slope.velocity.iter().chain(&slope.acceleration).all(|x| (h * x).abs() < LEAST);
    rests.then(|| ReducedPoint {
        d: slope.velocity.map(|v| h * v),
        xi: lagrangian::from_fn(|i| xi[i] + h * slope.acceleration[i]),
    })
}

/// Moves a state to the end of an interval, at the time `t` (s).
#[inline]
fn moved<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    point: &ReducedPoint<N, M>,
    state: &mut State<N>,
) -> Result<StepReport<M>, StepError> {
    let ReducedPoint { d, xi } = *point;
    let v = system.velocity_of(t, &state.ahead(&d), &xi)?;
    super::rk4::explicit(state, &d, v, Some(xi))
}
