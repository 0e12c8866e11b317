use noslip::prelude::*;

/// The Lagrangian, the constraint and the force of a system; its basis, if that is asked for, and never its reduced equations.
#[derive(Clone)]
pub(crate) struct Without<Sys, const BASIS: bool>(pub(crate) Sys);

impl<Sys: System<N, M>, const BASIS: bool, const N: usize, const M: usize> System<N, M> for Without<Sys, BASIS> {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        self.0.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        self.0.constraint(t, q)
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.0.force(t, q, v)
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        if BASIS { self.0.admissible_basis(t, q) } else { None }
    }
    fn angles(&self) -> [bool; N] {
        self.0.angles()
    }
}
