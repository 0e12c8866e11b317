//! A homogeneous ball rolls straight at any attitude: `x = r omega_y t`, `y = -r omega_x t`. By angles that end at an attitude
//! it meets (Drake issue 14114, Gazebo issue 2023), methods went on with any error; by quaternions there is nothing to meet.

use crate::attitudes::angles::AngleBall;
use crate::attitudes::tools::{Place, assert_halving, assert_order, largest};
use crate::support::{Five, Six};
use dla::{Composition, Dla, Energy, Gauss, Lobatto, OneStep, RunError, View};
use lagrangian::System;
use proptest::prelude::*;
use test_systems::{Attitude, ChaplyginBall};

const MOMENT: f64 = 0.4;

/// The largest errors of a run: of the place, of the energy relative to it, of the constraints.
type Errors = [f64; 3];

/// A run of so long (s), at an angular velocity, by steps of a length.
#[derive(Clone, Copy)]
struct Roll {
    omega: [f64; 3],
    step: f64,
    time: f64,
}

fn errors<Sys, const N: usize, const M: usize>(
    system: &Sys,
    method: &mut dyn OneStep<N, M>,
    start: Place<N>,
    Roll { omega, step, time }: Roll,
) -> (Errors, Option<RunError>)
where
    Sys: System<N, M>,
{
    let energy = lagrangian::energy(system, 0.0, &start.0, &start.1);
    let (found, end) = largest(system, method, start, (step, (time / step).round() as u64), |node: &View<'_>| {
        let q = node.state.unwrapped();
        let off = (q[0] - start.0[0] - omega[1] * node.t).abs().max((q[1] - start.0[1] + omega[0] * node.t).abs());
        [off, (node.energy() / energy - 1.0).abs(), node.constraint()]
    });
    (found, end.err())
}

/// The errors of the ball of mass and radius one by quaternions, from an attitude.
fn by_quaternions<Method: OneStep<6, 3>>(
    ball: ChaplyginBall,
    mut method: Method,
    from: &Attitude<f64>,
    roll: Roll,
) -> Errors {
    let (found, error) = errors(&Six::from(ball), &mut method, ball.rolling([0.0; 2], from, roll.omega), roll);
    assert_eq!(error, None);
    found
}

fn ball() -> ChaplyginBall {
    ChaplyginBall::new(1.0, 1.0, [MOMENT; 3])
}

/// At most ten metres, each step with a rounding of the place and the velocities, all in one direction at worst.
fn rounding(Roll { step, time, .. }: Roll) -> f64 {
    10.0 * f64::EPSILON * (time / step).max(16.0)
}

fn to_rounding(name: &str, found: Errors, roll: Roll) {
    println!("{name}, h = {}: {found:?}", roll.step);
    assert!(found.iter().all(|x| *x <= rounding(roll)), "{name}: {found:?}");
}

/// The angular velocities of which the angles end at a quarter turn, exactly, nearly and by far.
const TURNS: [[f64; 3]; 4] = [[0.0, 1.0, 0.0], [1e-6, 1.0, 0.0], [1e-3, 1.0, 0.0], [0.1, 1.0, 0.05]];

/// Every method that carries the length of the quaternion on positions, and every one that keeps it from its rate. The turn is
/// even, and the energy does not depend on the attitude: so the variational methods make no error at all.
fn rolls_straight(roll: Roll) {
    let (level, omega) = (Attitude::LEVEL, roll.omega);
    for (form, ball) in [("positions", ball()), ("rate", ball().norm_by_rate())] {
        let four = Composition::suzuki4(Dla::midpoint());
        for (name, found) in [
            ("dla", by_quaternions(ball, Dla::midpoint(), &level, roll)),
            ("dla4", by_quaternions(ball, four, &level, roll)),
            ("lobatto3", by_quaternions(ball, Lobatto::<3>::new(), &level, roll)),
            ("gauss8", by_quaternions(ball, Gauss::new::<4>(), &level, roll)),
        ] {
            to_rounding(&format!("{name}, {form}, {omega:?}"), found, roll);
        }
    }
    // The place has the method's order, and its error grows with time; energy and constraints do not know it.
    let [place, energy, slip] = by_quaternions(ball().norm_by_rate(), Energy::new::<2>(), &level, roll);
    println!("energy4, {omega:?}, h = {}: {place:e}", roll.step);
    assert!(energy <= rounding(roll) && slip <= rounding(roll));
    assert!(place <= 3e-4 * roll.time * roll.step.powi(4) + rounding(roll), "{place:e}");
}

/// The error of the place by the energy method of order 4.
fn by_energy(step: f64, time: f64) -> f64 {
    let roll = Roll { omega: TURNS[3], step, time };
    by_quaternions(ball().norm_by_rate(), Energy::new::<2>(), &Attitude::LEVEL, roll)[0]
}

/// Past the quarter turn.
#[test]
fn a_homogeneous_ball_rolls_straight() {
    rolls_straight(Roll { omega: TURNS[3], step: 0.1, time: 2.0 });
    assert_halving("energy4", [0.4, 0.2].map(|step| by_energy(step, 2.0)), 4.0);
}

#[test]
#[ignore = "slow"]
fn a_homogeneous_ball_rolls_straight_at_length() {
    for omega in TURNS {
        for step in [0.1, 0.01] {
            rolls_straight(Roll { omega, step, time: 10.0 });
        }
    }
    assert_order("energy4", [0.4, 0.2, 0.1, 0.05].map(|step| by_energy(step, 10.0)), 4.0);
}

/// The control: by angles the same runs leave the line, or are given up, with nothing said before.
#[test]
fn by_angles_it_does_not() {
    let ball = AngleBall { mass: 1.0, radius: 1.0, inertia: [MOMENT; 3] };
    let by_angles = |method: &mut dyn OneStep<5, 2>, omega: [f64; 3], step: f64| {
        errors(&Five::from(ball), method, ball.level(omega), Roll { omega, step, time: 10.0 })
    };
    let ([place, energy, _], error) = by_angles(&mut Dla::midpoint(), [1e-3, 1.0, 0.0], 0.01);
    println!("1e-3, dla: {place:e} m, energy {energy:e}, {error:?}");
    assert!(place > 1e-3 && energy > 0.01);
    let ([place, ..], error) = by_angles(&mut Dla::midpoint(), [0.1, 1.0, 0.05], 0.1);
    println!("0.1, dla: {place:e} m, {error:?}");
    assert!(place > 0.1);
    let ([place, ..], error) = by_angles(&mut Composition::suzuki4(Dla::midpoint()), [1e-6, 1.0, 0.0], 0.01);
    println!("1e-6, dla4: {place:e} m, {error:?}");
    assert!(place > 1e-4 || error.is_some());
}

/// A ball of unequal moments by both charts, while the angles are far from their end: one motion.
#[test]
fn both_charts_are_one_motion() {
    let (inertia, omega) = ([0.3, 0.4, 0.55], [0.3, 0.2, -0.4]);
    let (ours, theirs) = (ChaplyginBall::new(1.2, 0.7, inertia), AngleBall { mass: 1.2, radius: 0.7, inertia });
    let steps = (0.01, 300);
    let (_, by_quaternions) = largest(
        &Six::from(ours),
        &mut Gauss::new::<4>(),
        ours.rolling([0.0; 2], &Attitude::LEVEL, omega),
        steps,
        |_| [0.0],
    );
    let (_, by_angles) = largest(&Five::from(theirs), &mut Gauss::new::<4>(), theirs.level(omega), steps, |_| [0.0]);
    let (ours, theirs) = (by_quaternions.unwrap(), by_angles.unwrap());
    let [alpha, beta, gamma] = [2, 3, 4].map(|i| theirs.unwrapped()[i]);
    let about = |axis: [f64; 3], angle: f64| Attitude::about(axis, angle);
    let turned =
        about([1.0, 0.0, 0.0], alpha).after(&about([0.0, 1.0, 0.0], beta)).after(&about([0.0, 0.0, 1.0], gamma));
    let [.., s, x, y, z] = *ours.q();
    for (ours, theirs) in Attitude::new([s, x, y, z]).rotation().iter().zip(turned.rotation()) {
        approx::assert_abs_diff_eq!(&ours[..], &theirs[..], epsilon = 1e-13);
    }
    for i in 0..2 {
        approx::assert_abs_diff_eq!(ours.q()[i], theirs.q()[i], epsilon = 1e-13);
        approx::assert_abs_diff_eq!(ours.v()[i], theirs.v()[i], epsilon = 1e-13);
    }
}

/// From any attitude, at any angular velocity, over so long (s).
fn rolls_from(e: [f64; 4], omega: [f64; 3], time: f64) {
    let (from, roll) = (Attitude::nearest(e), Roll { omega, step: 0.1, time });
    to_rounding("dla", by_quaternions(ball(), Dla::midpoint(), &from, roll), roll);
    to_rounding("lobatto3", by_quaternions(ball(), Lobatto::<3>::new(), &from, roll), roll);
    // Space turned about the vertical turns the path of any ball: no direction of it is singled out.
    let ball = ChaplyginBall::new(1.2, 0.7, [0.3, 0.4, 0.55]);
    let steps = (10.0 * time).round() as u64;
    let run =
        |start: Place<6>| largest(&Six::from(ball), &mut Dla::midpoint(), start, (0.05, steps), |_| [0.0]).1.unwrap();
    let quarter = Attitude::about([0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2);
    let here = run(ball.rolling([0.0; 2], &from, omega));
    let there = run(ball.rolling([0.0; 2], &quarter.after(&from), quarter.in_space(&omega)));
    let ([x, y, ..], [turned_x, turned_y, ..]) = (*here.q(), *there.q());
    approx::assert_abs_diff_eq!(&[turned_x, turned_y][..], &[-y, x][..], epsilon = 1e-14 * steps as f64);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn from_any_attitude(e in proptest::array::uniform4(-1.0..1.0f64), omega in proptest::array::uniform3(-1.5..1.5f64)) {
        rolls_from(e, omega, 2.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    #[ignore = "slow"]
    fn from_any_attitude_at_length(
        e in proptest::array::uniform4(-1.0..1.0f64),
        omega in proptest::array::uniform3(-1.5..1.5f64),
    ) {
        rolls_from(e, omega, 10.0);
    }
}
