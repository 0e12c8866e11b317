//! Quadrature rules, against what their formulas say of the discrete Lagrangian as a function of both ends.

use crate::support::{Four, Three};
use crate::systems::models::{Disk, Kinetic, Particle, Pushed};
use approx::assert_relative_eq;
use dla::{DiscreteLagrangian, Discretisation, Rules};
use lagrangian::{Alpha, Dual, Midpoint, Rule, Scalar, System, Trapezoid, constraint_residual, on_line};
use proptest::prelude::*;

/// The mean Lagrangian of a rule, with the derivatives that follow from it alone.
struct Averaged<'a, Sys, const M: usize> {
    system: &'a Sys,
    rule: Rule,
}

impl<Sys: System<N, M>, const N: usize, const M: usize> DiscreteLagrangian<N> for Averaged<'_, Sys, M> {
    fn average<S: Scalar>(&self, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> S {
        self.rule.nodes().iter().fold(S::zero(), |sum, node| {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            sum + self.system.lagrangian(t, &q, v) * node.weight
        })
    }
    fn forces<S: Scalar>(&self, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> Option<[[S; N]; 2]> {
        let mut ends = [[S::zero(); N]; 2];
        for node in self.rule.nodes() {
            let (t, q) = on_line(node.alpha, t0, h, q0, v);
            let force = self.system.force(t, &q, v)?;
            for (end, part) in ends.iter_mut().zip([1.0 - node.alpha, node.alpha]) {
                for i in 0..N {
                    end[i] += h * force[i] * (node.weight * part);
                }
            }
        }
        Some(ends)
    }
    fn constraint(&self) -> Rule {
        self.rule
    }
}

fn check<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    q0: &[f64; N],
    v: &[f64; N],
    (t, h): (f64, f64),
    alpha: f64,
) {
    for rule in [Midpoint.into(), Trapezoid.into(), Rule::from(Alpha::new(alpha).unwrap())] {
        let (rules, expected) = (Rules::new(rule, rule), Averaged::<Sys, M> { system, rule });
        let (ends, block) = rules.linearised(system, (t, h), q0, v);
        let (right, right_block) = Discretisation::<N, M>::linearised(&expected, system, (t, h), q0, v);
        let momenta = rules.momenta(system, (t, h), q0, v);
        let by_itself = Discretisation::<N, M>::momenta(&expected, system, (t, h), q0, v);
        let same = |a: f64, b: f64| assert_relative_eq!(a, b, epsilon = 1e-13, max_relative = 1e-12);
        for found in [ends, momenta, by_itself] {
            assert_eq!(found.forces.is_some(), right.forces.is_some());
            let forces = found.forces.iter().flatten().flatten().zip(right.forces.iter().flatten().flatten());
            let slopes = found.slopes.iter().flatten().zip(right.slopes.iter().flatten());
            slopes.chain(forces).for_each(|(a, b)| same(*a, *b));
        }
        block.iter().flatten().zip(right_block.iter().flatten()).for_each(|(a, b)| same(*a, *b));

        let (residual, rows) = (rules.residual(system, (t, h), q0, v), rules.rows(system, (t, h), q0, v));
        let mut w = [Dual::<f64, N>::fixed(0.0); M];
        for node in rule.nodes() {
            let (q0, v) = (q0.map(Dual::fixed), Dual::variables(v));
            let (t, q) = on_line(node.alpha, Dual::fixed(t), Dual::fixed(h), &q0, &v);
            let slip = constraint_residual(system, t, &q, &v);
            (0..M).for_each(|k| w[k] += slip[k] * node.weight);
        }
        for k in 0..M {
            same(residual[k], w[k].re);
            same(rows[k].re, w[k].re);
            (0..N).for_each(|i| same(rows[k].eps[i], w[k].eps[i]));
        }
    }
}

proptest! {
    #[test]
    fn derivatives_of_every_rule(
        q in prop::array::uniform4(-1.0..1.0f64), v in prop::array::uniform4(-1.0..1.0f64), t in -2.0..2.0f64,
        h in prop_oneof![0.01..0.5f64, -0.5..-0.01f64], alpha in 0.0..=1.0f64,
    ) {
        let (at, place, along) = ((t, h), [q[0], q[1], q[2]], [v[0], v[1], v[2]]);
        check(&Three::from(Particle { kinetic: Kinetic::Quartic, damping: 0.3 }), &place, &along, at, alpha);
        check(&Three::from(Pushed), &place, &along, at, alpha);
        check(&Four::from(Disk), &q, &v, at, alpha);
    }
}

#[test]
fn weights_are_checked() {
    for alpha in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        assert!(Alpha::new(alpha).is_err());
    }
    assert!(Alpha::new(0.5).unwrap().is_symmetric());
    assert!(!Alpha::new(0.5 + 1e-15).unwrap().is_symmetric());
}
