//! Discrete Lagrangians and their derivatives, for every rule.

use crate::common::{Everything, vector};
use approx::assert_relative_eq;
use lagrangian::{
    Alpha, Constraint, Derivatives, DiscreteConstraint, DiscreteLagrangian, Midpoint, Scalar, Symmetrised, System,
    Trapezoid, constraint_residual,
};
use num_dual::HyperDual64;
use proptest::prelude::*;
use std::array::from_fn;

/// Terms of order `1/h`, some hundred of them.
fn close(a: f64, b: f64, h: f64) {
    assert_relative_eq!(a, b, epsilon = 1e-13 / h.abs(), max_relative = 1e-12);
}

/// A discrete constraint with its derivatives in the mean velocity, by hand for the rules, by dual numbers and by num-dual.
fn linearised<Sys: System<N, M>, C: DiscreteConstraint<Sys, N, M>, const N: usize, const M: usize>(
    rule: &C,
    system: &Sys,
    (t, h): (f64, f64),
    q0: &[f64; N],
    v: &[f64; N],
) {
    struct Residual<'a, C>(&'a C);
    impl<Sys: System<N, M>, C: DiscreteConstraint<Sys, N, M>, const N: usize, const M: usize>
        DiscreteConstraint<Sys, N, M> for Residual<'_, C>
    {
        fn residual<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [S; M] {
            self.0.residual(system, t0, h, q0, v)
        }
    }
    let (by_hand, automatic) = (rule.linearised(system, t, h, q0, v), Residual(rule).linearised(system, t, h, q0, v));
    let value = rule.residual(system, t, h, q0, v);
    for found in [by_hand, automatic] {
        for k in 0..M {
            assert_relative_eq!(found[k].re, value[k], epsilon = 1e-13, max_relative = 1e-13);
        }
        for i in 0..N {
            let v = from_fn(|k| HyperDual64::new(v[k], f64::from(u8::from(i == k)), 0.0, 0.0));
            let q0 = q0.map(HyperDual64::from);
            let w = rule.residual(system, HyperDual64::from(t), HyperDual64::from(h), &q0, &v);
            for k in 0..M {
                assert_relative_eq!(found[k].eps[i], w[k].eps1, epsilon = 1e-12, max_relative = 1e-12);
            }
        }
    }
}

/// Six coordinates: a row that moves, and one that is not affine.
struct Six;

impl System<6, 2> for Six {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 6], v: &[S; 6]) -> S {
        v.iter().fold(S::zero(), |sum, v| sum + *v * *v * 0.5)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 6]) -> Constraint<S, 6, 2> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        let row = [q[0] * q[5], one, (q[1] + t).sin(), zero, q[3] * 0.3, q[4] * q[2]];
        ([row, [zero; 6]], [(t * q[3]).cos(), zero])
    }
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; 6], v: &[S; 6]) -> Option<[Option<S>; 2]> {
        Some([None, Some(v[0] * v[0] * q[2] + v[4] * v[5] + t * v[3])])
    }
}

/// `D1`, `D2` and `D1 D2` as derivatives in the end points, by num-dual.
fn against_the_oracle<L: DiscreteLagrangian<Everything, 3, 1>>(
    rule: &L,
    system: &Everything,
    (t, h): (f64, f64),
    q0: &[f64; 3],
    v: &[f64; 3],
) {
    let d = rule.derivatives(system, t, h, q0, v);
    let d2 = rule.d2(system, t, h, q0, v);
    let [slope1, slope2] = rule.slopes(system, t, h, q0, v);
    assert_relative_eq!(d.value, rule.value(system, t, h, q0, v), max_relative = 1e-15);
    let q1: [f64; 3] = from_fn(|i| q0[i] + h * v[i]);
    for i in 0..3 {
        for j in 0..3 {
            let start: [HyperDual64; 3] = from_fn(|k| HyperDual64::new(q0[k], f64::from(u8::from(i == k)), 0.0, 0.0));
            let end: [HyperDual64; 3] = from_fn(|k| HyperDual64::new(q1[k], 0.0, f64::from(u8::from(j == k)), 0.0));
            let mean = from_fn(|k| (end[k] - start[k]) / h);
            let l = rule.value(system, HyperDual64::from(t), HyperDual64::from(h), &start, &mean);
            close(d.d1[i], l.eps1, h);
            close(d.d2[j], l.eps2, h);
            close(d2[j], l.eps2, h);
            close(slope1[i], l.eps1, h);
            close(slope2[j], l.eps2, h);
            close(d.d1d2[i][j], l.eps1eps2, h * h);
        }
    }
}

proptest! {
    #[test]
    fn derivatives_of_every_rule(
        c in vector(), t in -2.0..2.0f64, h in prop_oneof![0.01..1.0f64, -1.0..-0.01f64], q0 in vector(), v in vector(),
        alpha in 0.0..1.0f64,
    ) {
        let (system, at) = (Everything { c }, (t, h));
        against_the_oracle(&Midpoint, &system, at, &q0, &v);
        against_the_oracle(&Trapezoid, &system, at, &q0, &v);
        against_the_oracle(&Alpha::new(alpha).unwrap(), &system, at, &q0, &v);
        against_the_oracle(&Symmetrised::new(alpha).unwrap(), &system, at, &q0, &v);
        against_the_oracle(&HandMade, &system, at, &q0, &v);
    }

    #[test]
    fn constraints_of_every_rule(
        c in vector(), t in -2.0..2.0f64, h in prop_oneof![0.01..1.0f64, -1.0..-0.01f64], q0 in vector(), v in vector(),
        alpha in 0.0..1.0f64,
    ) {
        let (system, at) = (Everything { c }, (t, h));
        linearised(&Midpoint, &system, at, &q0, &v);
        linearised(&Trapezoid, &system, at, &q0, &v);
        linearised(&Alpha::new(alpha).unwrap(), &system, at, &q0, &v);
        linearised(&Symmetrised::new(alpha).unwrap(), &system, at, &q0, &v);
        let [q0, v] = [[q0, v], [v, q0]].map(|parts| from_fn(|i| parts[i / 3][i % 3]));
        linearised(&Midpoint, &Six, at, &q0, &v);
        linearised(&Symmetrised::new(alpha).unwrap(), &Six, at, &q0, &v);
    }

    /// `L_d(q0, q1; t0, h) = -L_d(q1, q0; t1, -h)` for the symmetric rules; the alpha rule's mirror image is `1 - alpha`.
    #[test]
    fn symmetric_rules_are_self_adjoint(
        c in vector(), t in -2.0..2.0f64, h in 0.01..1.0f64, q0 in vector(), v in vector(), alpha in 0.0..1.0f64,
    ) {
        fn mirrored<A, B>(a: &A, b: &B, system: &Everything, t: f64, h: f64, q0: &[f64; 3], v: &[f64; 3])
        where
            A: DiscreteLagrangian<Everything, 3, 1> + DiscreteConstraint<Everything, 3, 1>,
            B: DiscreteLagrangian<Everything, 3, 1> + DiscreteConstraint<Everything, 3, 1>,
        {
            let q1 = from_fn(|i| q0[i] + h * v[i]);
            let (there, back) = (a.value(system, t, h, q0, v), b.value(system, t + h, -h, &q1, v));
            assert_relative_eq!(there, -back, epsilon = 1e-12, max_relative = 1e-12);
            let (there, back) = (a.residual(system, t, h, q0, v), b.residual(system, t + h, -h, &q1, v));
            assert_relative_eq!(there[0], back[0], epsilon = 1e-12, max_relative = 1e-12);
            let (there, back) = (a.forces(system, t, h, q0, v).unwrap(), b.forces(system, t + h, -h, &q1, v).unwrap());
            for i in 0..3 {
                assert_relative_eq!(there.0[i], -back.1[i], epsilon = 1e-12, max_relative = 1e-12);
                assert_relative_eq!(there.1[i], -back.0[i], epsilon = 1e-12, max_relative = 1e-12);
            }
        }
        let system = Everything { c };
        mirrored(&Midpoint, &Midpoint, &system, t, h, &q0, &v);
        mirrored(&Trapezoid, &Trapezoid, &system, t, h, &q0, &v);
        let rule = Symmetrised::new(alpha).unwrap();
        mirrored(&rule, &rule, &system, t, h, &q0, &v);
        mirrored(&Alpha::new(alpha).unwrap(), &Alpha::new(1.0 - alpha).unwrap(), &system, t, h, &q0, &v);
    }

    /// The rules are what their formulas say.
    #[test]
    fn values_of_the_rules(c in vector(), t in -2.0..2.0f64, h in 0.01..1.0f64, q0 in vector(), v in vector()) {
        let system = Everything { c };
        let at = |alpha: f64| (t + alpha * h, from_fn(|i| q0[i] + alpha * h * v[i]));
        let l = |alpha: f64| { let (t, q) = at(alpha); h * system.lagrangian(t, &q, &v) };
        let w = |alpha: f64| { let (t, q) = at(alpha); constraint_residual(&system, t, &q, &v)[0] };
        close(Midpoint.value(&system, t, h, &q0, &v), l(0.5), 1.0);
        close(Trapezoid.value(&system, t, h, &q0, &v), 0.5 * (l(0.0) + l(1.0)), 1.0);
        close(Alpha::new(0.3).unwrap().value(&system, t, h, &q0, &v), l(0.3), 1.0);
        close(Midpoint.residual(&system, t, h, &q0, &v)[0], w(0.5), 1.0);
        close(Trapezoid.residual(&system, t, h, &q0, &v)[0], 0.5 * (w(0.0) + w(1.0)), 1.0);
        let (minus, plus) = Alpha::new(0.3).unwrap().forces(&system, t, h, &q0, &v).unwrap();
        let force = { let (t, q) = at(0.3); system.force(t, &q, &v).unwrap() };
        for i in 0..3 {
            close(minus[i], 0.7 * h * force[i], 1.0);
            close(plus[i], 0.3 * h * force[i], 1.0);
        }
    }
}

/// A midpoint discrete Lagrangian that a user writes: the value, and the derivatives by hand.
struct HandMade;

impl DiscreteLagrangian<Everything, 3, 1> for HandMade {
    fn average<S: Scalar>(&self, system: &Everything, t0: S, h: S, q0: &[S; 3], v: &[S; 3]) -> S {
        Midpoint.average(system, t0, h, q0, v)
    }
    fn derivatives<S: Scalar>(&self, system: &Everything, t0: S, h: S, q0: &[S; 3], v: &[S; 3]) -> Derivatives<S, 3> {
        // D1 = h/2 L_q - L_v, D2 = h/2 L_q + L_v, D1D2 = h/4 L_qq + (L_qv - L_vq)/2 - L_vv/h: here from the end points'
        // own blocks, so that the override is a different computation.
        use lagrangian::HyperDual;
        let half = h * 0.5;
        let (t, q): (S, [S; 3]) = (t0 + half, from_fn(|i| q0[i] + half * v[i]));
        let unit = |i: usize| from_fn(|k| S::constant(if k == i { 1.0 } else { 0.0 }));
        let zero = [S::zero(); 3];
        let lift = |x: S| HyperDual::<S, 3, 3>::fixed(x);
        let both = |x: [S; 3]| -> [HyperDual<S, 3, 3>; 3] { from_fn(|i| HyperDual::linear(x[i], unit(i), unit(i))) };
        let qq = system.lagrangian(lift(t), &both(q), &v.map(lift));
        let vv = system.lagrangian(lift(t), &q.map(lift), &both(*v));
        let first = from_fn(|i| HyperDual::linear(q[i], unit(i), zero));
        let second = from_fn(|i| HyperDual::linear(v[i], zero, unit(i)));
        let qv = system.lagrangian(lift(t), &first, &second);
        Derivatives {
            value: h * qq.re,
            d1: from_fn(|i| half * qq.e1[i] - vv.e1[i]),
            d2: from_fn(|i| half * qq.e1[i] + vv.e1[i]),
            d1d2: from_fn(|i| {
                from_fn(|j| h * 0.25 * qq.e12[i][j] + (qv.e12[i][j] - qv.e12[j][i]) * 0.5 - vv.e12[i][j] / h)
            }),
        }
    }
}

#[test]
fn weights_are_checked() {
    for alpha in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        assert!(Alpha::new(alpha).is_err());
        assert!(Symmetrised::new(alpha).is_err());
    }
    assert!(Alpha::new(0.5).unwrap().is_symmetric());
    assert!(!Alpha::new(0.5 + 1e-15).unwrap().is_symmetric());
}
