use super::pace::Pace;
use super::stretch::{LyapunovFailure, Running, Stretch};
use super::tangent::Steps;
use super::verdict::{Evidence, MotionVerdict};
use crate::Run;
use crate::timing::Ticker;
use crate::{Method, Progress};
use dla::{Mechanism, Schedule, SensitivityError};
use thiserror::Error;

/// The exponents asked for, and their motion.
#[derive(Debug, Clone, PartialEq)]
pub struct LyapunovRequest {
    /// The schedule of the counted steps.
    pub schedule: Schedule,
    /// Number of steps before them, in which the motion and the tangent vectors settle.
    pub settle: u64,
    /// Number of exponents, the largest first; `None` for all.
    pub exponents: Option<usize>,
    /// Configuration at the start.
    pub q: Vec<f64>,
    /// Velocity at the start.
    pub v: Vec<f64>,
}

/// The Lyapunov exponents of a motion, as the discrete map has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Lyapunov {
    /// The exponents (1/s), the largest first.
    pub exponents: Vec<f64>,
    /// Half the width of the 95 % confidence interval of each (1/s); `None` if the run is too short.
    ///
    /// It is the sum of two parts: the scatter that a longer run averages out, from batch means, and `3 ln(1 + T/t)/T`, the possible error
    /// because the counted time `T` is finite, after the time `t` that is not counted: neighbours of regular motions part company by powers
    /// of the time. The interval of an exponent of zero holds zero. The error of the steps is not in it.
    pub ci: Vec<Option<f64>>,
    /// The number of exponents that the motion has.
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
    /// The kind of the motion.
    pub verdict: MotionVerdict,
    /// The evidence for the verdict.
    pub evidence: Evidence,
    /// Why the run ended early, if it did.
    pub failure: Option<LyapunovFailure>,
}

/// Why exponents are not computed at all.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LyapunovError {
    /// The motion has fewer exponents than asked for, or none is asked for.
    #[error(
        "{asked} exponents are asked for; accepted is a number from 1 to {most}: of each free coordinate one, and of \
            each free velocity"
    )]
    Count {
        /// The number asked for.
        asked: usize,
        /// The number that there are.
        most: usize,
    },
    /// Forces or constraints jump along the run, and a step across a jump has no derivative.
    #[error("forces or constraints jump at t = {time:?} s, and a motion has no derivative there")]
    Jump {
        /// The time of the jump (s).
        time: f64,
    },
    /// The method or the system cannot be differentiated.
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError),
}

/// The Lyapunov exponents of a motion of a system, by the derivatives of the steps that a method makes along it.
///
/// The first `n` coordinates and `m` constraints of the system, `own`, are its own: others fill up its shape, and have no exponents.
/// `2 n - m` exponents belong to the distribution, in the coordinates `(q, xi)`, less one for each constraint on positions:
/// neighbours that do not keep these do not count. The exponents do not depend on the coordinates if the motion stays in a bounded region
/// of them or is invariant under the translations that leave it. A run that fails gives what it has, with [`Lyapunov::failure`] set.
///
/// # Errors
/// [`LyapunovError`] if the request makes no sense, or the method has no derivatives here.
pub fn lyapunov(
    system: &dyn Mechanism,
    own: (usize, usize),
    method: &Method,
    request: &LyapunovRequest,
    progress: &mut dyn Progress,
) -> Result<Lyapunov, LyapunovError> {
    let LyapunovRequest { schedule, settle, exponents, q, v } = request;
    let all = Schedule { steps: settle.saturating_add(schedule.steps), ..*schedule };
    if let Some(time) = system.jump_times(all.t0, all.time(all.steps)).into_iter().min_by(f64::total_cmp) {
        return Err(LyapunovError::Jump { time });
    }
    let tangent = Steps::of(system, own, method, (all.t0, q))?;
    let most = tangent.count();
    let count = exponents.unwrap_or(most);
    if count == 0 || count > most {
        return Err(LyapunovError::Count { asked: count, most });
    }
    let mut stretch = Stretch::new(&tangent, method.info().order, count, (*settle, schedule.steps));
    let mut observer = (&mut stretch, Ticker::new(progress, 0));
    let outcome = Run::of(system, method).observe(&mut observer).moves(&all, &mut system.state(q, v));
    let failure = stretch.failure.or(outcome.err().map(Into::into));
    // Even if all steps are counted, the tangent vectors have had one step to align.
    let before = (*settle).max(1) as f64 * schedule.step.abs();
    Ok(result(&stretch, most, before, failure))
}

/// The result of the sums, with the exponents in order.
fn result(stretch: &Stretch<'_>, most: usize, before: f64, failure: Option<LyapunovFailure>) -> Lyapunov {
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

/// Largest power of the time by which neighbours of a motion without positive exponents part company.
///
/// The power is one if speeds or frequencies differ by a constant, as in nearly all straight, periodic and quasi-periodic motions; two if
/// headings differ by a rate, as beside the straight motion of a sleigh whose spin nothing brakes; three if that motion is uniformly
/// accelerated besides.
const POWER: f64 = 3.0;

/// The possible error of an exponent because the time is finite (1/s), for a frame that is carried along for `before` seconds and then
/// counted for `time` seconds: `3 ln(1 + time/before) / time`.
///
/// Neighbours along a direction whose exponent is zero part company like a polynomial `p(t)` of the time without negative coefficients, of
/// degree three at most. Then `p(s t) <= s^3 p(t)` for `s >= 1`, so that the growth counted between `before` and `before + time` is at most
/// `3 ln((before + time)/before)`, for any units and any beginning of the growth. A direction that makes up for it shrinks by as much. With
/// `before` of a fixed length this is the known `ln T/T`; if it is a part of the run, `1/T`. (A power of the time times an exponential does
/// the same to an exponent that is not zero.)
fn bias(before: f64, time: f64) -> f64 {
    POWER * (time / before).ln_1p() / time
}
