//! What is built on methods, with methods that do what they are told: parts of steps, memories, observers, trials.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dla::{
    Composition, Dla, Event, Gni, Observer, OneStep, Part, RecommendError, RunError, Samples, Schedule, State,
    StepError, StepReport, Substepping, View, Watch, piece_by_piece_from, recommend_by_trial,
};
use lagrangian::{Constraint, Piecewise, Scalar, System};
use sleigh::Sleigh;
use std::ops::ControlFlow;

/// Moves with its velocity, in steps below one eighth before the time 1/4 and of any length later; it remembers them.
#[derive(Debug, Clone, Default, PartialEq)]
struct Short {
    made: Vec<f64>,
}

impl<Sys> OneStep<Sys, 1, 1> for Short {
    fn step(&mut self, _: &Sys, t: f64, h: f64, state: &mut State<1>) -> Result<StepReport<1>, StepError> {
        if t < 0.25 && h > 0.125 {
            return Err(StepError::Branch);
        }
        self.made.extend([t, h]);
        let v = *state.v();
        state.advance(&[h * v[0]], v, None);
        Ok(StepReport { impulses: [[h], [2.0 * h]], iterations: 1, work: (t > 0.2).then_some(h) })
    }
    fn memory(&self) -> Vec<f64> {
        self.made.clone()
    }
    fn recall(&mut self, memory: &[f64], _state: &State<1>) {
        self.made = memory.to_vec();
    }
}

fn start() -> State<1> {
    State::new([0.0], [1.0], [false])
}

/// Two eighths, and then parts twice as long wherever the grid of the longer ones is met.
#[test]
fn parts_grow_on_their_grid() {
    let (mut method, mut state) = (Substepping::new(Short::default(), 4), start());
    let report = method.step(&(), 0.0, 1.0, &mut state).unwrap();
    assert_eq!(method.method.made, [0.0, 0.125, 0.125, 0.125, 0.25, 0.25, 0.5, 0.5]);
    assert_eq!((state.q()[0], report.iterations, method.divided()), (1.0, 4, 1));
    // Impulses add up, and so does the work from where it is known.
    assert_eq!(report, StepReport { impulses: [[1.0], [2.0]], iterations: 4, work: Some(0.75) });
    // A step of three halves does not end on the grid of its wholes.
    let (mut method, mut state) = (Substepping::new(Short::default(), 4), start());
    OneStep::<(), 1, 1>::step(&mut method, &(), 0.0625, 1.5, &mut state).unwrap();
    assert_eq!(method.method.made, [0.0625, 0.09375, 0.15625, 0.09375, 0.25, 0.1875, 0.4375, 0.375, 0.8125, 0.75]);
    // Not short enough.
    let mut method = Substepping::new(Short::default(), 2);
    assert_eq!(OneStep::<(), 1, 1>::step(&mut method, &(), 0.0, 1.0, &mut state), Err(StepError::Branch));
}

#[test]
fn memories_pass_through() {
    let given = [0.5, 0.25];
    let method = Short { made: given.to_vec() };
    let (mut parts, mut composed) = (Substepping::new(Short::default(), 3), Composition::suzuki4(Short::default()));
    OneStep::<(), 1, 1>::recall(&mut parts, &given, &start());
    OneStep::<(), 1, 1>::recall(&mut composed, &given, &start());
    assert_eq!(parts.method, method);
    assert_eq!(OneStep::<(), 1, 1>::memory(&parts), given);
    assert_eq!(OneStep::<(), 1, 1>::memory(&composed), given);
    // What is a map has none.
    assert!(OneStep::<Sleigh, 3, 1>::memory(&Dla::midpoint()).is_empty());
}

/// What it was shown.
#[derive(Debug, Default, PartialEq)]
struct Log(Vec<&'static str>);

impl Observer<(), 1, 1> for Log {
    fn start(&mut self, _node: &View<'_, (), 1>) {
        self.0.push("start");
    }
    fn resume(&mut self, _node: &View<'_, (), 1>) {
        self.0.push("resume");
    }
    fn step(&mut self, _node: &View<'_, (), 1>, _report: &StepReport<1>) -> ControlFlow<()> {
        self.0.push("step");
        ControlFlow::Break(())
    }
    fn end(&mut self, _node: &View<'_, (), 1>) {
        self.0.push("end");
    }
}

fn shown(observer: &mut impl Observer<(), 1, 1>) -> ControlFlow<()> {
    let state = start();
    let node = |k| View { system: &(), k, t: k as f64, state: &state };
    observer.start(&node(0));
    observer.resume(&node(0));
    let flow = observer.step(&node(1), &StepReport::of(1));
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
    let mut watch = Watch::new(Short::default(), &[], Log::default());
    assert!(shown(&mut watch).is_break());
    assert_eq!(watch.into_inner().0, all);
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
        let events = [Event::new("the velocity", |_, state: &State<1>| state.v()[0])];
        let mut watch = Watch::new(Short::default(), &events, ());
        let node = |v: f64| State::new([0.0], [v], [false]);
        Observer::<(), 1, 1>::start(&mut watch, &View { system: &(), k: 3, t: 0.5, state: &node(before) });
        Observer::<(), 1, 1>::resume(&mut watch, &View { system: &(), k: 3, t: 0.5, state: &node(after) });
        let found: Vec<_> = watch.crossings().iter().map(|found| (found.rising, found.k, found.t)).collect();
        assert_eq!(found, crossing.map(|rising| (rising, 3, 0.5)).into_iter().collect::<Vec<_>>(), "{before} {after}");
    }
}

/// After a jump a sample moves with the velocity that the next piece begins with.
#[test]
fn samples_begin_again_after_a_jump() {
    let times = [0.5];
    let mut samples = Samples::new(Short::default(), &times);
    let state = |q: f64, v: f64| State::new([q], [v], [false]);
    Observer::<(), 1, 1>::start(&mut samples, &View { system: &(), k: 2, t: 0.25, state: &state(0.0, 1.0) });
    Observer::<(), 1, 1>::resume(&mut samples, &View { system: &(), k: 2, t: 0.25, state: &state(0.0, 2.0) });
    let end = state(1.0, 2.0);
    let flow = samples.step(&View { system: &(), k: 3, t: 0.75, state: &end }, &StepReport::<1>::of(1));
    assert!(flow.is_continue());
    assert_relative_eq!(samples.taken()[0].q()[0], 0.5);
}

/// A point that is led with the speed 1, 2, 3, .. from one second to the next, and from the fourth on by nothing possible.
#[derive(Debug, Clone)]
struct Led(f64);

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
        let (mut state, mut made) = (State::new([0.0], [0.0], [false]), Vec::new());
        let outcome = piece_by_piece_from(from, &Led(1.0), &schedule, &mut state, |_, steps, state| {
            made.push((steps.start, steps.end, state.v()[0]));
            Ok(Part { made: steps.end, stopped: steps.end >= stop })
        });
        (outcome, made)
    };
    assert_eq!(run(0, 6, 9), (Ok(6), vec![(0, 2, 1.0), (2, 4, 2.0), (4, 6, 3.0)]));
    assert_eq!(run(2, 6, 9), (Ok(6), vec![(2, 4, 2.0), (4, 6, 3.0)]));
    // Inside a piece there is no impulse.
    assert_eq!(run(3, 6, 9), (Ok(6), vec![(3, 4, 0.0), (4, 6, 3.0)]));
    assert_eq!(run(0, 6, 3), (Ok(4), vec![(0, 2, 1.0), (2, 4, 2.0)]));
    assert_eq!(run(0, 0, 9), (Ok(0), vec![(0, 0, 1.0)]));
    let (outcome, made) = run(0, 8, 9);
    let RunError { step, time, source } = outcome.unwrap_err();
    assert!((step, time, made.len()) == (7, 3.0, 3) && matches!(source, StepError::Dependent(_)), "{source}");
}

/// Trials with the error `c h^order` at every time, and with a failure above a step.
fn by_law(order: i32, tolerance: f64, longest: f64) -> Result<dla::Recommendation, RecommendError> {
    recommend_by_trial::<1>(10.0, tolerance, |schedule, times| {
        if schedule.step > longest {
            return Err(RunError { step: 1, time: 0.0, source: StepError::Branch });
        }
        Ok(times.iter().map(|t| State::new([t + 3.0 * schedule.step.powi(order)], [1.0], [false])).collect())
    })
}

#[test]
fn a_step_is_recommended_by_the_law_of_its_errors() {
    for order in [1, 2, 4, 6] {
        for tolerance in [1e-2, 1e-4, 1e-6] {
            for longest in [f64::INFINITY, 0.1] {
                let found = by_law(order, tolerance, longest).unwrap();
                assert_relative_eq!(found.step * found.steps as f64, 10.0, max_relative = 1e-15);
                assert!(found.step <= longest);
                // Known to a twentieth of the tolerance, it is below the half that is aimed at.
                let error = 3.0 * found.step.powi(order);
                assert_abs_diff_eq!(found.estimated_error, error, epsilon = 0.05 * tolerance);
                assert!(error <= 0.55 * tolerance, "{order} {tolerance}: {error}");
                // The longest that is content with that, unless a longer one fails or one step makes the difference.
                let longer = 10.0 / (found.steps - 1) as f64;
                let as_long = error >= 0.2 * tolerance || 3.0 * longer.powi(order) > 0.45 * tolerance;
                assert!(as_long || longest < 1.0 || found.steps <= 4, "{order} {tolerance}: {found:?}");
            }
        }
    }
}

#[test]
fn what_cannot_be_recommended() {
    for (tolerance, duration) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (1.0, 0.0), (1.0, f64::INFINITY)] {
        let refused = recommend_by_trial::<1>(duration, tolerance, |_, _| Ok(Vec::new())).unwrap_err();
        assert!(matches!(refused, RecommendError::Request { .. }));
    }
    // A method that cannot do the system is asked once, at the longest step of a fourth.
    let mut asked = 0;
    let refused = recommend_by_trial::<1>(10.0, 1e-3, |_, _| {
        asked += 1;
        Err(RunError { step: 1, time: 0.0, source: StepError::Unsupported { reason: "it cannot" } })
    });
    assert!(matches!(refused, Err(RecommendError::Fails { step, .. }) if step == 2.5) && asked == 1, "{refused:?}");
    // Errors that stay are out of reach, whatever the step.
    let mut sign = 1.0;
    let stays = recommend_by_trial::<1>(10.0, 1e-9, |schedule, times| {
        sign = -sign;
        Ok(times.iter().map(|t| State::new([t + sign * 1e-8 * (1.0 + schedule.step)], [1.0], [false])).collect())
    });
    let Err(RecommendError::OutOfReach { tolerance, best, step, steps }) = stays else { panic!("{stays:?}") };
    assert!(tolerance == 1e-9 && best >= 2e-8 && best < 1e-6);
    assert_relative_eq!(step * steps as f64, 10.0, max_relative = 1e-15);
}

/// A particle that is pushed by a constant force and braked in proportion to its velocity, held in its second coordinate.
struct Pushed {
    force: f64,
    drag: f64,
}

impl System<2, 1> for Pushed {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        v[0] * v[0] + v[1] * v[1]
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[S; 2]> {
        Some([v[0] * -self.drag + self.force, S::zero()])
    }
}

/// Of mass 2: a constant force is a parabola, to rounding; equations that are linear need no second correction but the one that
/// sees so.
#[test]
fn the_counter_example_feels_forces() {
    let (mut state, mut method) = (State::new([0.0; 2], [0.5, 0.0], [false; 2]), Gni::<_, 2>::default());
    for k in 0..20 {
        let t = 0.1 * f64::from(k);
        let report =
            OneStep::<_, 2, 1>::step(&mut method, &Pushed { force: 3.0, drag: 0.0 }, t, 0.1, &mut state).unwrap();
        assert!(report.iterations <= 2);
        let t = t + 0.1;
        assert_abs_diff_eq!(state.q()[0], 0.5 * t + 0.75 * t * t, epsilon = 1e-13);
        assert_abs_diff_eq!(state.v()[0], 0.5 + 1.5 * t, epsilon = 1e-13);
        assert_abs_diff_eq!(state.q()[1], 0.0, epsilon = 1e-15);
    }
    // Braked it loses `e^(-c t/m)`, to the second order: the error of a step is below `(c h/m)^3`.
    let mut state = State::new([0.0; 2], [1.0, 0.0], [false; 2]);
    let mut method = Gni::<_, 2>::default();
    for k in 0..20 {
        let system = Pushed { force: 0.0, drag: 0.8 };
        let report = OneStep::<_, 2, 1>::step(&mut method, &system, 0.1 * f64::from(k), 0.1, &mut state).unwrap();
        assert!(report.iterations <= 2);
    }
    assert_abs_diff_eq!(state.v()[0], (-0.4_f64 * 2.0).exp(), epsilon = 20.0 * 0.04_f64.powi(3));
}
