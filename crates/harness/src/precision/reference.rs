use super::ReferenceMotion;
use crate::{Method, MethodError};
use dla::{RunError, Runaway};
use lagrangian::linear::larger;
use thiserror::Error;

/// Where a motion ends, computed until finer steps change nothing but rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Configuration at the end, angles with their full turns.
    pub q: Vec<f64>,
    /// Steps of the run.
    pub steps: u64,
    /// How far it may be off: the largest distance among the runs from which on nothing improves, and from one by
    /// `gauss14`.
    pub error: f64,
}

/// Why there is no reference.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReferenceError {
    /// No step was small enough.
    #[error("the reference, gauss16 with {steps} steps: {source}")]
    Run {
        /// Steps of the finest run.
        steps: u64,
        /// What happened.
        #[source]
        source: RunError,
    },
    /// The method is not there.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The best end is no end.
    #[error(
        "the reference, gauss16 with {steps} steps, is off by {error:.3e} m or rad: no error can be measured from it; a shorter \
         --duration has a better one"
    )]
    Vague {
        /// Steps of the best run.
        steps: u64,
        /// How far it may be off (m or rad).
        error: f64,
    },
    /// Not two runs succeeded.
    #[error("the reference: too few runs of gauss16 succeed")]
    TooFew,
}

/// From one run to the next there are so many times the steps: an error of order 16 falls by 650.
const RATIO: f64 = 1.5;
/// Runs at most; the last has 1.5^31 times the steps of the first.
const RUNS: usize = 32;
/// Runs of more steps than this say when a motion leaves the range of numbers.
const FINE: u64 = 1 << 10;
/// A reference that is off by more (m or rad) is none.
const VAGUE: f64 = 0.1;
/// So many runs on, nothing has improved: rounding is reached.
const PATIENCE: usize = 3;

impl Reference {
    /// Runs `gauss16` with ever more steps until the distance of successive ends no longer falls.
    ///
    /// The state carries its coordinates with twice the digits, so that what is left is the rounding of the velocities.
    /// `distance` is that of two configurations.
    ///
    /// # Errors
    /// [`ReferenceError`] where no run succeeds.
    pub fn converged(
        motion: &ReferenceMotion<'_>,
        distance: &dyn Fn(&[f64], &[f64]) -> f64,
    ) -> Result<Self, ReferenceError> {
        let (gauss16, gauss14) = (Method::named("gauss16", None)?, Method::named("gauss14", None)?);
        let mut ends: Vec<(u64, Vec<f64>)> = Vec::new();
        // The distances of successive ends, the best of them and where it is.
        let mut steps: Vec<f64> = Vec::new();
        let mut best = (f64::INFINITY, 0);
        let (mut wanted, mut failure, mut runaway) = (motion.fewest(), None, Runaway::default());
        for _ in 0..RUNS {
            let count = motion.aligned(wanted);
            match motion.end(&gauss16, count) {
                Ok(q) => {
                    if let Some((_, before)) = ends.last() {
                        let step = distance(before, &q);
                        if step < best.0 {
                            best = (step, steps.len());
                        }
                        steps.push(step);
                    }
                    ends.push((count, q));
                }
                Err(source) => {
                    let over = runaway.sees(&source, motion.duration() / count as f64, FINE);
                    failure = Some(ReferenceError::Run { steps: count, source });
                    if over {
                        break;
                    }
                }
            }
            if best.0.is_finite() && steps.len() > best.1 + PATIENCE {
                break;
            }
            wanted = (count as f64 * RATIO).ceil() as u64;
        }
        // Of the two ends with the smallest distance the later one.
        let Some((count, q)) = ends.get(best.1 + 1).cloned() else {
            return Err(failure.unwrap_or(ReferenceError::TooFew));
        };
        let rounding = f64::EPSILON * q.iter().fold(0.0, |size: f64, q| size.max(q.abs()));
        let mut error = ends.iter().skip(best.1).map(|(_, end)| distance(end, &q)).fold(rounding, larger);
        if let Ok(other) = motion.end(&gauss14, count) {
            error = larger(error, distance(&other, &q));
        }
        if error > VAGUE {
            Err(ReferenceError::Vague { steps: count, error })
        } else {
            Ok(Self { q, steps: count, error })
        }
    }
}
