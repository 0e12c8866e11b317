//! One step of every family of methods.

use crate::lobatto::systems::Moving;
use crate::sensitivity::differences::{BAR, Input, Start, disagreement};
use crate::sensitivity::systems::{Controlled, Swivelling};
use crate::support::{ByHand, Three, ThreeTwo, Two};
use dla::{
    Composition, Differentiable, Dla, Energy, Form, Gauss, Lobatto, OneStep, Sensitivity, SensitivityError, State,
};
use lagrangian::{Midpoint, System, Trapezoid};
use sleigh::{Guided, Sleigh};
use test_systems::{IsokineticParticle, Model, SleighOnArm, Snakeboard};

fn assert_close(name: &str, worst: f64) {
    println!("{name}: {worst:.1e}");
    assert!(worst < BAR, "{name}: {worst:e}");
}

const START: Input<3, 6> = Input { q: [0.3, -0.2, 0.5], v: [0.6, 0.2, 1.1], t: 0.2, h: 0.1, p: Controlled::PARAMETERS };

fn on<const N: usize, const P: usize>(at: &Input<N, P>) -> (Start, &Input<N, P>) {
    (Start::Admissible, at)
}

fn bare() -> Input<3, 0> {
    Input { q: START.q, v: START.v, t: START.t, h: START.h, p: [] }
}

fn controlled<Method>(name: &str, method: &Method)
where
    Method: OneStep<3, 1> + Differentiable<3, 1> + Clone,
{
    let system = Controlled::at(&START.p);
    assert_close(
        name,
        disagreement(&Sensitivity::of_member(&system), Controlled::at, method, (Start::Admissible, &START)),
    );
}

/// State, mass, inertia, offset, height of the potential, and two controls.
#[test]
fn a_sleigh_with_parameters_and_controls() {
    controlled("dla", &Dla::midpoint());
    controlled("gauss8", &Gauss::new::<4>());
}

#[test]
#[ignore = "slow"]
fn a_sleigh_with_parameters_and_controls_in_full() {
    controlled("dla", &Dla::midpoint());
    controlled("dla-alpha", &Dla::alpha(0.3).unwrap());
    controlled("dla4", &Composition::suzuki4(Dla::midpoint()));
    controlled("lobatto3", &Lobatto::<3>::new());
    controlled("gauss8", &Gauss::new::<4>());
    controlled("energy2", &Energy::new::<1>());
    controlled("energy4", &Energy::new::<2>());
}

/// Its closed step and its accelerations by hand are differentiated through the general equations.
#[test]
fn the_free_sleigh() {
    let sleigh = ByHand::from(Sleigh::new(1.3, 0.8, 0.4).unwrap());
    let sensitivity = Sensitivity::of(&sleigh);
    assert_close("dla", disagreement(&sensitivity, |_| sleigh.clone(), &Dla::midpoint(), on(&bare())));
    assert_close("gauss8", disagreement(&sensitivity, |_| sleigh.clone(), &Gauss::new::<4>(), on(&bare())));
}

#[test]
fn multipliers_with_time_everywhere() {
    let system = Three::from(Moving);
    let sensitivity = Sensitivity::of(&system);
    assert_close("trapezoid", disagreement(&sensitivity, |_| system, &Dla::trapezoid(), on(&bare())));
    assert_close("mixed", disagreement(&sensitivity, |_| system, &Dla::new(Midpoint, Trapezoid), on(&bare())));
    assert_close("lobatto3", disagreement(&sensitivity, |_| system, &Lobatto::<3>::new(), on(&bare())));
}

#[test]
fn an_affine_constraint() {
    let table = || ByHand::from(Guided::turntable(Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.6).unwrap());
    let system = table();
    let sensitivity = Sensitivity::of(&system);
    let mixed = Dla::new(Midpoint, Midpoint).solved(Form::Multipliers);
    assert_close("multipliers", disagreement(&sensitivity, |_| table(), &mixed, on(&bare())));
    assert_close("gauss8", disagreement(&sensitivity, |_| table(), &Gauss::new::<4>(), on(&bare())));
}

/// The end of a step is on the constraint of its own time.
#[test]
fn a_basis_that_moves() {
    let at = Input { q: START.q, v: START.v, t: START.t, h: START.h, p: Swivelling::PARAMETERS };
    let system = Swivelling::at(&at.p);
    let sensitivity = Sensitivity::of_member(&system);
    assert_close("dla", disagreement(&sensitivity, Swivelling::at, &Dla::midpoint(), on(&at)));
    assert_close("gauss8", disagreement(&sensitivity, Swivelling::at, &Gauss::new::<4>(), on(&at)));
}

/// Two constraints, five coordinates.
#[test]
fn the_snakeboard() {
    let board = Snakeboard { m: 1.2, l: 0.4, J: 0.05, Jr: 0.03, Jw: 0.02 };
    let (mut q, v) = board.start();
    q[4] += 0.3;
    let at = Input { q, v, t: 0.0, h: 0.1, p: [] };
    let sensitivity = Sensitivity::of(&board);
    assert_close("dla", disagreement(&sensitivity, |_| board, &Dla::midpoint(), on(&at)));
}

/// A constraint on positions beside the blade's; the start is off it too, where the step still has a derivative.
#[test]
fn a_sleigh_on_an_arm() {
    let sleigh = SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0);
    let (q, v) = sleigh.start();
    let at = Input { q, v, t: 0.0, h: 0.1, p: [] };
    let sleigh = ThreeTwo::from(sleigh);
    let sensitivity = Sensitivity::of(&sleigh);
    assert_close("dla", disagreement(&sensitivity, |_| sleigh, &Dla::midpoint(), on(&at)));
    assert_close(
        "multipliers",
        disagreement(&sensitivity, |_| sleigh, &Dla::midpoint().solved(Form::Multipliers), on(&at)),
    );
    // The step that follows a tangent follows the arm: the first order of its length does not change.
    let mut state = State::new(q, v, sleigh.angles());
    let derivative = sensitivity.step(&mut Dla::midpoint(), 0.0, 0.1, &mut state).unwrap();
    let slope = lagrangian::position_misses(&sleigh, 0.1, state.q()).unwrap()[1].unwrap().eps;
    for column in derivative.from_v {
        let stretch: f64 = (0..3).map(|i| slope[i] * column.q[i]).sum();
        assert!(stretch.abs() < 1e-14, "{stretch:e}");
        assert!(column.q.iter().any(|x| x.abs() > 1e-3), "the control: it moves");
    }
    let refused = sensitivity.step(&mut Gauss::new::<4>(), 0.0, 0.1, &mut state);
    assert!(matches!(refused, Err(SensitivityError::Unsupported { .. })), "{refused:?}");
}

/// A constraint that is not affine in the velocities, by Chetaev's rule.
#[test]
fn an_isokinetic_particle() {
    let particle = IsokineticParticle::new(1.3, 0.8, 0.6);
    let (q, v) = particle.state_at([0.2, -0.1], 1.1);
    let at = Input { q, v, t: 0.0, h: 0.1, p: [] };
    let particle = Two::from(particle);
    let sensitivity = Sensitivity::of(&particle);
    assert_close("dla", disagreement(&sensitivity, |_| particle, &Dla::midpoint(), on(&at)));
    assert_close("dla4", disagreement(&sensitivity, |_| particle, &Composition::suzuki4(Dla::midpoint()), on(&at)));
}

/// Off the distribution the derivative is that of the equations in their general form.
#[test]
fn inadmissible_velocities() {
    let system = Controlled::at(&START.p);
    let sensitivity = Sensitivity::of_member(&system);
    let any = (Start::Any, &START);
    assert_close("dla", disagreement(&sensitivity, Controlled::at, &Dla::midpoint(), any));
    assert_close("lobatto3", disagreement(&sensitivity, Controlled::at, &Lobatto::<3>::new(), any));
    assert_close("gauss8", disagreement(&sensitivity, Controlled::at, &Gauss::new::<4>(), any));
    assert_close("energy2", disagreement(&sensitivity, Controlled::at, &Energy::new::<1>(), any));
}
