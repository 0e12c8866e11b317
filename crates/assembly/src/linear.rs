use crate::factor::Factor;
use crate::pattern::Pattern;
use crate::{Assembly, Solver};
use dla::{AssemblyFault, DependentRows, Stage, StepError};
use lagrangian::Rounded;
use lagrangian::linear::largest;

/// Linear equations with a pattern that is found once, and their solution without allocation.
pub(crate) struct Linear {
    pub(crate) pattern: Pattern,
    factor: Factor,
    pub(crate) values: Vec<f64>,
    /// Right side, the equations of the unknowns before the constraints.
    pub(crate) right: Vec<f64>,
    rest: Vec<f64>,
    /// The last solution: correction, then multipliers.
    pub(crate) solution: Vec<f64>,
}

/// A pivot below it, relative to its column, is round-off.
const SINGULAR: f64 = 1e-13;

impl Linear {
    pub(crate) fn new(pattern: Pattern, solver: Solver) -> Result<Self, StepError> {
        let zeros = || vec![0.0; pattern.unknowns()];
        Ok(Self {
            factor: Factor::of(&pattern, solver)?,
            values: vec![0.0; pattern.entries()],
            right: zeros(),
            rest: zeros(),
            solution: zeros(),
            pattern,
        })
    }

    /// Factorises the matrix that was written. Where it is singular the error names the constraints, if it is the matrix of this
    /// assembly.
    pub(crate) fn factorise(&mut self, stage: Stage, of: Option<&Assembly>) -> Result<(), StepError> {
        let pivot = self.factor.factorise(&self.pattern, &self.values)?;
        if pivot < SINGULAR {
            let named = |assembly| dependent(assembly, &self.pattern, &mut self.values, &mut self.factor);
            return Err(AssemblyFault::Singular { stage, pivot, constraints: of.map_or([None; 4], named) }.into());
        }
        Ok(())
    }

    /// Solves with the factors there are; with iterative refinements where the matrix is theirs, or nearly so.
    pub(crate) fn solve(&mut self, refinements: u32) {
        self.solution.copy_from_slice(&self.right);
        self.factor.solve(&mut self.solution);
        for _ in 0..refinements {
            self.rest.copy_from_slice(&self.right);
            self.pattern.subtract_product(&self.values, &self.solution, &mut self.rest);
            self.factor.solve(&mut self.rest);
            for (x, d) in self.solution.iter_mut().zip(&self.rest) {
                *x += d;
            }
        }
    }

    /// The largest change of the equations by the last correction, in units of the round-off of their terms. The changes are `K d + G'
    /// dlambda` and `C d`. The round-off is relative to `sizes`, the sums of the sizes of the terms, to which the terms of the unknowns,
    /// `|K| |x|`, and the reactions `G' lambda` are added here. The round-off of a correction added to the unknowns counts too, as in
    /// the static methods.
    ///
    /// A constraint is met to the rounding of the largest correction, whichever unknowns it has: at rest, where all corrections are the
    /// round-off of large reactions, elimination mixes these.
    ///
    /// The correction `dlambda` of the multipliers must be included: if the round-off of a constraint moves the unknowns, by `g/h` of a
    /// joint in a short step, the reactions balance that motion.
    #[cold]
    pub(crate) fn most_roundings(
        &self,
        (x, multipliers, corrections): (&[f64], &[f64], &[f64]),
        sizes: &mut [f64],
        changes: &mut [f64],
    ) -> f64 {
        changes.fill(0.0);
        let (coordinates, most) = (x.len(), largest(&self.solution[..x.len()]));
        for (j, (d, x)) in self.solution.iter().zip(x).enumerate() {
            for (i, value) in self.pattern.column(&self.values, j) {
                changes[i] += value * d;
                let with = if i < coordinates { d.abs() } else { most };
                sizes[i] += value.abs() * (x.abs() + with);
            }
        }
        for (j, (d, lambda)) in (x.len()..).zip(corrections.iter().zip(multipliers)) {
            for (i, value) in self.pattern.column(&self.values, j) {
                changes[i] += value * d;
                sizes[i] += (value * lambda).abs();
            }
        }
        let pairs = changes.iter().zip(&*sizes);
        pairs.fold(0.0, |most, (change, size)| Rounded { value: *change, size: *size }.roundings().max(most))
    }
}

/// The constraints that depend on one another in a matrix that is singular: those with a part in its null vector.
///
/// The diagonal block of the constraints is made a little less than zero, `-delta` (a regularisation). Inverse iteration then converges to
/// the vector of the smallest eigenvalue: multipliers whose forces cancel.
#[cold]
fn dependent(assembly: &Assembly, pattern: &Pattern, values: &mut [f64], factor: &mut Factor) -> DependentRows {
    const PART: f64 = 1e-3;
    let delta = 1e-9 * largest(values);
    for place in &pattern.regular {
        values[*place as usize] = -delta;
    }
    let factorised = factor.factorise(pattern, values);
    for place in &pattern.regular {
        values[*place as usize] = 0.0;
    }
    let n = assembly.coordinates();
    // No row of a model is orthogonal to these numbers by its symmetry.
    let mut x: Vec<f64> = (0..pattern.unknowns()).map(|i| if i < n { 0.0 } else { 1.0 + (i as f64).sin() }).collect();
    let mut named = [None; 4];
    if factorised.is_err() {
        return named;
    }
    for _ in 0..3 {
        factor.solve(&mut x);
        let size = largest(&x);
        if !size.is_finite() || size == 0.0 {
            return named;
        }
        x.iter_mut().for_each(|x| *x /= size);
        x[..n].fill(0.0);
    }
    let mut heaviest: Vec<usize> = (n..x.len()).filter(|k| x[*k].abs() > PART).collect();
    heaviest.sort_by(|a, b| x[*b].abs().total_cmp(&x[*a].abs()));
    named.iter_mut().zip(heaviest).for_each(|(name, k)| *name = assembly.constraint(k - n));
    named
}
