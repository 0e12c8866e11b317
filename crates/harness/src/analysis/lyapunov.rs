use super::neutral::bias;
use super::pace::Pace;
use super::stretch::{LyapunovFailure, Running, Stretch};
use super::tangent::{StepTangent, Steps};
use super::verdict::{Evidence, MotionVerdict};
use crate::run::integrate_pieces;
use crate::timing::Ticker;
use crate::{Method, Progress};
use dla::{FullMechanics, OwnMethods, Schedule, SensitivityError, State, Subject};
use thiserror::Error;

/// What exponents are asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LyapunovRequest<const N: usize> {
    /// When the counted steps are.
    pub schedule: Schedule,
    /// So many steps are made before them, until the motion and the tangent vectors have settled.
    pub settle: u64,
    /// How many exponents, the largest first; all where none is said.
    pub exponents: Option<usize>,
    /// Configuration at the start.
    pub q: [f64; N],
    /// Velocity at the start.
    pub v: [f64; N],
}

/// The Lyapunov exponents of a motion, as the discrete map has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Lyapunov {
    /// The exponents (1/s), the largest first.
    pub exponents: Vec<f64>,
    /// Half the width of the 95 % confidence interval of each (1/s); none where the run is too short.
    ///
    /// From batch means, the scatter of what a longer run averages out, and beyond it `3 ln(1 + T/t)/T`, what an exponent may be off
    /// by because the time `T` is finite, with the time `t` before it that is not counted: neighbours of regular motions part company by
    /// powers of the time. An exponent that is zero has an interval that holds zero. The error of the steps is not in it.
    pub ci: Vec<Option<f64>>,
    /// How many exponents there are.
    pub most: usize,
    /// The mean over the nodes of the divergence of the continuous equations (1/s), by the trapezoidal rule.
    ///
    /// The sum of all exponents is the mean of `ln |det D Phi| / h`. By Liouville's theorem the two agree, to the order of the
    /// method.
    pub divergence_mean: f64,
    /// The time that was counted (s).
    pub time: f64,
    /// The estimates on the way, of the same exponents in the same order.
    pub running: Vec<Running>,
    /// What the motion is.
    pub verdict: MotionVerdict,
    /// What it is judged by.
    pub evidence: Evidence,
    /// Why the run ended early, if it did.
    pub failure: Option<LyapunovFailure>,
}

/// Why exponents are not computed at all.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LyapunovError {
    /// There are no so many.
    #[error(
        "{asked} exponents are asked for; accepted is a number from 1 to {most}: of each free coordinate one, and of \
            each free velocity"
    )]
    Count {
        /// How many were asked for.
        asked: usize,
        /// How many there are.
        most: usize,
    },
    /// Forces or constraints jump along the run, and a step across a jump has no derivative.
    #[error("forces or constraints jump at t = {time:?} s, and a motion has no derivative there")]
    Jump {
        /// When (s).
        time: f64,
    },
    /// The method or the system cannot be differentiated.
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError),
}

/// The Lyapunov exponents of a motion of a system, which may bring integrators of its own, by the derivatives of the steps that a method
/// makes along it.
///
/// `2 N - M` exponents belong to the distribution, in the coordinates `(q, xi)`, less one for each constraint on positions: neighbours that do
/// not keep these are none. The exponents do not depend on the coordinates where
/// the motion stays in a bounded region of them or is invariant under the translations that leave it. A run that fails gives what it has,
/// with [`Lyapunov::failure`] set.
///
/// # Errors
/// [`LyapunovError`] where the request makes no sense, or the method has no derivatives here.
pub fn lyapunov<const N: usize, const M: usize>(
    subject: (&dyn FullMechanics<N, M>, &dyn OwnMethods<N, M>),
    method: &Method,
    request: &LyapunovRequest<N>,
    progress: &mut dyn Progress,
) -> Result<Lyapunov, LyapunovError> {
    lyapunov_within(subject, (N, M), method, request, progress)
}

/// The same of a system of which so many coordinates and constraints, the first, are its own: the others fill up the shape, and have no
/// exponents.
///
/// # Errors
/// As [`lyapunov`].
#[inline(never)]
pub fn lyapunov_within<const N: usize, const M: usize>(
    (system, own): (&dyn FullMechanics<N, M>, &dyn OwnMethods<N, M>),
    its: (usize, usize),
    method: &Method,
    request: &LyapunovRequest<N>,
    progress: &mut dyn Progress,
) -> Result<Lyapunov, LyapunovError> {
    let (first, last) =
        (request.schedule.t0, request.schedule.time(request.settle.saturating_add(request.schedule.steps)));
    if let Some(time) = system.jump_times(first, last).into_iter().min_by(f64::total_cmp) {
        return Err(LyapunovError::Jump { time });
    }
    let LyapunovRequest { schedule, settle, q, v, .. } = *request;
    let tangent = Steps::of(system, its, method, (schedule.t0, &q))?;
    let most = tangent.count();
    let count = request.exponents.unwrap_or(most);
    if count == 0 || count > most {
        return Err(LyapunovError::Count { asked: count, most });
    }
    let mut stretch = Stretch::new(&tangent, method.info().order, count, (settle, schedule.steps));
    let all = Schedule { steps: settle.saturating_add(schedule.steps), ..schedule };
    let mut state = State::new(q, v, system.angles());
    let mut observer = (&mut stretch, Ticker::new(progress, 0));
    let outcome = integrate_pieces(Subject { system, own }, method, &all, &mut state, &mut observer);
    let failure = stretch.failure.or(outcome.err().map(Into::into));
    // Also where all steps are counted, the tangent vectors have had one step to align.
    let before = settle.max(1) as f64 * schedule.step.abs();
    Ok(result(&stretch, most, before, failure))
}

/// What the sums come to; the exponents in order.
fn result<const N: usize, const M: usize>(
    stretch: &Stretch<'_, N, M>,
    most: usize,
    before: f64,
    failure: Option<LyapunovFailure>,
) -> Lyapunov {
    let (sums, time) = (&stretch.sums, stretch.sums.time);
    let mut order: Vec<usize> = (0..sums.logs.len()).collect();
    order.sort_by(|a, b| sums.logs[*b].total_cmp(&sums.logs[*a]));
    let sorted = |values: &[f64]| -> Vec<f64> { order.iter().map(|i| values[*i]).collect() };
    let exponents = sorted(&sums.logs.iter().map(|sum| sum / time).collect::<Vec<f64>>());
    let interval = |i: &usize| stretch.blocks[*i].interval_of_mean().map(|scatter| scatter + bias(before, time.abs()));
    let ci: Vec<Option<f64>> = order.iter().map(interval).collect();
    let pace = stretch.pace.as_ref();
    let evidence = Evidence {
        largest: exponents[0],
        ci: ci[0],
        size: pace.map_or(0.0, Pace::largest),
        change: pace.map_or(0.0, Pace::change),
        maxima: pace.and_then(Pace::maxima),
        period: pace.and_then(Pace::period),
    };
    let running = stretch.running.iter();
    Lyapunov {
        exponents,
        ci,
        most,
        divergence_mean: sums.divergence / time,
        time,
        running: running.map(|at| Running { time: at.time, exponents: sorted(&at.exponents) }).collect(),
        verdict: evidence.verdict(),
        evidence,
        failure,
    }
}

impl Lyapunov {
    /// The sum of the exponents (1/s).
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.exponents.iter().sum()
    }
}

/// The dimension that a whole spectrum gives an attractor: `j + (l_1 + .. + l_j) / |l_(j+1)|`, with the largest `j` whose sum is
/// not negative (Kaplan and Yorke 1979, Lecture Notes in Mathematics 730, 204-227).
#[must_use]
pub fn kaplan_yorke(exponents: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (j, exponent) in exponents.iter().enumerate() {
        if sum + exponent < 0.0 {
            return j as f64 + sum / exponent.abs();
        }
        sum += exponent;
    }
    exponents.len() as f64
}
