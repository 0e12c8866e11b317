use super::{Bench, LadderLimits, Mark};
use crate::Method;
use dla::StepError;
use std::time::Instant;

/// One run of a ladder.
#[derive(Debug, Clone)]
pub(super) struct Rung {
    pub(super) method: Method,
    pub(super) steps: u64,
    /// Time of the one run that gave the error (s).
    pub(super) seconds: f64,
    pub(super) error: Option<f64>,
    pub(super) mark: Option<Mark>,
}

/// Errors above this (m or rad) are no accuracy at all; a ladder starts below.
const SATURATED: f64 = 0.1;
/// Below this a curve that hardly falls is on its plateau; above, its steps are still too coarse.
const FINE: f64 = 1e-9;
/// The error falls hardly if it falls by less than this power of the fall that the order promises.
const HARDLY: f64 = 0.25;
/// Errors within this multiple of the error of the reference contain that error.
const CLEAR: f64 = 10.0;
/// Number of points on the plateau that are kept: further ones are no news.
const PLATEAU: usize = 2;
/// Number of points that a curve wants above its plateau; it may take [`PATIENCE`] times as long for them.
const POINTS: usize = 6;
const PATIENCE: f64 = 10.0;
/// Maximum number of rungs.
const RUNGS: usize = 64;

/// The tolerances of an adaptive method, a tenth from one to the next.
const TOLERANCES: [f64; 14] =
    [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15];
const TENTH: f64 = 10.0;

/// The factor between the steps of one rung and the next: enough for an error 16 times smaller, and at most two.
fn ratio(order: u32) -> f64 {
    f64::min(2.0, 10.0_f64.powf(1.2 / f64::from(order.max(1))))
}

/// Runs a method with ever finer steps, until rounding or the limit of time. Fails with the reason if the method refuses.
pub(super) fn climb(bench: &Bench<'_>, method: &Method, limits: &LadderLimits) -> Result<Vec<Rung>, &'static str> {
    let adaptive = method.is_adaptive();
    let ratio = ratio(method.info().order);
    let mut rungs: Vec<Rung> = Vec::new();
    let mut wanted = if adaptive { 1 } else { limits.fewest };
    let mut tolerances = TOLERANCES.iter();
    for _ in 0..RUNGS {
        let steps = (bench.aligned)(wanted);
        let tuned = if adaptive {
            let Some(tuned) = tolerances.next().and_then(|tolerance| method.with_tolerance(*tolerance).ok()) else {
                break;
            };
            tuned
        } else {
            *method
        };
        let start = Instant::now();
        let outcome = (bench.end_error)(&tuned, steps);
        let seconds = start.elapsed().as_secs_f64();
        let rung = Rung { method: tuned, steps, seconds, error: None, mark: None };
        rungs.push(match outcome {
            Ok(error) if error.is_finite() => Rung { error: Some(error), ..rung },
            Ok(_) => Rung { mark: Some(Mark::Failed("the end is not a number".to_owned(), None)), ..rung },
            Err(failure) => match failure.source {
                StepError::Unsupported { reason } => return Err(reason),
                _ => Rung { mark: Some(Mark::Failed(failure.to_string(), Some(failure))), ..rung },
            },
        });
        mark_plateau(&mut rungs, bench.reference_error, method.info().order);
        let regular = rungs.iter().filter(|rung| rung.mark.is_none() && rung.error <= Some(SATURATED)).count();
        let flat = plateau(&rungs);
        let next = seconds * if adaptive { 1.0 } else { ratio };
        let late = next > limits.longest && (regular >= POINTS || next > PATIENCE * limits.longest);
        if flat >= PLATEAU || late {
            break;
        }
        if !adaptive {
            wanted = (steps + 1).max((steps as f64 * ratio).round() as u64);
        }
    }
    // Errors that fall again were not on a plateau.
    let (end, near) = (rungs.len() - plateau(&rungs), CLEAR * bench.reference_error);
    for rung in &mut rungs[..end] {
        rung.mark = rung.mark.take().filter(|mark| *mark != Mark::Plateau || rung.error <= Some(near));
    }
    Ok(without_coarse(rungs))
}

/// The number of rungs at the end that are on the plateau.
fn plateau(rungs: &[Rung]) -> usize {
    rungs.iter().rev().take_while(|rung| rung.mark == Some(Mark::Plateau)).count()
}

/// Marks the last rung if rounding shows in it.
fn mark_plateau(rungs: &mut [Rung], reference: f64, order: u32) {
    let flat = match rungs {
        [.., before, last] => match (before.error, last.error) {
            (_, Some(error)) if error <= CLEAR * reference => true,
            (Some(larger), Some(error)) if error < FINE => {
                // The fall that the order promises of the finer step; for a tolerance, the ratio of the tolerances.
                let finer = last.steps as f64 / before.steps as f64;
                let promised = if finer > 1.0 { finer.powf(f64::from(order)) } else { TENTH };
                error * promised.powf(HARDLY) > larger
            }
            _ => false,
        },
        [last] => last.error.is_some_and(|error| error <= CLEAR * reference),
        [] => false,
    };
    if let (true, Some(last)) = (flat, rungs.last_mut()) {
        last.mark = Some(Mark::Plateau);
    }
}

/// Leaves out the first rungs, whose steps are too coarse: runs that fail, errors of the size of the motion, and errors
/// that do not fall twice in a row. A method that never gets beyond keeps its finest run.
fn without_coarse(mut rungs: Vec<Rung>) -> Vec<Rung> {
    let falls = |pair: &[Rung]| match (pair[0].error, pair[1].error) {
        (Some(error), Some(next)) => error <= SATURATED && (next < error || pair[0].mark.is_some()),
        _ => false,
    };
    let twice = rungs.windows(3).position(|three| falls(&three[..2]) && falls(&three[1..]));
    let once = || rungs.windows(2).position(falls);
    let first = twice.or_else(once).unwrap_or(rungs.len().saturating_sub(1));
    rungs.split_off(first)
}
