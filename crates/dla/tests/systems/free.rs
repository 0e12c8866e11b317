//! Without forces and time: rules and their mixtures, one, two and no constraints, any kinetic term.

use crate::support::{Four, Free, Three};
use crate::systems::models::{Disk, Hyperbolic, Kinetic, Oscillator, Particle};
use crate::systems::tools::{assert_order, assert_slope, errors, forms, run};
use dla::Dla;
use lagrangian::{Alpha, Midpoint, Trapezoid};

#[test]
fn a_particle_on_its_closed_form() {
    let (system, end) = (Particle::FREE, 3.0);
    let (particle, exact) = (Three::from(system), |t| system.exact(t));
    for (form, method) in forms(Dla::midpoint()) {
        assert_order(form, errors(&particle, method, end, exact), 2.0);
    }
    assert_order("trapezoid", errors(&particle, Dla::trapezoid(), end, exact), 2.0);
}

/// The discrete constraint need not be that of the discrete Lagrangian's rule (Cortes and Martinez 2001).
#[test]
fn mixed_rules_are_of_second_order() {
    fn order(name: &str, method: Dla, expected: f64) -> f64 {
        let [basis, multipliers] =
            forms(method).map(|(_, method)| errors(&Three::from(Hyperbolic), method, 2.0, Hyperbolic::exact));
        for (a, b) in basis.iter().flatten().zip(multipliers.iter().flatten()) {
            // 160 steps with a rounding of some ulp each.
            approx::assert_abs_diff_eq!(a, b, epsilon = 1e-12);
        }
        assert_order(name, basis, expected);
        basis[3][1]
    }
    let mut all = [
        order("midpoint", Dla::midpoint(), 2.0),
        order("trapezoid", Dla::trapezoid(), 2.0),
        order("midpoint, trapezoid", Dla::new(Midpoint, Trapezoid), 2.0),
        order("trapezoid, midpoint", Dla::new(Trapezoid, Midpoint), 2.0),
    ];
    all.sort_by(f64::total_cmp);
    assert!(all.windows(2).all(|pair| pair[1] > 1.001 * pair[0]), "the rules differ: {all:?}");
    order("alpha = 0.3", Dla::alpha(0.3).unwrap(), 1.0);
    order("mixed alpha", Dla::new(Midpoint, Alpha::new(0.2).unwrap()), 1.0);
}

#[test]
fn no_constraint_at_all() {
    let free = Oscillator { damping: 0.0, drive: 0.0 };
    let system = Free::from(free);
    for (form, method) in forms(Dla::midpoint()) {
        assert_order(form, errors(&system, method, 5.0, |t| free.exact(t)), 2.0);
        // The midpoint rule keeps quadratic invariants; what is left is the rounding of 10^4 steps, by chance
        // a hundred of half an ulp.
        let nodes = run::<_, _, 1, 0>(&system, method, free.exact(0.0), 3000.0, 10_000);
        let energy = nodes.nodes()[0].energy;
        assert!(nodes.nodes().iter().all(|node| (node.energy - energy).abs() <= 5e-14), "{form}");
    }
    // The trapezoidal rule does not: its energy oscillates by h^2 / 8 of it.
    assert_order("trapezoid", errors(&system, Dla::trapezoid(), 5.0, |t| free.exact(t)), 2.0);
    let nodes = run::<_, _, 1, 0>(&system, Dla::trapezoid(), free.exact(0.0), 3000.0, 10_000);
    let energies = || nodes.nodes().iter().map(|node| node.energy);
    let (least, most) = (energies().fold(f64::INFINITY, f64::min), energies().fold(0.0, f64::max));
    assert!((0.01..0.02).contains(&(most - least)), "{}", most - least);
}

#[test]
fn a_rolling_disk() {
    let disk = Four::from(Disk);
    for (form, method) in forms(Dla::midpoint()) {
        assert_slope(form, errors(&disk, method, 3.0, Disk::exact).map(|e| e[0]), 2.0);
    }
    for (form, method) in forms(Dla::trapezoid()) {
        assert_slope(form, errors(&disk, method, 3.0, Disk::exact).map(|e| e[0]), 2.0);
    }
    // Rolling and turning rate belong to symmetries along the constraint, and every step keeps them.
    for (form, method) in forms(Dla::midpoint()) {
        for node in run::<_, _, 4, 2>(&disk, method, Disk::exact(0.0), 30.0, 300).nodes() {
            approx::assert_abs_diff_eq!(node.v[2], 2.0, epsilon = 1e-14);
            approx::assert_abs_diff_eq!(node.v[3], 0.8, epsilon = 1e-14);
            assert!(node.energy.is_finite(), "{form}");
        }
    }
}

/// Momenta that are not linear in the velocity: the projection at the end of a step iterates, too.
#[test]
fn other_kinetic_terms_move_alike() {
    for kinetic in [Kinetic::Relativistic, Kinetic::Quartic] {
        let system = Particle { kinetic, ..Particle::FREE };
        for (form, method) in forms(Dla::midpoint()) {
            assert_order(
                &format!("{kinetic:?}, {form}"),
                errors(&Three::from(system), method, 3.0, |t| system.exact(t)),
                2.0,
            );
        }
        let mixed = Dla::new(Midpoint, Trapezoid);
        assert_order(
            &format!("{kinetic:?}, mixed"),
            errors(&Three::from(system), mixed, 3.0, |t| system.exact(t)),
            2.0,
        );
    }
    // The steps are others: only their limit is the same.
    let last = |kinetic| {
        let system = Particle { kinetic, ..Particle::FREE };
        run::<_, _, 3, 1>(&Three::from(system), Dla::midpoint(), system.exact(0.0), 3.0, 20).nodes()[20].q.clone()
    };
    assert!((last(Kinetic::Quadratic)[0] - last(Kinetic::Quartic)[0]).abs() > 1e-5);
}
