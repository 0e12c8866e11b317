use crate::SleighError;
use lagrangian::{Piecewise, Scalar};

/// A function of time: a force, a torque, a position.
#[derive(Debug, Clone, PartialEq)]
pub enum TimeFunction {
    /// The same at all times.
    Constant(f64),
    /// `amplitude sin(frequency t + phase)`.
    Sine {
        /// Amplitude, in the unit of the function.
        amplitude: f64,
        /// Angular frequency (rad/s).
        frequency: f64,
        /// Phase at `t = 0` (rad).
        phase: f64,
    },
    /// Constant between the times of a table.
    Table(Table),
}

/// A piecewise-constant function: the value `values[i]` holds from `times[i]` on, and the first one before that too.
///
/// It is evaluated as one of its pieces at all times, the first until [`Piecewise::piece`] chooses another: a run that is
/// cut at the jumps never sees two.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    current: usize,
}

impl Table {
    /// The table of these times (s), increasing, and as many values.
    ///
    /// # Errors
    /// [`SleighError::Table`] where it is empty, of two lengths, not increasing or not finite.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Result<Self, SleighError> {
        let fail = |problem| Err(SleighError::Table { problem });
        if times.is_empty() {
            return fail("it is empty".to_owned());
        }
        if times.len() != values.len() {
            return fail(format!("it has {} times and {} values", times.len(), values.len()));
        }
        if let Some(bad) = times.iter().chain(&values).find(|x| !x.is_finite()) {
            return fail(format!("it contains {bad}, which is not finite"));
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
            return fail(format!("its times do not increase: {} does not come before {}", pair[0], pair[1]));
        }
        Ok(Self { times, values, current: 0 })
    }

    /// The times (s).
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The value from each of the times on.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl TimeFunction {
    /// The value at `t`.
    #[inline(always)]
    pub fn value<S: Scalar>(&self, t: S) -> S {
        match self {
            Self::Constant(value) => S::constant(*value),
            Self::Sine { amplitude, frequency, phase } => (t * *frequency + *phase).sin() * *amplitude,
            Self::Table(table) => S::constant(table.values[table.current]),
        }
    }

    /// The derivative in time at `t`, between the jumps.
    #[inline(always)]
    pub fn slope<S: Scalar>(&self, t: S) -> S {
        match self {
            Self::Sine { amplitude, frequency, phase } => (t * *frequency + *phase).cos() * (*amplitude * *frequency),
            Self::Constant(_) | Self::Table(_) => S::zero(),
        }
    }

    /// The function itself, where every number in it is finite.
    ///
    /// # Errors
    /// [`SleighError::NotFinite`] names the quantity that the function stands for.
    pub fn finite(self, quantity: &'static str) -> Result<Self, SleighError> {
        let numbers = match self {
            Self::Constant(value) => [value, 0.0, 0.0],
            Self::Sine { amplitude, frequency, phase } => [amplitude, frequency, phase],
            // Checked when it was made.
            Self::Table(_) => [0.0; 3],
        };
        match numbers.into_iter().find(|x| !x.is_finite()) {
            Some(value) => Err(SleighError::NotFinite { quantity, value }),
            None => Ok(self),
        }
    }
}

impl From<f64> for TimeFunction {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl Piecewise for TimeFunction {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        match self {
            // At the first time nothing changes.
            Self::Table(table) => table.times[1..].iter().copied().filter(|t| from < *t && *t < to).collect(),
            Self::Constant(_) | Self::Sine { .. } => Vec::new(),
        }
    }

    fn piece(&self, t: f64) -> Self {
        match self {
            Self::Table(table) => {
                let begun = table.times.partition_point(|time| *time <= t);
                Self::Table(Table { current: begun.saturating_sub(1), ..table.clone() })
            }
            other => other.clone(),
        }
    }
}
