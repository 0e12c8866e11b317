//! One step of every family of methods.

use crate::lobatto::systems::Moving;
use crate::sensitivity::differences::{BAR, Input, Start, disagreement};
use crate::sensitivity::systems::{Controlled, Swivelling};
use crate::support::{ByHand, Three, ThreeTwo, Two};
use dla::{Composition, Dla, Form, Gauss, Rk4, Sensitivity, SensitivityError, State};
use lagrangian::{Midpoint, System, Trapezoid};
use sleigh::{Guided, Sleigh};
use test_systems::{IsokineticParticle, Model, SleighOnArm, Snakeboard};

const START: Input<3, 6> = Input { q: [0.3, -0.2, 0.5], v: [0.6, 0.2, 1.1], t: 0.2, h: 0.1, p: Controlled::PARAMETERS };

/// An admissible start.
fn at<const N: usize, const P: usize>(q: [f64; N], v: [f64; N], p: [f64; P]) -> (Start, Input<N, P>) {
    (Start::Admissible, Input { q, v, t: START.t, h: START.h, p })
}

/// Compares the derivatives of the steps of methods on a system with differences.
macro_rules! agrees {
    ($sensitivity:expr, $system:expr, $at:expr, $($method:expr),+) => {{
        let (start, at) = $at;
        $({
            let worst = disagreement(&$sensitivity, $system, &$method, (start, &at));
            println!("{}: {worst:.1e}", stringify!($method));
            assert!(worst < BAR, "{}: {worst:e}", stringify!($method));
        })+
    }};
}

/// State, mass, inertia, offset, height of the potential, and two controls.
#[test]
fn a_sleigh_with_parameters_and_controls() {
    let system = Controlled::at(&START.p);
    let sensitivity = Sensitivity::of_member(&system);
    agrees!(sensitivity, Controlled::at, (Start::Admissible, START), Dla::midpoint(), Gauss::new::<4>());
    // Off the distribution, the equations in their general form give the derivative.
    agrees!(sensitivity, Controlled::at, (Start::Any, START), Dla::midpoint(), Gauss::new::<4>());
}

#[test]
#[ignore = "slow"]
fn a_sleigh_with_parameters_and_controls_by_more_methods() {
    let system = Controlled::at(&START.p);
    let (sensitivity, four) = (Sensitivity::of_member(&system), Composition::suzuki4(Dla::midpoint()));
    agrees!(sensitivity, Controlled::at, (Start::Admissible, START), Dla::alpha(0.3).unwrap(), four);
}

/// Its closed step and its accelerations by hand are differentiated through the general equations.
#[test]
fn the_free_sleigh() {
    let sleigh = ByHand::from(Sleigh::new(1.3, 0.8, 0.4).unwrap());
    let at = at(START.q, START.v, []);
    agrees!(Sensitivity::of(&sleigh), |_| sleigh.clone(), at, Dla::midpoint(), Gauss::new::<4>());
}

#[test]
fn multipliers_with_time_everywhere() {
    let system = Three::from(Moving);
    let at = at(START.q, START.v, []);
    agrees!(Sensitivity::of(&system), |_| system, at, Dla::trapezoid(), Dla::new(Midpoint, Trapezoid), Rk4);
}

#[test]
fn an_affine_constraint() {
    let table = || ByHand::from(Guided::turntable(Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.6).unwrap());
    let system = table();
    let mixed = Dla::new(Midpoint, Midpoint).solved(Form::Multipliers);
    agrees!(Sensitivity::of(&system), |_| table(), at(START.q, START.v, []), mixed, Gauss::new::<4>());
}

/// The end of a step is on the constraint of its own time.
#[test]
fn a_basis_that_moves() {
    let system = Swivelling::at(&Swivelling::PARAMETERS);
    let at = at(START.q, START.v, Swivelling::PARAMETERS);
    agrees!(Sensitivity::of_member(&system), Swivelling::at, at, Dla::midpoint(), Gauss::new::<4>());
}

/// Two constraints, five coordinates.
#[test]
fn the_snakeboard() {
    let board = Snakeboard { m: 1.2, l: 0.4, J: 0.05, Jr: 0.03, Jw: 0.02 };
    let (mut q, v) = board.start();
    q[4] += 0.3;
    agrees!(Sensitivity::of(&board), |_| board, at(q, v, []), Dla::midpoint());
}

/// A constraint on positions beside the blade's; the start is off it too, where the step still has a derivative.
#[test]
fn a_sleigh_on_an_arm() {
    let sleigh = SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0);
    let (q, v) = sleigh.start();
    let sleigh = ThreeTwo::from(sleigh);
    let sensitivity = Sensitivity::of(&sleigh);
    agrees!(sensitivity, |_| sleigh, at(q, v, []), Dla::midpoint(), Dla::midpoint().solved(Form::Multipliers));
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
    let particle = Two::from(particle);
    let four = Composition::suzuki4(Dla::midpoint());
    agrees!(Sensitivity::of(&particle), |_| particle, at(q, v, []), Dla::midpoint(), four);
}
