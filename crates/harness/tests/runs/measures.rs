//! What flow and methods do to areas of starts of the free sleigh, whose invariant measure is `du domega / |omega|`.

use approx::assert_abs_diff_eq;
use dla::{Mechanism, Method, Subject};
use harness::analysis::{enclosed_area, measure_defect};
use proptest::prelude::*;
use sleigh::{Exact, Sleigh, SleighState};
use std::f64::consts::{PI, TAU};

/// Points on a closed curve of starts about `(u, omega)`, round in `(u, ln |omega|)`.
fn ring([u, omega]: [f64; 2], radius: f64, count: u32) -> Vec<SleighState> {
    let at = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
        SleighState { speed: u + radius * cos, turn_rate: omega * (radius * sin).exp(), ..SleighState::default() }
    };
    (0..count).map(at).collect()
}

/// `du domega` and `du domega / |omega|` of what lies within a curve of starts.
fn areas(curve: &[SleighState]) -> [f64; 2] {
    let plain: Vec<_> = curve.iter().map(|state| [state.speed, state.turn_rate]).collect();
    let weighted: Vec<_> = curve.iter().map(|state| [state.speed, state.turn_rate.abs().ln()]).collect();
    [enclosed_area(&plain), enclosed_area(&weighted)]
}

proptest! {
    /// Of an ellipse anywhere, in both directions.
    #[test]
    fn the_area_of_an_ellipse(a in 0.01..10.0f64, b in 0.01..10.0f64, x in -1e3..1e3f64, tilt in 0.0..TAU) {
        let point = |k: i32| {
            let (sin, cos) = (TAU * f64::from(k) / 32.0).sin_cos();
            let (s, c) = tilt.sin_cos();
            [x + a * cos * c - b * sin * s, a * cos * s + b * sin * c]
        };
        let forward: Vec<_> = (0..32).map(point).collect();
        let backward: Vec<_> = (0..32).map(|k| point(-k)).collect();
        // The coordinates are rounded to so much, along the whole curve.
        let rounding = 4.0 * f64::EPSILON * (x.abs() + a + b) * (a + b) * PI;
        prop_assert!((enclosed_area(&forward) - PI * a * b).abs() <= rounding);
        prop_assert!((enclosed_area(&backward) + PI * a * b).abs() <= rounding);
    }

    /// The flow shrinks the plain area while the sleigh runs forward, and keeps the weighted one.
    #[test]
    fn the_flow_keeps_the_weighted_area(u in 0.3..1.0f64, omega in 0.1..0.8f64, t in 1.0..4.0f64, left in any::<bool>()) {
        let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
        let start = ring([u, if left { omega } else { -omega }], 0.1, 64);
        let end: Vec<_> = start.iter().map(|state| Exact::new(&sleigh, state).unwrap().at(t)).collect();
        let ([plain0, weighted0], [plain1, weighted1]) = (areas(&start), areas(&end));
        prop_assert!((weighted1 - weighted0).abs() <= 1e-13, "{weighted0:e} {weighted1:e}");
        // d(area)/dt = -c u area, and u > 0.2 at all of them.
        prop_assert!(plain1.abs() < plain0.abs() * (-sleigh.spin_gain() * 0.2 * t).exp());
    }
}

#[test]
fn no_curve_no_area() {
    assert_abs_diff_eq!(enclosed_area(&[]), 0.0);
    assert_abs_diff_eq!(enclosed_area(&[[1.0, 2.0]]), 0.0);
}

/// `ln (rho(z1) |det D Phi| / rho(z0))` of one step, with `rho = 1/|omega|`.
fn defect(method: &Method, h: f64) -> f64 {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let system = Subject::new(&sleigh, &());
    let (q, v) = SleighState { speed: -0.6, turn_rate: 1.1, ..SleighState::default() }.to_coordinates();
    let start = system.state(&q, &v);
    let (mut integrator, mut end) = (system.integrator(method), start.clone());
    let report = integrator.step(0.0, h, &mut end).unwrap();
    let derivative = system.step_derivative(method, (0.0, h), [&start, &end], report).unwrap();
    measure_defect(&derivative, [-v[2].abs().ln(), -end.v()[2].abs().ln()])
}

/// Every method keeps the measure to its order, or better: the defect of a step is `O(h^(p+1))`, and not zero.
#[test]
fn the_defect_of_each_method() {
    for (name, order, h) in [("dla", 2.0, 0.1), ("dla4", 4.0, 0.2), ("gauss4", 4.0, 0.6)] {
        let method = Method::named(name, None).unwrap();
        let [coarse, fine] = [h, 0.5 * h].map(|h| defect(&method, h).abs());
        let measured = (coarse / fine).log2();
        println!("{name:12} h = {h}: {coarse:.1e}, order of the defect {measured:.2}");
        assert!(fine > 1e-14, "{name}: nothing to see, {fine:e}");
        assert!(measured > order + 0.7, "{name}: {measured}");
    }
}
