use super::flow::{Block, slope};
use dla::convergence::tolerances::{BLIND, ROUNDINGS, SETTLED, STALL_OF_FIXED_POINT};
use dla::{History, Mechanism, NewtonError, SensitivityError};
use lagrangian::quadrature::{gauss_collocation, gauss_legendre};
use lagrangian::{Scalar, Seeded};

const MAX_SWEEPS: u32 = 100;

/// Gauss collocation on the reduced equations.
///
/// Its stages are iterated on dual numbers, value and derivatives together, until both change by round-off only:
/// the end then has the exact derivative of the discrete map in its start.
#[derive(Debug, Clone)]
pub(super) struct Stages {
    nodes: Vec<f64>,
    weights: Vec<f64>,
    coefficients: Vec<Vec<f64>>,
}

/// The changes of values, or of derivatives, in an iteration, their sizes, and the effect of the round-off of the start on them.
#[derive(Debug, Clone, Copy, Default)]
struct Change {
    moved: f64,
    size: f64,
    noise: f64,
}

impl Change {
    /// Takes into account that each number of the start is rounded once: the slope has derivatives in all of them.
    fn rounded(&mut self, slope: &Seeded, start: &[f64]) {
        let sum: f64 = slope.eps.iter().zip(start).map(|(eps, x)| (eps * x).abs()).sum();
        self.noise = self.noise.max(0.5 * f64::EPSILON * sum);
    }

    fn add(&mut self, before: f64, after: f64) {
        // NaN stays.
        let (moved, size) = ((after - before).abs(), after.abs());
        self.moved = if moved <= self.moved { self.moved } else { moved };
        self.size = if size <= self.size { self.size } else { size };
    }

    /// Whether the change is round-off: by its size, or because it is small and stalls.
    ///
    /// Far from the origin the places in a wave are rounded to more than the slopes are, and if forces cancel, the slopes are smaller than
    /// their terms.
    fn settled(self, before: Self) -> bool {
        let rounding = (ROUNDINGS * self.noise).max(BLIND * self.size);
        self.moved <= SETTLED * self.size
            || (self.moved <= rounding && self.moved >= STALL_OF_FIXED_POINT * before.moved)
    }
}

impl Stages {
    /// Gauss collocation with a number of stages in the table of methods (Hairer, Lubich and Wanner 2006, section II.1.3).
    pub(super) fn gauss(stages: usize) -> Self {
        match stages {
            2 => Self::collocation::<2>(),
            3 => Self::collocation::<3>(),
            4 => Self::collocation::<4>(),
            5 => Self::collocation::<5>(),
            6 => Self::collocation::<6>(),
            7 => Self::collocation::<7>(),
            _ => Self::collocation::<8>(),
        }
    }

    fn collocation<const S: usize>() -> Self {
        let (nodes, weights) = gauss_legendre::<S>();
        let coefficients = gauss_collocation(&nodes, &weights);
        Self {
            nodes: nodes.to_vec(),
            weights: weights.to_vec(),
            coefficients: coefficients.iter().map(|row| row.to_vec()).collect(),
        }
    }

    /// The increments of `q` and `xi` over a step from `t` to `t + h`, in one list, with their derivatives in some variables of the start `z`,
    /// which is `q` and `xi`.
    pub(super) fn increments(
        &self,
        system: &dyn Mechanism,
        (t, h): (f64, f64),
        z: &[f64],
        block: Block<'_>,
    ) -> Result<Vec<Seeded>, SensitivityError> {
        let start: Vec<f64> = block.all().map(|(_, variable)| z[variable]).collect();
        let z = block.seeded(z);
        let first = slope(system, t, &z).ok_or(NO_EQUATIONS)?;
        let mut slopes = vec![first; self.nodes.len()];
        let [mut values, mut derivatives] = [Change { moved: f64::INFINITY, ..Change::default() }; 2];
        let (mut settled, mut history) = ([false; 2], History::new());
        for iteration in 1..=MAX_SWEEPS {
            let before = (values, derivatives);
            (values, derivatives) = (Change::default(), Change::default());
            for (i, (node, coefficients)) in self.nodes.iter().zip(&self.coefficients).enumerate() {
                let mut there = sum(h, coefficients, &slopes);
                there.iter_mut().zip(&z).for_each(|(there, z)| *there = *z + *there);
                let slope = slope(system, t + node * h, &there).ok_or(NO_EQUATIONS)?;
                for (new, old) in slope.iter().zip(&slopes[i]) {
                    values.add(old.re, new.re);
                    values.rounded(new, &start);
                    new.eps.iter().zip(&old.eps).for_each(|(new, old)| derivatives.add(*old, *new));
                }
                slopes[i] = slope;
            }
            if !(values.size + derivatives.size).is_finite() {
                return Err(SensitivityError::Equations(NewtonError::NotFinite { iteration, history }));
            }
            history.push(derivatives.moved / derivatives.size);
            // Rounding goes round in cycles, and the two need not agree when each is small.
            settled = [settled[0] || values.settled(before.0), settled[1] || derivatives.settled(before.1)];
            if settled == [true; 2] {
                return Ok(sum(h, &self.weights, &slopes));
            }
        }
        let correction = derivatives.moved / derivatives.size;
        Err(SensitivityError::Equations(NewtonError::IterationLimit { iterations: MAX_SWEEPS, correction, history }))
    }
}

const NO_EQUATIONS: SensitivityError =
    SensitivityError::Unsupported { reason: "the system has no reduced equations, or they are degenerate" };

/// `h sum_j factors[j] slopes[j]`.
fn sum(h: f64, factors: &[f64], slopes: &[Vec<Seeded>]) -> Vec<Seeded> {
    let mut total = vec![Seeded::zero(); slopes.first().map_or(0, Vec::len)];
    for (factor, slope) in factors.iter().zip(slopes) {
        if *factor != 0.0 {
            total.iter_mut().zip(slope).for_each(|(total, slope)| *total += *slope * (h * factor));
        }
    }
    total
}
