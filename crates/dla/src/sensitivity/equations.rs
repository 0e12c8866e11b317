use super::SensitivityError;
use lagrangian::{AdmissibleBasis, Gradients, Scalar, Seeded, from_fn};

/// Where a step begins, and how long it is; every number may carry derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepStart<const N: usize> {
    /// Time (s).
    pub t: Seeded,
    /// Length of the step (s).
    pub h: Seeded,
    /// Configuration.
    pub q: [Seeded; N],
    /// Velocity.
    pub v: [Seeded; N],
}

/// The equations `R(z; q0, v0, t, h, p) = 0` of a step at some value of their unknowns, and the end that these would give.
#[derive(Debug, Clone, PartialEq)]
pub struct StepEquations<const N: usize> {
    /// `R`, as many as unknowns.
    pub residual: Vec<Seeded>,
    /// `q1 - q0`.
    pub increment: [Seeded; N],
    /// `v1`.
    pub velocity: [Seeded; N],
}

/// A method whose step is given by equations that can be differentiated.
///
/// The equations are a second statement of the method, beside its [`OneStep`](crate::OneStep), which solves them in its own
/// way; [`Sensitivity`](crate::Sensitivity) checks that the two agree.
pub trait Differentiable<const N: usize, const M: usize> {
    /// The fractions of the step that its sub-steps take: one, unless the method is a composition.
    fn fractions(&self) -> Vec<f64> {
        vec![1.0]
    }

    /// Whether the equations have constraints on positions, and such as are not affine in the velocities.
    fn carries_every_class(&self) -> bool {
        false
    }

    /// A first guess of the unknowns of a sub-step that begins with the velocity `v`; its length is their number.
    fn guess(&self, v: &[f64; N]) -> Vec<f64>;

    /// The equations of a sub-step at the unknowns `z`.
    ///
    /// # Errors
    /// [`SensitivityError::Unsupported`] for a method or a system whose step has no derivative here, with the reason.
    fn equations(
        &self,
        model: &dyn Gradients<N, M>,
        start: &StepStart<N>,
        z: &[Seeded],
    ) -> Result<StepEquations<N>, SensitivityError>;
}

/// Reads the unknowns of a step one group after the other.
#[derive(Debug, Clone)]
pub struct StepUnknowns<'a>(pub &'a [Seeded]);

impl StepUnknowns<'_> {
    /// The next `K` unknowns.
    pub fn take<const K: usize>(&mut self) -> [Seeded; K] {
        self.take_some(K)
    }

    /// The next `count` unknowns in the first places of an array, zeros after them.
    pub fn take_some<const K: usize>(&mut self, count: usize) -> [Seeded; K] {
        let (head, tail) = self.0.split_at(count.min(self.0.len()));
        self.0 = tail;
        from_fn(|i| head.get(i).copied().unwrap_or(Seeded::zero()))
    }
}

/// `f + A' lambda`.
pub(super) fn constrained<const N: usize, const M: usize>(
    f: &[Seeded; N],
    a: &[[Seeded; N]; M],
    lambda: &[Seeded; M],
) -> [Seeded; N] {
    from_fn(|i| (0..M).fold(f[i], |sum, k| sum + a[k][i] * lambda[k]))
}

/// `x + h sum_j factors[j] slopes[j]`.
pub(super) fn advanced<const N: usize>(
    x: &[Seeded; N],
    h: Seeded,
    factors: &[f64],
    slopes: &[[Seeded; N]],
) -> [Seeded; N] {
    from_fn(|i| {
        let sum = factors.iter().zip(slopes).fold(Seeded::zero(), |sum, (factor, slope)| sum + slope[i] * *factor);
        x[i] + h * sum
    })
}

pub(super) fn difference<const N: usize>(a: &[Seeded; N], b: &[Seeded; N]) -> [Seeded; N] {
    from_fn(|i| a[i] - b[i])
}

/// `w . f`.
pub(super) fn product<const N: usize>(w: &[Seeded; N], f: &[Seeded; N]) -> Seeded {
    (0..N).fold(Seeded::zero(), |sum, i| sum + w[i] * f[i])
}

/// The error of a method in a basis of admissible velocities, on a system without one.
pub(super) const NO_BASIS: SensitivityError = SensitivityError::Unsupported {
    reason: "the method needs a basis of the admissible velocities, and the system has no basis",
};

/// The dimension `N - M` of the distribution.
pub(super) const fn dimension<const N: usize, const M: usize>() -> usize {
    AdmissibleBasis::<Seeded, N, M>::DIMENSION
}
