use super::linear::Scaled;
use super::{Differentiable, SensitivityError, StepEquations, StepStart};
use crate::convergence::tolerances::{ROUNDINGS, STALL};
use crate::{History, NewtonError};
use lagrangian::linear::Singular;
use lagrangian::{Gradients, Rounded, Scalar, Seeded, from_fn, mapped};
use nalgebra::DMatrix;

/// The system at parameters that may carry derivatives.
pub(super) type Seeder<'a, const N: usize, const M: usize> = dyn Fn(&[Seeded]) -> Box<dyn Gradients<N, M> + 'a> + 'a;

/// How many directions a [`Seeded`] number carries.
const SEEDS: usize = 8;

/// `x`, the variable number `index`: seeded if the index is among the directions of the block.
pub(super) fn seeded(x: f64, index: usize, block: usize) -> Seeded {
    let mut number = Seeded::constant(x);
    if let Some(eps) = index.checked_sub(block * SEEDS).and_then(|k| number.eps.get_mut(k)) {
        *eps = 1.0;
    }
    number
}

/// How many blocks of directions `count` variables need.
pub(super) const fn blocks(count: usize) -> usize {
    count.div_ceil(SEEDS)
}

/// The variable number in which direction `k` of a block is.
pub(super) const fn variable(block: usize, k: usize) -> usize {
    block * SEEDS + k
}

/// An elementary step: one, or a sub-step of a composition.
pub(super) struct Elementary<'a, 's, const N: usize, const M: usize> {
    pub(super) method: &'a dyn Differentiable<N, M>,
    pub(super) seeder: &'a Seeder<'s, N, M>,
    pub(super) parameters: &'a [f64],
    pub(super) t: f64,
    pub(super) h: f64,
    pub(super) q: [f64; N],
    pub(super) v: [f64; N],
}

/// The end of an elementary step, with its derivatives in `(q0, v0, t, h, p)`.
pub(super) struct LinearisedStep<const N: usize> {
    pub(super) increment: [f64; N],
    pub(super) velocity: [f64; N],
    /// `d(q1, v1)`, the rows of `q1` first.
    pub(super) derivative: DMatrix<f64>,
}

impl<const N: usize, const M: usize> Elementary<'_, '_, N, M> {
    /// Newton's method is quadratic: of a correction as small as the first of these the next leaves rounding, and one as
    /// small as the second has left it itself.
    const NEARLY: [f64; 2] = [1e-7, 1e-11];
    const MAX_ITERATIONS: u32 = 50;

    /// How many inputs a step has: `(q0, v0, t, h, p)`.
    pub(super) fn inputs(&self) -> usize {
        2 * N + 2 + self.parameters.len()
    }

    /// The equations at the unknowns `z`, with the derivatives of a block of the variables `(z, q0, v0, t, h, p)`.
    fn evaluate(&self, z: &[f64], block: usize) -> Result<StepEquations<N>, SensitivityError> {
        let unknowns: Vec<Seeded> = z.iter().enumerate().map(|(i, z)| seeded(*z, i, block)).collect();
        let input = |x: f64, i: usize| seeded(x, z.len() + i, block);
        let start = StepStart {
            q: from_fn(|i| input(self.q[i], i)),
            v: from_fn(|i| input(self.v[i], N + i)),
            t: input(self.t, 2 * N),
            h: input(self.h, 2 * N + 1),
        };
        let parameters: Vec<Seeded> =
            self.parameters.iter().enumerate().map(|(i, p)| input(*p, 2 * N + 2 + i)).collect();
        let at = self.method.equations(&*(self.seeder)(&parameters), &start, &unknowns)?;
        if at.residual.len() != z.len() || z.is_empty() {
            return Err(SensitivityError::Unsupported { reason: "the numbers of equations and of unknowns differ" });
        }
        Ok(at)
    }

    /// The solution of the equations, and then by the implicit function theorem `dz = -(R_z)^-1 R_x dx` the derivative of
    /// the end that it gives.
    pub(super) fn linearised(&self) -> Result<LinearisedStep<N>, SensitivityError> {
        let z = self.solution()?;
        let (unknowns, inputs) = (z.len(), self.inputs());
        let mut r = DMatrix::zeros(unknowns, unknowns + inputs);
        let mut end = DMatrix::zeros(2 * N, unknowns + inputs);
        let (mut increment, mut velocity) = ([0.0; N], [0.0; N]);
        for block in 0..blocks(unknowns + inputs) {
            let at = self.evaluate(&z, block)?;
            for k in 0..SEEDS {
                let column = variable(block, k);
                if column >= unknowns + inputs {
                    break;
                }
                for (i, residual) in at.residual.iter().enumerate() {
                    r[(i, column)] = residual.eps[k];
                }
                for i in 0..N {
                    end[(i, column)] = at.increment[i].eps[k];
                    end[(N + i, column)] = at.velocity[i].eps[k];
                }
            }
            (increment, velocity) = (mapped(&at.increment, |x| x.re), mapped(&at.velocity, |x| x.re));
        }
        for i in 0..N {
            end[(i, unknowns + i)] += 1.0;
        }
        let (r_z, r_x) = (r.columns(0, unknowns).into_owned(), r.columns(unknowns, inputs).into_owned());
        let z_x = Scaled::new(r_z).map_err(|source| singular(0, source, History::new()))?.solve(-r_x);
        let derivative = end.columns(unknowns, inputs) + end.columns(0, unknowns) * z_x;
        if derivative.iter().all(|x| x.is_finite()) {
            Ok(LinearisedStep { increment, velocity, derivative })
        } else {
            Err(SensitivityError::Equations(NewtonError::NotFinite { iteration: 0, history: History::new() }))
        }
    }

    /// Whether the residuals at `z` are a few roundings of what they are made of: to first order, of all variables times the
    /// derivatives in them.
    #[cold]
    fn is_met(&self, z: &[f64]) -> Result<bool, SensitivityError> {
        let inputs = self.q.iter().chain(&self.v).chain([&self.t, &self.h]).chain(self.parameters);
        let variables: Vec<f64> = z.iter().chain(inputs).copied().collect();
        let (mut residuals, mut sizes) = (vec![0.0; z.len()], vec![0.0; z.len()]);
        for block in 0..blocks(variables.len()) {
            for (i, residual) in self.evaluate(z, block)?.residual.iter().enumerate() {
                residuals[i] = residual.re;
                for (eps, x) in residual.eps.iter().zip(&variables[variable(block, 0)..]) {
                    sizes[i] += (eps * x).abs();
                }
            }
        }
        let met = |(r, size): (&f64, &f64)| Rounded { value: *r, size: *size }.roundings() <= ROUNDINGS;
        Ok(residuals.iter().zip(&sizes).all(met))
    }

    /// The unknowns that solve the equations, to rounding.
    fn solution(&self) -> Result<Vec<f64>, SensitivityError> {
        let mut z = self.method.guess(&self.v);
        let mut nearly = false;
        let (mut last, mut history) = (f64::INFINITY, History::new());
        for iteration in 1..=Self::MAX_ITERATIONS {
            let mut r = DMatrix::zeros(z.len(), 1);
            let mut r_z = DMatrix::zeros(z.len(), z.len());
            for block in 0..blocks(z.len()).max(1) {
                let at = self.evaluate(&z, block)?;
                for (i, residual) in at.residual.iter().enumerate() {
                    r[i] = residual.re;
                    for k in 0..SEEDS.min(z.len() - variable(block, 0)) {
                        r_z[(i, variable(block, k))] = residual.eps[k];
                    }
                }
            }
            if r.iter().chain(&r_z).any(|x| !x.is_finite()) {
                return Err(SensitivityError::Equations(NewtonError::NotFinite { iteration, history }));
            }
            let jacobian = Scaled::new(r_z).map_err(|source| singular(iteration, source, history))?;
            let correction = jacobian.solve(-r);
            for (z, d) in z.iter_mut().zip(&correction) {
                *z += d;
            }
            let size = jacobian.size(z.iter().copied());
            let change = jacobian.size(correction.iter().copied());
            let stalls = iteration > 1 && change >= STALL * last * size;
            if nearly || change <= Self::NEARLY[1] * size || (stalls && self.is_met(&z)?) {
                return Ok(z);
            }
            nearly = change <= Self::NEARLY[0] * size;
            last = change / size;
            history.push(last);
        }
        let limit = NewtonError::IterationLimit { iterations: Self::MAX_ITERATIONS, correction: last, history };
        Err(SensitivityError::Equations(limit))
    }
}

fn singular(iteration: u32, source: Singular, history: History) -> SensitivityError {
    SensitivityError::Equations(NewtonError::Singular { iteration, source, history })
}
