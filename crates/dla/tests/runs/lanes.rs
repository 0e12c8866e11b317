use crate::runs::{backward, sleigh};
use crate::support::ByHand;
use approx::assert_abs_diff_eq;
use dla::{Each, Ensemble, Gauss, GaussAdaptive, GaussEnsemble, LaneState, OneStep, Same, Schedule, State, drive};
use lagrangian::{AdmissibleBasis, Constraint, Reduced, Scalar, System, With, velocity_of};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Torque};
use sleigh::{ClosedEnsemble, ClosedMap, RoundWell, Sleigh, SleighState, TimeFunction};

const W: usize = 16;
type Closed = ClosedEnsemble<W>;
type Start = ([f64; 3], [f64; 3]);

fn state_of(&([x, y, heading], [speed, turn_rate, _]): &Start) -> SleighState {
    SleighState { x, y, heading, speed, turn_rate }
}

/// Configuration and quasi-velocities.
fn reduced(start: &SleighState) -> Start {
    ([start.x, start.y, start.heading], [start.speed, start.turn_rate, 0.0])
}

/// One trajectory by the code of one trajectory; none where it fails.
fn alone<Sys: System<3, 1>>(
    system: &Sys,
    mut method: impl OneStep<3, 1>,
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
            match alone(&ByHand::from(*sleigh), ClosedMap::of(*sleigh), run, start) {
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

    #[test]
    #[ignore = "slow"]
    fn collocation_in_lanes_is_that_of_one_in_full(members in members(), h in 0.02..0.1f64) {
        collocation_is_that_of_one(&members, h);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2, ..ProptestConfig::default() })]

    #[test]
    fn collocation_in_lanes_is_that_of_one(members in members(), h in 0.02..0.1f64) {
        collocation_is_that_of_one(&members, h);
    }
}

/// A sleigh for each lane, its start, and the stiffness of its bowl.
fn members() -> impl Strategy<Value = Vec<(Sleigh, Start, f64)>> {
    prop::collection::vec((sleighs(), starts(), 0.0..0.3f64), W)
}

/// Collocation in lanes is that of one sleigh, free and in a bowl, each with its own parameters.
fn collocation_is_that_of_one(members: &[(Sleigh, Start, f64)], h: f64) {
    let run = (h, 20);
    let states: Vec<_> = members.iter().map(|(_, start, _)| *start).collect();
    let state = LaneState::new(&states, [false, false, true]);
    let free: [_; W] = std::array::from_fn(|i| ByHand::from(members[i].0));
    let mut alike = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Each(&free), (0.0, h), state).unwrap();
    alike.advance(run.1);
    let bowls: [_; W] = std::array::from_fn(|i| With {
        body: members[i].0,
        effects: Bowl::new([members[i].2, 0.1], [0.5, 0.0]).unwrap(),
    });
    let bowls = bowls.map(ByHand::from);
    let mut bowl = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Each(&bowls), (0.0, h), state).unwrap();
    bowl.advance(run.1);
    // In the axes of the sleigh, where the places depend on each other.
    let wells: [_; W] = std::array::from_fn(|i| RoundWell::new(members[i].0, members[i].2, [0.5, 0.0]).unwrap());
    let own: Vec<_> =
        wells.iter().zip(&states).map(|(well, start)| (well.coordinates(&state_of(start)).0, start.1)).collect();
    let (wells, state) = (wells.map(ByHand::from), LaneState::new(&own, [false, false, true]));
    let mut well = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Each(&wells), (0.0, h), state).unwrap();
    well.advance(run.1);
    for (lane, (sleigh, start, _)) in members.iter().enumerate() {
        let t = h * run.1 as f64;
        // The stages are found to rounding by both, and the well adds forces of some newtons to what the spin lets grow.
        let tolerance = 4.0 * rounding(sleigh, start, run) * (t * 3.0).exp();
        let expected = alone(&free[lane], Gauss::new::<4>(), run, start).unwrap();
        assert_same(&alike, lane, &expected, tolerance);
        let expected = alone(&bowls[lane], Gauss::new::<8>(), run, start).unwrap();
        assert_same(&bowl, lane, &expected, tolerance);
        let expected = alone(&wells[lane], Gauss::new::<8>(), run, &own[lane]).unwrap();
        let found = well.state().lane(lane, *expected.v()).unwrapped();
        assert_abs_diff_eq!(&found[..], &expected.unwrapped()[..], epsilon = tolerance);
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
    assert!(alone(&ByHand::from(sleigh), ClosedMap::of(sleigh), (h, 10), &states[3]).is_none());
    let whole: Vec<bool> = (0..W).map(|lane| ensemble.state().is_finite(lane)).collect();
    assert_eq!(whole, (0..W).map(|lane| lane != 3).collect::<Vec<_>>());

    // Far too long a step for the iteration; beside it a sleigh at rest, whose stages settle at once.
    let rest = reduced(&SleighState { speed: 0.0, turn_rate: 0.0, ..backward() });
    let states: Vec<_> = (0..W).map(|i| if i == 3 { reduced(&quick) } else { rest }).collect();
    let state = LaneState::new(&states, [false, false, true]);
    let system = ByHand::from(sleigh);
    let mut ensemble = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Same(&system), (0.0, 40.0), state).unwrap();
    ensemble.advance(2);
    assert!((0..W).all(|lane| ensemble.state().is_finite(lane) == (lane != 3)));
}

#[test]
fn one_system_for_all_is_as_each_its_own() {
    let states: Vec<_> = (0..W).map(|i| reduced(&SleighState { turn_rate: 0.02 * i as f64, ..backward() })).collect();
    let state = LaneState::new(&states, [false, false, true]);
    let bowl = ByHand::from(With { body: sleigh(), effects: Bowl::new([0.1, 0.2], [0.0, 0.0]).unwrap() });
    let bowls: [_; W] = std::array::from_fn(|_| bowl.clone());
    let mut same = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Same(&bowl), (0.0, 0.5), state).unwrap();
    let mut each = GaussEnsemble::<_, _, 8, W, 3, 1>::new(Each(&bowls), (0.0, 0.5), state).unwrap();
    same.advance(40);
    each.advance(40);
    assert!((0..W).all(|lane| same.state().q(lane) == each.state().q(lane)));
    assert!(same.state().q(0) != same.state().q(1));
}

/// A torque acts at the time of each stage, whenever a run begins and however its steps are asked for.
#[test]
fn time_goes_on_in_lanes() {
    let torque = TimeFunction::Sine { amplitude: 0.8, frequency: 2.0, phase: 0.3 };
    let system = ByHand::from(With { body: sleigh(), effects: Torque::new(torque).unwrap() });
    let starts: Vec<_> = (0..W).map(|i| reduced(&SleighState { speed: 0.05 * i as f64, ..backward() })).collect();
    let state = LaneState::new(&starts, [false, false, true]);
    let (t0, h) = (0.7, 0.1);
    let mut ensemble = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Same(&system), (t0, h), state).unwrap();
    ensemble.advance(7);
    ensemble.advance(13);
    for (lane, start) in starts.iter().enumerate() {
        let mut expected = State::new(start.0, velocity_of(&system, t0, &start.0, &start.1).unwrap(), system.angles());
        let schedule = Schedule { t0, step: h, steps: 20 };
        drive(&system, &mut Gauss::new::<4>(), &schedule, &mut expected, ()).unwrap();
        // As in the bowl: the torque adds less than a newton metre.
        let tolerance = 4.0 * rounding(&sleigh(), start, (h, 20)) * (20.0 * h * 3.0).exp();
        assert_same(&ensemble, lane, &expected, tolerance);
    }
}

/// The largest reaction of a lane is that of one trajectory, whether its steps are quick, wide, or the map of one.
#[test]
fn the_largest_reaction_of_every_lane() {
    let (sleigh, h, steps) = (Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.15, 20);
    let turn_rate = |lane: usize| [0.1, 1.0, 5.0, -0.2][lane % 4];
    let starts: Vec<_> = (0..W)
        .map(|lane| reduced(&SleighState { speed: 0.4 - 0.1 * lane as f64, turn_rate: turn_rate(lane), ..backward() }))
        .collect();
    let mut ensemble = Closed::new([sleigh; W], h, LaneState::new(&starts, [false, false, true]));
    ensemble.advance(steps);
    for (lane, start) in starts.iter().enumerate() {
        let mut state = State::new(start.0, velocity_of(&sleigh, 0.0, &start.0, &start.1).unwrap(), sleigh.angles());
        let (mut map, mut largest) = (ClosedMap::of(sleigh), 0.0f64);
        for k in 0..steps {
            let report = map.step(&ByHand::from(sleigh), k as f64 * h, h, &mut state).unwrap();
            largest = largest.max((report.impulses[0][0] + report.impulses[1][0]).abs() / h);
        }
        // A momentum has the rounding of the velocities, the masses being near one.
        let tolerance = 2.0 * rounding(&sleigh, start, (h, steps)) / h;
        assert_abs_diff_eq!(ensemble.largest_multiplier(lane), largest, epsilon = tolerance);
        // Some have made full turns.
        assert_same(&ensemble, lane, &state, rounding(&sleigh, start, (h, steps)));
        assert!(largest > 1e3 * tolerance, "the control: {largest:e} is more than rounding, {tolerance:e}");
    }
}

/// Eight lanes iterate until the slowest of them has settled, from the polynomial of the step before; less when less is asked for.
#[test]
fn stages_in_lanes_settle_with_the_slowest() {
    let (sleigh, h, steps) = (ByHand::from(sleigh()), 0.2, 40);
    let starts: Vec<_> =
        (0..W).map(|lane| reduced(&SleighState { turn_rate: 0.1 * lane as f64, ..backward() })).collect();
    let begin = LaneState::new(&starts, [false, false, true]);
    let run = |settled: Option<f64>| {
        let mut ensemble = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Same(&sleigh), (0.0, h), begin).unwrap();
        ensemble.settled = settled.unwrap_or(ensemble.settled);
        ensemble.advance(steps);
        ensemble
    };
    // The slowest of each eight, step by step.
    let mut most = vec![[0; W / 8]; steps as usize];
    for (lane, start) in starts.iter().enumerate() {
        let mut state = State::new(start.0, velocity_of(&sleigh, 0.0, &start.0, &start.1).unwrap(), sleigh.angles());
        let mut method = Gauss::new::<4>();
        for (k, most) in most.iter_mut().enumerate() {
            let report = method.step(&sleigh, k as f64 * h, h, &mut state).unwrap();
            most[lane / 8] = report.iterations.max(most[lane / 8]);
        }
    }
    let alone: u32 = most.as_flattened().iter().sum();
    let (whole, loose) = (run(None), run(Some(1e-7)));
    println!("{} sweeps, alone {alone}, to 1e-7 {}", whole.sweeps(), loose.sweeps());
    // By the same rule; that of lanes takes one contraction for all components, so it may be an iteration off.
    assert!(
        whole.sweeps().abs_diff(u64::from(alone)) <= steps * (W as u64 / 8),
        "{} sweeps, alone {alone}",
        whole.sweeps()
    );
    assert!(2 * loose.sweeps() < whole.sweeps(), "{} sweeps to 1e-7, {} to rounding", loose.sweeps(), whole.sweeps());
    for lane in 0..W {
        let ([u, omega, _], [u1, omega1, _]) = (whole.state().xi(lane), loose.state().xi(lane));
        let off = (u - u1).abs().max((omega - omega1).abs());
        assert!(off < 1e-7 * steps as f64, "{off:e}");
    }
}

/// A particle of mass 1 that moves along a direction which turns in the plane, at 0.8 rad/s, under the force 1 along `x`: with
/// `phi = 0.8 t` the speed grows as `xi' = cos phi`.
struct Turning;

impl Turning {
    const RATE: f64 = 0.8;

    /// Place and speed at the time `t` of what passes the origin at the time `t0` with the speed `xi0`.
    fn at(t: f64, (t0, xi0): (f64, f64)) -> ([f64; 2], f64) {
        let (w, phi, phi0) = (Self::RATE, Self::RATE * t, Self::RATE * t0);
        let c = xi0 - phi0.sin() / w;
        let x = c * (phi.sin() - phi0.sin()) / w + (phi.sin().powi(2) - phi0.sin().powi(2)) / (2.0 * w * w);
        let area = |t: f64| 0.5 * t - (2.0 * w * t).sin() / (4.0 * w);
        let y = c * (phi0.cos() - phi.cos()) / w + (area(t) - area(t0)) / w;
        ([x, y], c + phi.sin() / w)
    }
}

impl System<2, 1> for Turning {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5 + q[0]
    }
    fn constraint<S: Scalar>(&self, t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        let (sin, cos) = (t * Self::RATE).sin_cos();
        ([[-sin, cos]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        let (sin, cos) = (t * Self::RATE).sin_cos();
        Some(AdmissibleBasis::new([[cos, sin]]))
    }
    fn reduced(&self) -> impl Reduced<2, 1> {
        self
    }
}

impl Reduced<2, 1> for Turning {
    fn reduced_motion<S: Scalar>(&self, t: S, _q: &[S; 2], _xi: &[S; 2]) -> Option<[S; 2]> {
        Some([(t * Self::RATE).cos(), S::zero()])
    }
}

/// A direction that turns is that of the time of each stage, in lanes and alone, at once and in turn.
#[test]
fn a_direction_that_turns() {
    let (t0, h, steps) = (0.7, 0.25, 8);
    let t1 = t0 + h * steps as f64;
    let starts: Vec<_> = (0..W).map(|lane| ([0.0; 2], [0.1 * lane as f64, 0.0])).collect();
    let begin = LaneState::new(&starts, [false; 2]);
    let mut ensemble = GaussEnsemble::<_, _, 8, W, 2, 1>::new(Same(&Turning), (t0, h), begin).unwrap();
    ensemble.advance(steps);
    for (lane, (q, xi)) in starts.iter().enumerate() {
        let (place, speed) = Turning::at(t1, (t0, xi[0]));
        // Of order 16 with a fifth of a radian a step: what is left is some roundings a step of numbers below four.
        let rounding = 16.0 * 4.0 * steps as f64 * f64::EPSILON;
        let assert_at = |q: &[f64], xi: f64, epsilon: f64| {
            assert_abs_diff_eq!(q, &place[..], epsilon = epsilon);
            assert_abs_diff_eq!(xi, speed, epsilon = epsilon);
        };
        assert_at(&ensemble.state().q(lane), ensemble.state().xi(lane)[0], rounding);

        let alone = |method: &mut dyn OneStep<2, 1>, h: f64| {
            let mut state = State::new(*q, velocity_of(&Turning, t0, q, xi).unwrap(), [false; 2]);
            let mut t = t0;
            while t < t1 - 0.5 * h {
                method.step(&Turning, t, h, &mut state).unwrap();
                t += h;
            }
            let (sin, cos) = (Turning::RATE * t1).sin_cos();
            (*state.q(), cos * state.v()[0] + sin * state.v()[1])
        };
        let (q, xi) = alone(&mut Gauss::new::<8>(), h);
        assert_at(&q, xi, rounding);
        let (q, xi) = alone(&mut Gauss::new::<8>().one_by_one(), h);
        assert_at(&q, xi, rounding);
        // Some steps, each with an error of the tolerance times numbers below four.
        let (q, xi) = alone(&mut GaussAdaptive::new::<8>(1e-11), 1.0);
        assert_at(&q, xi, 1e2 * 1e-11);
    }
}

#[test]
fn many_steps_lose_no_energy_but_by_rounding() {
    lose_no_energy(150, 1e-5);
}

#[test]
#[ignore = "slow"]
fn many_steps_lose_no_energy_but_by_rounding_in_full() {
    lose_no_energy(100_000, 1e-9);
}

/// What the steps of an ensemble leave out does not add up: the energy of each wanders by rounding, as that of one alone. The control
/// leaves out more.
fn lose_no_energy(steps: u32, control: f64) {
    let bowl = ByHand::from(With { body: sleigh(), effects: Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap() });
    let states: Vec<_> = (0..W).map(|i| reduced(&SleighState { turn_rate: 0.05 * i as f64, ..backward() })).collect();
    let wander = |settled: Option<f64>| {
        let state = LaneState::new(&states, [false, false, true]);
        let mut ensemble = GaussEnsemble::<_, _, 4, W, 3, 1>::new(Same(&bowl), (0.0, 0.05), state).unwrap();
        ensemble.settled = settled.unwrap_or(ensemble.settled);
        ensemble.advance(steps.into());
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
    // Sums that are rounded by less than `eps E` in every step are off by five times this once in a million.
    let walk = 5.0 * f64::EPSILON * f64::from(steps).sqrt();
    let [kept, lost] = [None, Some(control)].map(wander);
    assert!(kept < walk, "{kept:e} of {walk:e}");
    assert!(lost > walk, "{lost:e} of {walk:e}");
}

/// However many iterations a checkpoint claims for the last step, the limit of the method holds.
#[test]
fn remembered_iterations_stay_within_the_limit() {
    let system = ByHand::from(sleigh());
    let (q, v) = backward().to_coordinates();
    let mut state = State::new(q, v, system.angles());
    let mut method = Gauss::new::<8>();
    let step = |method: &mut Gauss, state: &mut State<3>| method.step(&system, 0.0, 0.5, state).unwrap();
    step(&mut method, &mut state);
    let mut memory = OneStep::<3, 1>::memory(&method);
    // After the slopes of six coordinates and six velocities in eight stages, the length of the step and its quarters.
    memory[98] = 4e9;
    let (mut other, mut there) = (Gauss::new::<8>(), state);
    OneStep::<3, 1>::recall(&mut other, &memory, &there);
    step(&mut method, &mut state);
    assert!(step(&mut other, &mut there).iterations <= method.max_iterations);
    for i in 0..3 {
        approx::assert_abs_diff_eq!(there.q()[i], state.q()[i], epsilon = 4.0 * f64::EPSILON);
    }
}
