use crate::error::SceneError;
use crate::fault::Fault;

/// A number of a scene: its key, its unit and the values it may have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quantity {
    pub(crate) key: &'static str,
    unit: &'static str,
    range: Range,
}

#[derive(Debug, Clone, Copy)]
enum Range {
    Finite,
    Positive,
    Fraction,
}

impl Quantity {
    /// Any finite number.
    pub(crate) const fn finite(key: &'static str, unit: &'static str) -> Self {
        Self { key, unit, range: Range::Finite }
    }

    /// A finite number greater than 0.
    pub(crate) const fn positive(key: &'static str, unit: &'static str) -> Self {
        Self { key, unit, range: Range::Positive }
    }

    /// A number from 0 to 1, without a unit.
    pub(crate) const fn fraction(key: &'static str) -> Self {
        Self { key, unit: "", range: Range::Fraction }
    }

    /// The values it may have, as messages say it.
    pub(crate) fn accepted(&self) -> String {
        match self.range {
            Range::Finite => format!("a finite number, in {}", self.unit),
            Range::Positive => format!("a finite number greater than 0, in {}", self.unit),
            Range::Fraction => "a number from 0 to 1".to_owned(),
        }
    }

    /// Whether the quantity may have this value.
    pub(crate) fn check(&self, value: f64) -> Result<(), Fault> {
        let problem = match self.range {
            _ if !value.is_finite() => "must be finite",
            Range::Positive if value <= 0.0 => "must be positive",
            Range::Fraction if !(0.0..=1.0).contains(&value) => "must be between 0 and 1",
            Range::Finite | Range::Positive | Range::Fraction => return Ok(()),
        };
        Err(Fault {
            variant: SceneError::OutOfRange,
            key: self.key,
            problem: problem.to_owned(),
            found: Some(format!("{value:?}")),
            accepted: self.accepted(),
            help: None,
        })
    }
}
