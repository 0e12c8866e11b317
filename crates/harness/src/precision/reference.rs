use super::ReferenceMotion;
use crate::{Method, MethodError};
use dla::{RunError, Runaway};
use lagrangian::linear::larger;
use thiserror::Error;

/// The end of a motion, computed until finer steps change nothing but rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Configuration at the end, angles with their full turns.
    pub q: Vec<f64>,
    /// Steps of the run.
    pub steps: u64,
    /// Its possible error: the largest distance among the runs from which on nothing improves, and from one by `gauss14`.
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
        /// The error of the run.
        #[source]
        source: RunError,
    },
    /// The method is not there.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The best end is not accurate enough.
    #[error(
        "the reference, gauss16 with {steps} steps, is off by {error:.3e} m or rad: no error can be measured from it; a shorter \
         --duration has a better one"
    )]
    Vague {
        /// Steps of the best run.
        steps: u64,
        /// Its possible error (m or rad).
        error: f64,
    },
    /// Not two runs succeeded.
    #[error("the reference: too few runs of gauss16 succeed")]
    TooFew,
}

/// Ratio of the steps of one run and the next: an error of order 16 falls by 650.
const RATIO: f64 = 1.5;
/// Maximum number of runs; the last has 1.5^31 times the steps of the first.
const RUNS: usize = 32;
/// Runs of more steps than this show when a motion leaves the range of numbers.
const FINE: u64 = 1 << 10;
/// Largest error of a reference (m or rad).
const VAGUE: f64 = 0.1;
/// Number of runs without improvement after which rounding is reached.
const PATIENCE: usize = 3;

impl Reference {
    /// Runs `gauss16` with ever more steps until the distance of successive ends no longer falls.
    ///
    /// The state carries its coordinates with twice the digits, so that only the rounding of the velocities is left. `distance` is the
    /// distance of two configurations.
    ///
    /// # Errors
    /// [`ReferenceError`] if no run succeeds.
    pub fn converged(
        motion: &ReferenceMotion<'_>,
        distance: &dyn Fn(&[f64], &[f64]) -> f64,
    ) -> Result<Self, ReferenceError> {
        let (gauss16, gauss14) = (Method::named("gauss16", None)?, Method::named("gauss14", None)?);
        let mut ends: Vec<(u64, Vec<f64>)> = Vec::new();
        // The distances of successive ends, the smallest of them and its index.
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
        // The later one of the two ends with the smallest distance.
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
