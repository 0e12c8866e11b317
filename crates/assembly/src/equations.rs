use crate::contributions::{Contributions, MatrixPart, at};
use crate::dla::PARALLEL;
use crate::element::with_room;
use crate::linear::Linear;
use crate::pattern::Pattern;
use crate::{Assembly, AssemblyState, Solver};
use dla::convergence::{Convergence, CorrectionKind, Demand};
use dla::{Newton, Stage, StepError};

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

    /// Writes the right side (minus the momenta and the levels), and a part of the matrix.
    pub(crate) fn write(&mut self, assembly: &Assembly, part: Option<MatrixPart>, p: &[f64]) {
        let Self { contributions, linear: Linear { pattern, values, right, .. }, .. } = self;
        let n = assembly.coordinates();
        let (momenta, levels) = right.split_at_mut(n);
        for (right, p) in momenta.iter_mut().zip(p) {
            *right = -p;
        }
        contributions.add_momenta(assembly, -1.0, momenta);
        contributions.write_levels(assembly, levels);
        if let Some(part) = part {
            contributions.write_matrix(assembly, pattern, part, values);
        }
    }
}

/// The arrays of the convergence test of an assembly's iteration: of [`Convergence`](dla::convergence::Convergence) with as many components
/// as there are unknowns.
#[derive(Debug, Default)]
pub(crate) struct AssemblySettling {
    pub(crate) newton: Newton,
    pub(crate) last: Vec<f64>,
    pub(crate) rounding: Vec<bool>,
    pub(crate) start: Vec<f64>,
    /// The sums of the sizes of the terms of the equations, and by how much a correction changes these.
    pub(crate) sizes: Vec<f64>,
    pub(crate) changes: Vec<f64>,
    /// The multipliers of the correction before.
    pub(crate) reactions: Vec<f64>,
    /// Whether the last iteration contracted from its start, so that its result is the solution near there.
    pub(crate) certain: bool,
    /// A correction below this leads to no other solution: see [`rounding_of_place`](dla::convergence::rounding_of_place).
    pub(crate) near: f64,
}

/// Number of refinements of a linear solution if corrections stall above the round-off of the equations.
const REFINEMENTS: u32 = 2;

impl AssemblySettling {
    /// Arrays for these numbers of unknowns and constraints.
    fn new(unknowns: usize, rows: usize) -> Self {
        Self {
            newton: Newton::default(),
            last: vec![0.0; unknowns],
            rounding: vec![false; unknowns],
            start: vec![0.0; unknowns],
            sizes: vec![0.0; unknowns + rows],
            changes: vec![0.0; unknowns + rows],
            reactions: vec![0.0; rows],
            certain: true,
            near: 0.0,
        }
    }
}

/// Adds the sums of the sizes of the terms of the equations of a step of length `h`, at the configuration and velocity `q` and `v`, one for
/// each coordinate and then one for each constraint: what their rounding is a part of. See
/// [`Convergence`](dla::convergence::Convergence).
pub(crate) fn add_terms(assembly: &Assembly, time: (f64, f64), (q, v): (&[f64], &[f64]), sizes: &mut [f64]) {
    let coordinates = assembly.coordinates();
    for placed in assembly.placed() {
        with_room(placed.at.len(), |momentum| {
            with_room(placed.rows, |level| {
                at(placed, q, v, |q, v| placed.element.sizes(time, q, v, momentum, level));
                for (i, size) in placed.at.iter().zip(momentum) {
                    sizes[*i] += *size;
                }
                for (to, size) in sizes[coordinates + placed.row..].iter_mut().zip(level) {
                    *to += *size;
                }
            });
        });
    }
}

/// The velocity `v1` at the configuration `q1` with the momenta `-p` but for a reaction: `sum_e L_v(q1, v1) = -p + A(q1)' mu`,
/// `A(q1) v1 + b = 0`.
///
/// `v1` is the first guess, and `v` one by whose size rounding is judged.
pub(crate) fn project(
    equations: &mut AssemblyEquations,
    (assembly, t, h): (&Assembly, f64, f64),
    (q1, v): (&[f64], &[f64]),
    p: &[f64],
    v1: &mut [f64],
) -> Result<u32, StepError> {
    let evaluate = |equations: &mut AssemblyEquations, v1: &[f64], derivatives: bool| {
        equations.contributions.ask(assembly, derivatives, &|placed, out| {
            at(placed, q1, v1, |q1, v1| placed.element.velocity(t, q1, v1, out));
        });
        equations.write(assembly, derivatives.then_some(MatrixPart::All), p);
    };
    let terms = |sizes: &mut [f64]| add_terms(assembly, (t, h), (q1, v), sizes);
    equations.newton((assembly, Stage::Projection), v1, terms, evaluate)
}

impl Assembly {
    /// Brings the velocity of a state onto the constraints by an impulse of the constraints, if it misses them by more than rounding, as
    /// after a jump of an imposed velocity: `sum_e L_v(q, v) = p + A' mu`, `A v + b = 0`, as [`dla::onto_constraint`]. Rounding is
    /// judged for a step of length `h` (s).
    ///
    /// # Errors
    /// [`StepError`] if the constraints do not determine the velocity, or if the memory does not suffice.
    pub fn onto_constraint(&self, (t, h): (f64, f64), state: &mut AssemblyState) -> Result<(), StepError> {
        let (q, v) = (state.q().to_vec(), state.v().to_vec());
        let (levels, p) = self.levels(t, &q, &v);
        let mut sizes = vec![0.0; self.coordinates() + self.rows()];
        add_terms(self, (t, h), (&q, &v), &mut sizes);
        let met = |(level, size): (&f64, &f64)| level.abs() <= 8.0 * f64::EPSILON * size;
        if levels.iter().zip(&sizes[self.coordinates()..]).all(met) {
            return Ok(());
        }
        let mut equations = AssemblyEquations::of(self, Solver::Best, PARALLEL)?;
        let mut v1 = v.clone();
        project(&mut equations, (self, t, h), (&q, &v), &p, &mut v1)?;
        for (i, v) in v1.into_iter().enumerate() {
            state.set_velocity(i, v);
        }
        Ok(())
    }

    /// The misses of the constraints, `-(A v + b)`, and the momenta with their signs turned.
    pub(crate) fn levels(&self, t: f64, q: &[f64], v: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut contributions = Contributions::of(self, PARALLEL);
        let mut levels = vec![0.0; self.rows()];
        let mut p = vec![0.0; self.coordinates()];
        contributions.ask(self, false, &|placed, out| at(placed, q, v, |q, v| placed.element.velocity(t, q, v, out)));
        contributions.add_momenta(self, -1.0, &mut p);
        contributions.write_levels(self, &mut levels);
        (levels, p)
    }
}
