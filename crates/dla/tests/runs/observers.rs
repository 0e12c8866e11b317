//! What observers are shown, and runs cut into pieces, by methods that do what they are told.

use crate::runs::scripted::{Point, Short, start};
use crate::support::{Free, OWN, One, Own};
use approx::assert_relative_eq;
use dla::{
    AnyState, Checkpoint, Event, Observer, Part, Piece, Report, RunError, Samples, Schedule, State, StepError, Subject,
    Trajectory, View, Watch, Work, piece_by_piece,
};
use lagrangian::{Constraint, Piecewise, Scalar, System};
use std::cell::Cell;
use std::ops::ControlFlow;

/// What it was shown.
#[derive(Debug, Default, PartialEq)]
struct Log(Vec<&'static str>);

impl Observer for Log {
    fn start(&mut self, _node: &View<'_>) {
        self.0.push("start");
    }
    fn resume(&mut self, _node: &View<'_>) {
        self.0.push("resume");
    }
    fn step(&mut self, _node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        self.0.push("step");
        ControlFlow::Break(())
    }
    fn end(&mut self, _node: &View<'_>) {
        self.0.push("end");
    }
}

fn shown(observer: &mut impl Observer) -> ControlFlow<()> {
    let (point, state) = (One::Point(Point), AnyState::from(start()));
    let system = Subject::from(&point);
    let node = |k| View { system: &system, k, t: k as f64, state: &state };
    observer.start(&node(0));
    observer.resume(&node(0));
    let flow = observer.step(&node(1), &Report::of(1));
    observer.end(&node(1));
    flow
}

#[test]
fn observers_pass_everything_on() {
    let all = ["start", "resume", "step", "end"];
    let mut pair = ((), (Some(Log::default()), Log::default()));
    assert!(shown(&mut pair).is_break());
    let ((), (first, second)) = pair;
    assert_eq!((first.unwrap().0, second.0), (all.to_vec(), all.to_vec()));
    assert!(shown(&mut None::<Log>).is_continue() && shown(&mut ()).is_continue());
    let mut log = Log::default();
    assert!(shown(&mut &mut log).is_break());
    assert_eq!(log.0, all);
    let mut watch = Watch::new(&OWN, &[], Log::default());
    assert!(shown(&mut watch).is_break());
    assert_eq!(watch.into_inner().0, all);
}

/// Shows the point at a node, with this place and velocity; it makes the short steps.
fn shown_at<T>(k: u64, t: f64, (q, v): (f64, f64), show: impl FnOnce(&View<'_>) -> T) -> T {
    let (point, own) = (One::Point(Point), Own(Short::default()));
    let state = State::new([q], [v], [false]).into();
    show(&View { system: &Subject::new(&point, &own), k, t, state: &state })
}

/// A velocity that jumps over the value of an event crosses it; one that jumps onto it or stays on a side does not.
#[test]
fn a_jump_over_zero_is_a_crossing() {
    for (before, after, crossing) in [
        (1.0, -1.0, Some(false)),
        (-1.0, 1.0, Some(true)),
        (1.0, 0.0, None),
        (0.0, 1.0, None),
        (2.0, 1.0, None),
        (-2.0, -1.0, None),
    ] {
        let events = [Event::new("the velocity", |_, _, v| v[0])];
        let mut watch = Watch::new(&OWN, &events, ());
        shown_at(3, 0.5, (0.0, before), |node| watch.start(node));
        shown_at(3, 0.5, (0.0, after), |node| watch.resume(node));
        let found: Vec<_> = watch.crossings().iter().map(|found| (found.rising, found.k, found.t)).collect();
        assert_eq!(found, crossing.map(|rising| (rising, 3, 0.5)).into_iter().collect::<Vec<_>>(), "{before} {after}");
    }
}

/// After a jump a sample moves with the velocity that the next piece begins with.
#[test]
fn samples_begin_again_after_a_jump() {
    let times = [0.5];
    let mut samples = Samples::new(&OWN, &times);
    shown_at(2, 0.25, (0.0, 1.0), |node| samples.start(node));
    shown_at(2, 0.25, (0.0, 2.0), |node| samples.resume(node));
    assert!(shown_at(3, 0.75, (1.0, 2.0), |node| samples.step(node, &Report::of(1))).is_continue());
    assert_relative_eq!(samples.taken()[0].q()[0], 0.5);
}

/// A point that is led with the speed 1, 2, 3, .. from one second to the next, and from the fourth on by nothing possible.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Led(f64);

impl System<1, 1> for Led {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 1> {
        ([[S::constant(if self.0 < 4.0 { 1.0 } else { 0.0 })]], [S::constant(-self.0)])
    }
}

impl Piecewise for Led {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        (0..9).map(f64::from).filter(|t| from < *t && *t < to).collect()
    }
    fn piece(&self, t: f64) -> Self {
        Self(t.floor() + 1.0)
    }
}

/// A run that goes on from a node makes the rest of its pieces, and meets the velocity of a piece where it begins.
#[test]
fn pieces_from_a_node_on() {
    let run = |from: u64, steps: u64, stop: u64| {
        let schedule = Schedule { t0: 0.0, step: 0.5, steps };
        let (mut state, mut made) = (State::new([0.0], [0.0], [false]).into(), Vec::new());
        let outcome = piece_by_piece(
            from,
            &Subject::from(&One::from(Led(1.0))),
            &schedule,
            &mut state,
            |_, Piece { steps, .. }, state| {
                made.push((steps.start, steps.end, state.v()[0]));
                Ok(Part { made: steps.end, stopped: steps.end >= stop })
            },
        );
        (outcome, made)
    };
    assert_eq!(run(0, 6, 9), (Ok(6), vec![(0, 2, 1.0), (2, 4, 2.0), (4, 6, 3.0)]));
    assert_eq!(run(2, 6, 9), (Ok(6), vec![(2, 4, 2.0), (4, 6, 3.0)]));
    // Inside a piece there is no impulse.
    assert_eq!(run(3, 6, 9), (Ok(6), vec![(3, 4, 0.0), (4, 6, 3.0)]));
    assert_eq!(run(0, 6, 3), (Ok(4), vec![(0, 2, 1.0), (2, 4, 2.0)]));
    assert_eq!(run(0, 0, 9), (Ok(0), vec![(0, 0, 1.0)]));
    let (outcome, made) = run(0, 8, 9);
    let RunError { step, time, source, .. } = outcome.unwrap_err();
    assert!((step, time, made.len()) == (7, 3.0, 3) && matches!(source, StepError::Dependent(_)), "{source}");
}

/// A particle of mass one in a field of 3 N.
#[derive(Clone, Copy)]
pub(crate) struct Falling;

impl System<1, 0> for Falling {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 1], v: &[S; 1]) -> S {
        v[0] * v[0] * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 0> {
        ([], [])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 1], _v: &[S; 1]) -> Option<[S; 1]> {
        Some([S::constant(3.0)])
    }
}

/// Work goes on from a checkpoint with what was done before, and with the node where it was written.
#[test]
fn work_is_resumed() {
    let falling = Free::Falling(Falling);
    let system = Subject::from(&falling);
    let node = |t: f64| AnyState::from(State::new([t + 1.5 * t * t], [1.0 + 3.0 * t], [false]));
    let (at, after) = (node(0.2), node(0.5));
    let mut work = Work::default();
    work.start(&View { system: &system, k: 0, t: 0.0, state: &node(0.0) });
    let _ = work.step(&View { system: &system, k: 2, t: 0.2, state: &at }, &Report::of(0));
    // Gauss nodes along a parabola are exact: a dozen roundings of numbers below ten.
    assert_relative_eq!(work.total(), 3.0 * at.q()[0], max_relative = 1e-14);
    let mut checkpoint = Checkpoint::of([("method", "any".to_owned())]);
    work.save(&mut checkpoint);
    let resumed = Work::load(&checkpoint, 0.2, &at).unwrap();
    let mut trajectory = Trajectory::resumed(1, 0.2, resumed);
    let _ = trajectory.step(&View { system: &system, k: 5, t: 0.5, state: &after }, &Report::of(0));
    assert_relative_eq!(trajectory.nodes()[0].work, 3.0 * after.q()[0], max_relative = 1e-14);
    // A velocity that jumps to twice its size has been given the energy for it.
    let faster = State::new([after.q()[0]], [2.0 * after.v()[0]], [false]).into();
    trajectory.resume(&View { system: &system, k: 5, t: 0.5, state: &faster });
    let report = Report { work: Some(0.25), ..Report::of(0) };
    let _ = trajectory.step(&View { system: &system, k: 6, t: 0.6, state: &faster }, &report);
    let given = 0.5 * 3.0 * after.v()[0] * after.v()[0];
    assert_relative_eq!(trajectory.nodes()[1].work, 3.0 * after.q()[0] + given + 0.25, max_relative = 1e-14);
}

/// A sample that the method has no step for ends the sampling, and is told.
#[test]
fn a_sample_may_fail() {
    let times = [0.05, 0.2, 0.21];
    let mut samples = Samples::new(&OWN, &times);
    shown_at(0, 0.0, (0.0, 1.0), |node| samples.start(node));
    let _ = shown_at(1, 0.5, (0.5, 1.0), |node| samples.step(node, &Report::of(1)));
    assert_eq!((samples.taken().len(), samples.failure()), (1, Some(StepError::Branch)));
    assert_eq!(samples.into_taken(), Err(StepError::Branch));
}

/// A crossing of a smooth function is found by interpolation, in far fewer evaluations than the fifty of a bisection.
#[test]
fn a_crossing_is_interpolated() {
    for (name, function, at) in [
        ("a line", (|x| x - 0.3) as fn(f64) -> f64, 0.3),
        ("an exponential", |x: f64| (3.0 * x).exp() - 2.0, 2.0_f64.ln() / 3.0),
        ("its inverse", |x: f64| (-3.0 * x).exp() - 0.2, 5.0_f64.ln() / 3.0),
        ("a cube", |x: f64| x * x * x - 0.1, 0.1_f64.cbrt()),
    ] {
        let asked = Cell::new(0);
        let events = [Event::new(name, |_, q, _| {
            asked.set(asked.get() + 1);
            function(q[0])
        })];
        let mut watch = Watch::new(&OWN, &events, ());
        shown_at(0, 1.0, (0.0, 1.0), |node| watch.start(node));
        let _ = shown_at(1, 2.0, (1.0, 1.0), |node| watch.step(node, &Report::of(1)));
        let [found] = watch.crossings() else { panic!("{name}: {:?}", watch.crossings()) };
        // Rounding of the time, and of the function over its slope.
        assert_relative_eq!(found.t, 1.0 + at, max_relative = 4.0 * f64::EPSILON);
        assert!(found.within <= 8.0 * f64::EPSILON, "{name}: {:e}", found.within);
        // Seven samples, and a search.
        assert!(asked.get() < 7 + 16, "{name}: {} evaluations", asked.get());
    }
}

/// Keeps the impulses of the last report.
#[derive(Debug, Default)]
struct Last([[f64; 1]; 2]);

impl Observer for Last {
    fn start(&mut self, _node: &View<'_>) {}
    fn step(&mut self, _node: &View<'_>, report: &Report) -> ControlFlow<()> {
        self.0 = [0, 1].map(|end| [report.impulses[end][0]]);
        ControlFlow::Continue(())
    }
}

/// A tolerance is a time, whatever the step; the last node of a run has the report of the step that ends there.
#[test]
fn an_event_ends_a_step_early() {
    let events = [Event::new("an exponential", |_, q, _| q[0].exp() - 2.0).terminal()];
    let mut watch = Watch::new(&OWN, &events, Last::default());
    watch.tolerance = 0.01;
    shown_at(0, 1.0, (0.0, 1.0), |node| watch.start(node));
    assert!(shown_at(1, 3.0, (2.0, 1.0), |node| watch.step(node, &Report::of(1))).is_break());
    let found = watch.ended().unwrap().clone();
    // The ends of the interval are times near two, and rounded as such.
    assert!(found.within <= 0.01 + f64::EPSILON && (found.t - 1.0 - 2.0_f64.ln()).abs() <= found.within, "{found:?}");
    // The method reports the length of its step, and twice that.
    assert_relative_eq!(watch.into_inner().0[0][0], found.t - 1.0, max_relative = 1e-15);
}
