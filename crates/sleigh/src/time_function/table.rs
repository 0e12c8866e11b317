use crate::SleighError;
use lagrangian::Piecewise;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// A piecewise-constant function: the value `values[i]` holds from `times[i]` on, and the first one before that too.
///
/// It is evaluated as one of its pieces at all times, the first until [`Piecewise::piece`] chooses another: a run that is
/// cut at the jumps never sees two.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    #[serde(serialize_with = "listed")]
    times: Arc<[f64]>,
    #[serde(serialize_with = "listed")]
    values: Arc<[f64]>,
    #[serde(skip)]
    current: usize,
}

impl Table {
    /// The table of these times (s), increasing, and as many values.
    ///
    /// # Errors
    /// [`SleighError::Table`] if the table is empty, its columns differ in length, its times do not increase, or a number is not finite.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Result<Self, SleighError> {
        checked(&times, &values)?;
        Ok(Self { times: times.into(), values: values.into(), current: 0 })
    }

    /// The value of the piece.
    #[inline(always)]
    pub(super) fn value(&self) -> f64 {
        self.values[self.current]
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

impl Piecewise for Table {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        // At the first time nothing changes.
        within(&self.times[1..], from, to)
    }

    fn piece(&self, t: f64) -> Self {
        Self { current: begun(&self.times, t).saturating_sub(1), ..self.clone() }
    }
}

/// Writes the numbers as a list.
pub(super) fn listed<S: Serializer>(numbers: &Arc<[f64]>, to: S) -> Result<S::Ok, S::Error> {
    numbers[..].serialize(to)
}

/// The times between two.
pub(super) fn within(times: &[f64], from: f64, to: f64) -> Vec<f64> {
    times.iter().copied().filter(|t| from < *t && *t < to).collect()
}

/// How many of increasing times are not after `t`.
pub(super) fn begun(times: &[f64], t: f64) -> usize {
    times.partition_point(|time| *time <= t)
}

/// Refuses a table that is empty, has columns of different lengths, times that do not increase, or a number that is not finite.
pub(super) fn checked(times: &[f64], values: &[f64]) -> Result<(), SleighError> {
    let fail = |problem| Err(SleighError::Table { problem });
    if times.is_empty() {
        return fail("the table has no times".to_owned());
    }
    if times.len() != values.len() {
        return fail(format!("the table has {} times and {} values", times.len(), values.len()));
    }
    if let Some(bad) = times.iter().chain(values).find(|x| !x.is_finite()) {
        return fail(format!("{bad} is not finite"));
    }
    if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
        return fail(format!("the times do not increase: {:?} does not come before {:?}", pair[0], pair[1]));
    }
    Ok(())
}
