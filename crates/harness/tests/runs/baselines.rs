//! The implicit midpoint rule and the adaptive method, on a line on which the motion is known.

use approx::assert_relative_eq;
use dla::{
    Derivative, Dla, Dop853, Hint, ImplicitMidpoint, NewtonError, NotANumber, OneStep, Rk4, Rk4Projected, Rk4Reduced,
    Schedule, State, StepError, SystemFunction, Variable, drive,
};
use lagrangian::{AdmissibleBasis, Constraint, Reduced, Scalar, System};
use std::cell::Cell;

/// A point of unit mass in the plane with `y' = 0`, so that it moves along a line.
struct Line<Law>(Law);

/// The potential of a line.
trait Potential {
    fn potential<S: Scalar>(x: S) -> S;
}

/// `x'' = -x`.
struct Spring;

impl Potential for Spring {
    fn potential<S: Scalar>(x: S) -> S {
        x * x * 0.5
    }
}

/// `x'' = 3 x^2`: from `x = 1` with `x' = sqrt(2)` it is `(1 - t / sqrt(2))^-2`, which ends at `t = sqrt(2)`.
struct Runaway;

impl Potential for Runaway {
    fn potential<S: Scalar>(x: S) -> S {
        -(x * x * x)
    }
}

impl<Law: Potential> System<2, 1> for Line<Law> {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5 - Law::potential(q[0])
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        Some(AdmissibleBasis::new([[S::constant(1.0), S::zero()]]))
    }
}

fn at(x: f64, v: f64) -> State<2> {
    State::new([x, 0.0], [v, 0.0], [false; 2])
}

fn schedule(step: f64, steps: u64) -> Schedule {
    Schedule { t0: 0.0, step, steps }
}

/// `x^2 + x'^2` is an integral of the spring; it is quadratic, and kept. The control: `rk4` loses it.
#[test]
fn the_midpoint_rule_keeps_quadratic_integrals() {
    let steps = 2000;
    let mut state = at(1.0, 0.3);
    let radius = |state: &State<2>| state.q()[0].hypot(state.v()[0]);
    let initial = radius(&state);
    drive(&Line(Spring), &mut ImplicitMidpoint::default(), &schedule(0.3, steps), &mut state, ()).unwrap();
    // Each step rounds x, x' and what the iteration leaves of the acceleration.
    assert_relative_eq!(radius(&state), initial, max_relative = 4.0 * f64::EPSILON * steps as f64);
    let mut state = at(1.0, 0.3);
    drive(&Line(Spring), &mut Rk4, &schedule(0.3, steps), &mut state, ()).unwrap();
    assert!((radius(&state) / initial - 1.0).abs() > 1e-3, "{state:?}");
}

/// It is its own adjoint: a step back undoes a step.
#[test]
fn the_midpoint_rule_is_symmetric() {
    let mut method = ImplicitMidpoint::default();
    let mut state = at(1.0, 0.3);
    let start = state;
    drive(&Line(Runaway), &mut method, &schedule(0.05, 16), &mut state, ()).unwrap();
    drive(&Line(Runaway), &mut method, &schedule(-0.05, 16), &mut state, ()).unwrap();
    assert_relative_eq!(state.q()[0], start.q()[0], max_relative = 1e-13);
    assert_relative_eq!(state.v()[0], start.v()[0], max_relative = 1e-13);
}

/// On the spring the iteration contracts by `h^2 / 4`: beyond `h = 2` it cannot converge, and one iteration never does.
#[test]
fn an_iteration_that_does_not_settle_is_an_error() {
    let start = at(1.0, 0.3);
    for (step, max_iterations) in [(3.0, 100), (1.0, 1)] {
        let mut state = start;
        let mut method = ImplicitMidpoint { max_iterations };
        let error = drive(&Line(Spring), &mut method, &schedule(step, 10), &mut state, ()).unwrap_err();
        let StepError::Newton { source, .. } = error.source else { panic!("{error}") };
        match max_iterations {
            1 => assert!(matches!(source, NewtonError::IterationLimit { iterations: 1, .. }), "{error}"),
            _ => assert!(matches!(source, NewtonError::Diverged { .. }), "{error}"),
        }
        assert_eq!((error.step, state), (1, start), "a failed step leaves the state");
    }
}

fn runaway(t: f64) -> f64 {
    (1.0 - t / 2f64.sqrt()).powi(-2)
}

/// Close to its end the motion asks for ever shorter steps, which no method of fixed steps takes.
#[test]
fn the_adaptive_method_shortens_its_steps() {
    let mut method = Dop853::new(1e-12);
    let mut state = at(1.0, 2f64.sqrt());
    drive(&Line(Runaway), &mut method, &schedule(0.1, 13), &mut state, ()).unwrap();
    // An error e at the start shifts the end by about e, and x by e x'/x there: 2 / (sqrt(2) - t) = 18; some 30 steps.
    assert_relative_eq!(state.q()[0], runaway(1.3), max_relative = 18.0 * 30.0 * 1e-12);
    // In one interval it is the same.
    let mut whole = at(1.0, 2f64.sqrt());
    drive(&Line(Runaway), &mut Dop853::new(1e-12), &schedule(1.3, 1), &mut whole, ()).unwrap();
    assert_relative_eq!(whole.q()[0], runaway(1.3), max_relative = 18.0 * 30.0 * 1e-12);
    // The control.
    let mut fixed = at(1.0, 2f64.sqrt());
    drive(&Line(Runaway), &mut Rk4, &schedule(0.1, 13), &mut fixed, ()).unwrap();
    assert!((fixed.q()[0] / runaway(1.3) - 1.0).abs() > 1e-3, "{fixed:?}");
}

/// There and back with one object, whose step is carried over with either sign. Errors grow on the way back as the fourth
/// power of the time to the end, by 15, on a position of 4; forty steps.
#[test]
fn the_adaptive_method_runs_backward() {
    let mut method = Dop853::new(1e-12);
    let mut state = at(1.0, 2f64.sqrt());
    drive(&Line(Runaway), &mut method, &schedule(0.1, 7), &mut state, ()).unwrap();
    drive(&Line(Runaway), &mut method, &schedule(-0.35, 2), &mut state, ()).unwrap();
    assert_relative_eq!(state.q()[0], 1.0, max_relative = 15.0 * 4.0 * 40.0 * 1e-12);
}

/// Nothing crosses the end of the motion: the error says in which interval it lies, and the state is the last good one.
#[test]
fn the_adaptive_method_ends_with_the_motion() {
    for step in [0.1, 0.7, 1.5] {
        let mut state = at(1.0, 2f64.sqrt());
        let error = drive(&Line(Runaway), &mut Dop853::new(1e-12), &schedule(step, 100), &mut state, ()).unwrap_err();
        println!("{error}");
        let good = (2f64.sqrt() / step).floor();
        assert_eq!(error.step, good as u64 + 1, "{error}");
        assert_relative_eq!(error.time, good * step, max_relative = 1e-15);
        assert!(matches!(error.source, StepError::Tolerance { .. } | StepError::NotFinite), "{error}");
        assert_relative_eq!(state.q()[0], runaway(error.time), max_relative = 1e-8);
    }
}

/// A spring with a quadratic drag, which has no derivative at rest; and beside it one that is not a number, or a kinetic energy that is
/// none.
#[derive(Clone, Copy)]
struct Slowed {
    drag: f64,
    inertia: f64,
}

impl System<2, 1> for Slowed {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 2], v: &[S; 2]) -> S {
        Line(Spring).lagrangian(t, q, v) + v[0] * v[0] * self.inertia
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        Line(Spring).constraint(t, q)
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[S; 2]> {
        Some([v[0] * (v[0] * v[0]).sqrt() * -0.5, S::constant(self.drag)])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        Line(Spring).admissible_basis(t, q)
    }
}

/// These methods need no derivative of a force; a value that is not a number they name like all others.
#[test]
fn what_is_not_a_number_is_named() {
    fn outcome(system: Slowed, mut method: impl OneStep<2, 1>) -> Result<u64, StepError> {
        drive(&system, &mut method, &schedule(0.1, 10), &mut at(1.0, 0.0), ()).map_err(|error| error.source)
    }
    let all = |system| {
        [
            outcome(system, Rk4),
            outcome(system, Rk4Projected),
            outcome(system, Rk4Reduced),
            outcome(system, ImplicitMidpoint::default()),
            outcome(system, Dop853::new(1e-9)),
        ]
    };
    assert_eq!(all(Slowed { drag: 0.0, inertia: 0.0 }), [Ok(10); 5]);
    let named = |function, derivative| {
        Err(StepError::NotANumber(NotANumber { function, derivative, time: 0.0, at_node: true }))
    };
    let force = named(SystemFunction::Force { coordinate: 1 }, Derivative::Value);
    assert_eq!(all(Slowed { drag: f64::NAN, inertia: 0.0 }), [force; 5]);
    let kinetic = named(SystemFunction::Lagrangian, Derivative::Value);
    assert_eq!(all(Slowed { drag: 0.0, inertia: f64::NAN }), [kinetic; 5]);
    // The control: an implicit method that needs the derivative.
    let corner = outcome(Slowed { drag: 0.0, inertia: 0.0 }, Dla::midpoint());
    let first = Derivative::First(Variable::Velocity(0));
    assert_eq!(corner, named(SystemFunction::Force { coordinate: 0 }, first));
    assert_eq!(corner.unwrap_err().hint(), Some(Hint::Corner));
}

/// The spring, which counts how often its slope is asked for.
#[derive(Default)]
struct Counting(Cell<u32>);

impl System<2, 1> for Counting {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 2], v: &[S; 2]) -> S {
        Line(Spring).lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        Line(Spring).constraint(t, q)
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        Line(Spring).admissible_basis(t, q)
    }
    fn reduced(&self) -> impl Reduced<2, 1> {
        self
    }
}

impl Reduced<2, 1> for Counting {
    fn reduced_motion<S: Scalar>(&self, _t: S, q: &[S; 2], _xi: &[S; 2]) -> Option<[S; 2]> {
        self.0.set(self.0.get() + 1);
        Some([-q[0], S::zero()])
    }
}

/// A step costs its twelve stages and an interval one slope more; the slopes of an interpolant are not worked out.
#[test]
fn the_adaptive_method_asks_for_no_more_than_it_uses() {
    let (system, mut state) = (Counting::default(), at(1.0, 0.0));
    drive(&system, &mut Dop853::new(1.0), &schedule(0.1, 10), &mut state, ()).unwrap();
    assert_eq!(system.0.get(), 10 * (1 + 12));
    // A step of 0.1 leaves (0.1)^9 of an error, with room.
    assert_relative_eq!(state.q()[0], 1f64.cos(), max_relative = 10.0 * 1e-9);
}

/// What is not a number is refused at once, and where there is no basis the method says so.
#[test]
fn the_adaptive_method_refuses() {
    let mut state = at(f64::NAN, 1.0);
    assert!(drive(&Line(Runaway), &mut Dop853::new(1e-12), &schedule(0.1, 1), &mut state, ()).is_err());
    let mut state = State::new([0.1, 0.2, 0.3], [0.9, 0.7, 0.18], [false; 3]);
    let system = crate::runs::Particle::of(1.0);
    let error = drive(&system, &mut Dop853::new(1e-12), &schedule(0.1, 1), &mut state, ()).unwrap_err();
    assert!(error.to_string().contains("basis"), "{error}");
    // The control: a method without a basis runs.
    drive(&system, &mut Dla::midpoint(), &schedule(0.1, 1), &mut state, ()).unwrap();
}
