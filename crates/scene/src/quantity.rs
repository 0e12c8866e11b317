use crate::error::SceneError;
use crate::fault::Fault;

/// A number of a scene: its key, its unit and the values it may have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KeyQuantity {
    pub(crate) key: &'static str,
    pub(crate) unit: &'static str,
    range: AcceptedRange,
}

#[derive(Debug, Clone, Copy)]
enum AcceptedRange {
    Finite,
    Positive,
    NotNegative,
    Fraction,
}

impl KeyQuantity {
    /// Any finite number.
    pub(crate) const fn finite(key: &'static str, unit: &'static str) -> Self {
        Self { key, unit, range: AcceptedRange::Finite }
    }

    /// A finite number greater than 0.
    pub(crate) const fn positive(key: &'static str, unit: &'static str) -> Self {
        Self { key, unit, range: AcceptedRange::Positive }
    }

    /// A finite number, 0 or greater.
    pub(crate) const fn not_negative(key: &'static str, unit: &'static str) -> Self {
        Self { key, unit, range: AcceptedRange::NotNegative }
    }

    /// A number from 0 to 1, without a unit.
    pub(crate) const fn fraction(key: &'static str) -> Self {
        Self { key, unit: "", range: AcceptedRange::Fraction }
    }

    /// The quantity under another key.
    pub(crate) const fn named(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// The values it may have, as messages say it.
    pub(crate) fn accepted(&self) -> String {
        match self.range {
            AcceptedRange::Finite => format!("a finite number, in {}", self.unit),
            AcceptedRange::Positive if self.unit.is_empty() => "a finite number greater than 0".to_owned(),
            AcceptedRange::Positive => format!("a finite number greater than 0, in {}", self.unit),
            AcceptedRange::NotNegative => format!("a finite number, 0 or greater, in {}", self.unit),
            AcceptedRange::Fraction => "a number from 0 to 1".to_owned(),
        }
    }

    /// Whether the quantity may have this value.
    pub(crate) fn check(&self, value: f64) -> Result<(), Fault> {
        let problem = match self.range {
            _ if !value.is_finite() => "must be finite",
            AcceptedRange::Positive if value <= 0.0 => "must be positive",
            AcceptedRange::NotNegative if value < 0.0 => "must not be negative",
            AcceptedRange::Fraction if !(0.0..=1.0).contains(&value) => "must be between 0 and 1",
            AcceptedRange::Finite | AcceptedRange::Positive | AcceptedRange::NotNegative | AcceptedRange::Fraction => {
                return Ok(());
            }
        };
        Err(Fault::new(SceneError::OutOfRange, self.key, problem, self.accepted()).found(format!("{value:?}")))
    }
}
