use super::table::{begun, checked, listed, within};
use crate::SleighError;
use lagrangian::{Piecewise, Scalar};
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// A piecewise-linear function: straight lines between the points `(times[i], values[i])`, constant before the first and after the last.
///
/// Like a [`Table`](crate::Table) it is evaluated as one of its pieces, the constant before the first time until [`Piecewise::piece`]
/// chooses another: a run is cut at the corners.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ramp {
    #[serde(serialize_with = "listed")]
    times: Arc<[f64]>,
    #[serde(serialize_with = "listed")]
    values: Arc<[f64]>,
    /// How many of the times are not after the piece.
    #[serde(rename = "interpolation", serialize_with = "linear")]
    begun: usize,
}

/// A table in a file says that its values are joined by lines.
fn linear<S: Serializer>(_begun: &usize, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str("linear")
}

impl Ramp {
    /// The function through the points of these times (s), increasing, and as many values.
    ///
    /// # Errors
    /// [`SleighError::Table`] where there are none, of two lengths, not increasing or not finite, or where a line between two
    /// is too steep for a number.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Result<Self, SleighError> {
        checked(&times, &values)?;
        let ramp = Self { times: times.into(), values: values.into(), begun: 0 };
        for begun in 1..ramp.times.len() {
            let steepness = (Self { begun, ..ramp.clone() }).line()[2];
            if !steepness.is_finite() {
                let problem = format!("the line from {:?} s is too steep for a number", ramp.times[begun - 1]);
                return Err(SleighError::Table { problem });
            }
        }
        Ok(ramp)
    }

    /// The begin (s) of the piece, the value there, and the slope.
    #[inline(always)]
    fn line(&self) -> [f64; 3] {
        let (times, values, i) = (&self.times, &self.values, self.begun);
        match i {
            0 => [times[0], values[0], 0.0],
            i if i == times.len() => [times[i - 1], values[i - 1], 0.0],
            i => [times[i - 1], values[i - 1], (values[i] - values[i - 1]) / (times[i] - times[i - 1])],
        }
    }

    /// The times (s).
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The value at each of the times.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The derivative of this order in time at `t`.
    #[inline(always)]
    pub(super) fn derivative<const ORDER: usize, S: Scalar>(&self, t: S) -> S {
        let [begin, value, slope] = self.line();
        match ORDER {
            0 => (t - begin) * slope + value,
            1 => S::constant(slope),
            _ => S::zero(),
        }
    }
}

impl Piecewise for Ramp {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        within(&self.times, from, to)
    }

    fn piece(&self, t: f64) -> Self {
        Self { begun: begun(&self.times, t), ..self.clone() }
    }
}
