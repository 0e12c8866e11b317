//! What the texts of a system mean: coordinates, a Lagrangian, constraints and forces, written as formulas, checked and derived.
//!
//! 1. [`Words`] are the texts of a system, as a file or a program has them.
//! 2. [`Formulas`] are what they mean. A [`TextError`] says which text is wrong, in which column, and which names the text may use.
//! 3. [`ReducedFormulas`] are the equations of motion in a basis of the admissible velocities, derived of these.
//!
//! No number is computed here: that is for tapes (the crate `text`), or for a compiler (the crate `macros`).

mod basis;
mod build;
mod error;
mod period;
mod reduced;
mod tables;

pub use basis::RowElimination;
pub use error::{Entry, Problem, TextError};
pub use reduced::ReducedFormulas;

use crate::{Corners, Error, Expression, Graph};

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
/// In a text `t` is time (s), `x'` or `x_dot` the rate of the coordinate `x`. Formulas may use parameters and earlier abbreviations, and the
/// rates along the motion of those abbreviations that contain no rates; see [the crate](crate) for the rest of the syntax.
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
    /// Constraints on velocities, affine in the rates: equations, or formulas that vanish.
    pub constraints: Vec<String>,
    /// Constraints on positions, without rates: equations, or formulas that vanish.
    pub positions: Vec<String>,
    /// The names of the constraints, those on velocities first; empty for a constraint without a name. May be shorter than the constraints.
    pub rows: Vec<String>,
    /// Generalised forces, by the name of the coordinate on which they act.
    pub forces: Vec<(String, String)>,
    /// A basis of the admissible velocities: for each vector a formula for each coordinate. If empty, a basis is derived.
    pub basis: Vec<Vec<String>>,
    /// Further quantities to output: names with their formulas, which may contain the multipliers `lambda1`, `lambda2`, .. of the constraints,
    /// in place of the number the name of a constraint that has one, as `lambda_wheel`.
    pub outputs: Vec<(String, String)>,
    /// The units of the outputs; empty for an output without a unit. May be shorter than the outputs.
    pub output_units: Vec<String>,
}

impl Words {
    /// The name of the multiplier of a constraint, those on velocities first: `lambda1`, .., or `lambda_NAME` of a constraint with a name.
    #[must_use]
    pub fn multiplier(&self, row: usize) -> String {
        match self.rows.get(row).filter(|name| !name.is_empty()) {
            Some(name) => format!("lambda_{name}"),
            None => format!("lambda{}", row + 1),
        }
    }

    /// All texts that are formulas.
    pub(crate) fn formulas(&self) -> impl Iterator<Item = &str> {
        let named = [&self.abbreviations, &self.forces, &self.outputs].into_iter().flatten().map(|(_, text)| text);
        let lists = [&self.constraints, &self.positions].into_iter().chain(&self.basis).flatten();
        named.chain(lists).chain([&self.lagrangian]).map(String::as_str)
    }
}

/// The form of a system's parameters in its formulas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameters {
    /// Their values.
    Numbers,
    /// Variables, numbered after time, coordinates and rates.
    Variables,
}

/// The meaning of a system's texts, as expressions of one graph.
///
/// With `n` coordinates, variable 0 is time, `1 + i` coordinate `i`, `1 + n + i` its rate, and `1 + 2 n + k` parameter `k`.
#[derive(Debug, Clone)]
pub struct Formulas {
    /// The number of coordinates.
    pub n: usize,
    /// The number of constraints. The last ones are the rates of constraints on positions.
    pub m: usize,
    /// All expressions.
    pub graph: Graph,
    /// The Lagrangian.
    pub lagrangian: Expression,
    /// The matrix `A` of the constraints, `m` rows of `n` entries.
    pub rows: Vec<Expression>,
    /// `b` of the constraints `A v + b = 0`.
    pub level: Vec<Expression>,
    /// The functions of the constraints on positions.
    pub positions: Vec<Expression>,
    /// A generalised force for each coordinate; `None` if no text gives a force.
    pub force: Option<Vec<Expression>>,
    /// The basis of the admissible velocities, `n - m` vectors of `n` components; `None` if no text gives a basis.
    pub basis: Option<Vec<Expression>>,
    /// The further outputs.
    pub outputs: Vec<Expression>,
    /// The variable of the first multiplier, if outputs contain multipliers; the multipliers of the other rows follow.
    pub multipliers: Option<u32>,
}

impl Formulas {
    /// The variable of a coordinate.
    #[must_use]
    pub fn coordinate(&self, i: usize) -> u32 {
        (1 + i) as u32
    }

    /// The variable of the rate of a coordinate.
    #[must_use]
    pub fn rate(&self, i: usize) -> u32 {
        (1 + self.n + i) as u32
    }

    /// The variable of a parameter.
    #[must_use]
    pub fn parameter(&self, k: usize) -> u32 {
        (1 + 2 * self.n + k) as u32
    }

    /// The variables of all rates.
    #[must_use]
    pub fn rates(&self) -> Vec<u32> {
        (0..self.n).map(|i| self.rate(i)).collect()
    }

    /// The corners in time, and the formulas with variables for their sides, numbered after all other variables; `None` if there are no
    /// such corners. The outputs stay as they are.
    ///
    /// # Errors
    /// [`Error::GraphFull`].
    pub fn pieces(&self) -> Result<Option<(Corners, Self)>, Error> {
        let mut pieces = self.clone();
        let lists = [&self.rows[..], &self.level, &self.positions, self.force.as_deref().unwrap_or_default()];
        let all = [&[self.lagrangian][..], &lists.concat(), self.basis.as_deref().unwrap_or_default()].concat();
        let Some((corners, smooth)) = Corners::of(&mut pieces.graph, &all, 0, self.parameter(0))? else {
            return Ok(None);
        };
        let mut smooth = smooth.into_iter();
        pieces.lagrangian = smooth.next().unwrap_or(self.lagrangian);
        let lists = [Some(&mut pieces.rows), Some(&mut pieces.level), Some(&mut pieces.positions)];
        for list in lists.into_iter().chain([pieces.force.as_mut(), pieces.basis.as_mut()]).flatten() {
            list.iter_mut().zip(&mut smooth).for_each(|(formula, piece)| *formula = piece);
        }
        Ok(Some((corners, pieces)))
    }
}
