use super::FittedSlope;
use dla::RunError;
use lagrangian::Shown;
use std::fmt;

/// The setting that varies along the curve of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RungSetting {
    /// The step (s).
    Step(f64),
    /// The tolerance of an adaptive method.
    Tolerance(f64),
}

/// A remark on a point, beside its numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// The error is within ten times the error of the reference, or finer steps no longer make it smaller: rounding.
    Plateau,
    /// The run failed, with the reason; and with the failure itself, if this program made the run.
    Failed(String, Option<RunError>),
}

impl fmt::Display for RungSetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(step) => write!(f, "step {} s", Shown(*step)),
            Self::Tolerance(tolerance) => write!(f, "tolerance {}", Shown(*tolerance)),
        }
    }
}

/// A number with every digit, in exponent form instead of a long row of zeros.
#[must_use]
pub fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e16).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

impl fmt::Display for Mark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plateau => f.write_str("plateau"),
            Self::Failed(reason, _) => write!(f, "failed: {reason}"),
        }
    }
}

/// A run of one method, its error and its time; also one that another program made.
#[derive(Debug, Clone, PartialEq)]
pub struct PrecisionPoint {
    /// The name of the method.
    pub method: String,
    /// The source of the point, if not this program.
    pub source: Option<String>,
    /// The setting of the run.
    pub setting: Option<RungSetting>,
    /// Steps made: of the schedule, for an adaptive method the intervals that it crosses.
    pub steps: Option<u64>,
    /// Distance of the end from the reference; `None` if the run failed.
    pub error: Option<f64>,
    /// Elapsed time of a run (s), the median.
    pub wall_seconds: Option<f64>,
    /// Processor time of a run (s), the median.
    pub cpu_seconds: Option<f64>,
    /// The width of the middle half of the processor times, as a fraction of the median.
    pub spread: Option<f64>,
    /// A remark.
    pub mark: Option<Mark>,
    /// No other point has both a smaller error and a smaller time.
    pub pareto: bool,
}

impl PrecisionPoint {
    /// The time to compare (s): the processor's, or elapsed time if that alone is known.
    #[must_use]
    pub fn seconds(&self) -> Option<f64> {
        self.cpu_seconds.or(self.wall_seconds)
    }

    /// Error and time, if the point has both and both have a logarithm.
    #[must_use]
    pub fn measured(&self) -> Option<[f64; 2]> {
        let usable = |value: &f64| value.is_finite() && *value > 0.0;
        Some([self.error.filter(usable)?, self.seconds().filter(usable)?])
    }

    /// Whether the error comes from the method and not from round-off.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        self.mark.is_none() && self.error.is_some()
    }
}

/// The points of one method, from coarse to fine.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The name of the method.
    pub method: String,
    /// The source of the points, if not this program.
    pub source: Option<String>,
    /// The order of the method; `None` if it is not known.
    pub order: Option<u32>,
    /// The exponent `p` of `error = c h^p`, or of the tolerance, by least squares (see [`FittedSlope`]).
    pub slope: Option<FittedSlope>,
    /// The points.
    pub points: Vec<PrecisionPoint>,
    /// Why the method refuses the system; there are then no points. `None` if it does not refuse.
    pub refusal: Option<&'static str>,
}

impl Curve {
    /// A curve with the slope of its points.
    #[must_use]
    pub fn new(method: String, source: Option<String>, order: Option<u32>, points: Vec<PrecisionPoint>) -> Self {
        let curve = Self { method, source, order, slope: None, points, refusal: None };
        Self { slope: FittedSlope::of(&curve), ..curve }
    }

    /// The name of the method, with the source of the points.
    #[must_use]
    pub fn label(&self) -> String {
        match &self.source {
            Some(source) => format!("{} ({source})", self.method),
            None => self.method.clone(),
        }
    }
}
