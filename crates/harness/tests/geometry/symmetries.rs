use crate::geometry::{dla, run};
use approx::assert_relative_eq;
use dla::State;
use harness::analysis::MomentumMeter;
use lagrangian::{Conservation, CoordinateField, Scalar, System, VectorField, With, conservation, momentum_balance};
use sleigh::effects::Bowl;
use sleigh::{Flywheel, Sleigh, TimeFunction};

fn sleigh() -> Sleigh {
    Sleigh::new(1.3, 0.7, 0.4).unwrap()
}

fn rotor(torque: Option<TimeFunction>) -> Flywheel<Sleigh> {
    Flywheel::new(sleigh(), 0.2, torque).unwrap()
}

/// Turning everything about the origin: the blade's contact point and the heading.
struct Rotation;
impl<const N: usize> VectorField<N> for Rotation {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        std::array::from_fn(|i| match i {
            0 => -q[1],
            1 => q[0],
            2 => S::constant(1.0),
            _ => S::zero(),
        })
    }
}

/// No symmetry of anything with a mass: it stretches the plane.
struct Stretching;
impl<const N: usize> VectorField<N> for Stretching {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        std::array::from_fn(|i| if i < 2 { q[i] } else { S::zero() })
    }
}

/// Admissible states in general position.
fn states<Sys: System<N, 1>, const N: usize>(system: &Sys) -> Vec<(f64, [f64; N], [f64; N])> {
    let state = |k: usize| {
        let at = |i: usize, turn: f64| (1.3 * k as f64 + 0.7 * i as f64 + turn).sin();
        let (q, xi) = (std::array::from_fn(|i| at(i, 0.2)), std::array::from_fn(|i| at(i, 1.1)));
        (0.4 + 0.3 * k as f64, q, system.admissible_basis(0.0, &q).unwrap().combine(&xi))
    };
    (0..5).map(state).collect()
}

fn told<Sys: System<N, 1>, const N: usize>(system: &Sys, field: &impl VectorField<N>) -> Conservation {
    conservation(system, &states(system), field).unwrap()
}

#[test]
fn the_theorem_tells_conserved_momenta_from_those_that_reactions_change() {
    // The rotor's own: nothing of the blade acts along it, unless a motor does.
    assert_eq!(told(&rotor(None), &CoordinateField(3)), Conservation::Conserved);
    assert_eq!(told(&rotor(Some(0.3.into())), &CoordinateField(3)), Conservation::MomentumEquation);
    // The plane's: symmetries, which the blade does not admit.
    for k in 0..2 {
        assert_eq!(told(&sleigh(), &CoordinateField(k)), Conservation::MomentumEquation);
    }
    assert_eq!(told(&sleigh(), &Rotation), Conservation::MomentumEquation);
    // The positive controls: no symmetries.
    assert_eq!(told(&sleigh(), &CoordinateField(2)), Conservation::NoSymmetry);
    assert_eq!(told(&sleigh(), &Stretching), Conservation::NoSymmetry);
    let bowl = |center| With { body: sleigh(), effects: Bowl::new([0.3, 0.3], center).unwrap() };
    assert_eq!(told(&bowl([0.0, 0.0]), &Rotation), Conservation::MomentumEquation);
    assert_eq!(told(&bowl([0.1, 0.0]), &Rotation), Conservation::NoSymmetry);
    assert_eq!(told(&bowl([0.0, 0.0]), &CoordinateField(0)), Conservation::NoSymmetry);
}

/// `d/dt p_x = lambda . (A d_x) = -m u omega (I/J) sin theta`, by hand.
#[test]
fn the_balance_is_the_reaction_of_the_blade() {
    let (s, theta, u, omega) = (sleigh(), 0.8_f64, 1.1, -0.6);
    let (q, v) = ([0.2, 0.3, theta], [u * theta.cos(), u * theta.sin(), omega]);
    let balance = momentum_balance::<_, _, 3, 1>(&s, 0.0, &q, &v, &CoordinateField(0)).unwrap();
    let force = s.mass() * u * omega * s.inertia() / s.pivot_inertia();
    assert_relative_eq!(balance.rate(), -force * theta.sin(), max_relative = 1e-14);
    assert_relative_eq!(balance.crossing[0], -theta.sin());
    // p_x = m C'_x, C' = P' + a omega n.
    let momentum = s.mass() * (v[0] - s.offset() * omega * theta.sin());
    assert_relative_eq!(balance.momentum, momentum, max_relative = 1e-14);
}

#[test]
fn a_run_keeps_the_one_and_changes_the_other_as_it_must() {
    let system = rotor(None);
    let (q, v) = ([0.0, 0.0, 0.4, 0.0], [-0.4_f64.cos(), -0.4_f64.sin(), 0.1, 1.3]);
    let measured = |steps: u64| {
        let mut meters =
            (MomentumMeter::new(&system, CoordinateField(3)), MomentumMeter::new(&system, CoordinateField(0)));
        let mut state = State::new(q, v, system.angles());
        run(&system, dla, (20.0 / steps as f64, steps), &mut state, (&mut meters.0, &mut meters.1));
        meters
    };
    let (coarse, fine) = (measured(400), measured(800));
    // I_r (omega + psi') is about 0.3 and made of sums of a few times its size: rounding at every node is below 1e-15 of it.
    assert!(coarse.0.drift() < 800.0 * f64::EPSILON * 0.3, "{}", coarse.0.drift());
    // The sleigh turns around: the momentum along x changes by about 2 m U, and its equation holds to second order.
    assert!(coarse.1.drift() > 1.0);
    let order = (coarse.1.defect() / fine.1.defect()).log2();
    assert_relative_eq!(order, 2.0, epsilon = 0.1);
}
