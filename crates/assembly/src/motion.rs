use crate::contributions::{Contributions, MatrixPart, at};
use crate::linear::Linear;
use crate::pattern::Pattern;
use crate::{Assembly, Solver};
use dla::{Stage, StepError};

/// The continuous equations of motion of an assembly, `M v' = F + .. + A' lambda` and `d/dt (A v + b) = 0`, summed over its elements
/// as the discrete ones are: see [`lagrangian::ElementMotion`].
pub(crate) struct ElementMotion {
    linear: Linear,
    contributions: Contributions,
    coordinates: usize,
}

impl ElementMotion {
    pub(crate) fn of(assembly: &Assembly) -> Result<Self, StepError> {
        Ok(Self {
            linear: Linear::new(Pattern::of(assembly), Solver::Best)?,
            contributions: Contributions::of(assembly, usize::MAX),
            coordinates: assembly.coordinates(),
        })
    }

    /// Accelerations, and multipliers with their signs turned.
    pub(crate) fn solved(
        &mut self,
        assembly: &Assembly,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<(&[f64], &[f64]), StepError> {
        let Self { linear, contributions, coordinates } = self;
        contributions.ask(assembly, true, &|placed, out| at(placed, q, v, |q, v| placed.element.motion(t, q, v, out)));
        let (forces, levels) = linear.right.split_at_mut(*coordinates);
        forces.fill(0.0);
        contributions.add_momenta(assembly, 1.0, forces);
        contributions.write_levels(assembly, levels);
        contributions.write_matrix(assembly, &linear.pattern, MatrixPart::All, &mut linear.values);
        linear.factorise(Stage::Projection, None)?;
        linear.solve(1);
        Ok(linear.solution.split_at(*coordinates))
    }
}
