use scene::{Built, SceneSystem, StartPlace};
use sleigh::Sleigh;
use std::f64::consts::TAU;

/// The start with its velocities scaled so that its energy is `wanted` (J); `None` if no factor does that.
pub(crate) fn with_energy(system: &Built<'_>, (q, v): &StartPlace, wanted: f64) -> Option<StartPlace> {
    // The energy is quadratic in the velocity.
    let scaled = |factor: f64| -> Vec<f64> { v.iter().map(|v| factor * v).collect() };
    let mechanism = system.mechanism();
    let at = |factor: f64| mechanism.energy(0.0, q, &scaled(factor));
    let (rest, ahead, back) = (at(0.0), at(1.0), at(-1.0));
    let (square, linear) = (0.5 * (ahead + back) - rest, 0.5 * (ahead - back));
    let half = 0.5 * linear / square;
    let factor = (half * half - (rest - wanted) / square).sqrt() - half;
    (factor.is_finite() && factor >= 0.0).then(|| (q.clone(), scaled(factor)))
}

/// The steps of sequences that fill squares and cubes evenly (Roberts 2018): powers of the roots of `x^(d + 1) = x + 1`.
fn sequence(dimensions: usize) -> impl Fn(u64, usize) -> f64 {
    let mut root = 2.0_f64;
    for _ in 0..64 {
        root = (1.0 + root).powf(1.0 / (dimensions as f64 + 1.0));
    }
    move |i, k| (root.powi(-(k as i32 + 1)) * i as f64).fract()
}

/// `count` starts: `first`, then starts at the same place and of the same energy, with directions of motion that fill the sphere of
/// directions evenly. Starts of a sleigh differ in heading too. Starts that the energy does not allow are left out.
pub(crate) fn spread(system: &Built<'_>, first: &StartPlace, sleigh: Option<&Sleigh>, count: u64) -> Vec<StartPlace> {
    let wanted = system.mechanism().energy(0.0, &first.0, &first.1);
    let turned = |i: u64| match system.sleigh().zip(sleigh) {
        Some((blade, sleigh)) => turned(system, blade, sleigh, first, i),
        None => directed(system, first, i),
    };
    let other = |i: u64| with_energy(system, &turned(i)?, wanted);
    std::iter::once(first.clone()).chain((1..count).filter_map(other)).collect()
}

/// The sleigh with another heading, moving in another direction.
fn turned(
    system: &Built<'_>,
    blade: &dyn SceneSystem,
    sleigh: &Sleigh,
    first: &StartPlace,
    i: u64,
) -> Option<StartPlace> {
    let [turn, direction] =
        [0.754_877_666_246_692_7, 0.569_840_290_998_053_2].map(|step| TAU * (step * i as f64).fract());
    let (sin, cos) = direction.sin_cos();
    let heading = blade.sleigh_state(&first.0, &first.1).heading + turn;
    let values = [heading, cos / sleigh.mass().sqrt(), sin / sleigh.pivot_inertia().sqrt()];
    ["heading", "speed", "turn_rate"]
        .into_iter()
        .zip(values)
        .try_fold(first.clone(), |start, (name, value)| system.with(&start, system.named(name)?, value))
}

/// The system at the same place, with quasi-velocities in direction `i` of a sequence that fills the sphere of kinetic energy evenly.
fn directed(system: &Built<'_>, first: &StartPlace, i: u64) -> Option<StartPlace> {
    let (n, m) = system.own();
    let count = n - m;
    let next = sequence(count);
    // Pairs of uniform numbers make pairs of normal ones (Box and Muller 1958), whose directions are uniform.
    let direction: Vec<f64> = (0..count)
        .map(|k| {
            let [a, b] = [2 * (k / 2), 2 * (k / 2) + 1].map(|k| next(i, k));
            let (sin, cos) = (TAU * b).sin_cos();
            (-2.0 * (1.0 - a).ln()).sqrt() * if k % 2 == 0 { cos } else { sin }
        })
        .collect();
    let q = &first.0;
    let mechanism = system.mechanism();
    let energy = |xi: &[f64]| Some(mechanism.energy(0.0, q, &mechanism.velocity_of(0.0, q, xi).ok()?));
    let mut xi = vec![0.0; q.len()];
    let rest = energy(&xi)?;
    let unit = |k: usize, sign: f64| -> Vec<f64> { (0..q.len()).map(|j| if j == k { sign } else { 0.0 }).collect() };
    for (k, part) in direction.iter().enumerate() {
        let twice = energy(&unit(k, 1.0))? + energy(&unit(k, -1.0))? - 2.0 * rest;
        xi[k] = if twice > 0.0 { part / twice.sqrt() } else { 0.0 };
    }
    Some((q.clone(), mechanism.velocity_of(0.0, q, &xi).ok()?))
}
