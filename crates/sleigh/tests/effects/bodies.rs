//! What a body with a rotor passes on from the body, and which coordinates are angles.

use approx::assert_abs_diff_eq;
use lagrangian::{Constraint, Reduced, Scalar, System};
use sleigh::{CentreOfMass, Flywheel, Sleigh};

/// A body whose constraint is of positions, and one more that is not affine.
struct Bent;

impl System<3, 2> for Bent {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        ([[q[0], q[1], S::zero()], [S::zero(); 3]], [S::zero(); 2])
    }
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<[Option<S>; 2]> {
        Some([Some(q[0] * q[0] + q[1] * q[1] + q[2] - t), None])
    }
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[Option<S>; 2]> {
        Some([None, Some(v[0] * v[1] - q[2] * v[2] + t)])
    }
    fn angles(&self) -> [bool; 3] {
        [true, false, false]
    }
}

#[test]
fn constraints_of_the_body_stay() {
    let rotor = Flywheel::new(Bent, 0.25, None).unwrap();
    assert!((rotor.inertia() - 0.25).abs() < f64::EPSILON);
    let (t, q, v) = (0.5, [0.1, 0.2, 0.3, 9.0], [1.0, 2.0, 3.0, 9.0]);
    let [Some(position), None] = rotor.holonomic(t, &q).unwrap() else { panic!("no constraint on positions") };
    assert_abs_diff_eq!(position, 0.01 + 0.04 + 0.3 - 0.5, epsilon = 1e-15);
    let [None, Some(velocity)] = rotor.nonlinear(t, &q, &v).unwrap() else {
        panic!("no constraint that is not affine")
    };
    assert_abs_diff_eq!(velocity, 2.0 - 0.9 + 0.5, epsilon = 1e-15);
    assert_eq!(rotor.angles(), [true, false, false, true]);
    // Two rows leave the body no reduced motion of its own here.
    assert!(rotor.reduced_motion(t, &q, &v).is_none() && rotor.pushed_motion(t, &q, &v, &v).is_none());
}

#[test]
fn headings_are_angles() {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    assert_eq!(sleigh.angles(), [false, false, true]);
    assert_eq!(CentreOfMass(sleigh).angles(), [false, false, true]);
    assert_eq!(Flywheel::new(sleigh, 0.2, None).unwrap().angles(), [false, false, true, true]);
}

/// `u' = (e . f)/m`, `omega' = tau/J`; the blade holds `m a omega' - n . f`. The motor takes from the body what it gives the rotor.
#[test]
fn responses_to_forces() {
    let (m, inertia, a, heading) = (1.3, 0.8, 0.4, 0.7_f64);
    let sleigh = Sleigh::new(m, inertia, a).unwrap();
    let (sin, cos) = heading.sin_cos();
    let ([fx, fy, tau, motor], j) = ([0.5, -0.3, 0.9, 0.2], inertia + m * a * a);
    let along = (cos * fx + sin * fy) / m;
    let made = sleigh.response(0.0, &[0.1, 0.2, heading], &[fx, fy, tau]).unwrap();
    for (found, expected) in made.acceleration.into_iter().zip([along * cos, along * sin, tau / j]) {
        assert_abs_diff_eq!(found, expected, epsilon = 1e-15);
    }
    assert_abs_diff_eq!(made.multiplier[0], m * a * tau / j - (cos * fy - sin * fx), epsilon = 1e-15);
    let rotor = Flywheel::new(sleigh, 0.25, None).unwrap();
    // At rest the accelerations are those of the forces alone.
    let place = [0.1, 0.2, heading, 5.0];
    let made = Reduced::<4, 1>::pushed_motion(&rotor, 0.0, &place, &[0.0; 4], &[fx, fy, tau, motor]).unwrap();
    for (found, expected) in made.into_iter().zip([along, (tau - motor) / j, motor / 0.25, 0.0]) {
        assert_abs_diff_eq!(found, expected, epsilon = 1e-15);
    }
    // With a motor that pushes, the free motion and that: `u' = a omega^2`, `omega' = -(m a/J) u omega - tau/J`.
    let driven = Flywheel::new(sleigh, 0.25, Some(motor.into())).unwrap();
    let (u, omega) = (0.6, -0.8);
    let made = Reduced::<4, 1>::reduced_motion(&driven, 0.0, &[0.1, 0.2, heading, 5.0], &[u, omega, 2.0, 0.0]).unwrap();
    let expected = [a * omega * omega, -m * a / j * u * omega - motor / j, motor / 0.25, 0.0];
    for (found, expected) in made.into_iter().zip(expected) {
        assert_abs_diff_eq!(found, expected, epsilon = 1e-15);
    }
}

/// The centre of mass is `a` ahead along the heading, and its velocity is the velocity of the blade plus `a omega` across.
#[test]
fn the_centre_of_mass_is_ahead() {
    let (a, heading) = (0.4, 0.7_f64);
    let com = CentreOfMass(Sleigh::new(1.3, 0.8, a).unwrap());
    let (sin, cos) = heading.sin_cos();
    let (q, v) = com.from_blade(&[1.0, 2.0, heading], &[0.5, -0.6, 0.9]);
    let expected = [1.0 + a * cos, 2.0 + a * sin, heading, 0.5 - a * 0.9 * sin, -0.6 + a * 0.9 * cos, 0.9];
    for (found, expected) in q.into_iter().chain(v).zip(expected) {
        assert_abs_diff_eq!(found, expected, epsilon = 1e-15);
    }
}
