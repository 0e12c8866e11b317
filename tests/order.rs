//! The order of every method, on the free sleigh against its closed form.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]
mod common;

use common::{backward, distance, sleigh, sleigh_state, state_of};
use dla::{Schedule, State};
use harness::{METHODS, Method, integrate};
use lagrangian::System;
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

/// The least-squares slope over all steps of the ladder.
fn fitted(steps: &[f64], errors: &[f64]) -> f64 {
    let mut trend = harness::Trend::default();
    for (h, error) in steps.iter().zip(errors) {
        trend.add(h.log2(), error.log2());
    }
    trend.slope().unwrap()
}

/// The rounding of these runs: some tens of steps, positions and angles of order one.
const PLATEAU: f64 = 1e-13;

fn short(errors: &[f64]) -> String {
    errors.iter().map(|e| format!("{e:.1e} ")).collect()
}

fn check(name: &str, steps: &[f64], errors: &[f64], order: f64, margin: f64) {
    let slope = fitted(steps, errors);
    println!("{name:<15} order {slope:.3}, errors {}", short(errors));
    assert!(errors.iter().all(|e| *e > PLATEAU), "{name}: the ladder reaches the plateau of rounding");
    assert!((slope - order).abs() <= margin, "{name}: order {slope}, expected {order} +- {margin}");
}

#[test]
fn methods_up_to_order_four() {
    let sleigh = sleigh();
    for info in METHODS.iter().filter(|info| info.order <= 4) {
        let method = Method::named(info.name, None).unwrap();
        let errors = STEPS.map(|h| error(&sleigh, &method, h));
        let margin = if info.order == 4 { 0.1 } else { 0.05 };
        check(info.name, &STEPS, &errors, f64::from(method.info().order), margin);
    }
    let one_sided = Method::named("dla-alpha", Some(0.25)).unwrap();
    let errors = STEPS.map(|h| error(&sleigh, &one_sided, h));
    assert_eq!(one_sided.info().order, 1);
    check("alpha = 1/4", &STEPS, &errors, 1.0, 0.05);
}

/// Of high orders double precision leaves few points between the steps that are too long and the plateau of rounding; a
/// livelier motion and the mean over many starts, which evens out the zeros of the error, make the most of them.
#[test]
fn methods_of_high_order() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.8).unwrap();
    for info in METHODS.iter().filter(|info| info.order > 4) {
        let margin = match info.order {
            6 | 8 => 0.1,
            10 => 0.15,
            12 => 0.5,
            _ => 1.0,
        };
        // So loose a tolerance lets the adaptive method make every step in one; the others have none.
        let method = Method::named(info.name, None).unwrap().with_tolerance(1e6).unwrap();
        // The four shortest steps whose error is clear of the plateau, or the three that there are.
        let (mut steps, mut errors) = (Vec::new(), Vec::new());
        for n in [4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64] {
            let error = mean_error(&sleigh, &method, n);
            if error > 2.0 * PLATEAU {
                steps.push(DURATION / n as f64);
                errors.push(error);
            }
        }
        assert!(steps.len() >= 3, "{}: too few steps above the plateau", info.name);
        let first = steps.len().saturating_sub(4);
        check(info.name, &steps[first..], &errors[first..], f64::from(info.order), margin);
    }
}

/// The root mean square of the error at the end over two dozen starts.
fn mean_error(sleigh: &Sleigh, method: &Method, steps: u64) -> f64 {
    let schedule = Schedule { t0: 0.0, step: DURATION / steps as f64, steps };
    let squares = (0..24).map(|k| {
        let start = SleighState { turn_rate: 1.5, speed: -2.0 + 0.15 * f64::from(k), ..start() };
        let mut state = state_of(sleigh, &start);
        integrate(sleigh, method, &schedule, &mut state, ()).unwrap();
        distance(&sleigh_state(&state), &Exact::new(sleigh, &start).unwrap().at(DURATION)).powi(2)
    });
    (squares.sum::<f64>() / 24.0).sqrt()
}

/// An adaptive method has a tolerance in place of the step: its error follows that, and hardly the step.
#[test]
fn the_adaptive_method_follows_its_tolerance() {
    let sleigh = sleigh();
    let method = Method::named("dop853", None).unwrap();
    for h in [DURATION, 0.5] {
        let tolerances = [1e-5, 1e-7, 1e-9, 1e-11];
        let errors = tolerances.map(|tolerance| error(&sleigh, &method.with_tolerance(tolerance).unwrap(), h));
        println!("h = {h}: errors {}", short(&errors));
        for (tolerance, error) in tolerances.iter().zip(&errors) {
            // Sixteen steps at most, and no error grows faster than the spin does, by exp(c u t) with u below 1.2 m/s.
            let growth = (1.2 * sleigh.spin_gain() * DURATION).exp();
            assert!(*error <= 16.0 * growth * tolerance, "h = {h}, tolerance {tolerance:e}: {error:e}");
        }
    }
    // Over one long interval the error is nearly proportional to it.
    let long = [1e-5, 1e-7, 1e-9, 1e-11];
    let errors = long.map(|tolerance| error(&sleigh, &method.with_tolerance(tolerance).unwrap(), DURATION));
    let slope = fitted(&long, &errors);
    assert!((0.8..=1.2).contains(&slope), "error goes with tolerance^{slope}");
    // The default asks for as much as there is to have.
    let default = error(&sleigh, &method, 0.05);
    assert!(default <= 1e-12, "default tolerance: {default:e}");
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
        check(name, &STEPS, &errors, f64::from(method.info().order), if name == "rk4" { 0.1 } else { 0.05 });
    }
}
