use crate::{RunError, Runaway, Schedule, StepError, stops};
use lagrangian::linear::larger;
use thiserror::Error;

/// A constant step for a tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recommendation {
    /// The step (s), a whole part of the duration.
    pub step: f64,
    /// The number of steps in the duration.
    pub steps: u64,
    /// The error to expect: the largest of a coordinate, in its own units, at eighths of the duration.
    pub estimated_error: f64,
}

/// Why there is no step for a tolerance.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RecommendError {
    /// The tolerance or the duration is not a positive number.
    #[error("the tolerance and the duration must be positive and finite, and are {tolerance} and {duration} s")]
    Request {
        /// The tolerance.
        tolerance: f64,
        /// The duration (s).
        duration: f64,
    },
    /// The method does not reach the tolerance: rounding, or the steps, are too many.
    #[error(
        "the tolerance {tolerance:e} is out of reach: the best error found is about {best:.2e}, with a step of \
            {step:.3e} s"
    )]
    OutOfReach {
        /// The tolerance.
        tolerance: f64,
        /// The smallest error found.
        best: f64,
        /// The step of that error (s).
        step: f64,
        /// The number of such steps in the duration.
        steps: u64,
    },
    /// The caller has ended the search ([`Stop`](crate::Stop)).
    #[error("ended before a step was found")]
    Stopped,
    /// The run fails with the shortest step tried.
    #[error("the run fails even with steps of {step:.3e} s: {source}")]
    Fails {
        /// The step (s).
        step: f64,
        /// How it fails.
        #[source]
        source: Box<RunError>,
    },
}

/// Number of times at which trials are compared, evenly over the duration and independent of the nodes: an error that happens to pass
/// through zero at one of them hides nothing.
const TIMES: usize = 8;
/// The recommended step aims at this part of the tolerance, and is content with anything between the second and it.
const AIM: (f64, f64) = (0.5, 0.25);
/// The reference is as close as this part of the tolerance.
const REFERENCE: f64 = 0.05;
/// Trials between the last step that is too long and the first that is not.
const REFINEMENTS: u32 = 12;
/// Changes below this part of the largest coordinate may be rounding.
const ROUNDING: f64 = 1e-7;
/// Maximum number of steps of a trial.
const MOST: u64 = 1 << 26;
/// Maximum number of steps of a trial, unless shorter steps are seen to help.
const MOST_WITHOUT_GAIN: u64 = 1 << 22;
/// Runs with more steps than this show when a motion leaves the range of numbers, and the best error of numbers that lack digits for the
/// tolerance.
const FINE: u64 = 1 << 16;

/// The longest constant step with which a motion from time zero reaches its tolerance, the largest error of a coordinate in its own units,
/// found by trial: `make` makes a run by a schedule, and returns the configurations, angles with their turns, at the given times; the last
/// time is the end of the run.
///
/// A step that changes along a run would destroy the symmetry of a symmetric method; a constant one keeps it. The number of steps is
/// doubled until the change, extrapolated by the ratio of two changes (Richardson), no longer moves by more than a part of the tolerance:
/// that is the reference. That ratio shows the order of the method. Then the number of steps is refined against the reference, to half of
/// the tolerance. The search costs some four times the steps of its result, and more if the tolerance is loose.
///
/// # Errors
/// [`RecommendError`], with the best that is within reach.
pub fn recommend_by_trial(
    duration: f64,
    tolerance: f64,
    mut make: impl FnMut(&Schedule, &[f64]) -> Result<Sampled, RunError>,
) -> Result<Recommendation, RecommendError> {
    if !(tolerance > 0.0 && tolerance.is_finite() && duration > 0.0 && duration.is_finite()) {
        return Err(RecommendError::Request { tolerance, duration });
    }
    let mut trial = |steps: u64| -> Result<Sampled, RunError> {
        let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
        // The last time is the time of the last node, to the bit.
        let end = schedule.time(steps);
        let times: [f64; TIMES] = lagrangian::from_fn(|i| end * (i + 1) as f64 / TIMES as f64);
        let found = make(&schedule, &times)?;
        if stops() {
            return Err(RunError::new(steps, end, StepError::Stopped));
        }
        let finite = found.len() == TIMES && found.iter().flatten().all(|q| q.is_finite());
        if finite { Ok(found) } else { Err(RunError::new(steps, end, StepError::NotFinite)) }
    };
    let (found, trials) = reference(&mut trial, duration, tolerance)?;
    refined(&mut trial, &found, &trials, duration, tolerance)
}

/// Configurations at some times.
type Sampled = Vec<Vec<f64>>;

/// The largest difference of a coordinate at any of the times.
fn distance(a: &Sampled, b: &Sampled) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).fold(0.0, |largest, (a, b)| larger(largest, a - b))
}

/// The trials made, by the number of their steps.
type Trials = Vec<(u64, Sampled)>;

/// The motion to a part of the tolerance, and the trials that led to it.
fn reference(
    trial: &mut impl FnMut(u64) -> Result<Sampled, RunError>,
    duration: f64,
    tolerance: f64,
) -> Result<(Sampled, Trials), RecommendError> {
    let mut trials: Trials = Vec::new();
    let mut extrapolated: Option<Sampled> = None;
    let (mut change, mut best) = (f64::INFINITY, (f64::INFINITY, 1));
    let (mut failure, mut runaway, mut slowly) = (None, Runaway::default(), false);
    let (mut steps, mut stalls, mut size, mut largest) = (4, 0, 0.0, 0.0);
    while steps <= MOST {
        match trial(steps) {
            Ok(now) => {
                size = now.iter().flatten().fold(size, |size, q| larger(size, *q));
                if let Some((_, before)) = trials.last() {
                    let new_change = distance(before, &now);
                    let ratio = change / new_change;
                    change = new_change;
                    if change < 0.75 * best.0 {
                        best = (change, steps);
                    }
                    largest = larger(largest, change);
                    // A ratio of two is an error of order one.
                    let better = (ratio >= 1.9).then(|| {
                        let gain = (ratio.log2().round().clamp(1.0, 20.0).exp2() - 1.0).recip();
                        let beyond = |(now, before): (&f64, &f64)| now + gain * (now - before);
                        let each = |(now, before): (&Vec<f64>, &Vec<f64>)| now.iter().zip(before).map(beyond).collect();
                        now.iter().zip(before).map(each).collect::<Sampled>()
                    });
                    let moved = match (&better, &extrapolated) {
                        (Some(better), Some(before)) => distance(better, before),
                        _ => f64::INFINITY,
                    };
                    trials.push((steps, now.clone()));
                    if moved <= REFERENCE * tolerance {
                        return Ok((better.unwrap_or(now), trials));
                    }
                    // Nothing but rounding is left.
                    if change <= REFERENCE * tolerance {
                        return Ok((now, trials));
                    }
                    extrapolated = better;
                    // Numbers of that size do not have the digits, or nothing is gained by all these steps.
                    // At this rate, and one order better, all steps that there may be would not do: twice in a row.
                    let left = (MOST / steps) as f64;
                    let slow = steps >= FINE && change * left.powf(-2.0 * larger(ratio.log2(), 0.5)) > tolerance;
                    let hopeless = slow && slowly;
                    slowly = slow;
                    let coarse = f64::EPSILON * size > tolerance && change < 0.5 * size;
                    if hopeless || (coarse && steps >= FINE) || (steps >= MOST_WITHOUT_GAIN && change > 0.5 * largest) {
                        break;
                    }
                } else {
                    trials.push((steps, now));
                }
            }
            Err(RunError { source: StepError::Stopped, .. }) => return Err(RecommendError::Stopped),
            // Results with longer steps cannot be compared.
            Err(error) => {
                failure = Some(error);
                trials.clear();
                (change, extrapolated) = (f64::INFINITY, None);
                let hopeless = matches!(error.source, StepError::Unsupported { .. } | StepError::TooLarge { .. });
                let costly = error.step > MOST_WITHOUT_GAIN / 2;
                if hopeless || costly || runaway.sees(&error, duration / steps as f64, FINE) {
                    break;
                }
            }
        }
        // Small changes that have stalled twice are round-off.
        stalls = if change > best.0 && change <= ROUNDING * size { stalls + 1 } else { 0 };
        if stalls == 2 {
            break;
        }
        steps *= 2;
    }
    let out_of_reach =
        RecommendError::OutOfReach { tolerance, best: best.0, step: duration / best.1 as f64, steps: best.1 };
    match failure {
        Some(source) if trials.is_empty() => {
            Err(RecommendError::Fails { step: duration / steps as f64, source: Box::new(source) })
        }
        _ => Err(out_of_reach),
    }
}

/// The fewest steps whose error is below the aim, to the width of the aim.
fn refined(
    trial: &mut impl FnMut(u64) -> Result<Sampled, RunError>,
    reference: &Sampled,
    trials: &Trials,
    duration: f64,
    tolerance: f64,
) -> Result<Recommendation, RecommendError> {
    let (aim, enough) = (AIM.0 * tolerance, AIM.1 * tolerance);
    let mut few = (0, f64::INFINITY);
    let mut many = None;
    // All trials before the last one that is not good enough count as not good enough.
    for (steps, found) in trials {
        let error = distance(found, reference);
        if error > aim {
            (few, many) = ((*steps, error), None);
        } else if many.is_none() {
            many = Some((*steps, error));
        }
    }
    // The extrapolation may be better than every trial.
    let mut many = match many {
        Some(many) => many,
        None => loop {
            let steps = 2 * few.0;
            let fails = |source: RunError| match source.source {
                StepError::Stopped => RecommendError::Stopped,
                _ => RecommendError::Fails { step: duration / steps as f64, source: Box::new(source) },
            };
            let error = distance(&trial(steps).map_err(fails)?, reference);
            if error <= aim {
                break (steps, error);
            }
            // A method of any order would gain more; an error that does not shrink is round-off.
            if error > 0.75 * few.1 || steps > MOST {
                let step = duration / few.0 as f64;
                return Err(RecommendError::OutOfReach { tolerance, best: few.1, step, steps: few.0 });
            }
            few = (steps, error);
        },
    };
    for _ in 0..REFINEMENTS {
        if many.0 - few.0 <= 1 || many.1 >= enough {
            break;
        }
        let steps = between(few, many, f64::sqrt(aim * enough));
        let error = match trial(steps) {
            Err(RunError { source: StepError::Stopped, .. }) => return Err(RecommendError::Stopped),
            found => found.map_or(f64::INFINITY, |found| distance(&found, reference)),
        };
        if error <= aim {
            many = (steps, error);
        } else {
            few = (steps, error);
        }
    }
    let (steps, estimated_error) = many;
    Ok(Recommendation { step: duration / steps as f64, steps, estimated_error })
}

/// A number of steps between two, for which a power law through their errors has the error `aim`; the middle of the powers if they have no
/// law.
fn between(few: (u64, f64), many: (u64, f64), aim: f64) -> u64 {
    let (low, high) = ((few.0.max(1) as f64).ln(), (many.0 as f64).ln());
    let (top, bottom) = (few.1.ln(), many.1.max(f64::MIN_POSITIVE).ln());
    let part = (top - aim.ln()) / (top - bottom);
    // Never too near an end, so that both move.
    let part = if part.is_finite() { part.clamp(0.1, 0.9) } else { 0.5 };
    let steps = (low + part * (high - low)).exp().round() as u64;
    steps.clamp(few.0 + 1, many.0 - 1)
}
