use crate::energy::systems::{Potential, at_centre, com};
use crate::support::{ByHand, ThreeTwo};
use dla::{Derivative, Lobatto, NewtonError, OneStep, Stage, State, StepError, SystemFunction};
use lagrangian::{Constraint, Scalar, System};
use sleigh::{Sleigh, SleighState};

/// A point whose two constraints become one where `x = 0`.
#[derive(Clone, Copy)]
pub(crate) struct Dropping;
impl System<3, 2> for Dropping {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        ([[zero, one, zero], [zero, one, q[0]]], [zero; 2])
    }
}

/// The step fails, and the state is what it was.
fn refused<Sys: System<3, M>, const S: usize, const M: usize>(
    system: &Sys,
    method: &mut Lobatto<S>,
    h: f64,
    state: &State<3>,
) -> StepError {
    let mut after = *state;
    let error = method.step(system, 0.0, h, &mut after).unwrap_err();
    // By their digits: a velocity may be no number.
    assert_eq!(format!("{after:?}"), format!("{state:?}"), "a failed step leaves the state");
    error
}

#[test]
fn an_unconverged_step_is_never_accepted() {
    let system = com(0.5, Potential::EggCrate);
    let (q, v) = at_centre([0.5, 1.0, 0.3, 0.4, 0.7], 0.5);
    let state = State::new(q, v, system.angles());
    let mut method = Lobatto::<4>::new();
    method.newton.max_iterations = 2;
    let error = refused(&system, &mut method, 0.2, &state);
    let StepError::Newton { stage: Stage::Increment, source: NewtonError::IterationLimit { iterations: 2, .. } } =
        error
    else {
        panic!("{error}");
    };
}

/// Of longer and longer steps from one start those that succeed lie on one curve, whose points are as near as its slope
/// allows; a solution of another branch would lie elsewhere.
fn steps_on_one_curve(starts: &[u32], parts: u32) -> [u32; 2] {
    let sleigh = ByHand::from(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    let (mut accepted, mut refusals) = (0, 0);
    for &k in starts {
        let start = SleighState { speed: -3.0 + 0.5 * f64::from(k), turn_rate: 1.3, ..SleighState::default() };
        let (q, v) = start.to_coordinates();
        let mut before: Option<f64> = None;
        for part in 1..=parts {
            let mut state = State::new(q, v, sleigh.angles());
            match Lobatto::<3>::new().step(&sleigh, 0.0, 0.005 * f64::from(part), &mut state) {
                Ok(_) => {
                    let spin = state.v()[2];
                    // Spins and speeds are below 4, rates below 16, and near the end of a branch as roots.
                    if let Some(before) = before {
                        assert!((spin - before).abs() < 0.3, "{k}, part {part}: {before} {spin}");
                    }
                    (before, accepted) = (Some(spin), accepted + 1);
                }
                Err(error) => {
                    assert!(error.hint().is_some(), "{error}");
                    refusals += 1;
                }
            }
        }
    }
    println!("accepted {accepted}, refused {refusals}");
    [accepted, refusals]
}

/// Steps to 0.6 s; those to 0.1 s at least are accepted.
#[test]
fn no_wrong_root_is_accepted() {
    let [accepted, _] = steps_on_one_curve(&[0, 6], 120);
    assert!(accepted >= 40, "{accepted}");
}

#[test]
#[ignore = "slow"]
fn no_wrong_root_is_accepted_at_length() {
    let [accepted, refusals] = steps_on_one_curve(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11], 800);
    assert!(accepted > 2000 && refusals > 100, "{accepted} {refusals}");
}

#[test]
fn a_step_far_too_long() {
    let system = com(0.5, Potential::EggCrate);
    let (q, v) = at_centre([0.5, 1.0, 0.3, 4.0, 7.0], 0.5);
    let state = State::new(q, v, system.angles());
    let error = refused(&system, &mut Lobatto::<3>::new(), 300.0, &state);
    assert!(matches!(error, StepError::Turn { coordinate: 2, .. }), "{error}");
}

#[test]
fn what_is_not_a_number() {
    let system = com(0.5, Potential::EggCrate);
    let error = |v: [f64; 3]| {
        let state = State::new([0.0; 3], v, system.angles());
        refused(&system, &mut Lobatto::<3>::new(), 0.1, &state)
    };
    for v in [[f64::NAN, 0.0, 0.1], [1.0, f64::INFINITY, 0.1]] {
        let error = error(v);
        assert!(matches!(error, StepError::Newton { .. }), "{error}");
    }
    // Of velocities that are numbers it is the system whose kinetic energy is none.
    let error = error([1e308, -1e308, 1.0]);
    let StepError::NotANumber(found) = error else { panic!("{error}") };
    assert_eq!((found.function, found.derivative), (SystemFunction::Lagrangian, Derivative::Value));
}

#[test]
fn constraints_that_depend_on_one_another() {
    let system = ThreeTwo::from(Dropping);
    let state = State::new([0.0; 3], [0.0, 0.0, 1.0], [false; 3]);
    let error = refused(&system, &mut Lobatto::<3>::new(), 0.1, &state);
    assert!(error.to_string().starts_with("rows 1 and 2 of the constraint are linearly dependent"), "{error}");
    assert!(matches!(error, StepError::Dependent(_)));
    // The control: elsewhere they do not.
    let mut state = State::new([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [false; 3]);
    Lobatto::<3>::new().step(&system, 0.0, 0.1, &mut state).unwrap();
    assert!((state.q()[0] - 1.1).abs() < 1e-14);
}
