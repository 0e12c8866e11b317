use crate::linear::Linear;
use crate::pattern::{Pattern, PatternPart};
use crate::settling::{AssemblySettling, REFINEMENTS};
use crate::{AssemblyError, Solver};
use dla::Stage;
use dla::convergence::{Convergence, CorrectionKind, Demand};
use lagrangian::linear::largest;

/// Linear equations of parts that share unknowns,
///
/// ```text
/// K x + G' lambda = r,      C x = c,
/// ```
///
/// and Newton's method on them. Multipliers are corrected as the unknowns are, so that neither `K` nor `G` need be exact: that
/// the right side vanishes is all that a solution is.
pub(crate) struct Sparse {
    parts: Vec<PatternPart>,
    pub(crate) linear: Linear,
    unknowns: usize,
    /// Whether the next iteration may use the factors of the last one: a frozen Jacobian.
    pub(crate) factors_serve: bool,
    /// Whether one more correction is made after convergence: the error that linear convergence with a frozen Jacobian leaves has the
    /// same sign in every step, and adds up.
    pub(crate) polishes: bool,
}

/// Where a correction is no more than this part of the one before, its matrix is good enough for the next.
const KEPT: f64 = 0.05;

impl Sparse {
    /// Equations for `n` unknowns and `m` constraints.
    pub(crate) fn new(n: usize, m: usize, parts: Vec<PatternPart>, solver: Solver) -> Result<Self, AssemblyError> {
        Ok(Self {
            linear: Linear::new(Pattern::of_parts((n, m), &parts), solver)?,
            unknowns: n,
            factors_serve: false,
            polishes: false,
            parts,
        })
    }

    /// Whether there are constraints.
    pub(crate) fn has_rows(&self) -> bool {
        self.unknowns < self.linear.right.len()
    }

    /// Forgets the matrix and the right side.
    pub(crate) fn clear(&mut self) {
        self.linear.values.fill(0.0);
        self.linear.right.fill(0.0);
    }

    /// Adds to the right side of the unknowns of a part.
    pub(crate) fn add_right(&mut self, k: usize, residual: &[f64]) {
        for (at, x) in self.parts[k].at.iter().zip(residual) {
            self.linear.right[*at] += x;
        }
    }

    /// Writes the right side of the constraints of a part.
    pub(crate) fn write_levels(&mut self, k: usize, levels: &[f64]) {
        let first = self.unknowns + self.parts[k].row;
        self.linear.right[first..first + levels.len()].copy_from_slice(levels);
    }

    /// Adds to the block of a part, by rows.
    pub(crate) fn add_block(&mut self, k: usize, block: &[f64]) {
        let PatternPart { at, rows, acts, .. } = &self.parts[k];
        let places = self.linear.pattern.places(k, (at.len(), *rows), *acts);
        for (place, x) in places.block.iter().zip(block) {
            self.linear.values[*place as usize] += x;
        }
    }

    /// Writes the rows `G` and `C` of the constraints of a part.
    pub(crate) fn write_rows(&mut self, k: usize, acting: &[f64], rows: &[f64]) {
        let PatternPart { at, rows: count, acts, .. } = &self.parts[k];
        let places = self.linear.pattern.places(k, (at.len(), *count), *acts);
        for (place, x) in places.transposed.iter().zip(acting) {
            self.linear.values[*place as usize] = *x;
        }
        for (place, x) in places.rows.iter().zip(rows) {
            self.linear.values[*place as usize] = *x;
        }
    }

    /// Solves for the unknowns `x` and the multipliers: `evaluate` writes the right side at these, and the matrix where it is
    /// told so, which it is not while the factors of the last one are good enough; `terms` adds the sums of the sizes of the terms of
    /// the equations, those of the unknowns and then those of the constraints.
    pub(crate) fn newton(
        &mut self,
        (settling, stage): (&mut AssemblySettling, Stage),
        x: &mut [f64],
        multipliers: &mut [f64],
        mut terms: impl FnMut(&mut [f64]),
        mut evaluate: impl FnMut(&mut Self, &[f64], &[f64], bool) -> Result<(), AssemblyError>,
    ) -> Result<u32, AssemblyError> {
        let AssemblySettling { newton, last, rounding, start, sizes, changes, certain, near, .. } = settling;
        start.copy_from_slice(x);
        let mut convergence = Convergence::new(last, rounding, start);
        let mut refinements = 0;
        let (mut before, mut fresh) = (f64::INFINITY, !self.factors_serve);
        let mut polished = !self.polishes;
        loop {
            self.linear.right.fill(0.0);
            if fresh {
                self.linear.values.fill(0.0);
            }
            evaluate(self, x, multipliers, fresh)?;
            if fresh {
                self.linear.factorise(stage, None)?;
            }
            self.linear.solve(refinements.max(u32::from(fresh)));
            let (correction, corrections) = self.linear.solution.split_at(x.len());
            for (multiplier, d) in multipliers.iter_mut().zip(corrections) {
                *multiplier += d;
            }
            let step = largest(correction);
            x.iter_mut().zip(correction).for_each(|(x, d)| *x += d);
            let demand = Demand {
                kind: CorrectionKind::Chord,
                tolerance: newton.tolerance,
                limit: newton.max_iterations,
                refinable: refinements == 0,
                near: *near,
            };
            let linear = &self.linear;
            let done = convergence.check(demand, x, correction, || {
                sizes.fill(0.0);
                terms(sizes);
                Some(linear.most_roundings((x, multipliers, corrections), sizes, changes))
            });
            *certain = convergence.is_certain();
            if done.map_err(|source| AssemblyError::Newton { stage, source })? {
                if polished {
                    return Ok(convergence.made());
                }
                polished = true;
            }
            if convergence.is_unmet() {
                refinements = REFINEMENTS;
            }
            fresh = step > KEPT * before;
            before = step;
        }
    }
}
