//! What has no derivative says so, and changes nothing.

use crate::lobatto::systems::Moving;
use crate::sensitivity::systems::Controlled;
use crate::support::{Three, ThreeTwo};
use dla::{
    Composition, Differentiable, Dla, Gauss, OneStep, Schedule, Sensitivity, SensitivityError, State, StepEquations,
    StepError, StepReport, StepStart,
};
use lagrangian::{Gradients, Seeded, System};
use std::ops::ControlFlow;
use test_systems::{Model, SleighOnArm};

#[test]
fn a_refusal_has_a_reason_and_changes_nothing() {
    // No basis: the method's own refusal comes through.
    let mut state = State::new([0.1, 0.2, 0.3], [1.0, 0.4, 0.2], [false; 3]);
    let (system, before) = (Three::from(Moving), state);
    let refused = Sensitivity::of(&system).step(&mut Gauss::new::<4>(), 0.0, 0.1, &mut state);
    assert!(matches!(refused, Err(SensitivityError::Step(_))), "{refused:?}");
    assert_eq!(state, before);
    // From the same start another method has one.
    Sensitivity::of(&system).step(&mut Dla::trapezoid(), 0.0, 0.1, &mut state).unwrap();
}

#[test]
fn a_failed_step_and_numbers_that_are_none() {
    let system = Controlled::at(&Controlled::PARAMETERS);
    let mut state = State::new([0.0; 3], [f64::MAX, 0.0, f64::MAX], system.angles());
    let before = state;
    let failed = Sensitivity::of_member(&system).step(&mut Dla::midpoint(), 0.0, 0.1, &mut state);
    assert!(matches!(failed, Err(SensitivityError::Step(_))), "{failed:?}");
    assert_eq!(state, before);

    // Of a run the error says which step it was, and when.
    let schedule = Schedule { t0: 0.5, step: 0.1, steps: 3 };
    let failed = Sensitivity::of_member(&system)
        .drive(&mut Dla::midpoint(), &schedule, &mut state, &mut [], |_, _, _| ControlFlow::Continue(()))
        .unwrap_err();
    assert_eq!((failed.step, failed.time.to_bits()), (1, 0.5f64.to_bits()));
    assert_eq!(state, before);
}

/// Which classes of constraints a composition carries, and into what it divides a step, is its base's matter.
#[test]
fn a_composition_is_differentiated_as_its_base() {
    let sleigh = SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0);
    let ((q, v), sleigh) = (sleigh.start(), ThreeTwo::from(sleigh));
    let (start, sensitivity) = (State::new(q, v, sleigh.angles()), Sensitivity::of(&sleigh));
    let mut end = start;
    let carries = Composition::suzuki4(Dla::midpoint());
    let report = OneStep::step(&mut { carries }, &sleigh, 0.0, 0.1, &mut end).unwrap();
    assert!(sensitivity.between(&carries, (0.0, 0.1), &start, &end, report).is_ok());
    let not = Composition::suzuki4(Gauss::new::<1>());
    let refused = sensitivity.between(&not, (0.0, 0.1), &start, &end, report);
    let Err(SensitivityError::Unsupported { reason }) = refused else { panic!("{refused:?}") };
    assert!(reason.contains("constraints on positions"), "{reason}");

    let (outer, inner) = (Composition::suzuki4(()), Composition::kahan_li6(Dla::midpoint()));
    let fractions = Differentiable::<3, 1>::fractions(&Composition::suzuki4(inner));
    let products = outer.weights().iter().flat_map(|g| inner.weights().iter().map(move |w| g * w));
    assert_eq!(fractions, products.collect::<Vec<_>>());
}

/// A method that steps by one rule and states the equations of another.
struct Impostor;

impl OneStep<3, 1> for Impostor {
    fn step(
        &mut self,
        system: &dyn dla::Mechanics<3, 1>,
        t: f64,
        h: f64,
        state: &mut State<3>,
    ) -> Result<StepReport<1>, StepError> {
        Dla::trapezoid().step(system, t, h, state)
    }
}

impl Differentiable<3, 1> for Impostor {
    fn guess(&self, v: &[f64; 3]) -> Vec<f64> {
        Differentiable::<3, 1>::guess(&Dla::midpoint(), v)
    }
    fn equations(
        &self,
        model: &dyn Gradients<3, 1>,
        start: &StepStart<3>,
        z: &[Seeded],
    ) -> Result<StepEquations<3>, SensitivityError> {
        Dla::midpoint().equations(model, start, z)
    }
}

#[test]
fn a_step_that_does_not_solve_its_equations_is_found_out() {
    let mut state = State::new([0.1, 0.2, 0.3], [1.0, 0.4, 0.2], [false; 3]);
    let refused = Sensitivity::of(&Three::from(Moving)).step(&mut Impostor, 0.0, 0.1, &mut state);
    assert!(matches!(refused, Err(SensitivityError::OtherSolution { defect }) if defect > 1e-6), "{refused:?}");
}
