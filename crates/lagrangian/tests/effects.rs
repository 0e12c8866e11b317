//! Effects compose by types and by lists, and none of them is the bare body.

use crate::common::{Everything, vector};
use lagrangian::{Effect, Scalar, System, With};
use proptest::prelude::*;

/// A spring in the first coordinate.
#[derive(Debug, Clone, Copy)]
struct Spring(f64);
impl<B> Effect<B, 3> for Spring {
    fn lagrangian<S: Scalar>(&self, _body: &B, _t: S, q: &[S; 3], _v: &[S; 3]) -> Option<S> {
        Some(-(q[0] * q[0]) * (0.5 * self.0))
    }
}

/// A damper in the second coordinate.
#[derive(Debug, Clone, Copy)]
struct Damper(f64);
impl<B> Effect<B, 3> for Damper {
    fn force<S: Scalar>(&self, _body: &B, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([S::zero(), -v[1] * self.0, S::zero()])
    }
}

/// What a file's list of effects becomes.
#[derive(Debug, Clone, Copy)]
enum Either {
    Spring(Spring),
    Damper(Damper),
}
impl<B> Effect<B, 3> for Either {
    fn lagrangian<S: Scalar>(&self, body: &B, t: S, q: &[S; 3], v: &[S; 3]) -> Option<S> {
        match self {
            Self::Spring(effect) => effect.lagrangian(body, t, q, v),
            Self::Damper(effect) => effect.lagrangian(body, t, q, v),
        }
    }
    fn force<S: Scalar>(&self, body: &B, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        match self {
            Self::Spring(effect) => effect.force(body, t, q, v),
            Self::Damper(effect) => effect.force(body, t, q, v),
        }
    }
}

proptest! {
    #[test]
    fn tuples_and_lists_agree(c in vector(), t in -1.0..1.0f64, q in vector(), v in vector(), k in 0.0..2.0f64) {
        let body = Everything { c };
        let typed = With { body, effects: (Spring(k), Damper(2.0 * k), Spring(0.5)) };
        let listed = With {
            body,
            effects: vec![Either::Spring(Spring(k)), Either::Damper(Damper(2.0 * k)), Either::Spring(Spring(0.5))],
        };
        prop_assert_eq!(typed.lagrangian(t, &q, &v), listed.lagrangian(t, &q, &v));
        prop_assert_eq!(typed.force(t, &q, &v), listed.force(t, &q, &v));
        let spring = -0.5 * (k + 0.5) * q[0] * q[0];
        approx::assert_relative_eq!(typed.lagrangian(t, &q, &v) - body.lagrangian(t, &q, &v), spring, epsilon = 1e-13);
        let force = typed.force(t, &q, &v).unwrap();
        approx::assert_relative_eq!(force[1], body.force(t, &q, &v).unwrap()[1] - 2.0 * k * v[1], epsilon = 1e-14);
    }

    #[test]
    fn no_effect_is_the_bare_body(c in vector(), t in -1.0..1.0f64, q in vector(), v in vector()) {
        let body = Everything { c };
        let typed = With { body, effects: () };
        let listed: With<_, Vec<Either>> = With { body, effects: vec![] };
        prop_assert_eq!(typed.lagrangian(t, &q, &v), body.lagrangian(t, &q, &v));
        prop_assert_eq!(listed.lagrangian(t, &q, &v), body.lagrangian(t, &q, &v));
        prop_assert_eq!(typed.force(t, &q, &v), body.force(t, &q, &v));
        prop_assert_eq!(typed.constraint(t, &q), body.constraint(t, &q));
    }
}

#[test]
fn absence_is_known() {
    fn is_none<E: Effect<(), 3>>(effect: &E) -> bool {
        effect.is_none()
    }
    assert!(is_none(&()));
    assert!(is_none(&((), ())));
    assert!(is_none(&Vec::<Spring>::new()));
    assert!(!is_none(&((), Spring(0.0))));
    assert!(!is_none(&vec![Spring(0.0)]));
    // A potential adds no force, a force no potential: nothing is computed for the other.
    let (q, v) = ([1.0; 3], [1.0; 3]);
    assert_eq!(Effect::<(), 3>::force(&Spring(1.0), &(), 0.0, &q, &v), None);
    assert_eq!(Effect::<(), 3>::lagrangian(&(Damper(1.0), ()), &(), 0.0, &q, &v), None);
}
