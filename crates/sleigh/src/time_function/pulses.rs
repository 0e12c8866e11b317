use super::table::{begun, checked, within};
use crate::SleighError;
use lagrangian::{Piecewise, Scalar};
use serde::Serialize;
use std::f64::consts::TAU;

/// Smooth pulses from rest to rest, one after the other: `f(t) = A_i/T_i (1 - cos(2 pi (t - t_i)/T_i))` from `t_i` to `t_i + T_i`,
/// so that pulse `i` has the integral `A_i`; function and slope vanish at every seam, and after the last pulse.
///
/// Like a [`Table`](crate::Table) it is evaluated as one of its pieces, the first until [`Piecewise::piece`] chooses another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pulses {
    times: Vec<f64>,
    areas: Vec<f64>,
    #[serde(skip)]
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
        checked(&times, &[areas.as_slice(), &[0.0]].concat())?;
        Ok(Self { times, areas, current: 0 })
    }

    /// The begin (s), the length (s) and the integral of the pulse that is evaluated; none after the last one.
    #[inline(always)]
    fn pulse(&self) -> Option<[f64; 3]> {
        let (begin, end) = (self.times.get(self.current)?, self.times.get(self.current + 1)?);
        Some([*begin, end - begin, self.areas[self.current]])
    }

    /// The derivative of this order in time at `t`.
    #[inline(always)]
    pub(super) fn derivative<const ORDER: usize, S: Scalar>(&self, t: S) -> S {
        let Some([begin, length, area]) = self.pulse() else { return S::zero() };
        let (rate, mean) = (TAU / length, area / length);
        let angle = (t - begin) * rate;
        match ORDER {
            0 => (-angle.cos() + 1.0) * mean,
            1 => angle.sin() * (mean * rate),
            _ => angle.cos() * (mean * rate * rate),
        }
    }
}

impl Piecewise for Pulses {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        within(&self.times[1..], from, to)
    }

    fn piece(&self, t: f64) -> Self {
        Self { current: begun(&self.times, t).saturating_sub(1), ..self.clone() }
    }
}
