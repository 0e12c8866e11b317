use super::ReducedDerivative;
use crate::StepReport;
use lagrangian::from_fn;

/// A variation of a state, or the derivative of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variation<const N: usize> {
    /// The variation of the configuration.
    pub q: [f64; N],
    /// The variation of the velocity.
    pub v: [f64; N],
}

/// A variation of a state and of the parameters of its system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangent<const N: usize, const P: usize> {
    /// The variation of the state.
    pub state: Variation<N>,
    /// The variation of the parameters; it is the same along a run.
    pub parameters: [f64; P],
}

/// The derivative of one step `(q0, v0) -> (q1, v1)` in its start, in the parameters of the system, and in the time.
///
/// The step is a map on the distribution, `A(q0) v0 + b = 0`. *Admissible* variations stay on it to first order:
/// `A dv + d(A v + b)/dq dq + d(A v + b)/dp dp + .. = 0`. Along them this is the derivative of the map, and the result
/// is admissible at the end. A single column need not be admissible. Off the distribution it is the derivative of the map's extension by
/// the equations in their general form: `v0` acts through its momentum tested against the admissible velocities ([`Dla`](crate::Dla)),
/// or by its part along the basis ([`Gauss`](crate::Gauss)). [`StepDerivative::reduced`] has no such columns.
#[derive(Debug, Clone, PartialEq)]
pub struct StepDerivative<const N: usize, const M: usize, const P: usize> {
    /// In every component of `q0`.
    pub from_q: [Variation<N>; N],
    /// In every component of `v0`.
    pub from_v: [Variation<N>; N],
    /// In every parameter, the start being fixed.
    pub from_parameters: [Variation<N>; P],
    /// In the time of the start, the step being fixed (per s).
    pub from_time: Variation<N>,
    /// In the length of the step (per s).
    pub from_step: Variation<N>,
    /// The derivative in quasi-velocities, if the system has a basis of admissible velocities.
    pub reduced: Option<ReducedDerivative<N, P>>,
    /// Relative distance of the end of the step from the solution of the equations that were differentiated: rounding.
    pub defect: f64,
    /// The report of the step.
    pub report: StepReport<M>,
}

impl<const N: usize> Variation<N> {
    /// No variation.
    pub const ZERO: Self = Self { q: [0.0; N], v: [0.0; N] };

    /// `self + factor other`.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        Self { q: from_fn(|i| self.q[i] + factor * other.q[i]), v: from_fn(|i| self.v[i] + factor * other.v[i]) }
    }
}

impl<const N: usize, const M: usize, const P: usize> StepDerivative<N, M, P> {
    /// The variation of the end of the step that belongs to one of its start and of the parameters.
    #[must_use]
    pub fn apply(&self, tangent: &Tangent<N, P>) -> Tangent<N, P> {
        let Tangent { state: start, parameters } = tangent;
        let columns = self.from_q.iter().chain(&self.from_v).chain(&self.from_parameters);
        let factors = start.q.iter().chain(&start.v).chain(parameters);
        let state = columns.zip(factors).fold(Variation::ZERO, |sum, (column, factor)| sum.plus(*factor, column));
        Tangent { state, parameters: *parameters }
    }
}
