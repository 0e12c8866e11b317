//! The dual numbers against `num-dual`, on single operations and on a Lagrangian that has everything.

use crate::common::{Everything, component, vector};
use approx::assert_relative_eq;
use lagrangian::{
    Dual, Gradient, HyperDual, Motion, Scalar, System, constraint_residual, energy, mass_matrix, momentum,
};
use num_dual::{Dual64, HyperDual64};
use proptest::prelude::*;

/// A sum of some hundred terms of order one, each rounded once: 1e-13 is far above its rounding, far below a wrong term.
const ROUNDING: f64 = 1e-13;

/// Every operation of a scalar, at arguments where all are defined.
fn operations<S: Scalar>(x: S, y: S) -> Vec<S> {
    let positive = x * x + 0.7;
    let small = x / (positive + 1.0);
    let (sin, cos) = (x * y).sin_cos();
    let mut sum = x;
    sum += y;
    sum -= x * y;
    sum *= 1.5;
    vec![
        x + y,
        x - y,
        x * y,
        x / (y * y + 1.0),
        -x,
        x + 2.0,
        x - 2.0,
        x * 3.0,
        x / 3.0,
        sin,
        cos,
        x.exp(),
        positive.ln(),
        positive.sqrt(),
        positive.recip(),
        x.powi(0),
        x.powi(1),
        x.powi(2),
        x.powi(5),
        positive.powi(-3),
        x.squared(),
        x.sin(),
        y.cos(),
        sum,
        S::constant(4.0),
        S::zero(),
        x.tan(),
        small.asin(),
        small.acos(),
        y.atan(),
        x.sinh(),
        y.cosh(),
        x.tanh(),
        (x + 0.3).abs(),
        x.sign() * y,
        positive.powf(1.7),
        positive.powf(-0.5),
        x.powf(2.0),
        x.powf(1.0),
        x.powf(0.0),
        x.min(y),
        x.max(y),
        (x - y).where_positive(sin, cos),
        S::length(&[positive, x, y]),
        // Not of a difference of `positive`: where that nearly vanishes, its rounding is no longer small.
        (x * 2.0).atan2(y - 2.5),
    ]
}

proptest! {
    #[test]
    fn first_derivatives_of_every_operation(x in component(), y in component()) {
        let ours = operations(Dual::variable(x, 0), Dual::<f64, 2>::variable(y, 1));
        let in_x = operations(Dual64::from(x).derivative(), Dual64::from(y));
        let in_y = operations(Dual64::from(x), Dual64::from(y).derivative());
        let values = operations(x, y);
        for k in 0..ours.len() {
            prop_assert_eq!(ours[k].re, values[k], "the value is that of f64 to the last bit");
            assert_relative_eq!(ours[k].eps[0], in_x[k].eps, epsilon = ROUNDING, max_relative = ROUNDING);
            assert_relative_eq!(ours[k].eps[1], in_y[k].eps, epsilon = ROUNDING, max_relative = ROUNDING);
        }
    }

    /// Gradients agree with dual numbers, in the variables alone or in more places; a constant has none.
    #[test]
    fn gradients_of_every_operation(x in component(), y in component()) {
        let duals = operations(Dual::variable(x, 0), Dual::<f64, 2>::variable(y, 1));
        let in_x = operations(Gradient::<f64, 2>::variable(x, 0), Gradient::fixed(y));
        let [a, b] = Gradient::<f64, 8>::variables(&[x, y]);
        let (both, fixed) = (operations(a, b), Gradient::<f64, 2>::all_fixed(&[x, y]));
        for (k, constant) in operations(fixed[0], fixed[1]).into_iter().enumerate() {
            prop_assert_eq!([both[k].re, in_x[k].re, constant.re], [duals[k].re; 3]);
            prop_assert_eq!(constant.gradient::<2>(), [0.0; 2]);
            let [by_x, by_y, none] = both[k].gradient();
            prop_assert_eq!(none, 0.0);
            assert_relative_eq!(by_x, duals[k].eps[0], epsilon = ROUNDING, max_relative = ROUNDING);
            assert_relative_eq!(by_y, duals[k].eps[1], epsilon = ROUNDING, max_relative = ROUNDING);
            let [by_x, by_y] = in_x[k].gradient();
            prop_assert_eq!(by_y, 0.0);
            assert_relative_eq!(by_x, duals[k].eps[0], epsilon = ROUNDING, max_relative = ROUNDING);
            prop_assert_eq!(both[k].is_zero(), both[k].re == 0.0 && by_x == 0.0 && duals[k].eps[1] == 0.0);
        }
    }

    #[test]
    fn second_derivatives_of_every_operation(x in component(), y in component()) {
        // All four second derivatives: both groups on both variables.
        let seed = |v: f64, k: usize| {
            let unit = std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
            HyperDual::<f64, 2, 2>::linear(v, unit, unit)
        };
        let ours = operations(seed(x, 0), seed(y, 1));
        let values = operations(x, y);
        for i in 0..2 {
            for j in 0..2 {
                let oracle_seed = |v: f64, k: usize| {
                    HyperDual64::new(v, f64::from(u8::from(i == k)), f64::from(u8::from(j == k)), 0.0)
                };
                let oracle = operations(oracle_seed(x, 0), oracle_seed(y, 1));
                for k in 0..ours.len() {
                    prop_assert_eq!(ours[k].re, values[k]);
                    assert_relative_eq!(ours[k].e1[i], oracle[k].eps1, epsilon = ROUNDING, max_relative = ROUNDING);
                    assert_relative_eq!(ours[k].e2[j], oracle[k].eps2, epsilon = ROUNDING, max_relative = ROUNDING);
                    assert_relative_eq!(
                        ours[k].e12[i][j], oracle[k].eps1eps2, epsilon = ROUNDING, max_relative = ROUNDING
                    );
                }
            }
        }
    }

    /// A dual number over dual numbers gives the same second derivatives as the hyper-dual one.
    #[test]
    fn nested_duals_agree(x in component(), y in component()) {
        let nested = operations(
            Dual::<Dual<f64, 1>, 1>::variable(Dual::variable(x, 0), 0),
            Dual::fixed(Dual::fixed(y)),
        );
        let direct = operations(HyperDual::<f64, 1, 1>::linear(x, [1.0], [1.0]), HyperDual::fixed(y));
        for k in 0..nested.len() {
            assert_relative_eq!(
                nested[k].eps[0].eps[0], direct[k].e12[0][0], epsilon = ROUNDING, max_relative = ROUNDING
            );
        }
    }

    #[test]
    fn momentum_energy_and_mass_of_a_lagrangian(c in vector(), t in component(), q in vector(), v in vector()) {
        let system = Everything { c };
        let (p, mass) = mass_matrix(&system, t, &q, &v);
        let mut hamiltonian = -system.lagrangian(t, &q, &v);
        for i in 0..3 {
            for j in 0..3 {
                let seeded = std::array::from_fn(|k| {
                    HyperDual64::new(v[k], f64::from(u8::from(i == k)), f64::from(u8::from(j == k)), 0.0)
                });
                let oracle = system.lagrangian(HyperDual64::from(t), &q.map(HyperDual64::from), &seeded);
                assert_relative_eq!(p[i], oracle.eps1, epsilon = ROUNDING, max_relative = ROUNDING);
                assert_relative_eq!(mass[i][j], oracle.eps1eps2, epsilon = ROUNDING, max_relative = ROUNDING);
            }
            hamiltonian += p[i] * v[i];
        }
        assert_relative_eq!(energy(&system, t, &q, &v), hamiltonian, epsilon = ROUNDING);
        prop_assert_eq!(momentum(&system, t, &q, &v), p);
    }

    /// The accelerations satisfy the Lagrange-d'Alembert equations, each of their terms taken from `num-dual`.
    #[test]
    fn the_equations_of_motion_hold(c in vector(), t in component(), q in vector(), v in vector()) {
        let system = Everything { c };
        let Ok(Motion { acceleration, multiplier }) = Motion::of(&system, t, &q, &v) else {
            return Err(TestCaseError::reject("degenerate"));
        };
        let (a, _) = system.constraint(t, &q);
        let force = system.force(t, &q, &v).unwrap();
        let size = 1.0 + acceleration.iter().chain(&multiplier).fold(0.0f64, |m, x| m.max(x.abs()));
        for i in 0..3 {
            // d/dt L_v along the motion: the second group moves along it.
            let along = |x: f64, rate: f64| HyperDual64::new(x, 0.0, rate, 0.0);
            let in_v = std::array::from_fn(|k| {
                HyperDual64::new(v[k], f64::from(u8::from(i == k)), acceleration[k], 0.0)
            });
            let along_q = std::array::from_fn(|k| along(q[k], v[k]));
            let rate = system.lagrangian(along(t, 1.0), &along_q, &in_v).eps1eps2;
            let in_q = std::array::from_fn(|k| Dual64::new(q[k], f64::from(u8::from(i == k))));
            let slope = system.lagrangian(Dual64::from(t), &in_q, &v.map(Dual64::from)).eps;
            let residual = rate - slope - force[i] - a[0][i] * multiplier[0];
            prop_assert!(residual.abs() <= ROUNDING * size, "equation {i}: {residual:e}");
        }
        let moving = std::array::from_fn(|k| Dual64::new(q[k], v[k]));
        let speeding = std::array::from_fn(|k| Dual64::new(v[k], acceleration[k]));
        let slip = constraint_residual(&system, Dual64::new(t, 1.0), &moving, &speeding)[0].eps;
        prop_assert!(slip.abs() <= ROUNDING * size, "slip rate {slip:e}");
    }
}
