use crate::systems::{Particle, Potential, at_centre, com, distance, run};
use dla::{Energy, Gradient, OneStep, State};
use lagrangian::System;
use sleigh::{Exact, Sleigh, SleighState};

/// Errors at the given numbers of steps, and the least order between neighbours.
fn ladder<Sys: System<N, M>, Method: OneStep<Sys, N, M>, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut Method,
    start: &([f64; N], [f64; N]),
    duration: f64,
    steps: &[u64],
    exact: &State<N>,
) -> (Vec<f64>, Vec<f64>) {
    let errors: Vec<f64> = steps.iter().map(|n| distance(&run(system, method, start, (duration, *n)), exact)).collect();
    let orders = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    (errors, orders)
}

fn check(name: &str, (errors, orders): (Vec<f64>, Vec<f64>), order: f64) {
    let shown: String = errors.iter().map(|e| format!(" {e:.1e}")).collect();
    println!("{name}: orders {orders:.3?}, errors{shown}");
    assert!(errors.iter().all(|e| *e > 1e-12), "{name}: the ladder reaches the plateau of rounding");
    let last = orders.last().unwrap();
    assert!((last - order).abs() < 0.04 * order, "{name}: order {last}, expected {order}");
}

/// The method of order 2 with the other discrete gradient; the methods with names are measured with all others.
fn gonzalez<Sys: System<N, M>, const N: usize, const M: usize>(
    name: &str,
    system: &Sys,
    start: &([f64; N], [f64; N]),
    duration: f64,
    first: u64,
    exact: &State<N>,
) {
    let steps = [first, 2 * first, 4 * first];
    check(name, ladder(system, &mut Energy::with(Gradient::Gonzalez), start, duration, &steps, exact), 2.0);
}

/// Through the reversal, against the closed form, with no parameter equal to one.
#[test]
fn free_sleigh() {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let start = SleighState { x: 0.3, y: -0.2, heading: 0.5, speed: -0.9, turn_rate: 0.8 };
    let (q, v) = Exact::new(&sleigh, &start).unwrap().at(4.0).to_coordinates();
    let exact = State::new(q, v, sleigh.angles());
    gonzalez("free sleigh", &sleigh, &start.to_coordinates(), 4.0, 64, &exact);
}

/// Against a run in 30 digits.
#[test]
fn egg_crate() {
    let end = [6.116263299104192, 12.39178403258227, 1.011883547635337, 0.4666370265451718, 0.0372610222581567];
    let system = com(0.5, Potential::EggCrate);
    let (q, v) = at_centre(end, 0.5);
    let exact = State::new(q, v, [false; 3]);
    gonzalez("egg-crate", &system, &at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5), 10.0, 128, &exact);
}

/// Masses that depend on the place, a magnetic field, an energy that is not quadratic: against itself at small steps.
#[test]
fn particle() {
    let system = Particle { mass: 1.3, quartic: 0.2 };
    let start = ([0.3, 0.5, -0.2], [0.6, -0.4, 0.3]);
    let exact = run(&system, &mut Energy::<4>::new(), &start, (3.0, 300));
    gonzalez("particle", &system, &start, 3.0, 64, &exact);
}
