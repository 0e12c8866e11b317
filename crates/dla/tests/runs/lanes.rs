use crate::{backward, sleigh};
use approx::assert_abs_diff_eq;
use dla::{
    ClosedEnsemble, Dla, Each, Ensemble, Gauss, GaussEnsemble, LaneState, OneStep, Same, Schedule, State, drive,
};
use lagrangian::{System, With, velocity_of};
use proptest::prelude::*;
use sleigh::effects::Bowl;
use sleigh::{Sleigh, SleighState};

const W: usize = 16;
type Closed = ClosedEnsemble<Sleigh, 2, W, 3, 1, 5, 6>;
type Start = ([f64; 3], [f64; 3]);

/// Configuration and quasi-velocities.
fn reduced(start: &SleighState) -> Start {
    ([start.x, start.y, start.heading], [start.speed, start.turn_rate, 0.0])
}

/// One trajectory by the code of one trajectory; none where it fails.
fn alone<Sys: System<3, 1>>(
    system: &Sys,
    mut method: impl OneStep<Sys, 3, 1>,
    (h, steps): (f64, u64),
    (q, xi): &Start,
) -> Option<State<3>> {
    let v = velocity_of(system, 0.0, q, xi).unwrap();
    let mut state = State::new(*q, v, system.angles());
    drive(system, &mut method, &Schedule { t0: 0.0, step: h, steps }, &mut state, ()).ok().map(|_| state)
}

/// What rounding may do in a run of a sleigh: so many units in the last place a step of the largest numbers, which the spin
/// lets grow by at most `exp(c U t)`.
fn rounding(sleigh: &Sleigh, (q, xi): &Start, (h, steps): (f64, u64)) -> f64 {
    let speed = xi[0].hypot(xi[1] * (sleigh.pivot_inertia() / sleigh.mass()).sqrt());
    let t = h * steps as f64;
    let size = 1.0 + q.iter().fold(0.0, |size: f64, q| size.max(q.abs())) + speed * t + xi[1].abs();
    16.0 * f64::EPSILON * steps as f64 * size * (1.0 + speed * t) * (sleigh.spin_gain().abs() * speed * t).exp()
}

fn assert_same<const N: usize>(ensemble: &impl Ensemble<3, N>, lane: usize, expected: &State<3>, tolerance: f64) {
    let found = ensemble.state().lane(lane, *expected.v());
    for (a, b) in found.unwrapped().iter().zip(expected.unwrapped()) {
        assert_abs_diff_eq!(*a, b, epsilon = tolerance);
    }
    let [u, omega, _] = ensemble.state().xi(lane);
    let expected = SleighState::from_coordinates(&expected.unwrapped(), expected.v());
    assert_abs_diff_eq!(u, expected.speed, epsilon = tolerance);
    assert_abs_diff_eq!(omega, expected.turn_rate, epsilon = tolerance);
}

fn sleighs() -> impl Strategy<Value = Sleigh> {
    (0.3..3.0f64, 0.3..3.0f64, prop_oneof![4 => -1.0..1.0, 1 => Just(0.0)])
        .prop_map(|(m, i, a)| Sleigh::new(m, i, a).unwrap())
}

fn starts() -> impl Strategy<Value = Start> {
    let spin = prop_oneof![6 => -2.0..2.0f64, 1 => Just(0.0), 1 => -1e-200..1e-200, 1 => 4.0..9.0];
    (-5.0..5.0f64, -5.0..5.0f64, -9.0..9.0f64, -1.5..1.5f64, spin)
        .prop_map(|(x, y, heading, speed, turn_rate)| reduced(&SleighState { x, y, heading, speed, turn_rate }))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Lanes with their own sleighs give what the code of one sleigh gives, to round-off, whether their steps are quick, wide,
    /// or the map of one; and are lost where that has no step.
    #[test]
    fn closed_maps_in_lanes_are_those_of_one(
        members in prop::collection::vec((sleighs(), starts()), W),
        h in prop_oneof![0.005..0.1f64, 0.1..0.4f64, -0.1..-0.01f64],
    ) {
        let run = (h, 70);
        let systems = std::array::from_fn(|i| members[i].0);
        let states: Vec<_> = members.iter().map(|(_, start)| *start).collect();
        let mut ensemble = Closed::new(systems, h, LaneState::new(&states, [false, false, true]));
        ensemble.advance(run.1);
        for (lane, (sleigh, start)) in members.iter().enumerate() {
            match alone(sleigh, Dla::midpoint(), run, start) {
                Some(state) => assert_same(&ensemble, lane, &state, rounding(sleigh, start, (h.abs(), run.1))),
                None => prop_assert!(!ensemble.state().is_finite(lane)),
            }
        }
    }

    /// What a lane gives does not depend on the others, to the last bit.
    #[test]
    fn neighbours_change_no_bit(member in (sleighs(), starts()), other in (sleighs(), starts()), h in 0.01..0.3f64) {
        let run = |neighbour: (Sleigh, Start)| {
            let members: Vec<_> = (0..W).map(|i| if i == 5 { member } else { neighbour }).collect();
            let states: Vec<_> = members.iter().map(|(_, start)| *start).collect();
            let systems = std::array::from_fn(|i| members[i].0);
            let mut ensemble = Closed::new(systems, h, LaneState::new(&states, [false, false, true]));
            ensemble.advance(70);
            (ensemble.state().q(5).map(f64::to_bits), ensemble.state().xi(5).map(f64::to_bits))
        };
        prop_assert_eq!(run(member), run(other));
    }

    /// Collocation in lanes is that of one sleigh, free and in a bowl, each with its own parameters.
    #[test]
    fn collocation_in_lanes_is_that_of_one(
        members in prop::collection::vec((sleighs(), starts(), 0.0..0.3f64), W),
        h in 0.02..0.1f64,
    ) {
        let run = (h, 20);
        let states: Vec<_> = members.iter().map(|(_, start, _)| *start).collect();
        let state = LaneState::new(&states, [false, false, true]);
        let free: [Sleigh; W] = std::array::from_fn(|i| members[i].0);
        let mut alike = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Each(&free), (0.0, h), state).unwrap();
        alike.advance(run.1);
        let bowls: [_; W] = std::array::from_fn(|i| {
            With { body: free[i], effects: Bowl::new([members[i].2, 0.1], [0.5, 0.0]).unwrap() }
        });
        let mut bowl = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Each(&bowls), (0.0, h), state).unwrap();
        bowl.advance(run.1);
        for (lane, (sleigh, start, _)) in members.iter().enumerate() {
            let t = h * run.1 as f64;
            // The stages are found to rounding by both, and the well adds forces of some newtons to what the spin lets grow.
            let tolerance = 4.0 * rounding(sleigh, start, run) * (t * 3.0).exp();
            let expected = alone(sleigh, Gauss::<4>::default(), run, start).unwrap();
            assert_same(&alike, lane, &expected, tolerance);
            let expected = alone(&bowls[lane], Gauss::<8>::default(), run, start).unwrap();
            assert_same(&bowl, lane, &expected, tolerance);
        }
    }
}

#[test]
fn a_lane_that_fails_leaves_the_others_alone() {
    // The steps are so long that one that goes backward has none where it swings round.
    let (sleigh, h) = (sleigh(), 2.9);
    let swinging = SleighState { speed: -1.5, turn_rate: 1e-3, ..backward() };
    let (quick, usual) = (SleighState { turn_rate: 8.0, ..backward() }, SleighState { speed: 1.0, ..backward() });
    let states: Vec<_> = (0..W).map(|i| reduced(if i == 3 { &swinging } else { &usual })).collect();
    let mut ensemble = Closed::new([sleigh; W], h, LaneState::new(&states, [false, false, true]));
    ensemble.advance(10);
    assert!(alone(&sleigh, Dla::midpoint(), (h, 10), &states[3]).is_none());
    let whole: Vec<bool> = (0..W).map(|lane| ensemble.state().is_finite(lane)).collect();
    assert_eq!(whole, (0..W).map(|lane| lane != 3).collect::<Vec<_>>());

    // Far too long a step for the iteration; beside it a sleigh at rest, whose stages settle at once.
    let rest = reduced(&SleighState { speed: 0.0, turn_rate: 0.0, ..backward() });
    let states: Vec<_> = (0..W).map(|i| if i == 3 { reduced(&quick) } else { rest }).collect();
    let state = LaneState::new(&states, [false, false, true]);
    let mut ensemble = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Same(&sleigh), (0.0, 40.0), state).unwrap();
    ensemble.advance(2);
    assert!((0..W).all(|lane| ensemble.state().is_finite(lane) == (lane != 3)));
}

#[test]
fn one_system_for_all_is_as_each_its_own() {
    let states: Vec<_> = (0..W).map(|i| reduced(&SleighState { turn_rate: 0.02 * i as f64, ..backward() })).collect();
    let state = LaneState::new(&states, [false, false, true]);
    let bowl = With { body: sleigh(), effects: Bowl::new([0.1, 0.2], [0.0, 0.0]).unwrap() };
    let bowls: [_; W] = std::array::from_fn(|_| bowl.clone());
    let mut same = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Same(&bowl), (0.0, 0.5), state).unwrap();
    let mut each = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Each(&bowls), (0.0, 0.5), state).unwrap();
    same.advance(40);
    each.advance(40);
    assert!((0..W).all(|lane| same.state().q(lane) == each.state().q(lane)));
    assert!(same.state().q(0) != same.state().q(1));
}

/// What the steps of an ensemble leave out does not add up: the energy of each wanders by rounding, as that of one alone.
#[test]
fn many_steps_lose_no_energy_but_by_rounding() {
    let bowl = With { body: sleigh(), effects: Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap() };
    let states: Vec<_> = (0..W).map(|i| reduced(&SleighState { turn_rate: 0.05 * i as f64, ..backward() })).collect();
    let wander = |settled: Option<f64>| {
        let state = LaneState::new(&states, [false, false, true]);
        let mut ensemble = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Same(&bowl), (0.0, 0.05), state).unwrap();
        ensemble.settled = settled.unwrap_or(ensemble.settled);
        ensemble.advance(STEPS);
        let energy = |q: &[f64; 3], xi: &[f64; 3]| {
            let v = velocity_of(&bowl, 0.0, q, xi).unwrap();
            lagrangian::energy(&bowl, 0.0, q, &v)
        };
        let off = |lane: usize| {
            let (q, xi) = (ensemble.state().q(lane), ensemble.state().xi(lane));
            let before = energy(&states[lane].0, &states[lane].1);
            (energy(&q, &xi) - before).abs() / before
        };
        (0..W).map(off).fold(0.0, f64::max)
    };
    const STEPS: u64 = 100_000;
    // Sums that are rounded by less than `eps E` in every step are off by five times this once in a million.
    let walk = 5.0 * f64::EPSILON * (STEPS as f64).sqrt();
    let [kept, lost] = [None, Some(1e-9)].map(wander);
    assert!(kept < walk, "{kept:e} of {walk:e}");
    assert!(lost > walk, "{lost:e} of {walk:e}");
}
