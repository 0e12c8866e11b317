//! Orders above eight, and that of the adaptive method.
//!
//! With long steps the error of Gauss collocation is governed by the singularities of the motion in complex time, and falls
//! unevenly; by where the power of the step is left alone, double precision is at its end. A motion without singularities,
//! as that of the knife edge, shows the power from the longest step on; of others the mean over many starts is seen.

use crate::case::{Case, Facts, Point, Row};
use crate::rows::{named, table};
use crate::shapes::Three;
use crate::tools::{fitted_order, method};
use dla::Schedule;
use harness::METHODS;
use sleigh::Sleigh;

/// The error at the time `t`, of so many steps.
fn error(case: &dyn Case, name: &str, start: &Point, t: f64, steps: u64) -> f64 {
    let schedule = Schedule { t0: 0.0, step: t / steps as f64, steps };
    let end = case.run(&method(name), start, &schedule, &mut |_| {}).unwrap();
    end.distance(&case.exact_from(start, t).unwrap())
}

#[test]
fn on_a_motion_without_singularities() {
    let case = named("knife edge on an incline");
    let duration = 40.0;
    for info in METHODS.iter().filter(|info| info.order > 8) {
        let errors =
            (13..80).map(|n| (duration / n as f64, error(case.as_ref(), info.name, &case.start(), duration, n)));
        // The rounding of some dozen steps to a place forty metres away is a few 1e-14.
        let ladder: Vec<(f64, f64)> = errors.filter(|(_, error)| *error > 2e-12).collect();
        let order = fitted_order(&ladder);
        println!("{:<8} order {order:.3}, {} steps, errors {:.0e} ..", info.name, ladder.len(), ladder[0].1);
        assert!(ladder.len() >= 5);
        assert!((order - f64::from(info.order)).abs() <= 0.1, "{}: order {order}, {ladder:?}", info.name);
    }
}

/// The root mean square over two dozen starts evens out the zeros of the error.
#[test]
fn on_the_sleigh_in_the_mean() {
    let system = Sleigh::new(1.0, 1.0, 0.8).unwrap().into();
    let case: Row<Three, 3> =
        Row { name: "livelier sleigh", system, start: Default::default(), duration: 4.0, facts: Facts::default() };
    let starts: Vec<Point> = (0..24)
        .map(|k| {
            let (heading, speed) = (0.5f64, -2.0 + 0.15 * f64::from(k));
            let v = vec![speed * heading.cos(), speed * heading.sin(), 1.5];
            Point { q: vec![0.3, -0.2, heading], v }
        })
        .collect();
    let mean = |name: &str, steps| {
        let squares = starts.iter().map(|start| {
            let schedule = Schedule { t0: 0.0, step: case.duration / steps as f64, steps };
            let end = case.run(&method(name), start, &schedule, &mut |_| {}).unwrap();
            let exact = case.exact_from(start, case.duration).unwrap();
            let apart = |i: usize| end.q[i] - exact.q[i];
            apart(0).hypot(apart(1)).max(apart(2).abs()).powi(2)
        });
        (squares.sum::<f64>() / 24.0).sqrt()
    };
    for info in METHODS.iter().filter(|info| info.order > 8 || info.name == "dop853") {
        let errors =
            [4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64].map(|n| (4.0 / n as f64, mean(info.name, n)));
        let ladder: Vec<(f64, f64)> = errors.into_iter().filter(|(_, error)| *error > 2e-13).collect();
        let order = crate::tools::slope(&ladder[ladder.len().saturating_sub(4)..]);
        let margin = match info.order {
            8 | 10 => 0.15,
            12 => 0.5,
            _ => 1.0,
        };
        println!("{:<8} mean over starts: order {order:.3} of {ladder:?}", info.name);
        assert!(ladder.len() >= 3);
        assert!((order - f64::from(info.order)).abs() <= margin, "{}: order {order}", info.name);
    }
}

/// On every row and at every step a stage more is worth its while, down to the rounding.
#[test]
fn more_stages_are_more_accurate() {
    for case in table().iter().filter(|case| !case.facts().without_basis) {
        let reference = case.end(&method("gauss16"), (case.duration() * 100.0) as u64).unwrap();
        let steps = (2.0 * case.duration()) as u64;
        let errors = ["gauss8", "gauss10", "gauss12", "gauss14", "gauss16"]
            .map(|name| case.end(&method(name), steps).unwrap().distance(&reference));
        println!("{:<32} 8 to 16: {errors:?}", case.name());
        for pair in errors.windows(2).filter(|pair| pair[0] > 1e-13 * reference.size()) {
            assert!(pair[1] < 0.5 * pair[0], "{}: {errors:?}", case.name());
        }
    }
}
