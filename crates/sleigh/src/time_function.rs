use crate::SleighError;
use lagrangian::{Piecewise, Scalar};
use std::f64::consts::TAU;

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
    /// Smooth pulses, one after the other.
    Pulses(Pulses),
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
            return fail("the table has no times".to_owned());
        }
        if times.len() != values.len() {
            return fail(format!("the table has {} times and {} values", times.len(), values.len()));
        }
        if let Some(bad) = times.iter().chain(&values).find(|x| !x.is_finite()) {
            return fail(format!("{bad} is not finite"));
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
            return fail(format!("the times do not increase: {:?} does not come before {:?}", pair[0], pair[1]));
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

/// Smooth pulses from rest to rest, one after the other: `f(t) = A_i/T_i (1 - cos(2 pi (t - t_i)/T_i))` from `t_i` to `t_i + T_i`,
/// so that pulse `i` has the integral `A_i`; function and slope vanish at every seam, and after the last pulse.
///
/// Like a [`Table`] it is evaluated as one of its pieces, the first until [`Piecewise::piece`] chooses another.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulses {
    times: Vec<f64>,
    areas: Vec<f64>,
    current: usize,
}

impl Pulses {
    /// The pulses between these times (s), increasing, with these integrals: one less than times.
    ///
    /// # Errors
    /// [`SleighError::Table`] where the lengths do not go together, the times do not increase, or a number is not finite.
    pub fn new(times: Vec<f64>, areas: Vec<f64>) -> Result<Self, SleighError> {
        if times.len() != areas.len() + 1 {
            let problem = format!("the table has {} times for {} pulses", times.len(), areas.len());
            return Err(SleighError::Table { problem });
        }
        // The rest is what a table is asked for.
        Table::new(times.clone(), [areas.as_slice(), &[0.0]].concat())?;
        Ok(Self { times, areas, current: 0 })
    }

    /// The begin (s), the length (s) and the integral of the pulse that is evaluated; none after the last one.
    #[inline(always)]
    fn pulse(&self) -> Option<[f64; 3]> {
        let (begin, end) = (self.times.get(self.current)?, self.times.get(self.current + 1)?);
        Some([*begin, end - begin, self.areas[self.current]])
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
            Self::Pulses(pulses) => pulses.pulse().map_or(S::zero(), |[begin, length, area]| {
                (-((t - begin) * (TAU / length)).cos() + 1.0) * (area / length)
            }),
        }
    }

    /// The derivative in time at `t`, between the jumps.
    #[inline(always)]
    pub fn slope<S: Scalar>(&self, t: S) -> S {
        match self {
            Self::Sine { amplitude, frequency, phase } => (t * *frequency + *phase).cos() * (*amplitude * *frequency),
            Self::Constant(_) | Self::Table(_) => S::zero(),
            Self::Pulses(pulses) => pulses.pulse().map_or(S::zero(), |[begin, length, area]| {
                ((t - begin) * (TAU / length)).sin() * (area / length * (TAU / length))
            }),
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
            // Checked when they were made.
            Self::Table(_) | Self::Pulses(_) => [0.0; 3],
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
            Self::Pulses(pulses) => pulses.times[1..].iter().copied().filter(|t| from < *t && *t < to).collect(),
            Self::Constant(_) | Self::Sine { .. } => Vec::new(),
        }
    }

    fn piece(&self, t: f64) -> Self {
        match self {
            Self::Table(table) => {
                let begun = table.times.partition_point(|time| *time <= t);
                Self::Table(Table { current: begun.saturating_sub(1), ..table.clone() })
            }
            Self::Pulses(pulses) => {
                let begun = pulses.times.partition_point(|time| *time <= t);
                Self::Pulses(Pulses { current: begun.saturating_sub(1), ..pulses.clone() })
            }
            other => other.clone(),
        }
    }
}
