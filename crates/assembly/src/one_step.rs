use crate::{Assembly, AssemblyError, State};

/// A one-step map on the constraint distribution of an assembly.
pub trait OneStep {
    /// Moves `state` from time `t` to `t + h` (s).
    ///
    /// # Errors
    /// [`AssemblyError`] where the step has no solution that the method accepts; `state` is then unchanged.
    fn step(&mut self, assembly: &Assembly, t: f64, h: f64, state: &mut State) -> Result<StepReport, AssemblyError>;
}

/// What a step did besides moving the state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepReport {
    /// Newton iterations of its equations.
    pub iterations: u32,
}
