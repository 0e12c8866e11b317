use crate::assembly::PlacedElement;
use crate::contributions::{MatrixPart, at, gathered};
use crate::element::WIDEST;
use crate::equations::{AssemblyEquations, add_terms, project};
use crate::linear::Linear;
use crate::{Assembly, AssemblyMethod, AssemblyState, Solver};
use dla::convergence::rounding_of_place;
use dla::{AssemblyFault, Stage, StepError};
use lagrangian::linear::{larger, largest};
use std::f64::consts::PI;

/// The discrete Lagrange-d'Alembert map of an assembly, with midpoint rules: order 2, self-adjoint.
///
/// The equations are the equations of the static [`Dla`](dla::Dla), summed over the elements. From `(q0, v0)` they give the mean
/// velocity `v` of the step and the multipliers `lambda`:
///
/// ```text
/// sum_e (L_v(q0, v0) + D1 L_d(q0, q1) + f_d^-) + A(q0)' lambda = 0,      w_d(q0, q1) = 0 or g(q1) = 0,
/// ```
///
/// then the velocity at the end by projection, `sum_e L_v(q1, v1) = sum_e (D2 L_d + f_d^+) + A(q1)' mu`, `A(q1) v1 = 0`. Each
/// Newton iteration is a sparse saddle-point system of `N + M` unknowns; both stages have the same pattern.
///
/// If a step turns a constraint by more than a radian, or its iteration does not contract from its start, the solution is continued from
/// a step of length zero, as by the static method. (The book, (3.1) and (3.2).)
pub struct SparseDla {
    equations: AssemblyEquations,
    q0: Vec<f64>,
    q1: Vec<f64>,
    v0: Vec<f64>,
    v: Vec<f64>,
    v1: Vec<f64>,
    p: Vec<f64>,
}

/// A step that turns no constraint by more than this angle (rad) ends near its start.
const NEAR: f64 = 1.0;

/// Number of elements below which threads cost more than they gain.
pub(crate) const PARALLEL: usize = 2048;

impl std::fmt::Debug for SparseDla {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Dla").field("unknowns", &self.equations.linear.right.len()).finish_non_exhaustive()
    }
}

impl SparseDla {
    /// The method for this assembly. It finds the pattern of the matrix and allocates the memory.
    ///
    /// # Errors
    /// [`AssemblyFault::Factorisation`] if the memory does not suffice.
    pub fn new(assembly: &Assembly, solver: Solver) -> Result<Self, StepError> {
        let zeros = || vec![0.0; assembly.coordinates()];
        Ok(Self {
            equations: AssemblyEquations::of(assembly, solver, PARALLEL)?,
            q0: zeros(),
            q1: zeros(),
            v0: zeros(),
            v: zeros(),
            v1: zeros(),
            p: zeros(),
        })
    }

    /// The method on a single thread, with the same results to the last bit.
    #[must_use]
    pub fn on_one_thread(mut self) -> Self {
        self.equations.contributions.parallel = usize::MAX;
        self
    }

    /// Computes the mean velocity of the step, in `v`: from the predictor, or, if that may lead to another solution, along the branch
    /// that begins with a step of length zero.
    fn increment(&mut self, assembly: &Assembly, (t0, h): (f64, f64), state: &AssemblyState) -> Result<u32, StepError> {
        predict(state, h, &self.v0, &mut self.v);
        let iterations = self.solve(assembly, (t0, h), state)?;
        let turn = self.turn(assembly, (t0, h));
        if turn <= NEAR && self.equations.settling.certain {
            return Ok(iterations);
        }
        self.followed(assembly, (t0, h), state, turn).ok_or(AssemblyFault::Branch { turn }.into())
    }

    #[cold]
    #[inline(never)]
    fn followed(&mut self, assembly: &Assembly, (t0, h): (f64, f64), state: &AssemblyState, turn: f64) -> Option<u32> {
        let (start, mut iterations) = (self.v0.clone(), 0);
        dla::followed(&start, 0.5 * NEAR / turn, |part, v: &mut Vec<f64>| {
            self.v.copy_from_slice(v);
            let within = (t0, part * h);
            iterations += self.solve(assembly, within, state).ok()?;
            v.copy_from_slice(&self.v);
            (self.equations.settling.certain && self.turn(assembly, within) < PI).then_some(())
        })?;
        Some(iterations)
    }

    /// Solves for the mean velocity of the step by Newton's method, starting from `v`, and writes it to `v`.
    fn solve(&mut self, assembly: &Assembly, (t0, h): (f64, f64), state: &AssemblyState) -> Result<u32, StepError> {
        let Self { equations, q0, q1, v, p, .. } = self;
        equations.contributions.ask(assembly, true, &|placed, out| {
            at(placed, state.q(), state.v(), |q, v| placed.element.beginning(t0, q, v, out));
        });
        p.fill(0.0);
        equations.contributions.add_momenta(assembly, 1.0, p);
        let AssemblyEquations { contributions, linear: Linear { pattern, values, .. }, .. } = equations;
        contributions.write_matrix(assembly, pattern, MatrixPart::Transposed, values);

        let evaluate = |equations: &mut AssemblyEquations, v: &[f64], derivatives: bool| {
            for (i, q1) in q1.iter_mut().enumerate() {
                *q1 = state.ahead(i, h * v[i]);
            }
            let (q0, q1) = (&*q0, &*q1);
            equations.contributions.ask(assembly, derivatives, &|placed, out| {
                at(placed, q0, v, |q0, v| {
                    let then = |q1: &[f64]| placed.element.increment((t0, h), [q0, q1], v, out);
                    match &placed.origins {
                        None => gathered(placed, q1, then),
                        Some(origins) => relative(placed, origins, h, state, v, then),
                    }
                });
            });
            equations.write(assembly, derivatives.then_some(MatrixPart::ElementBlocks), p);
        };
        let terms = |sizes: &mut [f64]| add_terms(assembly, (t0, h), (state.q(), state.v()), sizes);
        equations.newton((assembly, Stage::Increment), v, terms, evaluate)
    }

    /// The velocity at the end, in `v1`.
    fn projection(&mut self, assembly: &Assembly, (t0, h): (f64, f64)) -> Result<u32, StepError> {
        let Self { equations, q0, q1, v, v1, p, .. } = self;
        let (q0, q1, v) = (&*q0, &*q1, &*v);
        equations.contributions.ask(assembly, false, &|placed, out| {
            at(placed, q0, v, |q0, v| placed.element.end((t0, h), q0, v, out.momentum));
        });
        p.fill(0.0);
        // The right side of the equations is what the momenta still lack.
        equations.contributions.add_momenta(assembly, -1.0, p);
        v1.copy_from_slice(v);
        project(equations, (assembly, t0 + h, h), (q1, v), p, v1)
    }

    /// The largest turn of a constraint in the step (rad).
    fn turn(&self, assembly: &Assembly, (t0, h): (f64, f64)) -> f64 {
        let far = |(v, angle): (&f64, &bool)| *angle && (h * v).abs() > NEAR;
        if !self.v.iter().zip(assembly.angles()).any(far) {
            return 0.0;
        }
        let turns = assembly
            .placed()
            .iter()
            .map(|placed| at(placed, &self.q0, &self.v, |q0, v| placed.element.turn((t0, h), q0, v)));
        turns.fold(0.0, larger)
    }

    /// The answer of an element to its numbers at the beginning of the step, its mean velocity and its velocity at the end.
    fn of_both<T>(&self, placed: &PlacedElement, ask: impl Fn(&[f64], &[f64], &[f64]) -> T) -> T {
        at(placed, &self.q0, &self.v, |q0, v| gathered(placed, &self.v1, |v1| ask(q0, v, v1)))
    }

    /// Checks that the step is short enough for its damping, which must not reverse a velocity: see [`StepError::Overshoot`].
    fn brakes_only(&self, assembly: &Assembly, step: (f64, f64)) -> Result<(), StepError> {
        let acting = || assembly.placed().iter().filter(|placed| placed.element.acts());
        let damping: f64 =
            acting().map(|placed| self.of_both(placed, |q0, v, v1| placed.element.damping(step, q0, [v, v1]))).sum();
        if damping <= 0.0 {
            return Ok(());
        }
        let inertia = acting()
            .map(|placed| self.of_both(placed, |q0, v, v1| placed.element.inertia(step, q0, [v, v1])))
            .fold([0.0; 2], |[inertia, all], own| [inertia + own[0], all + own[1]]);
        dla::overshoot(damping, inertia)
    }
}

/// The coordinates of a joint at the end of a step with the mean velocity `v`. Coordinates with an origin are measured from it, since the
/// difference keeps digits that the coordinates lose far away.
fn relative(
    placed: &PlacedElement,
    origins: &[Option<usize>],
    h: f64,
    state: &AssemblyState,
    v: &[f64],
    then: impl FnOnce(&[f64]),
) {
    let mut q1 = [0.0; WIDEST];
    for (k, origin) in origins.iter().enumerate() {
        q1[k] = match origin {
            Some(origin) => state.apart(placed.at[k], placed.at[*origin]) + h * (v[k] - v[*origin]),
            None => state.ahead(placed.at[k], h * v[k]),
        };
    }
    then(&q1[..origins.len()]);
}

/// The predictor of the mean velocity: extrapolated from the last steps, or from the acceleration of the last step. It is `v0` if
/// neither is known, or if the prediction differs from `v0` so much that Newton's method might converge to another solution.
fn predict(state: &AssemblyState, h: f64, v0: &[f64], v: &mut [f64]) {
    /// The largest change of the velocity by a predictor, relative to the velocity, as in the static method.
    const MOST: f64 = 0.125;
    let gained = |i: usize| {
        let expected = state.expected(i, h).map(|dq| dq / h - v0[i]);
        expected.or_else(|| state.acceleration(i).map(|a| 0.5 * h * a))
    };
    let mut most = 0.0;
    for (i, v) in v.iter_mut().enumerate() {
        let Some(gained) = gained(i) else {
            most = f64::INFINITY;
            break;
        };
        *v = v0[i] + gained;
        most = larger(most, gained);
    }
    if most > MOST * largest(v0) || most.is_nan() {
        v.copy_from_slice(v0);
    }
}

impl AssemblyMethod for SparseDla {
    fn step(&mut self, assembly: &Assembly, t0: f64, h: f64, state: &mut AssemblyState) -> Result<u32, StepError> {
        if state.len() != self.q0.len() {
            return Err(StepError::OTHER_SHAPE);
        }
        self.q0.copy_from_slice(state.q());
        self.v0.copy_from_slice(state.v());
        self.equations.settling.near = rounding_of_place(&self.q0, h);
        let iterations = self.increment(assembly, (t0, h), state)?;
        for (i, q1) in self.q1.iter_mut().enumerate() {
            *q1 = state.ahead(i, h * self.v[i]);
        }
        self.projection(assembly, (t0, h))?;
        self.brakes_only(assembly, (t0, h))?;
        if !self.q1.iter().chain(&self.v1).all(|x| x.is_finite()) {
            return Err(StepError::NotFinite);
        }
        for i in 0..state.len() {
            let (v, v1) = (self.v[i], self.v1[i]);
            state.advance(h, i, h * v, v1, (v1 - v) / (0.5 * h));
        }
        Ok(iterations)
    }
}
