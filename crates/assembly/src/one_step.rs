use crate::{Assembly, AssemblyError, AssemblyState};

/// A one-step map on the constraint distribution of an assembly.
pub trait AssemblyMethod {
    /// Moves `state` from time `t` to `t + h` (s); returns the number of Newton iterations.
    ///
    /// # Errors
    /// [`AssemblyError`] where the step has no solution that the method accepts; `state` is then unchanged.
    fn step(&mut self, assembly: &Assembly, t: f64, h: f64, state: &mut AssemblyState) -> Result<u32, AssemblyError>;
}
