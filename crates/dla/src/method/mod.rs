//! The methods by name.

mod stepper;
mod table;

pub(crate) use stepper::differentiable;
pub use stepper::{has_derivatives, has_tangents};
pub use table::{METHODS, MethodInfo, MethodKind};

use crate::Substeps;
use lagrangian::{Alpha, Midpoint, NotAWeight, Rule, Trapezoid};
use thiserror::Error;

/// A method, ready to integrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    info: MethodInfo,
    alpha: Alpha,
    tolerance: f64,
    substeps: Option<Substeps>,
}

/// Why no method can be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MethodError {
    /// No method has this name.
    #[error("{}; the methods are {}", unknown(name), names().join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
    },
    /// The weight of `dla-alpha` is not between 0 and 1.
    #[error(transparent)]
    Alpha(#[from] NotAWeight),
    /// The tolerance of an adaptive method is not a positive number.
    #[error("the tolerance must be positive and finite, and is {tolerance}")]
    Tolerance {
        /// The tolerance given.
        tolerance: f64,
    },
}

/// The error for a name that no method has.
fn unknown(name: &str) -> String {
    if name.is_empty() { "an empty name is not a method".to_owned() } else { format!("unknown method `{name}`") }
}

fn names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

impl Method {
    /// The default tolerance of the [adaptive](MethodKind::is_adaptive) methods, relative and absolute: an error of `1e-12 (1 + |y|)` in
    /// every step of a component `y`.
    pub const TOLERANCE: f64 = 1e-12;

    /// The method `name`; `alpha` is the weight of `dla-alpha`, `1/2` by default.
    ///
    /// # Errors
    /// [`MethodError`] if the name is unknown, or the weight not between 0 and 1.
    pub fn named(name: &str, alpha: Option<f64>) -> Result<Self, MethodError> {
        let found = METHODS.iter().find(|info| info.name == name);
        let mut info = *found.ok_or_else(|| MethodError::Unknown { name: name.to_owned() })?;
        let alpha = Alpha::new(alpha.unwrap_or(0.5))?;
        if info.kind == MethodKind::DlaAlpha && alpha.is_symmetric() {
            // The one weight that makes the rule symmetric.
            info.order = 2;
        }
        Ok(Self { info, alpha, tolerance: Self::TOLERANCE, substeps: None })
    }

    /// The method `name` with the settings of a run: `alpha` as in [`named`](Self::named), and the tolerance of an adaptive method, by
    /// default [`TOLERANCE`](Self::TOLERANCE).
    ///
    /// # Errors
    /// [`MethodError`].
    pub fn of(name: &str, alpha: Option<f64>, tolerance: Option<f64>) -> Result<Self, MethodError> {
        Self::named(name, alpha)?.with_tolerance(tolerance.unwrap_or(Self::TOLERANCE))
    }

    /// `dla`, the first row of the table, with the same settings.
    pub(crate) fn as_dla(&self) -> Self {
        Self { info: METHODS[0], ..*self }
    }

    /// The same method without division of its steps.
    #[must_use]
    pub fn undivided(self) -> Self {
        Self { substeps: None, ..self }
    }

    /// The same method with another tolerance, which only [adaptive](MethodKind::is_adaptive) methods read.
    ///
    /// # Errors
    /// [`MethodError::Tolerance`] unless it is positive and finite.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self, MethodError> {
        if tolerance > 0.0 && tolerance.is_finite() {
            Ok(Self { tolerance, ..self })
        } else {
            Err(MethodError::Tolerance { tolerance })
        }
    }

    /// The same method for the tolerance of a run, if there is one. An adaptive method aims for it in each of its steps. Any other method
    /// is unchanged; `harness::Run::recommended` finds its step.
    ///
    /// # Errors
    /// As [`with_tolerance`](Self::with_tolerance).
    pub fn aiming_for(self, tolerance: Option<f64>) -> Result<Self, MethodError> {
        tolerance.filter(|_| self.is_adaptive()).map_or(Ok(self), |tolerance| self.with_tolerance(tolerance))
    }

    /// The same method with division of its steps: a step is made in parts if it fails as a whole, or if the whole step does not resolve
    /// the motion ([`Halved`](crate::Halved)). All runs that are integrated piece by piece or measured do this; each step then takes the
    /// time of three.
    #[must_use]
    pub fn with_substeps(self, substeps: Substeps) -> Self {
        Self { substeps: Some(substeps), ..self }
    }

    /// How far its steps may be divided; `None` if they may not be.
    #[must_use]
    pub fn substeps(&self) -> Option<Substeps> {
        self.substeps
    }

    /// Name, order and source.
    #[must_use]
    pub fn info(&self) -> MethodInfo {
        self.info
    }

    /// The tolerance of an adaptive method.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Whether the method chooses steps of its own.
    #[must_use]
    pub fn is_adaptive(&self) -> bool {
        self.info.kind.is_adaptive()
    }

    /// The rule of the discrete constraint: the midpoint rule, except for `dla-trapezoid` and `dla-alpha`.
    #[must_use]
    pub fn rule(&self) -> Rule {
        match self.info.kind {
            MethodKind::DlaTrapezoid => Trapezoid.into(),
            MethodKind::DlaAlpha => self.alpha.into(),
            _ => Midpoint.into(),
        }
    }

    /// The rule of `dla-alpha`.
    #[must_use]
    pub fn alpha(&self) -> Alpha {
        self.alpha
    }
}
