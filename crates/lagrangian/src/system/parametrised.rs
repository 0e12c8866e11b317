use crate::{AdmissibleBasis, Constraint, Scalar, System, mapped};

/// A family of mechanical systems with `N` coordinates, `M` velocity constraints and `P` parameters.
///
/// The functions are the functions of [`System`] with the parameters `p` as numbers of the same scalar. Quantities derived from them
/// therefore have exact derivatives in the parameters too: masses, offsets, stiffnesses, and controls that are constant over a step.
/// [`Member`] is the system at given parameters.
///
/// ```
/// use lagrangian::{Constraint, Member, Parametrised, Scalar};
///
/// /// A point in space with `z' = y x'`: its mass (kg), and a force along x (N).
/// struct Particle;
/// impl Parametrised<3, 1, 2> for Particle {
///     fn lagrangian<S: Scalar>(&self, &[mass, _]: &[S; 2], _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
///         mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
///     }
///     fn constraint<S: Scalar>(&self, _p: &[S; 2], _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
///         ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
///     }
///     fn force<S: Scalar>(&self, &[_, force]: &[S; 2], _t: S, _q: &[S; 3], _v: &[S; 3]) -> Option<[S; 3]> {
///         Some([force, S::zero(), S::zero()])
///     }
/// }
/// let system = Member { family: Particle, parameters: [2.0, 0.5] };
/// # assert_eq!(lagrangian::energy(&system, 0.0, &[0.0; 3], &[1.0, 2.0, 0.0]), 5.0);
/// ```
pub trait Parametrised<const N: usize, const M: usize, const P: usize> {
    /// The Lagrangian `L(p; t, q, v)` (J).
    fn lagrangian<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N], v: &[S; N]) -> S;

    /// `A(p; q, t)` and `b(p; q, t)` of the constraint `A v + b = 0`.
    fn constraint<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N]) -> Constraint<S, N, M>;

    /// Generalised forces that no Lagrangian gives; none by default.
    #[inline(always)]
    fn force<S: Scalar>(&self, _p: &[S; P], _t: S, _q: &[S; N], _v: &[S; N]) -> Option<[S; N]> {
        None
    }

    /// A basis of the admissible velocities, if one is known in closed form.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _p: &[S; P], _t: S, _q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        None
    }

    /// The functions of constraints on positions, as [`System::holonomic`]; none by default.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _p: &[S; P], _t: S, _q: &[S; N]) -> Option<[Option<S>; M]> {
        None
    }

    /// The functions of constraints that are not affine in the velocities, as [`System::nonlinear`]; none by default.
    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, _p: &[S; P], _t: S, _q: &[S; N], _v: &[S; N]) -> Option<[Option<S>; M]> {
        None
    }

    /// Which coordinates are angles, as [`System::angles`].
    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        [false; N]
    }
}

/// One system of a family, at given parameters: what a method runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Member<F, const P: usize> {
    /// The family.
    pub family: F,
    /// The parameters.
    pub parameters: [f64; P],
}

impl<F: Parametrised<N, M, P>, const N: usize, const M: usize, const P: usize> System<N, M> for Member<F, P> {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        self.family.lagrangian(&mapped(&self.parameters, S::constant), t, q, v)
    }
    #[inline(always)]
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.family.constraint(&mapped(&self.parameters, S::constant), t, q)
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.family.force(&mapped(&self.parameters, S::constant), t, q, v)
    }
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        self.family.admissible_basis(&mapped(&self.parameters, S::constant), t, q)
    }
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.family.holonomic(&mapped(&self.parameters, S::constant), t, q)
    }
    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; M]> {
        self.family.nonlinear(&mapped(&self.parameters, S::constant), t, q, v)
    }
    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        self.family.angles()
    }
}

/// A system as the family without parameters that it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unparametrised<'a, Sys>(pub &'a Sys);

impl<Sys: System<N, M>, const N: usize, const M: usize> Parametrised<N, M, 0> for Unparametrised<'_, Sys> {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _p: &[S; 0], t: S, q: &[S; N], v: &[S; N]) -> S {
        self.0.lagrangian(t, q, v)
    }
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _p: &[S; 0], t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.0.constraint(t, q)
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, _p: &[S; 0], t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.0.force(t, q, v)
    }
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _p: &[S; 0], t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        self.0.admissible_basis(t, q)
    }
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _p: &[S; 0], t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        self.0.holonomic(t, q)
    }
    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, _p: &[S; 0], t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; M]> {
        self.0.nonlinear(t, q, v)
    }
    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        self.0.angles()
    }
}

impl<F: Parametrised<N, M, P>, const N: usize, const M: usize, const P: usize> Parametrised<N, M, P> for &F {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N], v: &[S; N]) -> S {
        F::lagrangian(self, p, t, q, v)
    }
    #[inline(always)]
    fn constraint<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N]) -> Constraint<S, N, M> {
        F::constraint(self, p, t, q)
    }
    #[inline(always)]
    fn force<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        F::force(self, p, t, q, v)
    }
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        F::admissible_basis(self, p, t, q)
    }
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        F::holonomic(self, p, t, q)
    }
    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, p: &[S; P], t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; M]> {
        F::nonlinear(self, p, t, q, v)
    }
    #[inline(always)]
    fn angles(&self) -> [bool; N] {
        F::angles(self)
    }
}
