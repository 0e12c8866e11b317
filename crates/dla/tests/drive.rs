//! Runs: times, observers, and how they end.

use crate::support::One;
use dla::{
    AnyState, Dla, History, Mechanics, NewtonError, Node, Observer, OneStep, Report, RunError, Schedule, Stage, State,
    StepError, StepReport, Subject, Trajectory, View, drive,
};
use lagrangian::{Constraint, Scalar, System};
use std::ops::ControlFlow;

/// A point on a line that moves with time: `x' = 1 / (1 + t)`, of energy `x'^2 / 2`.
#[derive(Clone, Copy)]
pub(crate) struct Line;

impl System<1, 1> for Line {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, _q: &[S; 1]) -> Constraint<S, 1, 1> {
        ([[S::constant(1.0)]], [-(t + 1.0).recip()])
    }
}

/// Moves by one a step, notes the times it is given, and fails at a step.
#[derive(Default)]
struct Counting {
    times: Vec<f64>,
    fails_at: Option<usize>,
}

const FAILURE: StepError = StepError::Newton {
    stage: Stage::Projection,
    source: NewtonError::NotFinite { iteration: 3, history: History::new() },
};

impl OneStep<1, 1> for Counting {
    fn step(
        &mut self,
        _: &dyn Mechanics<1, 1>,
        t: f64,
        h: f64,
        state: &mut State<1>,
    ) -> Result<StepReport<1>, StepError> {
        self.times.push(t);
        if self.fails_at == Some(self.times.len()) {
            return Err(FAILURE);
        }
        state.advance(&[1.0], [(1.0 + t + h).recip()], None);
        let k = self.times.len() as u32;
        Ok(StepReport { impulses: [[0.25 * f64::from(k)], [0.75 * f64::from(k)]], ..StepReport::of(k) })
    }
}

/// What an observer was shown.
#[derive(Debug, PartialEq, Clone, Copy)]
enum Event {
    Start(u64, f64, f64),
    Step(u64, f64, f64, u32),
    End(u64, f64, f64),
}
use Event::{End, Start, Step};

#[derive(Default)]
struct Log {
    events: Vec<Event>,
    stop_at: Option<u64>,
}

impl Observer for Log {
    fn start(&mut self, node: &View<'_>) {
        self.events.push(Start(node.k, node.t, node.state.q()[0]));
    }
    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        self.events.push(Step(node.k, node.t, node.state.q()[0], report.iterations));
        if self.stop_at == Some(node.k) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn end(&mut self, node: &View<'_>) {
        self.events.push(End(node.k, node.t, node.state.q()[0]));
    }
}

fn start() -> State<1> {
    State::new([0.0], [1.0], [false])
}

const SCHEDULE: Schedule = Schedule { t0: 0.0, step: 0.5, steps: 3 };

#[test]
fn times_are_multiples_of_the_step() {
    for (t0, step) in [(0.0, 0.1), (-3.3, 0.01), (1e6, 1e-3), (2.0, -0.1)] {
        let (mut method, mut trajectory) = (Counting::default(), Trajectory::every(1));
        let schedule = Schedule { t0, step, steps: 1000 };
        assert_eq!(drive(&One::from(Line), &mut method, &schedule, &mut start(), &mut trajectory), Ok(1000));
        let expected: Vec<f64> = (0..=1000).map(|k| t0 + f64::from(k) * step).collect();
        assert_eq!(method.times, expected[..1000]);
        assert_eq!(trajectory.nodes().iter().map(|node| node.t).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn an_observer_sees_every_node_once() {
    let (mut state, mut log) = (start(), Log::default());
    assert_eq!(drive(&One::from(Line), &mut Counting::default(), &SCHEDULE, &mut state, &mut log), Ok(3));
    let steps = [Step(1, 0.5, 1.0, 1), Step(2, 1.0, 2.0, 2), Step(3, 1.5, 3.0, 3)];
    assert_eq!(log.events, [Start(0, 0.0, 0.0), steps[0], steps[1], steps[2], End(3, 1.5, 3.0)]);

    let mut log = Log::default();
    let none = Schedule { steps: 0, ..SCHEDULE };
    assert_eq!(drive(&One::from(Line), &mut Counting::default(), &none, &mut start(), &mut log), Ok(0));
    assert_eq!(log.events, [Start(0, 0.0, 0.0), End(0, 0.0, 0.0)]);
}

#[test]
fn a_break_ends_the_run_at_its_node() {
    // Either of a pair may break; both see the node, and both see the end.
    for (first, second) in [(Some(2), None), (None, Some(2)), (Some(2), Some(2)), (Some(2), Some(3))] {
        let (mut a, mut b) = (Log { stop_at: first, ..Log::default() }, Log { stop_at: second, ..Log::default() });
        let mut state = start();
        let made = drive(&One::from(Line), &mut Counting::default(), &SCHEDULE, &mut state, ((), (&mut a, &mut b)));
        assert_eq!((made, state.q()[0]), (Ok(2), 2.0));
        assert_eq!(a.events, [Start(0, 0.0, 0.0), Step(1, 0.5, 1.0, 1), Step(2, 1.0, 2.0, 2), End(2, 1.0, 2.0)]);
        assert_eq!(a.events, b.events);
    }
}

#[test]
fn a_failure_keeps_state_and_trajectory() {
    for fails_at in 1..=3u64 {
        let mut method = Counting { fails_at: Some(fails_at as usize), ..Counting::default() };
        let (mut state, mut log, mut trajectory) = (start(), Log::default(), Trajectory::every(10));
        let error =
            drive(&One::from(Line), &mut method, &SCHEDULE, &mut state, (&mut log, &mut trajectory)).unwrap_err();
        let (good, time) = (fails_at - 1, 0.5 * (fails_at - 1) as f64);
        assert_eq!(error, RunError::new(fails_at, time, FAILURE));
        assert_eq!(state.q()[0], good as f64, "the last good node");
        assert_eq!(log.events.last(), Some(&End(good, time, good as f64)));
        assert_eq!(log.events.len() as u64, 2 + good, "nothing is shown twice");
        let kept: Vec<u64> = trajectory.nodes().iter().map(|node| node.k).collect();
        assert_eq!(kept, if good == 0 { vec![0] } else { vec![0, good] });
        let text = format!("step {fails_at}, from t = {time} s: the projection onto the constraint: ");
        assert!(error.to_string().starts_with(&text), "{error}");
    }
}

#[test]
fn a_trajectory_keeps_every_nth_node_and_the_last() {
    let kept = |every: u64, steps: u64| {
        let mut trajectory = Trajectory::every(every);
        let schedule = Schedule { steps, ..SCHEDULE };
        drive(&One::from(Line), &mut Counting::default(), &schedule, &mut start(), &mut trajectory).unwrap();
        trajectory.nodes().iter().map(|node| node.k).collect::<Vec<_>>()
    };
    assert_eq!(kept(1, 4), [0, 1, 2, 3, 4]);
    assert_eq!(kept(0, 2), [0, 1, 2], "0 counts as 1");
    assert_eq!(kept(3, 7), [0, 3, 6, 7]);
    assert_eq!(kept(3, 6), [0, 3, 6]);
    assert_eq!(kept(100, 5), [0, 5]);
    assert_eq!(kept(3, 0), [0]);
}

#[test]
fn a_node_has_what_its_step_reported() {
    let mut trajectory = Trajectory::every(2);
    drive(&One::from(Line), &mut Counting::default(), &SCHEDULE, &mut start(), &mut trajectory).unwrap();
    // The work is integrated along the nodes, and these are not those of a motion.
    let works: Vec<f64> = trajectory.nodes().iter().map(|node| node.work).collect();
    let node = |k: u64, multipliers: Option<Vec<f64>>| {
        let t = 0.5 * k as f64;
        let v = (1.0 + t).recip();
        let work = works[k.div_ceil(2) as usize];
        Node {
            k,
            t,
            q: vec![k as f64],
            v: vec![v],
            energy: 0.5 * v * v,
            work,
            constraint: 0.0,
            position: None,
            multipliers,
        }
    };
    // The impulses of step k sum up to k, over h = 1/2.
    assert_eq!(trajectory.nodes(), [node(0, None), node(2, Some(vec![4.0])), node(3, Some(vec![6.0]))]);
}

#[test]
fn a_residual_that_is_no_number_is_seen() {
    let view = |v: f64| {
        let state = AnyState::from(State::new([0.0], [v], [false]));
        View { system: &Subject::from(&One::from(Line)), k: 0, t: 0.0, state: &state }.constraint()
    };
    assert_eq!((view(1.0), view(0.5), view(2.0)), (0.0, 0.5, 1.0));
    assert!(view(f64::NAN).is_nan());
}

/// The whole of it: a step of the real method, in time that matters.
#[test]
fn a_moving_constraint_is_met_at_every_node() {
    let (mut state, mut trajectory) = (start(), Trajectory::every(1));
    let schedule = Schedule { t0: 0.0, step: 0.01, steps: 500 };
    drive(&One::from(Line), &mut Dla::midpoint(), &schedule, &mut state, &mut trajectory).unwrap();
    assert!(trajectory.nodes().iter().all(|node| node.constraint <= f64::EPSILON));
    // The midpoint rule's error in the logarithm is h^2 / 24 times the change of the first derivative.
    let error = state.q()[0] - 6f64.ln();
    assert!((error + 0.01f64.powi(2) / 24.0 * (1.0 - 1.0 / 36.0)).abs() < 1e-9, "{error:e}");
}
