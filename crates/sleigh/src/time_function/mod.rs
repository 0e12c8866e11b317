//! Functions of time: forces, torques, places, imposed speeds.

mod formula;
mod pulses;
mod ramp;
mod table;

pub use formula::Formula;
pub use pulses::Pulses;
pub use ramp::Ramp;
pub use table::Table;

use crate::SleighError;
use lagrangian::{Piecewise, Scalar};
use serde::Serialize;

/// A function of time: a force, a torque, a position.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TimeFunction {
    /// The same value at all times.
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
    /// Linear between the times of a table.
    Ramp(Ramp),
    /// Smooth pulses, one after the other.
    Pulses(Pulses),
    /// A formula in `t`.
    Formula(Formula),
}

impl TimeFunction {
    /// The value at all times, where the piece is constant.
    #[inline(always)]
    fn constant(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            Self::Table(table) => Some(table.value()),
            _ => None,
        }
    }

    /// The value at `t`.
    #[inline(always)]
    pub fn value<S: Scalar>(&self, t: S) -> S {
        self.derivative::<0, S>(t)
    }

    /// The derivative in time at `t`, between the jumps.
    #[inline(always)]
    pub fn slope<S: Scalar>(&self, t: S) -> S {
        self.derivative::<1, S>(t)
    }

    /// The second derivative in time at `t`, between the jumps.
    #[inline(always)]
    pub fn curvature<S: Scalar>(&self, t: S) -> S {
        self.derivative::<2, S>(t)
    }

    /// The derivative of this order, at most 2, in time at `t`.
    #[inline(always)]
    fn derivative<const ORDER: usize, S: Scalar>(&self, t: S) -> S {
        if let Some(value) = self.constant() {
            return S::constant(if ORDER == 0 { value } else { 0.0 }).carried_as(t);
        }
        let derivative = t.called(
            #[inline(always)]
            |t| match self {
                Self::Constant(_) | Self::Table(_) => S::zero(),
                Self::Sine { amplitude, frequency, phase } => {
                    let angle = t * *frequency + *phase;
                    match ORDER {
                        0 => angle.sin() * *amplitude,
                        1 => angle.cos() * (*amplitude * *frequency),
                        _ => angle.sin() * -(*amplitude * *frequency * *frequency),
                    }
                }
                Self::Ramp(ramp) => ramp.derivative::<ORDER, S>(t),
                Self::Pulses(pulses) => pulses.derivative::<ORDER, S>(t),
                Self::Formula(formula) => formula.derivative(ORDER, t),
            },
        );
        derivative.carried_as(t)
    }

    /// Value, slope and second derivative at `t`. A sine computes its sine and cosine once for all three.
    #[inline(always)]
    pub(crate) fn jet<S: Scalar>(&self, t: S) -> [S; 3] {
        match self {
            Self::Sine { amplitude, frequency, phase } => {
                let (sin, cos) = (t * *frequency + *phase).sin_cos();
                let swing = *amplitude * *frequency;
                [sin * *amplitude, cos * swing, sin * -(swing * *frequency)]
            }
            _ => [self.value(t), self.slope(t), self.curvature(t)],
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
            Self::Table(_) | Self::Ramp(_) | Self::Pulses(_) | Self::Formula(_) => [0.0; 3],
        };
        match numbers.into_iter().find(|x| !x.is_finite()) {
            Some(value) => Err(SleighError::NotFinite { quantity, value }),
            None => Ok(self),
        }
    }
}

impl TimeFunction {
    /// Whether the value changes in time.
    #[must_use]
    pub fn varies(&self) -> bool {
        let changes = |values: &[f64]| values.windows(2).any(|pair| pair[0].to_bits() != pair[1].to_bits());
        match self {
            Self::Constant(_) => false,
            Self::Sine { amplitude, frequency, .. } => *amplitude != 0.0 && *frequency != 0.0,
            Self::Table(table) => changes(table.values()),
            Self::Ramp(ramp) => changes(ramp.values()),
            Self::Pulses(_) => true,
            Self::Formula(formula) => !formula.is_constant(),
        }
    }

    /// Whether the function, or its slope, jumps.
    #[must_use]
    pub fn has_corners(&self) -> bool {
        match self {
            Self::Constant(_) | Self::Sine { .. } | Self::Pulses(_) => false,
            Self::Table(table) => table.times().len() > 1,
            Self::Ramp(ramp) => ramp.times().len() > 1,
            Self::Formula(formula) => formula.has_corners(),
        }
    }

    /// A bound on the size of the values of a number, a sine or a table; the size of other functions at `t = 0`.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let of = |values: &[f64]| values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        match self {
            Self::Constant(value) | Self::Sine { amplitude: value, .. } => value.abs(),
            Self::Table(table) => of(table.values()),
            Self::Ramp(ramp) => of(ramp.values()),
            Self::Pulses(_) | Self::Formula(_) => self.value(0.0_f64).abs(),
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
            Self::Table(table) => table.jumps(from, to),
            Self::Ramp(ramp) => ramp.jumps(from, to),
            Self::Pulses(pulses) => pulses.jumps(from, to),
            Self::Formula(formula) => formula.jumps(from, to),
            Self::Constant(_) | Self::Sine { .. } => Vec::new(),
        }
    }

    fn piece(&self, t: f64) -> Self {
        match self {
            Self::Table(table) => Self::Table(table.piece(t)),
            Self::Ramp(ramp) => Self::Ramp(ramp.piece(t)),
            Self::Pulses(pulses) => Self::Pulses(pulses.piece(t)),
            Self::Formula(formula) => Self::Formula(formula.piece(t)),
            other => other.clone(),
        }
    }
}
