use crate::contributions::Contributions;
use crate::linear::Linear;
use crate::pattern::Pattern;
use crate::settling::{AssemblySettling, REFINEMENTS};
use crate::{Assembly, Solver};
use dla::convergence::{Convergence, CorrectionKind, Demand};
use dla::{Stage, StepError};

/// The linear equations of an assembly, and Newton's method on them.
pub(crate) struct AssemblyEquations {
    pub(crate) linear: Linear,
    pub(crate) contributions: Contributions,
    pub(crate) settling: AssemblySettling,
}

/// If a correction is at most this fraction of the one before, the next iteration keeps the matrix.
const CHORD: f64 = 1e-3;

impl AssemblyEquations {
    pub(crate) fn of(assembly: &Assembly, solver: Solver, parallel: usize) -> Result<Self, StepError> {
        Ok(Self {
            linear: Linear::new(Pattern::of(assembly), solver)?,
            contributions: Contributions::of(assembly, parallel),
            settling: AssemblySettling::new(assembly.coordinates(), assembly.rows()),
        })
    }

    /// Solves for the unknowns `x`. `evaluate` writes the right side at `x`, and the matrix if its flag says so: factors that are still
    /// good enough are kept. `terms` adds the sums of the sizes of the terms of the equations.
    pub(crate) fn newton(
        &mut self,
        of: (&Assembly, Stage),
        x: &mut [f64],
        terms: impl FnMut(&mut [f64]),
        mut evaluate: impl FnMut(&mut Self, &[f64], bool),
    ) -> Result<u32, StepError> {
        let mut settling = std::mem::take(&mut self.settling);
        let made = self.search(&mut settling, of, x, terms, &mut evaluate);
        self.settling = settling;
        made
    }

    fn search(
        &mut self,
        settling: &mut AssemblySettling,
        (assembly, stage): (&Assembly, Stage),
        x: &mut [f64],
        mut terms: impl FnMut(&mut [f64]),
        mut evaluate: impl FnMut(&mut Self, &[f64], bool),
    ) -> Result<u32, StepError> {
        let AssemblySettling { newton, last, rounding, start, sizes, changes, reactions, certain, near } = settling;
        start.copy_from_slice(x);
        let mut convergence = Convergence::new(last, rounding, start);
        let (mut before, mut fresh, mut refinements) = (f64::INFINITY, true, 0);
        loop {
            evaluate(self, x, fresh);
            if fresh {
                self.linear.factorise(stage, Some(assembly))?;
            }
            // One refinement, where the matrix is that of the factors.
            self.linear.solve(refinements.max(u32::from(fresh)));
            let linear = &self.linear;
            let (correction, multipliers) = linear.solution.split_at(x.len());
            let step = lagrangian::linear::largest(correction);
            x.iter_mut().zip(correction).for_each(|(x, d)| *x += d);
            let demand = Demand {
                kind: CorrectionKind::Chord,
                tolerance: newton.tolerance,
                limit: newton.max_iterations,
                refinable: refinements == 0,
                near: *near,
            };
            let done = convergence.check(demand, x, correction, || {
                sizes.fill(0.0);
                terms(sizes);
                // The multipliers are solved for as a whole in every iteration: their correction is the change.
                reactions.iter_mut().zip(multipliers).for_each(|(before, now)| *before = now - *before);
                Some(linear.most_roundings((x, multipliers, reactions), sizes, changes))
            });
            reactions.copy_from_slice(multipliers);
            *certain = convergence.is_certain();
            if done.map_err(|source| StepError::Newton { stage, source })? {
                return Ok(convergence.made());
            }
            if convergence.is_unmet() {
                refinements = REFINEMENTS;
            }
            fresh = step > CHORD * before;
            before = step;
        }
    }
}
