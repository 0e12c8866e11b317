use crate::{Motion, ReducedError, Scalar};

/// How formulas of several stages are evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StageEvaluation {
    /// All stages in vector registers ([`Wide`](crate::simd::Wide)): a term that is zero by the model takes no instruction.
    InRegisters,
    /// All stages in vector registers without a search for zeros ([`Pack`](crate::simd::Pack)), for simplified formulas: they compile in a
    /// fraction of the time.
    Simplified,
    /// All stages as arrays of numbers ([`Lanes`](crate::Lanes)), for formulas that are interpreted, operation by operation: vector
    /// registers would be stored and loaded around each operation.
    InArrays,
}

/// The equations of motion of a system as they are known by hand, or by computer algebra.
///
/// Every method works without them, on derivatives of the Lagrangian; with them it is quicker. A system that has some implements this
/// trait and says so, `fn reduced(&self) -> impl Reduced<N, M> { self }` in its [`System`](crate::System).
pub trait Reduced<const N: usize, const M: usize> {
    /// Whether anything may be known: not of `()`, nor of a body whose constraints leave nothing known.
    const ANY: bool = true;

    /// How a method evaluates the formulas of stages that it solves for at once.
    const STAGES: StageEvaluation = StageEvaluation::InRegisters;

    /// Accelerations and multipliers, for any velocity, admissible or not.
    #[inline(always)]
    fn motion(&self, _t: f64, _q: &[f64; N], _v: &[f64; N]) -> Option<Motion<N, M>> {
        None
    }

    /// The accelerations `xi'` of the quasi-velocities in [`System::admissible_basis`](crate::System::admissible_basis).
    ///
    /// Only the first `N - M` places of `xi` and of the result count.
    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, _t: S, _q: &[S; N], _xi: &[S; N]) -> Option<[S; N]> {
        None
    }

    /// The admissible velocity `W xi + v_b` of quasi-velocities; by default as `derived` gives it, from the basis and a linear system for
    /// `v_b`. What is known by hand leaves `derived` alone, which is then not compiled.
    ///
    /// # Errors
    /// [`ReducedError`] where there is none.
    #[inline(always)]
    fn velocity<S: Scalar>(
        &self,
        _t: S,
        _q: &[S; N],
        _xi: &[S; N],
        derived: impl FnOnce() -> Result<[S; N], ReducedError>,
    ) -> Result<[S; N], ReducedError> {
        derived()
    }

    /// Number of quadratures that give the configuration from the quasi-velocities over time, if the reconstruction is a cascade. Zero
    /// means that the basis is constant; one, that it depends only on coordinates whose rates are combinations of `xi` with constant
    /// coefficients. (The reconstruction equation; Bloch 2015, section 5.7.)
    ///
    /// A collocation then iterates on the quasi-velocities alone, and each iteration is a whole cascade.
    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        None
    }

    /// Whether the equations of the quasi-velocities contain neither time nor configuration, `xi' = f(xi)`, as for a free body
    /// (Euler-Poincare-Suslov equations; Bloch 2015, section 5.7). The configuration is then computed after they are solved.
    #[inline(always)]
    fn stands_alone(&self) -> bool {
        false
    }

    /// What one more generalised force would add to [`motion`](Self::motion).
    #[inline(always)]
    fn response(&self, _t: f64, _q: &[f64; N], _force: &[f64; N]) -> Option<Motion<N, M>> {
        None
    }

    /// As [`reduced_motion`](Self::reduced_motion), under one more generalised force.
    #[inline(always)]
    fn pushed_motion<S: Scalar>(&self, _t: S, _q: &[S; N], _xi: &[S; N], _force: &[S; N]) -> Option<[S; N]> {
        None
    }
}

/// Nothing is known by hand.
impl<const N: usize, const M: usize> Reduced<N, M> for () {
    const ANY: bool = false;
}

impl<R: Reduced<N, M>, const N: usize, const M: usize> Reduced<N, M> for &R {
    const ANY: bool = R::ANY;
    const STAGES: StageEvaluation = R::STAGES;

    #[inline(always)]
    fn motion(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<Motion<N, M>> {
        R::motion(self, t, q, v)
    }

    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N]) -> Option<[S; N]> {
        R::reduced_motion(self, t, q, xi)
    }

    #[inline(always)]
    fn velocity<S: Scalar>(
        &self,
        t: S,
        q: &[S; N],
        xi: &[S; N],
        derived: impl FnOnce() -> Result<[S; N], ReducedError>,
    ) -> Result<[S; N], ReducedError> {
        R::velocity(self, t, q, xi, derived)
    }

    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        R::reconstruction(self)
    }

    #[inline(always)]
    fn stands_alone(&self) -> bool {
        R::stands_alone(self)
    }

    #[inline(always)]
    fn response(&self, t: f64, q: &[f64; N], force: &[f64; N]) -> Option<Motion<N, M>> {
        R::response(self, t, q, force)
    }

    #[inline(always)]
    fn pushed_motion<S: Scalar>(&self, t: S, q: &[S; N], xi: &[S; N], force: &[S; N]) -> Option<[S; N]> {
        R::pushed_motion(self, t, q, xi, force)
    }
}
