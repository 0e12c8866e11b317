use super::Equilibrium;
use super::root::nearest_root;
use super::spectrum::{Spectrum, size, spectrum};
use crate::stepper::composed;
use crate::{Method, MethodKind, Rk4, Rk4Reduced};
use dla::{Differentiable, Dla, SeededMechanics, Sensitivity, State, StepReport};
use lagrangian::from_fn;
use nalgebra::{DMatrix, DVector};

/// A method as an object whose steps can be differentiated; none for the methods that this is not done for.
///
/// The family of `dla`, and `rk4` and `rk4-reduced` beside it: every further one would be compiled for every shape of system.
#[must_use]
#[inline(never)]
pub fn differentiable<const N: usize, const M: usize>(method: &Method) -> Option<Box<dyn Differentiable<N, M>>> {
    Some(match method.info().kind {
        MethodKind::Dla => Box::new(Dla::midpoint()),
        MethodKind::DlaTrapezoid | MethodKind::DlaAlpha => Box::new(Dla::new(method.rule(), method.rule())),
        MethodKind::Composed(order) => Box::new(composed(order, Dla::midpoint())),
        MethodKind::Rk4 => Box::new(Rk4),
        MethodKind::Rk4Reduced => Box::new(Rk4Reduced),
        _ => return None,
    })
}

/// A step of a method on a system: by length and start, the end of it; none where it fails.
pub type Step<'a, const N: usize> = dyn FnMut(f64, &State<N>) -> Option<State<N>> + 'a;

/// The map of one step about an equilibrium of the flow.
pub struct DiscreteMap<'a, const N: usize, const M: usize> {
    system: &'a dyn SeededMechanics<N, M>,
    sensitivity: Sensitivity<'a, N, M, 0>,
    method: &'a dyn Differentiable<N, M>,
    step: &'a mut Step<'a, N>,
}

/// The longest step with which a stable motion stays stable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepLimit {
    /// Longer than this (s): no limit was found.
    Beyond(f64),
    /// An eigenvalue of the map leaves the unit circle (s).
    Unstable(f64),
    /// The step has no solution any more, or none that stays near the motion (s).
    Ends(f64),
}

impl StepLimit {
    /// The limit (s), where there is one.
    #[must_use]
    pub fn step(self) -> Option<f64> {
        match self {
            Self::Beyond(_) => None,
            Self::Unstable(step) | Self::Ends(step) => Some(step),
        }
    }

    /// What ends there.
    #[must_use]
    pub fn reason(self) -> &'static str {
        match self {
            Self::Beyond(_) => "none",
            Self::Unstable(_) => "unstable",
            Self::Ends(_) => "no step",
        }
    }
}

/// A root of the map minus one: what it moves at most, relative to one plus its size.
const ROOT: f64 = 1e-11;
/// How far from the equilibrium of the flow that of the map may lie, relative to the same.
const NEAR: f64 = 0.5;
/// The limit is searched for on steps from a thousandth of the given one to 9500 times that, `1.25^72 = 9.5e6` in all.
const FIRST: f64 = 1e-3;
const FACTOR: f64 = 1.25;
const RUNGS: i32 = 72;
const BISECTIONS: usize = 45;

impl<const N: usize, const M: usize> std::fmt::Debug for DiscreteMap<'_, N, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DiscreteMap").finish_non_exhaustive()
    }
}

impl<'a, const N: usize, const M: usize> DiscreteMap<'a, N, M> {
    /// The map of a method whose steps `step` makes, from time zero.
    pub fn new(
        system: &'a dyn SeededMechanics<N, M>,
        method: &'a dyn Differentiable<N, M>,
        step: &'a mut Step<'a, N>,
    ) -> Self {
        Self { system, sensitivity: Sensitivity::of(system), method, step }
    }

    /// The eigenvalues of the map with the step `h` (s) in shape and quasi-velocities, at its own equilibrium near that of the
    /// flow, the largest first; none where it has none.
    #[inline(never)]
    pub fn spectrum(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> Option<Vec<[f64; 2]>> {
        self.at_rest(h, equilibrium).map(|spectrum| spectrum.values)
    }

    fn at_rest(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> Option<Spectrum> {
        let start = equilibrium.reduced(N - M);
        let scale = 1.0 + start.norm();
        let mut moved = |z: &DVector<f64>| self.moved(h, equilibrium, z);
        let z = nearest_root(&mut moved, start.clone(), ROOT * scale)?;
        if (&z - start).norm() > NEAR * scale {
            return None;
        }
        let (_, slope) = moved(&z)?;
        let identity = DMatrix::identity(slope.nrows(), slope.ncols());
        spectrum(&(slope + identity), size)
    }

    /// The longest step with which a stable equilibrium of the flow is one of the map, looked for about the step `h` (s).
    #[inline(never)]
    pub fn limit(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> StepLimit {
        let mut good = 0.0;
        let mut tried = h * FIRST;
        for _ in 0..RUNGS {
            if !self.is_stable(tried, equilibrium) {
                return self.bisected(good, tried, equilibrium);
            }
            (good, tried) = (tried, tried * FACTOR);
        }
        StepLimit::Beyond(good)
    }

    fn is_stable(&mut self, h: f64, equilibrium: &Equilibrium<N>) -> bool {
        self.at_rest(h, equilibrium).is_some_and(|spectrum| spectrum.is_stable_map())
    }

    fn bisected(&mut self, mut good: f64, mut bad: f64, equilibrium: &Equilibrium<N>) -> StepLimit {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (good + bad);
            if self.is_stable(middle, equilibrium) { good = middle } else { bad = middle }
        }
        // Just beyond the limit: at the limit itself both may hold.
        match self.spectrum(bad * (1.0 + 1e-6), equilibrium) {
            Some(_) => StepLimit::Unstable(good),
            None => StepLimit::Ends(good),
        }
    }

    /// What a step changes in shape and quasi-velocities, with its derivatives.
    fn moved(&mut self, h: f64, near: &Equilibrium<N>, z: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (shape, dimension) = (&near.shape, N - M);
        let mut q = near.q;
        shape.iter().enumerate().for_each(|(k, i)| q[*i] = z[k]);
        let xi: [f64; N] = from_fn(|a| if a < dimension { z[shape.len() + a] } else { 0.0 });
        let v = self.system.velocity_of(0.0, &q, &xi).ok()?;
        let start = State::new(q, v, self.system.angles());
        let end = (self.step)(h, &start)?;
        let derivative = self.sensitivity.between(self.method, (0.0, h), &start, &end, StepReport::of(0)).ok()?;
        let derivative = derivative.reduced?;
        let (moved, after) = (end.moved_since(&start), self.system.quasi_velocities(h, end.q(), end.v()).ok()?);
        let value = |row: usize| if row < N { moved[row] } else { after[row - N] - xi[row - N] };
        let rows: Vec<usize> = shape.iter().copied().chain(N..N + dimension).collect();
        let entry = |row: usize, column: usize| {
            let column = if column < N { &derivative.from_q[column] } else { &derivative.from_xi[column - N] };
            if row < N { column.q[row] } else { column.xi[row - N] }
        };
        let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| value(*row)));
        let slope =
            DMatrix::from_fn(rows.len(), rows.len(), |i, j| entry(rows[i], rows[j]) - f64::from(u8::from(i == j)));
        Some((values, slope))
    }
}
