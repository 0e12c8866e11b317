//! The order of every method, on the free sleigh against its closed form.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod common;

use common::{backward, distance, sleigh, sleigh_state, state_of};
use dla::{Schedule, State};
use harness::{METHODS, Method, integrate};
use lagrangian::{Alpha, System};
use sleigh::{CentreOfMass, Exact, Sleigh, SleighState};

const STEPS: [f64; 5] = [0.2, 0.1, 0.05, 0.025, 0.0125];

/// Through the reversal, where everything happens.
fn start() -> SleighState {
    SleighState { x: 0.3, y: -0.2, heading: 0.5, turn_rate: 0.6, ..backward() }
}
const DURATION: f64 = 4.0;

fn error(sleigh: &Sleigh, method: &Method, h: f64) -> f64 {
    let mut state = state_of(sleigh, &start());
    let schedule = Schedule { t0: 0.0, step: h, steps: (DURATION / h).round() as u64 };
    integrate(sleigh, method, &schedule, &mut state, ()).unwrap();
    distance(&sleigh_state(&state), &Exact::new(sleigh, &start()).unwrap().at(DURATION))
}

fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

/// The least-squares slope over all steps of the ladder.
fn fitted(errors: &[f64]) -> f64 {
    let mut trend = harness::Trend::default();
    for (h, error) in STEPS.iter().zip(errors) {
        trend.add(h.log2(), error.log2());
    }
    trend.slope().unwrap()
}

fn short(errors: &[f64]) -> String {
    errors.iter().map(|e| format!("{e:.1e} ")).collect()
}

fn check(name: &str, errors: &[f64], order: f64, margin: f64) {
    let slope = fitted(errors);
    println!("{name:<15} order {slope:.3}, pairs {:.3?}, errors {}", orders(errors), short(errors));
    assert!(errors.iter().all(|e| *e > 1e-12), "{name}: the ladder reaches the plateau of rounding");
    assert!((slope - order).abs() <= margin, "{name}: order {slope}, expected {order} +- {margin}");
}

#[test]
fn every_method_has_its_order() {
    let sleigh = sleigh();
    for info in METHODS {
        let method = Method::named(info.name, None).unwrap();
        let errors = STEPS.map(|h| error(&sleigh, &method, h));
        let margin = if info.order == 4 { 0.1 } else { 0.05 };
        check(info.name, &errors, f64::from(method.info().order), margin);
    }
    let one_sided = Method::DlaAlpha(Alpha::new(0.25).unwrap());
    let errors = STEPS.map(|h| error(&sleigh, &one_sided, h));
    assert_eq!(one_sided.info().order, 1);
    check("alpha = 1/4", &errors, 1.0, 0.05);
}

/// The same method in other coordinates is another method, of the same order.
#[test]
fn centre_of_mass_coordinates() {
    let sleigh = sleigh();
    let system = CentreOfMass(sleigh);
    let exact = Exact::new(&sleigh, &start()).unwrap().at(DURATION);
    let (q, v) = start().to_coordinates();
    for name in ["dla", "dla-trapezoid", "rk4"] {
        let method = Method::named(name, None).unwrap();
        let errors = STEPS.map(|h| {
            let (q, v) = system.from_blade(&q, &v);
            let mut state = State::new(q, v, system.angles());
            let schedule = Schedule { t0: 0.0, step: h, steps: (DURATION / h).round() as u64 };
            integrate(&system, &method, &schedule, &mut state, ()).unwrap();
            let (q, v) = system.to_blade(&state.unwrapped(), state.v());
            distance(&SleighState::from_coordinates(&q, &v), &exact)
        });
        check(name, &errors, f64::from(method.info().order), if name == "rk4" { 0.1 } else { 0.05 });
    }
}
