//! What every model promises, for parameters that are not one.

use crate::common::{Draws, draws, parameters, state};
use lagrangian::linear::Lu;
use lagrangian::{
    Dual, Lanes, Motion, acceleration_along, classify, constraint_residual, mass_matrix, quasi_velocities,
    reduced_acceleration, velocity_of,
};
use models::{
    ChaplyginBall, CompoundPendulum, ContactOscillator, GaugedOscillator, KnifeEdge, Model, ModelState, Particle,
    QuarticOscillator, RollerRacer, RollingDisk, SleighOnArm, Snakeboard, Suslov, TurntableBall,
};
use proptest::prelude::*;
use std::array::from_fn;

/// Something that holds for every model.
trait Check {
    fn on<Mo: Model<N, M>, const N: usize, const M: usize>(&mut self, model: &Mo);
}

/// Runs a check over every model, with parameters made from five positive numbers.
fn every_model(&[a, b, c, d, e]: &[f64; 5], check: &mut impl Check) {
    check.on(&RollingDisk::new(a, b, c, d).unwrap());
    check.on(&Particle::flat(a).unwrap());
    check.on(&Particle::in_well(a, b).unwrap());
    check.on(&KnifeEdge::new(a, b, c - d).unwrap());
    // Positive definite for any numbers: I33 is more than what the products take.
    let (i13, i23) = (c - d, d - e);
    check.on(&Suslov::new([a, b, c + i13 * i13 / a + i23 * i23 / b], i13, i23).unwrap());
    check.on(&Suslov::new([a, b, c], 0.0, 0.0).unwrap());
    check.on(&Suslov::new([a, b, c], 0.0, 0.0).unwrap().norm_by_rate());
    let ball = ChaplyginBall::new(a, b, [c, d, e]).unwrap();
    check.on(&ball);
    check.on(&ball.norm_by_rate());
    for eps in [0.0, a] {
        let oscillator = ContactOscillator::new(eps).unwrap();
        check.on(&oscillator);
        check.on(&GaugedOscillator::new(oscillator, b).unwrap());
        check.on(&GaugedOscillator::new(oscillator, 0.0).unwrap());
    }
    check.on(&QuarticOscillator::new(a).unwrap());
    check.on(&Snakeboard::new(a, b, c, d, e).unwrap());
    check.on(&RollerRacer::new(a, b, c, d, e).unwrap());
    let pendulum = CompoundPendulum::new(a, b, c, d - e).unwrap();
    check.on(&pendulum);
    check.on(&pendulum.pseudo_holonomic());
    check.on(&SleighOnArm::new(a, b, c - 1.0, d, d + e, c - e).unwrap());
    for rate in [0.0, d - e] {
        check.on(&TurntableBall::new(a, b, c, rate).unwrap());
    }
}

/// Roundings that a result may have taken beyond the condition of its problem; what is wrong is wrong by far more.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The largest entry of a vector, and one.
fn size<const N: usize>(x: &[f64; N]) -> f64 {
    x.iter().fold(1.0, |m, x| m.max(x.abs()))
}

/// The condition number of the mass matrix `W' M W` on the constraint, by which a solve for the accelerations loses
/// digits.
fn condition<Mo: Model<N, M>, const N: usize, const M: usize>(model: &Mo, q: &[f64; N], v: &[f64; N]) -> f64 {
    let (_, mass) = mass_matrix(model, 0.0, q, v);
    let basis = model.admissible_basis(0.0, q).unwrap();
    let w = basis.vectors();
    let mut reduced: [[f64; N]; N] = from_fn(|i| from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    for (i, wi) in w.iter().enumerate() {
        for (j, wj) in w.iter().enumerate() {
            reduced[i][j] = (0..N).map(|k| (0..N).map(|l| wi[k] * mass[k][l] * wj[l]).sum::<f64>()).sum();
        }
    }
    let lu = Lu::new(reduced).unwrap();
    let inverse: [[f64; N]; N] = from_fn(|j| lu.solve(from_fn(|i| if i == j { 1.0 } else { 0.0 })));
    let norm = |a: &[[f64; N]; N]| a.iter().map(|r| r.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    norm(&reduced) * norm(&inverse)
}

/// The size of the terms that add up to the accelerations.
fn terms<const N: usize>(q: &[f64; N], v: &[f64; N], a: &[f64; N]) -> f64 {
    let (q, v) = (size(q), size(v));
    size(a) + v * v + q * q * q
}

macro_rules! check {
    ($check:ident($draws:ident, $model:ident, $N:ident, $M:ident) $body:block) => {
        struct $check(Draws);
        impl Check for $check {
            fn on<Mo: Model<$N, $M>, const $N: usize, const $M: usize>(&mut self, $model: &Mo) {
                let $draws = &self.0;
                $body
            }
        }
    };
}

check!(TwoFormulations(draws, model, N, M) {
    let (q, v) = state(model, draws);
    let hand = model.accelerations_by_hand(0.0, &q, &v);
    let machine = Motion::automatic(model, 0.0, &q, &v).unwrap().acceleration;
    let tolerance = ROUNDING * condition(model, &q, &v) * terms(&q, &v, &machine);
    for i in 0..N {
        let error = (hand[i] - machine[i]).abs();
        assert!(error <= tolerance, "{}, {i}: {hand:?}, not {machine:?}: {error:e} > {tolerance:e}", model.name());
    }
});

check!(AlongTheBasis(draws, model, N, M) {
    let (q, v) = state(model, draws);
    let xi = quasi_velocities(model, 0.0, &q, &v).unwrap();
    let Some(along) = acceleration_along(model, 0.0, &q, &xi) else {
        assert!(N == M || N - M > 5, "{}", model.name());
        return;
    };
    let machine = Motion::automatic(model, 0.0, &q, &v).unwrap().acceleration;
    let right = reduced_acceleration(model, 0.0, &q, &xi).unwrap();
    // The quasi-velocities are found again from velocities, by a matrix of its own condition.
    let tolerance = 64.0 * ROUNDING * condition(model, &q, &v) * terms(&q, &v, &machine);
    for k in 0..N - M {
        let error = (along[k] - right[k]).abs();
        assert!(error <= tolerance, "{}, {k}: {along:?}, not {right:?}: {error:e} > {tolerance:e}", model.name());
    }
    // Eight at once are eight times one, but for the sines of lanes.
    let lanes = |x: f64| Lanes([x; 8]);
    let eight = acceleration_along(model, lanes(0.0), &q.map(lanes), &xi.map(lanes)).unwrap();
    for k in 0..N - M {
        assert!((eight[k].0[5] - along[k]).abs() <= tolerance, "{}", model.name());
    }
});

check!(Basis(draws, model, N, M) {
    let (q, v) = state(model, draws);
    let basis = model.admissible_basis(0.0, &q).unwrap();
    let (a, _) = model.constraint(0.0, &q);
    for w in basis.vectors() {
        for row in &a {
            let slip: f64 = (0..N).map(|i| row[i] * w[i]).sum();
            assert!(slip.abs() <= 8.0 * f64::EPSILON * size(w), "{}: {slip:e}", model.name());
        }
    }
    for (row, slip) in a.iter().zip(constraint_residual(model, 0.0, &q, &v)) {
        assert!(slip.abs() <= ROUNDING * size(row) * size(&v), "{}: {slip:e}", model.name());
    }
    // Constraints on positions hold, and are those of the rows.
    let held = lagrangian::position_residual(model, 0.0, &q);
    assert!(held <= ROUNDING * size(&q) * size(&q), "{}: {held:e}", model.name());
    let class = classify(model, 0.0, &q, &v);
    assert_eq!((class.rank, class.regular, class.consistent), (M, true, true), "{}", model.name());
    assert!(class.mismatched.is_empty(), "{}: {}", model.name(), class.mismatched);
    // With the rows of the constraint the vectors span all velocities.
    let mut all = [[0.0; N]; N];
    for (place, row) in all.iter_mut().zip(basis.vectors().iter().chain(&a)) {
        *place = *row;
    }
    assert!(Lu::new(all).is_ok(), "{}: dependent", model.name());
});

check!(Invariants(draws, model, N, M) {
    let (q, v) = state(model, draws);
    let a = model.accelerations_by_hand(0.0, &q, &v);
    let condition = condition(model, &q, &v);
    let along = |seed: &dyn Fn(usize) -> (f64, f64)| {
        let q: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [seed(i).0] });
        let v: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: v[i], eps: [seed(i).1] });
        model.invariants(&q, &v)
    };
    let whole = along(&|i| (v[i], a[i]));
    assert!(whole[0].0.ends_with("energy"));
    for (k, (name, rate)) in whole.iter().enumerate() {
        // The rate is a sum of the parts that each coordinate and each velocity adds.
        let parts: f64 = (0..N).map(|j| {
            let of_q = along(&|i| (if i == j { v[i] } else { 0.0 }, 0.0))[k].1.eps[0];
            let of_v = along(&|i| (0.0, if i == j { a[i] } else { 0.0 }))[k].1.eps[0];
            of_q.abs() + of_v.abs()
        }).sum();
        let tolerance = ROUNDING * condition * (1.0 + parts);
        assert!(rate.eps[0].abs() <= tolerance, "{}, {name}: {:e} > {tolerance:e}", model.name(), rate.eps[0]);
    }
});

// `div(rho X) = 0` for the reduced equations `q' = W xi`, `xi' = g(q, xi)` with the density `rho`.
//
// `g` is at most quadratic in `xi`, and a central difference of any width is then its derivative.
check!(Measure(draws, model, N, M) {
    let (q, v) = state(model, draws);
    let labels = model.labels();
    let Some(density) = model.density(&q) else {
        assert!(!labels.invariant_measure, "{}: a measure without its density", model.name());
        return;
    };
    assert!(labels.invariant_measure, "{}: a density without its measure", model.name());
    assert!(density > 0.0);
    let xi: [f64; N] = from_fn(|i| if i < N - M { 1.5 * draws[8 + i] } else { 0.0 });
    let (mut divergence, mut parts) = (0.0, 1.0);
    for j in 0..N {
        let moving: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [if i == j { 1.0 } else { 0.0 }] });
        let velocity = velocity_of(model, Dual::fixed(0.0), &moving, &xi.map(Dual::fixed)).unwrap();
        let part = (velocity[j] * model.density(&moving).unwrap()).eps[0];
        divergence += part;
        parts += part.abs();
    }
    for j in 0..N - M {
        let shifted = |by: f64| {
            let xi = from_fn(|i| if i == j { xi[i] + by } else { xi[i] });
            reduced_acceleration(model, 0.0, &q, &xi).unwrap()[j]
        };
        let (up, down) = (shifted(0.5), shifted(-0.5));
        divergence += density * (up - down);
        parts += density * (up.abs() + down.abs());
    }
    let tolerance = ROUNDING * condition(model, &q, &v) * parts * terms(&q, &v, &[0.0; N]);
    assert!(divergence.abs() <= tolerance, "{}: {divergence:e} > {tolerance:e}", model.name());
});

check!(Reversal(draws, model, N, M) {
    let (q, v) = state(model, draws);
    let back = v.map(|v| -v);
    let even = model.lagrangian(0.0, &q, &v) == model.lagrangian(0.0, &q, &back);
    let still = model.constraint(0.0, &q).1.iter().all(|b| *b == 0.0);
    assert_eq!(even && still, model.labels().reversible, "{}: the Lagrangian", model.name());
    if model.labels().reversible {
        let (a, b) = (model.accelerations_by_hand(0.0, &q, &v), model.accelerations_by_hand(0.0, &q, &back));
        // Rounding does not know signs: equal to the last bit.
        assert_eq!(a, b, "{}", model.name());
    }
});

/// The fourth-order Richardson extrapolation of central differences, with an error of `h^6`.
fn derivative<const N: usize>(f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let central = |h: f64| -> [f64; N] {
        let (up, down) = (f(h), f(-h));
        from_fn(|i| (up[i] - down[i]) / (2.0 * h))
    };
    let h = 4e-3;
    let (a, b, c) = (central(h), central(0.5 * h), central(0.25 * h));
    from_fn(|i| {
        let (ab, bc) = ((4.0 * b[i] - a[i]) / 3.0, (4.0 * c[i] - b[i]) / 3.0);
        (16.0 * bc - ab) / 15.0
    })
}

fn exact_is_a_solution<Mo: Model<N, M>, const N: usize, const M: usize>(model: &Mo, start: &ModelState<N>, t: f64) {
    let Some((q, v)) = model.exact_from(start, t) else { return };
    let name = model.name();
    let at = |dt: f64| model.exact_from(start, t + dt).unwrap();
    let a = model.accelerations_by_hand(t, &q, &v);
    let (q_rate, v_rate) = (derivative(|dt| at(dt).0), derivative(|dt| at(dt).1));
    // The differences lose the rounding of values over h/4, and have an error of h^6 times a seventh derivative.
    let tolerance = 1e-9 * terms(&[0.0; N], &v, &a) * (1.0 + size(&q));
    for i in 0..N {
        assert!((q_rate[i] - v[i]).abs() <= tolerance, "{name}, q{i}' = {:e}, v{i} = {:e}", q_rate[i], v[i]);
        assert!((v_rate[i] - a[i]).abs() <= tolerance, "{name}, v{i}' = {:e}, a{i} = {:e}", v_rate[i], a[i]);
    }
    for slip in constraint_residual(model, t, &q, &v) {
        assert!(slip.abs() <= ROUNDING * size(&q) * size(&v), "{name}: slip {slip:e}");
    }
    let here = model.exact_from(start, 0.0).unwrap();
    for i in 0..N {
        assert!((here.0[i] - start.0[i]).abs() <= ROUNDING * size(&start.0), "{name}: {here:?}, not {start:?}");
        assert!((here.1[i] - start.1[i]).abs() <= ROUNDING * size(&start.1), "{name}: {here:?}, not {start:?}");
    }
}

check!(Exact(draws, model, N, M) {
    let start = state(model, draws);
    exact_is_a_solution(model, &start, 4.0 * draws[15]);
    assert_eq!(model.exact(0.7), model.exact_from(&model.start(), 0.7));
    // Without a turn or a drift, where closed forms divide by zero.
    let basis = model.admissible_basis(0.0, &start.0).unwrap();
    for k in 0..N - M {
        let xi = from_fn(|i| if i == k { draws[8] } else { 0.0 });
        exact_is_a_solution(model, &(start.0, basis.combine(&xi)), 4.0 * draws[15]);
    }
});

check!(Start(draws, model, N, M) {
    let (q, v) = model.start();
    assert!(model.regularity(&q) > 0.5, "{}", model.name());
    for slip in constraint_residual(model, 0.0, &q, &v) {
        assert!(slip.abs() <= 4.0 * f64::EPSILON * size(&v), "{}: {slip:e}", model.name());
    }
    assert!(v.iter().any(|v| *v != 0.0), "{}: at rest", model.name());
    assert!(!model.name().is_empty() && !model.source().is_empty() && draws.len() == 16);
});

proptest! {
    #[test]
    fn two_formulations_agree(p in parameters(), draws in draws()) {
        every_model(&p, &mut TwoFormulations(draws));
    }

    #[test]
    fn derivatives_along_the_basis_give_the_same_accelerations(p in parameters(), draws in draws()) {
        every_model(&p, &mut AlongTheBasis(draws));
    }

    #[test]
    fn bases_are_admissible_and_independent(p in parameters(), draws in draws()) {
        every_model(&p, &mut Basis(draws));
    }

    #[test]
    fn invariants_are_constant(p in parameters(), draws in draws()) {
        every_model(&p, &mut Invariants(draws));
    }

    #[test]
    fn measures_are_invariant(p in parameters(), draws in draws()) {
        every_model(&p, &mut Measure(draws));
    }

    #[test]
    fn motions_reverse_where_the_label_says_so(p in parameters(), draws in draws()) {
        every_model(&p, &mut Reversal(draws));
    }

    #[test]
    fn closed_forms_solve_the_equations(p in parameters(), draws in draws()) {
        every_model(&p, &mut Exact(draws));
    }

    #[test]
    fn starts_are_admissible(p in parameters(), draws in draws()) {
        every_model(&p, &mut Start(draws));
    }
}
