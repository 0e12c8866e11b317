/// The unit of a coordinate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unit {
    /// An angle (rad), in which the system has the period `2 pi`.
    Angle,
    /// Any other, by its name.
    Other(String),
}

impl Unit {
    /// The unit of that name, not an angle with a period.
    #[must_use]
    pub fn other(name: &str) -> Self {
        Self::Other(name.to_owned())
    }

    /// Its name: that of an angle is `rad`.
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
/// In a text `t` is time (s), `x'` or `x_dot` the rate of the coordinate `x`. Formulas may use parameters, and abbreviations that stand
/// before them; see [`expression`] for what else.
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
    /// A basis of the velocities that the constraints admit: for each of its vectors a formula for each coordinate. Derived where it is
    /// empty.
    pub basis: Vec<Vec<String>>,
    /// What is to be told besides coordinates and rates: names with their formulas.
    pub outputs: Vec<(String, String)>,
}
