use crate::coordinate::Place;
use scene::SceneSystem;
use sleigh::{Sleigh, SleighState};
use std::f64::consts::TAU;

/// Configuration and velocity of a start.
pub(crate) type Start<const N: usize> = ([f64; N], [f64; N]);

/// Where the sleigh is.
pub(crate) fn place<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    q: &[f64; N],
    v: &[f64; N],
) -> Place {
    Place { state: system.sleigh_state(q, v), centre: system.centre(q) }
}

/// The start with the sleigh in another state, and all else as it is.
pub(crate) fn moved<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    (q, v): &Start<N>,
    state: &SleighState,
) -> Option<Start<N>> {
    let (place, velocity) = state.to_coordinates();
    let with = |x: &[f64; N], first: &[f64; 3]| std::array::from_fn(|i| first.get(i).copied().unwrap_or(x[i]));
    let (q, v) = (with(q, &place), with(v, &velocity));
    let xi = system.quasi_velocities(0.0, &q, &v).ok()?;
    Some((q, system.velocity_of(0.0, &q, &xi).ok()?))
}

/// The start with velocities so many times as large that it has that energy (J); none where it cannot.
pub(crate) fn with_energy<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    (q, v): &Start<N>,
    wanted: f64,
) -> Option<Start<N>> {
    // The energy is quadratic in the velocity.
    let at = |factor: f64| system.energy(0.0, q, &v.map(|v| factor * v));
    let (rest, ahead, back) = (at(0.0), at(1.0), at(-1.0));
    let (square, linear) = (0.5 * (ahead + back) - rest, 0.5 * (ahead - back));
    let half = 0.5 * linear / square;
    let factor = (half * half - (rest - wanted) / square).sqrt() - half;
    (factor.is_finite() && factor >= 0.0).then(|| (*q, v.map(|v| factor * v)))
}

/// `count` starts: the first as it is, and others at the same place and of the same energy, with headings and directions of
/// motion that fill the circle evenly (the sequence R2 of Roberts 2018). Those that the energy does not allow are left out.
pub(crate) fn spread<const N: usize, const M: usize>(
    system: &dyn SceneSystem<N, M>,
    first: &Start<N>,
    sleigh: &Sleigh,
    count: u64,
) -> Vec<Start<N>> {
    let wanted = system.energy(0.0, &first.0, &first.1);
    let state = system.sleigh_state(&first.0, &first.1);
    let other = |i: u64| {
        let [turn, direction] =
            [0.754_877_666_246_692_7, 0.569_840_290_998_053_2].map(|step| TAU * (step * i as f64).fract());
        let (sin, cos) = direction.sin_cos();
        let state = SleighState {
            heading: state.heading + turn,
            speed: cos / sleigh.mass().sqrt(),
            turn_rate: sin / sleigh.pivot_inertia().sqrt(),
            ..state
        };
        with_energy(system, &moved(system, first, &state)?, wanted)
    };
    std::iter::once(*first).chain((1..count).filter_map(other)).collect()
}
