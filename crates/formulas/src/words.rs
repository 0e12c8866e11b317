/// The unit of a coordinate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unit {
    /// An angle (rad), in which the system has the period `2 pi`.
    Angle,
    /// Any other unit, by its name.
    Other(String),
}

impl Unit {
    /// The unit with this name, which is no angle with a period.
    #[must_use]
    pub fn other(name: &str) -> Self {
        Self::Other(name.to_owned())
    }

    /// The name of the unit; `rad` for an angle.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Angle => "rad",
            Self::Other(name) => name,
        }
    }
}

/// The texts of a system, in the order in which they were written.
///
/// In a text `t` is time (s), `x'` or `x_dot` the rate of the coordinate `x`. Formulas may use parameters and earlier abbreviations; see
/// [`expression`] for the rest of the syntax.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Words {
    /// Coordinates with their units.
    pub coordinates: Vec<(String, Unit)>,
    /// Parameters with their values.
    pub parameters: Vec<(String, f64)>,
    /// Abbreviations: names with their formulas.
    pub abbreviations: Vec<(String, String)>,
    /// The Lagrangian (J).
    pub lagrangian: String,
    /// Constraints on velocities: formulas that vanish, affine in the rates.
    pub constraints: Vec<String>,
    /// Constraints on positions: formulas that vanish, without rates.
    pub positions: Vec<String>,
    /// Generalised forces, by the name of the coordinate on which they act.
    pub forces: Vec<(String, String)>,
    /// A basis of the admissible velocities: for each vector a formula for each coordinate. If empty, a basis is derived.
    pub basis: Vec<Vec<String>>,
    /// Further quantities to output: names with their formulas.
    pub outputs: Vec<(String, String)>,
}
