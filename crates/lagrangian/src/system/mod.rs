//! What a system is.

mod basis;
mod by_hand;
mod effect;
mod gradients;
mod parametrised;
mod piecewise;
mod with;
mod with_basis;

pub use basis::AdmissibleBasis;
pub use by_hand::{Reduced, StageEvaluation};
pub use effect::{Effect, EffectSlope};
pub(crate) use effect::{add_all, sum};
pub use gradients::{Along, Gradients, Seeded, SeededMember};
pub use parametrised::{Member, Parametrised, Unparametrised};
pub use piecewise::{Piecewise, whole_steps};
pub use with::With;
pub use with_basis::WithBasis;

use crate::Scalar;

/// The constraint `A(q, t) v + b(q, t) = 0` at one point: the `M` rows of `A`, and `b`.
pub type Constraint<S, const N: usize, const M: usize> = ([[S; N]; M], [S; M]);

/// A mechanical system with `N` coordinates and `M` velocity constraints.
///
/// The first two methods are the system; the rest have defaults. A method is generic in its scalar so that one
/// text serves values, exact derivatives and SIMD lanes. SI units, angles in radians.
///
/// ```
/// use lagrangian::{Constraint, Scalar, System};
///
/// /// A point of unit mass in space with `z' = y x'` (Rosenberg 1977).
/// struct Particle;
/// impl System<3, 1> for Particle {
///     fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
///         (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
///     }
///     fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
///         ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
///     }
/// }
/// # assert_eq!(lagrangian::energy(&Particle, 0.0, &[0.0; 3], &[1.0, 2.0, 0.0]), 2.5);
/// ```
pub trait System<const N: usize, const M: usize> {
    /// The Lagrangian `L(t, q, v)` (J).
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S;

    /// `A(q, t)` and `b(q, t)` of the constraint `A v + b = 0`.
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M>;

    /// Generalised forces that no Lagrangian gives: dissipation, controls. None by default, and then none is computed.
    #[inline(always)]
    fn force<S: Scalar>(&self, _t: S, _q: &[S; N], _v: &[S; N]) -> Option<[S; N]> {
        None
    }

    /// A basis of the admissible velocities `ker A(q, t)`, if one is known in closed form.
    ///
    /// A step then solves in it, and needs no multiplier (the discrete null-space method, Betsch 2005,
    /// Comput. Methods Appl. Mech. Engrg. 194, 5159-5190).
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        None
    }

    /// The system with its basis of admissible velocities for the neighbourhood of a configuration, and the number of this basis, if the
    /// basis does not hold everywhere. The default `None` means that the basis holds wherever the system does.
    ///
    /// `basis` is the number of the basis in use, zero if there is none yet. It stays in use as long as it is well conditioned. The
    /// number of another basis, from one to 2^53, determines it completely.
    fn near(&self, _t: f64, _q: &[f64; N], _basis: u64) -> Option<(Self, u64)>
    where
        Self: Sized,
    {
        None
    }

    /// The functions `g_k(q, t)` of constraints on positions, `g_k = 0`: `Some` for every row `k` that is the rate of one,
    /// `A_k = dg_k/dq` and `b_k = dg_k/dt`. None by default, and then only velocities are constrained.
    ///
    /// A method that carries them keeps `g_k = 0` at its nodes beside the velocities. The rows can be had from the functions
    /// by [`position_rows`](crate::position_rows), and [`classify`](crate::classify) tells where the two differ.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _t: S, _q: &[S; N]) -> Option<[Option<S>; M]> {
        None
    }

    /// The functions `phi_k(t, q, v)` of constraints that are not affine in the velocities, `phi_k = 0`: `Some` for every
    /// such row, whose place in [`System::constraint`] is left zero. None by default.
    ///
    /// The reaction is along `d phi_k / dv`, by Chetaev's rule. (Neimark and Fufaev 1972, Dynamics of Nonholonomic Systems,
    /// section IV.1.) A system with such rows gives no [`System::admissible_basis`].
    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, _t: S, _q: &[S; N], _v: &[S; N]) -> Option<[Option<S>; M]> {
        None
    }

    /// Which coordinates are angles, in which the whole system has the period `2 pi`.
    ///
    /// Integrators keep these within a turn and count the turns apart, so that a long run loses no digits.
    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        [false; N]
    }

    /// The equations of motion that are known by hand: `self` of a system that implements [`Reduced`]. None by default, and then all are
    /// derived from the Lagrangian.
    #[inline(always)]
    fn reduced(&self) -> impl Reduced<N, M> {}
}

/// The residual `A(q, t) v + b(q, t)` of each constraint, or `phi(t, q, v)` of one that is not affine.
#[inline]
pub fn constraint_residual<Sys, S, const N: usize, const M: usize>(system: &Sys, t: S, q: &[S; N], v: &[S; N]) -> [S; M]
where
    Sys: System<N, M>,
    S: Scalar,
{
    let (a, mut residual) = system.constraint(t, q);
    for k in 0..M {
        for i in 0..N {
            residual[k] += a[k][i] * v[i];
        }
    }
    with_nonlinear(system, t, q, v, residual)
}

/// The residuals of all constraints: `phi(t, q, v)` for nonlinear constraints, the given `residual` for affine ones.
#[inline(always)]
pub(crate) fn with_nonlinear<Sys, S, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
    mut residual: [S; M],
) -> [S; M]
where
    Sys: System<N, M>,
    S: Scalar,
{
    if let Some(phi) = system.nonlinear(t, q, v) {
        for k in 0..M {
            residual[k] = phi[k].unwrap_or(residual[k]);
        }
    }
    residual
}
