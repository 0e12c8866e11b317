use crate::error::SceneError;
use crate::fault::Fault;

/// A number of a scene: its key, its unit and the values it may have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quantity {
    pub(crate) key: &'static str,
    pub(crate) unit: &'static str,
    range: Range,
}

#[derive(Debug, Clone, Copy)]
enum Range {
    Finite,
    Positive,
    NotNegative,
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

    /// A finite number, 0 or greater.
    pub(crate) const fn not_negative(key: &'static str, unit: &'static str) -> Self {
        Self { key, unit, range: Range::NotNegative }
    }

    /// A number from 0 to 1, without a unit.
    pub(crate) const fn fraction(key: &'static str) -> Self {
        Self { key, unit: "", range: Range::Fraction }
    }

    /// The same kind of number under another key.
    pub(crate) const fn named(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// The values it may have, as messages say it.
    pub(crate) fn accepted(&self) -> String {
        match self.range {
            Range::Finite => format!("a finite number, in {}", self.unit),
            Range::Positive if self.unit.is_empty() => "a finite number greater than 0".to_owned(),
            Range::Positive => format!("a finite number greater than 0, in {}", self.unit),
            Range::NotNegative => format!("a finite number, 0 or greater, in {}", self.unit),
            Range::Fraction => "a number from 0 to 1".to_owned(),
        }
    }

    /// Whether the quantity may have this value.
    pub(crate) fn check(&self, value: f64) -> Result<(), Fault> {
        let problem = match self.range {
            _ if !value.is_finite() => "must be finite",
            Range::Positive if value <= 0.0 => "must be positive",
            Range::NotNegative if value < 0.0 => "must not be negative",
            Range::Fraction if !(0.0..=1.0).contains(&value) => "must be between 0 and 1",
            Range::Finite | Range::Positive | Range::NotNegative | Range::Fraction => return Ok(()),
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
