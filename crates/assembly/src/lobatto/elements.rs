//! What systems and joints add to the equations of the stages.

use super::element::{StageElement, StageTerms};
use crate::joint::{Joint, JointElement};
use crate::local::local;
use crate::system_element::SystemElement;
use dla::{Mechanics, StagePoint};
use lagrangian::{Constraint, Scalar, System, position_rows};

/// The terms of a system at one stage.
fn stage<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t, h): (f64, f64),
    [q, v, impulses]: [&[f64]; 3],
    out: &mut StageTerms,
) {
    let point = StagePoint::<N, M> { t, q: local(q), v: local(v), impulse: local(impulses) };
    out.write(&point.linearised(system, h), system.position_misses(t, &point.q));
}

impl<const N: usize, const M: usize> StageElement for SystemElement<N, M> {
    fn stage(&self, time: (f64, f64), q: &[f64], v: &[f64], impulses: &[f64], out: &mut StageTerms) {
        stage::<N, M>(&*self.system, time, [q, v, impulses], out);
    }

    fn is_affine(&self, t: f64, q: &[f64], v: &[f64]) -> bool {
        !self.system.is_nonlinear(t, &local(q), &local(v))
    }
}

/// A joint as a system without inertia.
struct Joined<'a, J>(&'a J);

impl<J: Joint<N, M>, const N: usize, const M: usize> System<N, M> for Joined<'_, J> {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; N], _v: &[S; N]) -> S {
        S::zero()
    }

    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, M> {
        position_rows(self, t, q)
    }

    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; M]> {
        Some(self.0.position(t, q).map(Some))
    }
}

impl<J: Joint<N, M>, const N: usize, const M: usize> StageElement for JointElement<J, N, M> {
    fn stage(&self, time: (f64, f64), q: &[f64], v: &[f64], impulses: &[f64], out: &mut StageTerms) {
        stage::<N, M>(&Joined(&self.joint), time, [q, v, impulses], out);
    }

    fn is_affine(&self, _t: f64, _q: &[f64], _v: &[f64]) -> bool {
        true
    }
}
