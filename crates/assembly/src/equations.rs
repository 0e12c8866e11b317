use crate::contributions::Contributions;
use crate::factor::Factor;
use crate::pattern::Pattern;
use crate::settling::Settling;
use crate::singular::dependent;
use crate::{Assembly, AssemblyError, Solver};
use dla::Stage;

/// The linear equations of an assembly, and Newton's method on them.
pub(crate) struct Equations {
    pub(crate) pattern: Pattern,
    factor: Factor,
    pub(crate) values: Vec<f64>,
    pub(crate) contributions: Contributions,
    /// Right side, momenta before constraints.
    pub(crate) right: Vec<f64>,
    rest: Vec<f64>,
    /// The last solution: correction, then multipliers.
    pub(crate) solution: Vec<f64>,
    pub(crate) settling: Settling,
}

/// A pivot below it, relative to its column, is rounding.
const SINGULAR: f64 = 1e-13;

/// Where a correction is no more than this part of the one before, the matrix of that is good enough for the next.
const CHORD: f64 = 1e-3;

impl Equations {
    pub(crate) fn of(assembly: &Assembly, solver: Solver, parallel: usize) -> Result<Self, AssemblyError> {
        let pattern = Pattern::of(assembly);
        let (factor, unknowns) = (Factor::of(&pattern, solver)?, pattern.unknowns());
        Ok(Self {
            factor,
            values: vec![0.0; pattern.entries()],
            contributions: Contributions::of(assembly, parallel),
            right: vec![0.0; unknowns],
            rest: vec![0.0; unknowns],
            solution: vec![0.0; unknowns],
            settling: Settling::new(assembly.coordinates()),
            pattern,
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
                let pivot = self.factor.factorise(&self.pattern, &self.values)?;
                if pivot < SINGULAR {
                    return Err(self.singular(assembly, stage, pivot));
                }
            }
            self.solve(fresh);
            let step = lagrangian::linear::largest(&self.solution[..x.len()]);
            let done = self.settling.correct(x, &self.solution[..x.len()]);
            if done.map_err(|source| AssemblyError::Newton { stage, source })? {
                return Ok(self.settling.made);
            }
            fresh = step > CHORD * before;
            before = step;
        }
    }

    /// Solves with the factors there are; with one iterative refinement where the matrix is theirs.
    fn solve(&mut self, refine: bool) {
        self.solution.copy_from_slice(&self.right);
        self.factor.solve(&mut self.solution);
        if refine {
            self.rest.copy_from_slice(&self.right);
            self.pattern.subtract_product(&self.values, &self.solution, &mut self.rest);
            self.factor.solve(&mut self.rest);
            for (x, d) in self.solution.iter_mut().zip(&self.rest) {
                *x += d;
            }
        }
    }

    #[cold]
    fn singular(&mut self, assembly: &Assembly, stage: Stage, pivot: f64) -> AssemblyError {
        let constraints = dependent(assembly, &self.pattern, &mut self.values, &mut self.factor);
        AssemblyError::Singular { stage, pivot, constraints }
    }
}
