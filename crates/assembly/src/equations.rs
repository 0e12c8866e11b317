use crate::contributions::Contributions;
use crate::linear::Linear;
use crate::pattern::Pattern;
use crate::settling::Settling;
use crate::{Assembly, AssemblyError, Solver};
use dla::Stage;

/// The linear equations of an assembly, and Newton's method on them.
pub(crate) struct Equations {
    pub(crate) linear: Linear,
    pub(crate) contributions: Contributions,
    pub(crate) settling: Settling,
}

/// Where a correction is no more than this part of the one before, the matrix of that is good enough for the next.
const CHORD: f64 = 1e-3;

impl Equations {
    pub(crate) fn of(assembly: &Assembly, solver: Solver, parallel: usize) -> Result<Self, AssemblyError> {
        Ok(Self {
            linear: Linear::new(Pattern::of(assembly), solver)?,
            contributions: Contributions::of(assembly, parallel),
            settling: Settling::new(assembly.coordinates()),
        })
    }

    /// Solves for the unknowns `x`: `evaluate` writes the right side at `x`, and the matrix where it is told so, which it is not
    /// while the factors of the last one still serve.
    pub(crate) fn newton(
        &mut self,
        assembly: &Assembly,
        stage: Stage,
        x: &mut [f64],
        mut evaluate: impl FnMut(&mut Self, &[f64], bool),
    ) -> Result<u32, AssemblyError> {
        self.settling.begin(x);
        let mut before = f64::INFINITY;
        let mut fresh = true;
        loop {
            evaluate(self, x, fresh);
            if fresh {
                self.linear.factorise(stage, Some(assembly))?;
            }
            // One refinement, where the matrix is that of the factors.
            self.linear.solve(u32::from(fresh));
            let correction = &self.linear.solution[..x.len()];
            let step = lagrangian::linear::largest(correction);
            let done = self.settling.correct(x, correction);
            if done.map_err(|source| AssemblyError::Newton { stage, source })? {
                return Ok(self.settling.made);
            }
            fresh = step > CHORD * before;
            before = step;
        }
    }
}
