//! Functions with corners where the motion begins: those that have a derivative there are done, the others named.

use crate::support::Three;
use approx::assert_abs_diff_eq;
use dla::{
    Composition, Derivative, Dla, Energy, Form, Gauss, GaussAdaptive, Gni, Hint, Lobatto, NotANumber, OneStep, Rules,
    RunError, Schedule, State, StepError, SystemFunction, Variable, drive, not_a_number,
};
use lagrangian::{AdmissibleBasis, Alpha, Constraint, Midpoint, Scalar, System};

/// Gravity along the slope (m/s^2) and drag over mass (1/m).
const G: f64 = 2.0;
const DRAG: f64 = 0.5;

/// What a skate is slowed by: `-DRAG v |v|`, a force that is nowhere differentiable at rest as it is written, or nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slowed {
    /// By a length.
    Length,
    /// By the root of a sum of squares.
    Root,
    /// By one that is wrong in its value on the second coordinate.
    Undefined,
    Not,
}

/// What else is wrong with it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Wrong {
    Nothing,
    /// A potential whose force on the first coordinate is not a number.
    Potential,
    /// A kinetic energy whose second derivative in the last velocity is infinite at rest.
    Inertia,
    /// A potential that is not a number, though its derivatives are: they vanish.
    Level,
    /// A constraint.
    Constraint,
    /// Its term without velocities.
    Term,
    /// The second vector of the basis.
    Basis,
    /// The potential beyond `x = 1e-5` m, which the skate comes to within its first step.
    Beyond,
}

/// A skate on a slope, with the basis of its admissible velocities or without.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Skate {
    slowed: Slowed,
    wrong: Wrong,
    basis: bool,
}

impl Skate {
    fn not(&self, wrong: Wrong) -> f64 {
        if self.wrong == wrong { f64::NAN } else { 1.0 }
    }
}

impl System<3, 1> for Skate {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let kinetic = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5;
        let bare = kinetic + q[0] * (G * self.not(Wrong::Potential));
        match self.wrong {
            Wrong::Inertia => bare + v[2].abs().powf(1.5),
            Wrong::Level => bare + self.not(Wrong::Level),
            Wrong::Beyond => bare + (-q[0] + 1e-5).sqrt() * 1e-3,
            _ => bare,
        }
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let rows = [[-q[2].sin(), q[2].cos() * self.not(Wrong::Constraint), S::zero()]];
        (rows, [S::constant(if self.wrong == Wrong::Term { f64::NAN } else { 0.0 })])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        let speed = match self.slowed {
            Slowed::Length => S::length(&[v[0], v[1]]),
            Slowed::Root | Slowed::Undefined => (v[0] * v[0] + v[1] * v[1]).sqrt(),
            Slowed::Not => return None,
        };
        let across = if self.slowed == Slowed::Undefined { (v[0] - 1.0).sqrt() } else { v[1] };
        Some([v[0] * speed * -DRAG, across * speed * -DRAG, S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(self.not(Wrong::Basis)));
        self.basis.then(|| AdmissibleBasis::new([[q[2].cos(), q[2].sin(), zero], [zero, zero, one]]))
    }
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

const START: [f64; 3] = [0.0, 0.0, 0.0];

/// How a run begins, and the length of its steps (s).
#[derive(Debug, Clone, Copy)]
struct Start {
    heading: f64,
    speed: f64,
    step: f64,
}

impl Start {
    const AT_REST: Self = Self { heading: 0.0, speed: 0.0, step: 0.01 };

    /// To three seconds.
    fn steps(self) -> u64 {
        (3.0 / self.step).round() as u64
    }
}

fn run(skate: Skate, mut method: impl OneStep<3, 1>, start: Start) -> (State<3>, Result<u64, RunError>) {
    let Start { heading, speed, step } = start;
    let v = [speed * heading.cos(), speed * heading.sin(), 0.0];
    let mut state = State::new([0.0, 0.0, heading], v, skate.angles());
    let outcome =
        drive(&Three::from(skate), &mut method, &Schedule { t0: 0.0, step, steps: start.steps() }, &mut state, ());
    (state, outcome)
}

/// The name of a method, the state at the end, and what came of the run.
type Ended = (&'static str, State<3>, Result<u64, RunError>);

/// Runs a skate by every method of this crate.
fn all(skate: Skate, start: Start) -> Vec<Ended> {
    let mut found = Vec::new();
    let mut add = |name, (state, outcome)| found.push((name, state, outcome));
    let alpha = Alpha::new(0.3).unwrap();
    add("dla", run(skate, Dla::midpoint(), start));
    add("dla with multipliers", run(skate, Dla::midpoint().solved(Form::Multipliers), start));
    add("dla-trapezoid", run(skate, Dla::trapezoid(), start));
    add("dla of two rules", run(skate, Dla::new(Midpoint, alpha), start));
    add("dla4", run(skate, Composition::suzuki4(Dla::midpoint()), start));
    add("lobatto3", run(skate, Lobatto::<3>::new(), start));
    add("lobatto4", run(skate, Lobatto::<4>::new(), start));
    add("gni", run(skate, Gni::of(Rules::new(Midpoint, Midpoint)), start));
    if skate.basis {
        add("gauss4", run(skate, Gauss::new::<2>(), start));
        add("gauss8", run(skate, Gauss::new::<4>(), start));
        add("gauss16", run(skate, Gauss::new::<8>(), start));
        add("gauss-adaptive", run(skate, GaussAdaptive::new::<8>(1e-9), start));
        add("energy2", run(skate, Energy::new::<1>(), start));
        add("energy4", run(skate, Energy::new::<2>(), start));
    }
    found
}

/// `u' = g - k u^2` from rest: `u = sqrt(g/k) tanh(sqrt(g k) t)`, along any heading of the slope.
fn a_quadratic_drag(step: f64, cases: &[(f64, bool)]) {
    for &(heading, basis) in cases {
        let start = Start { heading, speed: 0.0, step };
        let g = G * f64::cos(heading);
        let right = (g / DRAG).sqrt() * (3.0 * (g * DRAG).sqrt()).tanh();
        if heading == 0.0 {
            assert_abs_diff_eq!(right, 1.990_109_507, epsilon = 5e-10);
        }
        for (name, state, outcome) in all(Skate { slowed: Slowed::Length, wrong: Wrong::Nothing, basis }, start) {
            let u = state.v()[0].hypot(state.v()[1]);
            println!("{name}, heading {heading}, basis {basis}: {outcome:?}, off by {:e}", u - right);
            assert_eq!(outcome.map_err(|error| error.to_string()), Ok(start.steps()), "{name}");
            // (g k) h^2/12 of the speed for a method of second order.
            assert_abs_diff_eq!(u, right, epsilon = step * step / 12.0 * right);
            if ["gauss4", "gauss8", "gauss16", "gauss-adaptive", "energy4", "lobatto3", "lobatto4", "dla4"]
                .contains(&name)
            {
                assert_abs_diff_eq!(u, right, epsilon = 2e-3 * step.powi(4));
            }
        }
    }
}

#[test]
fn a_quadratic_drag_begins_at_rest() {
    a_quadratic_drag(0.05, &[(0.0, true), (0.5, false)]);
}

#[test]
#[ignore = "slow"]
fn a_quadratic_drag_begins_at_rest_in_full() {
    a_quadratic_drag(0.01, &[(0.0, true), (0.0, false), (0.5, true), (0.5, false)]);
}

/// That a run ends in its first step with this function named, whatever the method, and this hint.
fn named(skate: Skate, by: &[&str], expected: NotANumber, hint: Hint) {
    named_among(all(skate, Start::AT_REST), by, expected, hint);
}

fn named_among(found: Vec<Ended>, by: &[&str], expected: NotANumber, hint: Hint) {
    let mut seen = 0;
    for (name, state, outcome) in found {
        if !by.is_empty() && !by.contains(&name) {
            continue;
        }
        let error = outcome.unwrap_err();
        println!("{name}: {error}");
        assert_eq!((error.step, error.source), (1, StepError::NotANumber(expected)), "{name}: {error}");
        assert_eq!((error.hint(), error.source.history()), (Some(hint), None), "{name}");
        assert_eq!((state.q(), state.v()), (&START, &[0.0; 3]), "{name}");
        seen += 1;
    }
    assert!(seen > 0);
}

fn at_start(function: SystemFunction, derivative: Derivative) -> NotANumber {
    NotANumber { function, derivative, time: 0.0, at_node: true }
}

/// A root of squares in the force has no derivative at rest. Explicit methods and collocations need none; they do it.
#[test]
fn a_force_without_a_derivative_is_named() {
    let implicit =
        ["dla", "dla with multipliers", "dla-trapezoid", "dla of two rules", "dla4", "lobatto3", "lobatto4", "gni"];
    let expected = at_start(SystemFunction::Force { coordinate: 0 }, Derivative::First(Variable::Velocity(0)));
    for basis in [true, false] {
        let start = Start { step: 0.05, ..Start::AT_REST };
        let found = all(Skate { slowed: Slowed::Root, wrong: Wrong::Nothing, basis }, start);
        for (name, state, outcome) in found.iter().filter(|(name, ..)| name.starts_with("gauss")) {
            assert_eq!(*outcome, Ok(start.steps()), "{name}");
            assert_abs_diff_eq!(state.v()[0], 1.990_109_507, epsilon = 1e-5);
        }
        named_among(found, &implicit, expected, Hint::Corner);
    }
    let said = StepError::NotANumber(expected).to_string();
    assert_eq!(said, "the force on coordinate 0 has no finite derivative in velocity 0 at t = 0 s");
    let hint = StepError::NotANumber(expected).hint().unwrap().to_string();
    assert!(hint.contains("Scalar::length"), "{hint}");
}

#[test]
fn what_is_not_a_number_is_named_by_every_method() {
    let of = |slowed, wrong, basis| Skate { slowed, wrong, basis };
    for basis in [true, false] {
        let force = at_start(SystemFunction::Force { coordinate: 1 }, Derivative::Value);
        named(of(Slowed::Undefined, Wrong::Nothing, basis), &[], force, Hint::Numbers);
        let potential = at_start(SystemFunction::Lagrangian, Derivative::Value);
        named(of(Slowed::Not, Wrong::Potential, basis), &[], potential, Hint::Numbers);
        let row = at_start(SystemFunction::Constraint { row: 0, coordinate: 1 }, Derivative::Value);
        // In a basis the rows are not looked at.
        let by: &[&str] = if basis { &["dla with multipliers"] } else { &[] };
        named(of(Slowed::Length, Wrong::Constraint, basis), by, row, Hint::Numbers);
        let velocity = Variable::Velocity(2);
        let inertia = at_start(SystemFunction::Lagrangian, Derivative::Second(velocity, velocity));
        named(of(Slowed::Not, Wrong::Inertia, basis), &["dla", "dla4", "lobatto3"], inertia, Hint::Corner);
    }
    named(
        of(Slowed::Not, Wrong::Term, false),
        &["dla", "dla4", "lobatto3"],
        at_start(SystemFunction::ConstraintTerm { row: 0 }, Derivative::Value),
        Hint::Numbers,
    );
    let basis = at_start(SystemFunction::Basis { vector: 1, coordinate: 2 }, Derivative::Value);
    named(of(Slowed::Length, Wrong::Basis, true), &["dla", "gauss4", "energy2"], basis, Hint::Numbers);
    let level = at_start(SystemFunction::Lagrangian, Derivative::Value);
    named(of(Slowed::Not, Wrong::Level, true), &["energy2", "energy4"], level, Hint::Numbers);
    // A constant that is not a number moves nothing.
    let [(_, state, outcome), ..] = &all(of(Slowed::Not, Wrong::Level, true), Start::AT_REST)[..] else { panic!() };
    assert_eq!((outcome.as_ref(), state.v()[0] > 5.9), (Ok(&300), true));
}

/// Within a step a shorter one may still be made, and the hint says so.
#[test]
fn what_the_step_comes_to_is_named() {
    let skate = Skate { slowed: Slowed::Not, wrong: Wrong::Beyond, basis: true };
    for (name, state, outcome) in all(skate, Start { speed: 0.01, ..Start::AT_REST }) {
        let error = outcome.unwrap_err();
        println!("{name}: {error}");
        let StepError::NotANumber(NotANumber { function, derivative, time, at_node }) = error.source else {
            panic!("{name}: {error}");
        };
        assert_eq!((function, derivative), (SystemFunction::Lagrangian, Derivative::Value), "{name}");
        assert!(!at_node && 1e-3 < time && time < 0.01, "{name}");
        assert_eq!((error.hint(), state.v()[0]), (Some(Hint::ShorterStep { part: 0.5 }), 0.01), "{name}");
    }
}

#[test]
fn numbers_of_a_system() {
    let of = |wrong| Skate { slowed: Slowed::Not, wrong, basis: true };
    let at = |skate: Skate, q: [f64; 3], v: [f64; 3]| not_a_number(&Three::from(skate), 2.0, &q, &v);
    assert_eq!(at(of(Wrong::Nothing), [0.0; 3], [0.0; 3]), None);
    // Nothing is said of a place that is none.
    assert_eq!(at(of(Wrong::Potential), [f64::NAN, 0.0, 0.0], [0.0; 3]), None);
    // Large velocities have an infinite energy and finite momenta.
    assert_eq!(at(of(Wrong::Nothing), [0.0; 3], [1e200, 0.0, 0.0]), None);
    let found = at(of(Wrong::Beyond), [1e-5, 0.0, 0.0], [0.0; 3]).unwrap();
    assert_eq!((found.derivative, found.time), (Derivative::First(Variable::Coordinate(0)), 2.0));
    let moved = NotANumber { function: SystemFunction::Constraint { row: 1, coordinate: 2 }, ..found };
    let moved = moved.renumbered(|i| 10 + i, 5);
    assert_eq!(moved.function, SystemFunction::Constraint { row: 6, coordinate: 12 });
    assert_eq!(moved.derivative, Derivative::First(Variable::Coordinate(10)));
}
