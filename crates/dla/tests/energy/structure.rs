use crate::energy::systems::{Particle, Potential, at_centre, com, distance, run};
use crate::support::{ByHand, Three};
use dla::{Energy, OneStep, Schedule, State, drive};
use lagrangian::quadrature::gauss_legendre;
use lagrangian::{Bracket, Dual, Scalar, System, energy, energy_slope, reduced_acceleration};
use sleigh::Sleigh;
use std::array::from_fn;

/// The bracket gives the same motion as the equations in full coordinates.
fn same_motion<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys, q: [f64; N], xi: [f64; N]) {
    let here = Bracket::at(system, 0.0, &q, &xi).unwrap();
    let slope = energy_slope(system, 0.0, &q, &xi).unwrap();
    let (q_rate, pi_rate) = here.rates(&slope.h_q, &xi);

    let xi_rate = reduced_acceleration(system, 0.0, &q, &xi).unwrap();
    let along = |x: [f64; N], rate: [f64; N]| from_fn(|i| Dual { re: x[i], eps: [rate[i]] });
    let moving = Bracket::at(system, Dual::<f64, 1>::zero(), &along(q, here.velocity), &along(xi, xi_rate)).unwrap();
    for i in 0..N {
        assert!((slope.pi[i] - here.quasi_momenta()[i]).abs() < 1e-14);
        assert!((q_rate[i] - here.velocity[i]).abs() < 1e-14);
        let expected = moving.quasi_momenta()[i].eps[0];
        assert!((pi_rate[i] - expected).abs() < 1e-13, "pi' {i}: {} for {expected}", pi_rate[i]);
    }
    assert!((here.energy() - energy(system, 0.0, &q, &here.velocity)).abs() < 1e-14);
    // H_q at fixed pi: the energy does not change along the motion.
    let change: f64 = (0..N).map(|i| slope.h_q[i] * q_rate[i] + xi[i] * pi_rate[i]).sum();
    assert!(change.abs() < 1e-14, "H' = {change:e}");
}

#[test]
fn bracket_and_full_coordinates_agree() {
    let sleigh = Sleigh::new(1.7, 0.6, 0.35).unwrap();
    let (q, xi) = ([0.3, -0.8, 1.1], [0.9, -1.3, 0.0]);
    same_motion(&ByHand::from(sleigh), q, xi);
    same_motion(&ByHand::from(lagrangian::With { body: sleigh, effects: Potential::EggCrate }), q, xi);
    same_motion(&com(0.35, Potential::EggCrate), q, xi);
    same_motion(&Three::from(Particle { mass: 1.3, quartic: 0.0 }), q, xi);
    same_motion(&Three::from(Particle { mass: 1.3, quartic: 0.2 }), q, xi);

    // u' = a omega^2, J omega' = -m a u omega.
    let (m, a, j) = (1.7, 0.35, sleigh.pivot_inertia());
    let here = Bracket::at(&sleigh, 0.0, &q, &xi).unwrap();
    let (_, pi_rate) = here.rates(&energy_slope(&sleigh, 0.0, &q, &xi).unwrap().h_q, &xi);
    assert!((pi_rate[0] / m - a * xi[1] * xi[1]).abs() < 1e-15);
    assert!((pi_rate[1] + m * a * xi[0] * xi[1]).abs() < 1e-15 * j.max(1.0));
}

/// One step of order 2 is `(z1 - z0)/h = B((z0 + z1)/2) DG`: with the average of the gradient along the straight line,
/// whose product with `z1 - z0` is the change of energy.
#[test]
fn one_node_is_the_discrete_gradient_method() {
    let system = com(0.4, Potential::EggCrate);
    let (q, v) = at_centre([0.5, 1.0, 0.3, 0.9, 1.7], 0.4);
    let h = 0.1;
    let quasi = |state: &State<3>| lagrangian::quasi_velocities(&system, 0.0, state.q(), state.v()).unwrap();
    let start = State::new(q, v, [false; 3]);
    let mut end = start;
    Energy::new::<1>().step(&system, 0.0, h, &mut end).unwrap();

    // In the basis of the sleigh pi = (m u, J omega) with constants, so the line is straight in xi too.
    let (q0, xi0, q1, xi1) = (start.q(), quasi(&start), end.q(), quasi(&end));
    let at = |s: f64| -> ([f64; 3], [f64; 3]) {
        (from_fn(|i| q0[i] + s * (q1[i] - q0[i])), from_fn(|i| xi0[i] + s * (xi1[i] - xi0[i])))
    };
    let inertia = [1.0, 1.0 + 0.4 * 0.4, 0.0];
    let (nodes, weights) = gauss_legendre::<8>();
    let (mut h_q, mut h_pi) = ([0.0; 3], [0.0; 3]);
    for (s, w) in nodes.iter().zip(weights) {
        let (q, xi) = at(*s);
        let slope = energy_slope(&system, 0.0, &q, &xi).unwrap();
        for i in 0..3 {
            h_q[i] += w * slope.h_q[i];
            h_pi[i] += w * xi[i];
        }
    }
    let (dq, dpi): ([f64; 3], [f64; 3]) = (from_fn(|i| q1[i] - q0[i]), from_fn(|i| inertia[i] * (xi1[i] - xi0[i])));
    let change = energy(&system, 0.0, q1, end.v()) - energy(&system, 0.0, q0, start.v());
    let product: f64 = (0..3).map(|i| h_q[i] * dq[i] + h_pi[i] * dpi[i]).sum();
    let missing = change - product;
    assert!(missing.abs() < 1e-15, "{missing:e}");
    let (middle, xi) = at(0.5);
    let (q_rate, pi_rate) = Bracket::at(&system, 0.0, &middle, &xi).unwrap().rates(&h_q, &h_pi);
    for i in 0..3 {
        assert!((q1[i] - q0[i] - h * q_rate[i]).abs() < 1e-15);
        assert!((inertia[i] * (xi1[i] - xi0[i]) - h * pi_rate[i]).abs() < 1e-15);
    }
}

fn returns<Method: OneStep<N, M>, Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    mut method: Method,
    (q, v): ([f64; N], [f64; N]),
) {
    let start = State::new(q, v, system.angles());
    let mut state = start;
    drive(system, &mut method, &Schedule { t0: 0.0, step: 0.1, steps: 100 }, &mut state, ()).unwrap();
    assert!(distance(&state, &start) > 0.1);
    drive(system, &mut method, &Schedule { t0: 10.0, step: -0.1, steps: 100 }, &mut state, ()).unwrap();
    assert!(distance(&state, &start) < 1e-12, "{:e}", distance(&state, &start));
}

/// Back with the opposite step.
#[test]
fn symmetric() {
    let crate_start = at_centre([0.5, 1.0, 0.3, 0.9, 1.7], 0.4);
    returns(&com(0.4, Potential::EggCrate), Energy::new::<1>(), crate_start);
}

/// From rest, at rest, and through the cusps of a blade without spin that runs up and down.
fn ends_coincide(at_rest: u64, step: f64, steps: u64) {
    let holds = |mut method: Energy| {
        let system = com(0.3, Potential::EggCrate);
        let on_top = ([0.0; 3], [0.0; 3]);
        let end = run(&system, &mut method, &on_top, (0.05 * at_rest as f64, at_rest));
        assert!(end.q().iter().chain(end.v()).all(|x| *x == 0.0), "at rest it stays: {end:?}");
        // Straight along x in the trough from pi: u changes sign again and again.
        let released = ([2.0, std::f64::consts::PI, 0.0], [0.0; 3]);
        for start in [released, ([1.5, 2.0, 0.4], [0.0; 3])] {
            let before = energy(&system, 0.0, &start.0, &start.1);
            let end = run(&system, &mut method, &start, (step * steps as f64, steps));
            let after = energy(&system, 0.0, end.q(), end.v());
            // Roundings walk.
            assert!((after - before).abs() < 1e-12 * (steps as f64 / 2000.0).sqrt(), "{:e}", after - before);
            assert!(distance(&end, &State::new(start.0, start.1, [false; 3])) > 0.1);
        }
    };
    holds(Energy::new::<1>());
    holds(Energy::new::<2>());
    holds(Energy::new::<3>());
    holds(Energy::new::<4>());
}

/// Five seconds, in which the blade turns back once.
#[test]
fn coinciding_ends() {
    ends_coincide(5, 0.25, 20);
}

#[test]
#[ignore = "slow"]
fn coinciding_ends_in_full() {
    ends_coincide(20, 0.05, 2000);
}
