use super::Mechanics;
use crate::PiecewiseMechanics;
use lagrangian::{Called, Gradients, Reduced, Seeded, SeededMember, System, Unparametrised, velocity_of};

/// The questions about a system whose motion is differentiated: the same answers with derivatives in eight directions.
///
/// Every [`System`] is one. The trait is apart from [`Mechanics`], so that a system whose motions are not differentiated costs no such
/// code.
pub trait SeededMechanics<const N: usize, const M: usize>: Mechanics<N, M> {
    /// The system on numbers with derivatives.
    fn gradients(&self) -> Box<dyn Gradients<N, M> + '_>;

    /// As [`Mechanics::near`].
    fn near_seeded(
        &self,
        t: f64,
        q: &[f64; N],
        basis: u64,
        then: &mut dyn FnMut(u64, &dyn SeededMechanics<N, M>),
    ) -> bool;

    /// The velocity `W xi + v_b` of quasi-velocities; `None` if there is no basis.
    fn velocity_seeded(&self, t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]>;

    /// The accelerations of the quasi-velocities; `None` if they are not known by hand.
    fn reduced_motion_seeded(&self, t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]>;
}

impl<Sys: System<N, M>, const N: usize, const M: usize> SeededMechanics<N, M> for Sys {
    fn gradients(&self) -> Box<dyn Gradients<N, M> + '_> {
        Box::new(SeededMember { family: Unparametrised(self), parameters: [] })
    }

    fn near_seeded(
        &self,
        t: f64,
        q: &[f64; N],
        basis: u64,
        then: &mut dyn FnMut(u64, &dyn SeededMechanics<N, M>),
    ) -> bool {
        System::near(self, t, q, basis).map(|(near, number)| then(number, &near)).is_some()
    }

    fn velocity_seeded(&self, t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]> {
        velocity_of(self, Called(t), &Called::all(q), &Called::all(xi)).ok().map(|v| Called::plain(&v))
    }

    fn reduced_motion_seeded(&self, t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]> {
        let motion = System::reduced(self).reduced_motion(Called(t), &Called::all(q), &Called::all(xi))?;
        Some(Called::plain(&motion))
    }
}

impl<const N: usize, const M: usize> std::fmt::Debug for dyn SeededMechanics<N, M> + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let system: &dyn Mechanics<N, M> = self;
        system.fmt(f)
    }
}

/// All that is asked of a system: runs across jumps, and the derivatives of motions.
pub trait FullMechanics<const N: usize, const M: usize>: PiecewiseMechanics<N, M> + SeededMechanics<N, M> {}

impl<T: PiecewiseMechanics<N, M> + SeededMechanics<N, M>, const N: usize, const M: usize> FullMechanics<N, M> for T {}
