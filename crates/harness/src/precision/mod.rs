//! The cost of accuracy in time: the error at the end of a motion against the time of computing it, method by method.
//!
//! Every method climbs a ladder of steps, an adaptive one of tolerances, until rounding or a limit of time. Then all runs
//! are timed together, in rounds (work-precision diagrams: Hairer, Norsett and Wanner 1993, section II.10).

mod ladder;
mod motion;
mod point;
mod race;
mod reference;
mod slope;
mod verdict;

pub use motion::ReferenceMotion;
pub use point::{Curve, Mark, PrecisionPoint, RungSetting, number};
pub use reference::{Reference, ReferenceError};
pub use slope::FittedSlope;
pub use verdict::{Cheapest, LEVELS, cheapest, mark_pareto, seconds_to};

use crate::stopwatch::{Pinned, has_thread_time};
use crate::{Method, Progress};
use dla::{RunError, stops};
use std::fmt;

/// The questions about a motion with a known end, for any system.
pub struct Bench<'a> {
    /// The duration of the motion (s).
    pub duration: f64,
    /// How far the reference may be off (m or rad).
    pub reference_error: f64,
    /// Makes a run with the given number of steps and gives the distance of its end from the reference (m or rad).
    pub end_error: &'a dyn Fn(&Method, u64) -> Result<f64, RunError>,
    /// The first number of steps, from the given one on, that suits the jumps of the system.
    pub aligned: &'a dyn Fn(u64) -> u64,
}

impl fmt::Debug for Bench<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { duration, reference_error, .. } = self;
        let mut shown = f.debug_struct("Bench");
        shown.field("duration", duration).field("reference_error", reference_error).finish_non_exhaustive()
    }
}

/// How far the ladders go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LadderLimits {
    /// Steps of the coarsest run.
    pub fewest: u64,
    /// The longest run (s); ten times as long for a method that has not six points yet.
    pub longest: f64,
}

/// How times were taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clock {
    /// True for the processor's time of the thread, false for elapsed time.
    pub thread: bool,
    /// The thread stayed on one core.
    pub pinned: bool,
    /// Batches of runs from which a median is taken, all [rounds] unless the work was ended before; fewer, five at least of all rounds, for
    /// runs longer than half a millisecond.
    pub rounds: u64,
}

/// Measures every method; the points come from coarse to fine, their [Pareto front](mark_pareto) is not yet marked.
///
/// `progress` is told of each ladder that is climbed, and of each [round](rounds) of the timing. If it ends the work, the curves are from
/// the ladders that were climbed, with the times of the rounds that were made.
pub fn work_precision(
    bench: &Bench<'_>,
    methods: &[Method],
    limits: &LadderLimits,
    progress: &mut dyn Progress,
) -> (Vec<Curve>, Clock) {
    let pinned = Pinned::here();
    let mut ladders = Vec::with_capacity(methods.len());
    for method in methods {
        if progress.stops() {
            break;
        }
        let ladder = ladder::climb(bench, method, limits);
        if stops() {
            break;
        }
        ladders.push(ladder);
        progress.advance(1);
    }
    let all: Vec<&ladder::Rung> = ladders.iter().flatten().flatten().collect();
    let (times, rounds) = race::race(bench, &all, limits.longest, progress);
    let mut times = times.into_iter();
    let mut curves = Vec::with_capacity(methods.len());
    for (method, ladder) in methods.iter().zip(&ladders) {
        let info = method.info();
        let rungs = ladder.as_ref().map_or(&[][..], Vec::as_slice);
        let points = rungs.iter().map(|rung| point(rung, times.next().flatten(), bench.duration)).collect();
        let curve = Curve::new(info.name.to_owned(), None, Some(info.order), points);
        curves.push(Curve { refusal: ladder.as_ref().err().copied(), ..curve });
    }
    (curves, Clock { thread: has_thread_time(), pinned: pinned.holds(), rounds })
}

/// The number of rounds of the timing.
#[must_use]
pub fn rounds() -> u64 {
    race::ROUNDS
}

fn point(rung: &ladder::Rung, time: Option<race::Measured>, duration: f64) -> PrecisionPoint {
    let adaptive = rung.method.is_adaptive();
    let step = duration / rung.steps as f64;
    PrecisionPoint {
        method: rung.method.info().name.to_owned(),
        source: None,
        setting: Some(if adaptive { RungSetting::Tolerance(rung.method.tolerance()) } else { RungSetting::Step(step) }),
        steps: Some(rung.steps),
        error: rung.error,
        wall_seconds: time.map(|time| time.wall),
        cpu_seconds: time.map(|time| time.cpu),
        spread: time.map(|time| time.spread),
        mark: rung.mark.clone(),
        pareto: false,
    }
}

/// A time has no more than four digits that mean something; rounded once, it is the same wherever it is shown.
fn digits(time: f64) -> f64 {
    format!("{time:.3e}").parse().unwrap_or(time)
}
