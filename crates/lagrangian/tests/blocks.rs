//! Systems of more coordinates than one number carries derivatives in: blocks give what one evaluation would.

use crate::common::component;
use approx::assert_relative_eq;
use lagrangian::{
    Constraint, ConstraintSlopes, Dual, HyperDual, Scalar, System, add_position_curvature, add_reaction_curvature,
    classify, constraint_residual, mass_matrix, position_rows, residual_along, second_along,
};
use proptest::prelude::*;
use std::array::from_fn;

/// Not a multiple of eight, so that the last block is not full.
const N: usize = 21;
type Row = [f64; N];

/// Every coordinate acts on its neighbours; a row that moves, one of positions, and one that is not affine.
struct Long;

impl System<N, 3> for Long {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        (0..N).fold(S::zero(), |sum, i| {
            let (near, far) = ((i + 1) % N, (i + 11) % N);
            let (sin, cos) = (q[near] + t).sin_cos();
            sum + v[i] * v[i] * (sin * 0.2 + 1.0) + v[i] * v[far] * cos * 0.1 + v[near] * q[i] * q[far]
                - (q[i] * q[near]).exp() * 0.3
                + v[i].powi(4) * 0.02
        })
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; N]) -> Constraint<S, N, 3> {
        let moving = from_fn(|i| (q[(i + 5) % N] * 0.3 + t).sin() + 0.1 * i as f64);
        let (positions, rates) = position_rows(self, t, q);
        ([moving, positions[1], [S::zero(); N]], [q[4] * q[17] + t, rates[1], S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        Some(from_fn(|i| -v[i] * 0.1 + q[(i + 3) % N] * 0.2))
    }
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; N]) -> Option<[Option<S>; 3]> {
        let g = (0..N).fold(t * 0.4 - 1.0, |sum, i| sum + q[i] * q[(i + 9) % N] * (0.5 + 0.1 * i as f64));
        Some([None, Some(g), None])
    }
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[Option<S>; 3]> {
        let phi = (0..N).fold(t, |sum, i| sum + v[i] * v[(i + 10) % N] * (q[i] + 2.0));
        Some([None, None, Some(phi)])
    }
}

fn point() -> impl Strategy<Value = Row> {
    proptest::collection::vec(component(), N).prop_map(|x| from_fn(|i| x[i]))
}

fn unit(i: usize) -> Row {
    from_fn(|k| f64::from(u8::from(i == k)))
}

/// Entry by entry; of symmetric matrices one half is the mirror of the other, and differs by rounding from what it would be.
fn same(found: &[Row; N], whole: &[Row; N], symmetric: bool) {
    for i in 0..N {
        for j in 0..N {
            match symmetric && j < i {
                true => assert_relative_eq!(found[i][j], whole[i][j], epsilon = 1e-13, max_relative = 1e-13),
                false => assert_eq!(found[i][j].to_bits(), whole[i][j].to_bits(), "{i} {j}"),
            }
        }
    }
}

type Whole = HyperDual<f64, N, N>;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn at_a_node(t in -2.0..2.0f64, back in -1.0..1.0f64, ahead in -1.0..1.0f64, q in point(), v in point()) {
        let along = |by: f64| move |i: usize| unit(i).map(|x| by * x);
        let in_q: [Whole; N] = from_fn(|i| HyperDual::linear(q[i], along(back)(i), along(ahead)(i)));
        let in_v: [Whole; N] = from_fn(|i| HyperDual::linear(v[i], along(-1.0)(i), unit(i)));
        let whole = Long.lagrangian(HyperDual::fixed(t), &in_q, &in_v);
        let found = second_along(&Long, t, (&q, &v), [back, -1.0], Some([ahead, 1.0]));
        assert_eq!((found.re, found.e1, found.e2), (whole.re, whole.e1, whole.e2));
        same(&found.e12, &whole.e12, false);

        let rows = residual_along(&Long, t, &q, &v, ahead);
        let in_q: [Dual<f64, N>; N] = from_fn(|i| Dual { re: q[i], eps: along(ahead)(i) });
        let w: [Dual<f64, N>; 3] = constraint_residual(&Long, Dual::fixed(t), &in_q, &Dual::variables(&v));
        for k in 0..3 {
            assert_relative_eq!(rows[k].re, w[k].re, epsilon = 1e-12, max_relative = 1e-12);
            for i in 0..N {
                assert_relative_eq!(rows[k].eps[i], w[k].eps[i], epsilon = 1e-12, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn of_lagrangians(t in -2.0..2.0f64, q in point(), v in point()) {
        let time = Whole::fixed(t);
        let (fixed_q, fixed_v): ([Whole; N], [Whole; N]) = (q.map(HyperDual::fixed), v.map(HyperDual::fixed));
        let twice = |x: &Row| -> [Whole; N] { from_fn(|i| HyperDual::linear(x[i], unit(i), unit(i))) };
        let whole = Long.lagrangian(time, &fixed_q, &twice(&v));
        let (p, mass) = mass_matrix(&Long, t, &q, &v);
        assert_eq!(p, whole.e1);
        same(&mass, &whole.e12, true);
        for i in 0..N {
            for j in 0..N {
                assert_eq!(mass[i][j].to_bits(), mass[j][i].to_bits());
            }
        }

        let (whole, found) = (Long.lagrangian(time, &twice(&q), &fixed_v), second_along(&Long, t, (&q, &v), [1.0, 0.0], None));
        assert_eq!((found.re, found.e1, found.e2), (whole.re, whole.e1, whole.e2));
        same(&found.e12, &whole.e12, true);

        let first: [Whole; N] = from_fn(|i| HyperDual::linear(q[i], unit(i), [0.0; N]));
        let second: [Whole; N] = from_fn(|i| HyperDual::linear(v[i], [0.0; N], unit(i)));
        let (whole, found) = (Long.lagrangian(time, &first, &second), second_along(&Long, t, (&q, &v), [1.0, 0.0], Some([0.0, 1.0])));
        assert_eq!((found.re, found.e1, found.e2), (whole.re, whole.e1, whole.e2));
        same(&found.e12, &whole.e12, false);
    }

    #[test]
    fn of_constraints(t in -2.0..2.0f64, q in point(), v in point(), factors in proptest::array::uniform3(component())) {
        // Rows of positions are gradients of their functions.
        let (rows, rates) = position_rows(&Long, t, &q);
        let g = Long.holonomic(Dual::fixed(t), &Dual::<f64, N>::variables(&q)).unwrap()[1].unwrap();
        assert_eq!((rows[1], rows[0], rows[2], rates), (g.eps, [0.0; N], [0.0; N], [0.0, 0.4, 0.0]));

        let twice = |x: &Row| -> [Whole; N] { from_fn(|i| HyperDual::linear(x[i], unit(i), unit(i))) };
        let with = |e12: &[Row; N], factor: f64| -> [Row; N] { from_fn(|i| from_fn(|j| 1.0 + factor * e12[i][j])) };
        let (mut turn, mut bend) = ([[1.0; N]; N], [[1.0; N]; N]);
        add_reaction_curvature(&Long, t, (&q, &v), &factors, &mut turn);
        let phi = Long.nonlinear(Whole::fixed(t), &q.map(HyperDual::fixed), &twice(&v)).unwrap()[2].unwrap();
        same(&turn, &with(&phi.e12, factors[2]), false);
        add_position_curvature(&Long, t, &q, &factors, &mut bend);
        let g = Long.holonomic(Whole::fixed(t), &twice(&q)).unwrap()[1].unwrap();
        same(&bend, &with(&g.e12, factors[1]), false);

        let (mut w, mut w_q) = (v, [[0.5; N]; N]);
        let at = ConstraintSlopes::reacting(&Long, t, (&q, &v), &factors, (&mut w, &mut w_q));
        let (a, b) = Long.constraint(Dual::fixed(t), &Dual::<f64, N>::variables(&q));
        for k in 0..3 {
            let slip = (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i]);
            assert_eq!((at.a[k], at.g[k]), (a[k].map(|a| a.re), slip.re));
            for j in 0..N {
                assert_relative_eq!(at.g_q[k][j], slip.eps[j], epsilon = 1e-13, max_relative = 1e-13);
            }
        }
        for i in 0..N {
            let reaction = (0..3).fold(Dual::fixed(v[i]), |sum, k| sum + a[k][i] * factors[k]);
            assert_relative_eq!(w[i], reaction.re, epsilon = 1e-14, max_relative = 1e-14);
            for j in 0..N {
                assert_relative_eq!(w_q[i][j], 0.5 + reaction.eps[j], epsilon = 1e-14, max_relative = 1e-14);
            }
        }
    }
}

/// Skates of three coordinates each, some rows of which are there twice.
struct Skates {
    twice: bool,
}

impl System<24, 8> for Skates {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 24], v: &[S; 24]) -> S {
        v.iter().fold(S::zero(), |sum, v| sum + *v * *v * 0.5)
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 24]) -> Constraint<S, 24, 8> {
        let mut a = [[S::zero(); 24]; 8];
        for (k, row) in a.iter_mut().enumerate() {
            let k = if self.twice && k == 7 { 2 } else { k };
            let (sin, cos) = q[3 * k + 2].sin_cos();
            (row[3 * k], row[3 * k + 1]) = (-sin, cos);
        }
        (a, [S::zero(); 8])
    }
}

/// Each blade adds one direction by its brackets; a row that is there twice adds none, and depends on the other everywhere.
#[test]
fn classes() {
    let (q, v) = (from_fn(|i| 0.1 * i as f64), [0.0; 24]);
    let apart = classify(&Skates { twice: false }, 0.0, &q, &v);
    assert_eq!((apart.rank, apart.regular, apart.brackets), (8, true, 8));
    let twice = classify(&Skates { twice: true }, 0.0, &q, &v);
    assert_eq!((twice.rank, twice.regular, twice.consistent, twice.brackets), (7, true, true, 7));
    assert_eq!(twice.dependence.involved.iter().collect::<Vec<_>>(), [2, 7]);
    assert!(constraint_residual(&Skates { twice: true }, 0.0, &q, &v).iter().all(|x| x.abs() <= 0.0));
}
