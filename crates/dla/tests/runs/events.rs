use crate::runs::{Motion, backward, sleigh, state_of, system};
use crate::support::{ByHand, OWN, Two, run_own};
use dla::{
    Close, Composition, Direction, Dla, Event, Gauss, OneStep, Schedule, State, Trajectory, Watch, close_crossings,
    drive,
};
use lagrangian::{Constraint, Piecewise, Scalar, System};
use sleigh::{Sleigh, SleighState};
use std::f64::consts::PI;

pub fn speed(q: &[f64], v: &[f64]) -> f64 {
    SleighState::from_coordinates(q.first_chunk().unwrap(), v.first_chunk().unwrap()).speed
}

/// Times at which the events of a run from time zero happen, by their place in the list.
pub fn times<Method>(
    sleigh: &Sleigh,
    method: Method,
    start: &SleighState,
    (step, steps): (f64, u64),
    events: &[Event<'_>],
) -> Vec<(usize, f64)>
where
    Method: OneStep<3, 1> + Copy,
{
    let mut watch = Watch::new(&OWN, events, ());
    let schedule = Schedule { t0: 0.0, step, steps };
    run_own(&ByHand::from(*sleigh), method, &schedule, &mut state_of(start), &mut watch).unwrap();
    watch.crossings().iter().map(|crossing| (crossing.event, crossing.t)).collect()
}

/// The heading reaches a right angle, the speed crosses zero, on the scene `turnaround`.
fn errors<Method: OneStep<3, 1> + Copy>(method: Method, steps: u64) -> [f64; 2] {
    let (sleigh, start) = (sleigh(), backward());
    let motion = Motion::new(&sleigh, &start);
    let right_angle = std::f64::consts::FRAC_PI_2;
    let events = [Event::new("heading", |_, q, _| q[2] - right_angle), Event::new("speed", |_, q, v| speed(q, v))];
    let found = times(&sleigh, method, &start, (40.0 / steps as f64, steps), &events);
    // It has turned by a right angle before it stands: half of the whole turn, pi sqrt(5)/2, is more.
    assert_eq!(found.iter().map(|(event, _)| *event).collect::<Vec<_>>(), [0, 1], "{found:?}");
    let exact = [motion.at_turn(sleigh.offset(), right_angle), motion.turnaround];
    [0, 1].map(|event| (found[event].1 - exact[event]).abs())
}

#[test]
fn the_turnaround_is_located_to_the_order_of_the_method() {
    located_to_rounding();
    located_to_order(2.0, [100, 200, 400].map(|steps| errors(Dla::midpoint(), steps)));
}

#[test]
#[ignore = "slow"]
fn the_turnaround_is_located_to_the_order_of_the_method_in_full() {
    located_to_rounding();
    located_to_order(2.0, [400, 800, 1600].map(|steps| errors(Dla::midpoint(), steps)));
    located_to_order(4.0, [200, 400, 800].map(|steps| errors(Composition::suzuki4(Dla::midpoint()), steps)));
}

fn located_to_rounding() {
    let sixteen = errors(Gauss::new::<8>(), 100);
    println!("gauss16: {sixteen:?}");
    assert!(sixteen.iter().all(|error| *error <= 1e-12), "{sixteen:?}");
}

fn located_to_order(order: f64, found: [[f64; 2]; 3]) {
    println!("order {order}: {found:?}");
    for event in 0..2 {
        let slope = (found[1][event] / found[2][event]).log2();
        // The next power of the step is two higher; its share halves twice from pair to pair.
        let before = (found[0][event] / found[1][event]).log2();
        assert!((slope - order).abs() < 0.1 && (slope - order).abs() <= (before - order).abs() + 0.02, "{found:?}");
    }
}

#[test]
fn directions_and_the_end_of_a_run() {
    let (sleigh, start) = (sleigh(), backward());
    let turnaround = Motion::new(&sleigh, &start).turnaround;
    let event = |direction| Event::new("speed", |_, q, v| speed(q, v)).in_direction(direction);
    let run = (0.05, 800);
    let found = |direction| times(&sleigh, Dla::midpoint(), &start, run, &[event(direction)]).len();
    assert_eq!([Direction::Rising, Direction::Falling, Direction::Both].map(found), [1, 0, 1]);

    // The first that is terminal ends the run; the one that comes after it in the same step does not happen.
    let events = [
        Event::new("later", |t, _, _| t - turnaround - 1e-3),
        event(Direction::Both).terminal(),
        Event::new("before", |t, _, _| t - turnaround + 1e-3),
    ];
    let mut watch = Watch::new(&OWN, &events, Trajectory::every(1));
    let mut state = state_of(&start);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 800 };
    let made = run_own(&ByHand::from(sleigh), Dla::midpoint(), &schedule, &mut state, &mut watch).unwrap();
    let happened: Vec<_> = watch.crossings().iter().map(|crossing| crossing.event).collect();
    let ended = watch.ended().unwrap().clone();
    assert_eq!((happened, ended.k), (vec![2, 1], made - 1));
    // Located to the rounding of the speed, some eps of its parts over the acceleration a w^2 = 0.4.
    let speed = speed(&ended.state.unwrapped(), ended.state.v());
    assert!(speed.abs() <= 8.0 * f64::EPSILON, "{speed:e}");
    assert!(ended.within <= 8.0 * f64::EPSILON * schedule.step, "{:e}", ended.within);
    // The trajectory ends there, on the constraint; the nodes before are those of the run.
    let trajectory = watch.into_inner();
    let last = trajectory.nodes().last().unwrap();
    assert_eq!((last.k, last.t, &last.q), (made, ended.t, &ended.state.unwrapped()));
    assert!(last.constraint <= 2e-16 && last.multipliers.is_some());
    let mut plain = Trajectory::every(1);
    drive(&ByHand::from(sleigh), &mut Dla::midpoint(), &schedule, &mut state_of(&start), &mut plain).unwrap();
    assert_eq!(trajectory.nodes()[..made as usize], plain.nodes()[..made as usize]);
}

/// A point on a line that is pushed to and fro: the force, and the imposed velocity, jump at `t = 1`.
#[derive(Clone, Copy)]
pub(crate) struct Pushed {
    after: Option<bool>,
    imposed: bool,
}

impl System<2, 1> for Pushed {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        let imposed = match self.after {
            Some(true) if self.imposed => 2.0,
            _ => -1.0,
        };
        ([[S::zero(), S::constant(1.0)]], [S::constant(-imposed)])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], _v: &[S; 2]) -> Option<[S; 2]> {
        let push = if self.after == Some(true) { 5.0 } else { -1.0 };
        Some([S::constant(push), S::zero()])
    }
}

impl Piecewise for Pushed {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        if from < 1.0 && 1.0 < to { vec![1.0] } else { Vec::new() }
    }
    fn piece(&self, t: f64) -> Self {
        Self { after: Some(t > 1.0), ..*self }
    }
}

/// `x = 0.58 - t^2/2` to `t = 1`, then `0.08 - s + 5 s^2/2`, which is zero at `s = 0.2 -+ sqrt(0.04 - 0.032)`.
#[test]
fn events_within_each_piece_and_in_a_jump() {
    let system = Two::from(Pushed { after: None, imposed: true });
    let mut state = State::new([0.58, 0.0], [0.0, -1.0], [false; 2]);
    let events = [Event::new("x", |_, q, _| q[0]), Event::new("y'", |_, _, v| v[1]), Event::new("x'", |_, _, v| v[0])];
    // Steps so long that both zeros of x fall into one; the midpoint rule is exact for a constant force.
    let schedule = Schedule { t0: 0.0, step: 0.5, steps: 4 };
    let mut watch = Watch::new(&OWN, &events, ());
    run_own(&system, Dla::midpoint(), &schedule, &mut state, &mut watch).unwrap();
    let found: Vec<_> =
        watch.crossings().iter().map(|crossing| (crossing.event, crossing.rising, crossing.t)).collect();
    let root = 0.008f64.sqrt();
    let expected = [(1, true, 1.0), (0, false, 1.2 - root), (2, true, 1.2), (0, true, 1.2 + root)];
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        // Rounding of x over its slope 0.45 there.
        assert!((found.2 - expected.2).abs() <= 1e-14, "{found:?} {expected:?}");
    }
}

/// What only touches zero, or stays there, is no crossing.
#[test]
fn a_touch_is_no_crossing() {
    let (sleigh, start) = (sleigh(), backward());
    let turnaround = Motion::new(&sleigh, &start).turnaround;
    let events = [
        Event::new("square", |t, _, _| (t - turnaround) * (t - turnaround)),
        Event::new("nothing", |_, _, _| 0.0),
        Event::new("start", |t, _, _| t),
        Event::new("no number", |_, _, _| f64::NAN),
        // The control: a little less, and it crosses twice.
        Event::new("dip", |t, _, _| (t - turnaround) * (t - turnaround) - 1e-8),
        // A zero on a node, crossed and touched.
        Event::new("node", |t, _, _| t - 0.5),
        Event::new("node, touched", |t, _, _| -(t - 0.5).abs()),
    ];
    let found = times(&sleigh, Dla::midpoint(), &start, (0.125, 320), &events);
    assert_eq!(found.iter().map(|(event, _)| *event).collect::<Vec<_>>(), [5, 4, 4], "{found:?}");
    assert_eq!(found[0].1, 0.5);
    assert!((found[2].1 - found[1].1 - 2e-4).abs() <= 1e-12, "{found:?}");
}

/// A sleigh on the line `x = x0 + t`.
fn straight(x0: f64) -> State<3> {
    state_of(&SleighState { x: x0, speed: 1.0, ..SleighState::default() })
}

/// Julia's DiffEqBase issue 1231 and OrdinaryDiffEq issue 2691: of several events within one step, backward, the last was taken.
#[test]
fn several_events_within_one_step_have_its_direction() {
    let x = |value: f64| move |_: f64, q: &[f64], _: &[f64]| q[0] - value;
    let events = [
        Event::new("0", |t, _, _| t),
        Event::new("1", |t, _, _| t - 1e-8),
        Event::new("2", x(2e-8)),
        Event::new("3", x(0.3)).in_direction(Direction::Rising),
    ];
    for (t0, step, order, times) in [
        (-1.0, 2.0, vec![0, 1, 2, 3], vec![0.0, 1e-8, 2e-8, 0.3]),
        // Going back nothing rises.
        (1.0, -2.0, vec![2, 1, 0], vec![2e-8, 1e-8, 0.0]),
    ] {
        let mut watch = Watch::new(&OWN, &events, ());
        let schedule = Schedule { t0, step, steps: 1 };
        run_own(&system(), Dla::midpoint(), &schedule, &mut straight(t0), &mut watch).unwrap();
        let found: Vec<_> = watch.crossings().iter().map(|crossing| crossing.event).collect();
        assert_eq!(found, order);
        for (crossing, t) in watch.crossings().iter().zip(times) {
            // The rounding of times near one.
            assert!((crossing.t - t).abs() <= 2.0 * f64::EPSILON, "{crossing:?}");
            assert_eq!(crossing.rising, step > 0.0);
        }
    }

    // The first that is met ends the run: backward from x = 0 at t = 2 to x = -2.5 at t = -0.5, and not the one just before it.
    let events = [
        Event::new("x", |_, q, _| q[0] + 2.5).terminal(),
        Event::new("later", |_, q, _| q[0] + 2.5001),
        Event::new("before", |_, q, _| q[0] + 2.4999),
    ];
    let mut watch = Watch::new(&OWN, &events, Trajectory::every(1));
    let schedule = Schedule { t0: 2.0, step: -0.75, steps: 100 };
    run_own(&system(), Dla::midpoint(), &schedule, &mut straight(0.0), &mut watch).unwrap();
    assert_eq!(watch.crossings().iter().map(|crossing| crossing.event).collect::<Vec<_>>(), [2, 0]);
    let trajectory = watch.into_inner();
    let last = trajectory.nodes().last().unwrap();
    assert!((last.t + 0.5).abs() <= 4.0 * f64::EPSILON && (last.q[0] + 2.5).abs() <= 4.0 * f64::EPSILON, "{last:?}");
}

/// Two spacings are apart, less is close; four of crossings in one direction, between which there is one in the other.
#[test]
fn crossings_are_close_by_the_samples_between_them() {
    let at = |times: &'static [f64]| times.iter().map(|t| (1, *t, 0.25));
    let pair = |count, spacing, nearest| Some(Close { count, spacing, nearest, incomplete: 0 });
    assert_eq!(close_crossings(at(&[0.0, 0.5, 1.0]), |_| false), None);
    assert_eq!(close_crossings(at(&[0.0, 0.4, 1.0, 1.125]), |_| false), pair(2, 0.25, 0.125));
    // Backward in time.
    assert_eq!(close_crossings(at(&[1.125, 1.0, 0.0]), |_| false), pair(1, 0.25, 0.125));
    assert_eq!(close_crossings(at(&[0.0, 1.0]), |event| event == 1), None);
    assert_eq!(close_crossings(at(&[0.0, 0.875]), |event| event == 1), pair(1, 0.25, 0.875));
    // The wider of two spacings; other events between them are others; a jump is no sample.
    let list = [(0, 0.0, 0.1), (2, 0.1, 0.1), (0, 0.3, 0.2), (2, 0.31, 0.0), (2, 0.32, 0.1)];
    assert_eq!(close_crossings(list, |_| false), pair(1, 0.2, 0.3));
    assert_eq!(close_crossings([], |_| false), None);
}

/// A sine in the time, with steps from a small part of its turn to a thousand turns, all of whose zeros are found: it is looked at in as many
/// parts as it bends in. Of one that is quicker than any number of parts shows that is said.
#[test]
fn a_fast_sine_is_found_or_in_doubt() {
    let found = |frequency: f64, samples| {
        let events = [Event::new("a sine", |t, _, _| (frequency * t + 0.1).sin())];
        let mut watch = Watch::new(&OWN, &events, ());
        watch.samples = samples;
        let schedule = Schedule { t0: 0.0, step: 0.5, steps: 4 };
        run_own(&system(), Dla::midpoint(), &schedule, &mut straight(0.0), &mut watch).unwrap();
        let times: Vec<f64> = watch.crossings().iter().map(|crossing| crossing.t).collect();
        (times, watch.close())
    };
    for (frequency, samples) in
        [(1.0, 4), (5.0, 4), (12.0, 4), (12.0, 40), (30.0, 4), (35.0, 4), (80.0, 1), (PI * 16.0, 4), (2000.0, 4)]
    {
        let (times, close) = found(frequency, samples);
        let right = (1..).map(|k| (f64::from(k) * PI - 0.1) / frequency).take_while(|t| *t < 2.0);
        let right: Vec<f64> = right.collect();
        assert_eq!(times.len(), right.len(), "{frequency} {samples}");
        let off = times.iter().zip(&right).map(|(t, right)| (t - right).abs()).fold(0.0, f64::max);
        // Rounding of the phase, over the frequency.
        assert!(off <= 4.0 * f64::EPSILON * (1.0 + 2.0 * frequency) / frequency, "{frequency} {samples}: {off:e}");
        assert_eq!(close, None, "{frequency} {samples}");
    }
    let (_, close) = found(1e6, 4);
    assert_eq!(close.map(|close| close.incomplete), Some(4));
}

/// What hardly changes is no reason for doubt, whatever its rounding does, nor is a corner or a jump.
#[test]
fn what_hardly_changes_is_not_in_doubt() {
    let energy = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>() - 1.0;
    let events = [
        Event::new("energy", |_, _, v| energy(v)),
        Event::new("x", |_, q, _| q[0] - 0.7),
        // A corner and a jump bend in a few parts, however many there are.
        Event::new("corner", |t: f64, _, _| (t - 1.3).abs() - 0.4),
        Event::new("jump", |t: f64, _, _| (t - 2.1).signum()),
    ];
    let mut watch = Watch::new(&OWN, &events, ());
    let schedule = Schedule { t0: 0.0, step: 0.25, steps: 16 };
    run_own(&system(), Dla::midpoint(), &schedule, &mut straight(0.0), &mut watch).unwrap();
    assert_eq!(watch.close().map_or(0, |close| close.incomplete), 0);
    let counts = [1, 2, 3].map(|event| watch.crossings().iter().filter(|crossing| crossing.event == event).count());
    assert_eq!(counts, [1, 2, 1]);
}

/// An event without a value at a sample is in doubt, and so is a method that cannot be asked between nodes; one with values at all is not.
#[test]
fn a_sample_without_a_value_is_in_doubt() {
    for (root, incomplete) in [(0.3, 2), (-1.0, 0)] {
        // No number before the root, and a crossing a quarter beyond it.
        let events = [Event::new("root", move |t: f64, _, _| (t - root).sqrt() - 0.5)];
        let mut watch = Watch::new(&OWN, &events, ());
        let schedule = Schedule { t0: 0.0, step: 0.25, steps: 4 };
        run_own(&system(), Dla::midpoint(), &schedule, &mut straight(0.0), &mut watch).unwrap();
        assert_eq!(watch.close().map_or(0, |close| close.incomplete), incomplete, "{root}");
        assert_eq!(watch.crossings().len(), usize::from(root > 0.0), "{root}");
    }
}

/// A run that begins on a zero has not crossed it, also where the zero is one but for rounding.
#[test]
fn a_zero_at_the_start_is_not_crossed() {
    for (off, found) in [(0.0, 0), (1e-17, 0), (1e-16, 0), (-1e-16, 0), (1e-9, 1)] {
        let events = [Event::new("x", move |_, q, _| q[0] - off)];
        let mut watch = Watch::new(&OWN, &events, ());
        let schedule = Schedule { t0: 0.0, step: 0.25, steps: 4 };
        run_own(&system(), Dla::midpoint(), &schedule, &mut straight(0.0), &mut watch).unwrap();
        assert_eq!(watch.crossings().len(), found, "{off:e}");
    }
}
