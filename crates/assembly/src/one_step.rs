use crate::{Assembly, AssemblyError, AssemblyState};

/// A one-step map on the constraint distribution of an assembly.
pub trait AssemblyMethod {
    /// Moves `state` from time `t` to `t + h` (s).
    ///
    /// # Errors
    /// [`AssemblyError`] where the step has no solution that the method accepts; `state` is then unchanged.
    fn step(
        &mut self,
        assembly: &Assembly,
        t: f64,
        h: f64,
        state: &mut AssemblyState,
    ) -> Result<AssemblyReport, AssemblyError>;
}

/// What a step did besides moving the state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AssemblyReport {
    /// Newton iterations of its equations.
    pub iterations: u32,
    /// The work that the forces did over the step (J), for a method whose energy balance knows it.
    pub work: Option<f64>,
}

impl AssemblyReport {
    /// The report of a step of which nothing but the iterations is known.
    #[must_use]
    pub fn of(iterations: u32) -> Self {
        Self { iterations, work: None }
    }
}
