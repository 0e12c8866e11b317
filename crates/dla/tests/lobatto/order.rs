use crate::energy::systems::{Potential, at_centre, com, run};
use crate::lobatto::systems::{Forces, Moving, Particle, distance, reference, sleigh};
use crate::support::{ByHand, Three};
use dla::Lobatto;
use lagrangian::{System, With};

/// A start, and the place where its motion ends.
struct Case<'a, Sys> {
    name: &'a str,
    system: Sys,
    start: ([f64; 3], [f64; 3]),
    end: ([f64; 3], [f64; 3]),
    duration: f64,
}

/// The least-squares slope of the errors over a ladder of steps, the plateau of rounding left out.
fn order<Sys: System<3, 1>, const S: usize>(case: &Case<Sys>, ladder: [u64; 4]) {
    let errors = ladder.map(|steps| {
        let end = run(&case.system, &mut Lobatto::<S>::new(), &case.start, (case.duration, steps));
        distance(&end, &case.end)
    });
    let kept = errors.iter().zip(ladder).filter(|(error, _)| **error > 1e-12);
    let points: Vec<(f64, f64)> = kept.map(|(error, steps)| ((steps as f64).log2(), error.log2())).collect();
    let n = points.len() as f64;
    let (x, y) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    let expected = 2.0 * S as f64 - 2.0;
    let shown = errors.map(|error| format!("{error:.1e}")).join(" ");
    println!("{:<22} S = {S}: order {:.3}, errors {shown} in {ladder:?} steps", case.name, -slope);
    assert!(points.len() >= 3, "{}: the ladder reaches the plateau of rounding", case.name);
    assert!((slope + expected).abs() < 0.1, "{}: order {}, expected {expected}", case.name, -slope);
}

/// The method with two stages, by steps of a twentieth and less; those with more have their names, and their orders are measured with those of all methods.
fn orders<Sys: System<3, 1>>(case: &Case<Sys>) {
    order::<Sys, 2>(case, [20, 40, 80, 160].map(|steps| (steps as f64 * case.duration).round() as u64));
}

#[test]
fn particle() {
    let duration = 4.0;
    let (start, end) = (Particle::START, Particle::exact(duration));
    orders(&Case { name: "particle", system: Three::from(Particle), start, end, duration });
}

#[test]
fn egg_crate() {
    let (system, start) = (com(0.5, Potential::EggCrate), at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5));
    let end = reference(&system, &start, 4.0);
    orders(&Case { name: "egg-crate", system, start, end, duration: 4.0 });
}

/// Masses that depend on the heading, for the blade is the point of reference.
#[test]
fn forced() {
    let system = ByHand::from(With { body: sleigh(0.5), effects: Forces });
    let (sin, cos) = f64::sin_cos(0.3);
    let start = ([0.1, -0.2, 0.3], [0.8 * cos, 0.8 * sin, 0.9]);
    let end = reference(&system, &start, 4.0);
    orders(&Case { name: "forced sleigh", system, start, end, duration: 4.0 });
}

fn affine_and_time_dependent_over(duration: f64) {
    // z' = y x' - sin(t + z) y'/2 - .3 cos t - .2 x
    let (q, [vx, vy]): ([f64; 3], [f64; 2]) = ([0.3, -0.2, 0.1], [0.6, 0.5]);
    let start = (q, [vx, vy, q[1] * vx - 0.5 * q[2].sin() * vy - 0.3 - 0.2 * q[0]]);
    let system = Three::from(Moving);
    let end = reference(&system, &start, duration);
    orders(&Case { name: "affine, time-dependent", system, start, end, duration });
}

#[test]
fn affine_and_time_dependent() {
    affine_and_time_dependent_over(1.0);
}

#[test]
#[ignore = "slow"]
fn affine_and_time_dependent_in_full() {
    affine_and_time_dependent_over(4.0);
}
