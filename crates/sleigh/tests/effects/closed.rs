//! The closed step against its own equations: of the midpoint rule, in the velocities along the chord and about the blade.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dla::ClosedStepError;
use lagrangian::With;
use proptest::prelude::*;
use sleigh::closed::{ClosedForm, ClosedStart, ClosedStep, Memory};
use sleigh::effects::Thrust;
use sleigh::{Flywheel, Guide, Guided, Sleigh, SleighState};
use std::f64::consts::TAU;

fn start(heading: f64, speed: f64, turn_rate: f64) -> ([f64; 3], [f64; 3]) {
    SleighState { x: 0.3, y: -0.2, heading, speed, turn_rate }.to_coordinates()
}

fn step(sleigh: &Sleigh, h: f64, heading: f64, u: f64, omega: f64) -> Result<ClosedStep<3, 1>, ClosedStepError> {
    let (q, v) = start(heading, u, omega);
    ClosedForm::<3, 1>::closed_step(sleigh, 0.0, h, ClosedStart::new(&q, &v, &mut Memory::default())).unwrap()
}

proptest! {
    #[test]
    fn the_equations_of_the_step_hold(
        (m, i, a) in (0.1..10.0, 0.1..10.0, -0.8..0.8),
        (heading, u0, omega0) in (-3.0..3.0, -2.0..2.0, -2.0..2.0),
        h in prop_oneof![-0.5..-0.01, 0.01..0.5],
    ) {
        let sleigh = Sleigh::new(m, i, a).unwrap();
        let Ok(made) = step(&sleigh, h, heading, u0, omega0) else {
            // The blade turns by a right angle, or the spin is lost, in half a step.
            let lost = (0.5 * h * sleigh.spin_gain() * u0).abs() > 0.5;
            prop_assert!(lost, "refused");
            return Ok(());
        };
        let [dx, dy, turn] = made.increment;
        let (w, d, k) = (turn / h, 0.5 * turn, 0.5 * h * sleigh.spin_gain());
        let (sin, cos) = (heading + d).sin_cos();
        let chord = (dx * cos + dy * sin) / h;
        let [u1, omega1, rest] = made.xi;
        // Numbers below ten, and rounding of the search of the size of its bound, divided by the slope of the equation.
        let bound = 1e-13 * (1.0 + 1.0 / (1.0 + k * chord).abs());
        assert_abs_diff_eq!(dy * cos - dx * sin, 0.0, epsilon = 1e-14);
        assert_abs_diff_eq!(chord * d.cos() - a * w * d.sin(), u0, epsilon = bound);
        assert_abs_diff_eq!(w * (1.0 + k * chord), omega0, epsilon = bound);
        assert_abs_diff_eq!(chord * d.cos() + a * w * d.sin(), u1, epsilon = bound);
        assert_abs_diff_eq!(w * (1.0 - k * chord), omega1, epsilon = bound);
        prop_assert!(rest == 0.0 && made.iterations >= 1);
        // The blade at the end.
        let (sin, cos) = (heading + turn).sin_cos();
        assert_abs_diff_eq!(made.velocity[0], u1 * cos, epsilon = bound);
        assert_abs_diff_eq!(made.velocity[1], u1 * sin, epsilon = bound);
        prop_assert_eq!(made.velocity[2].to_bits(), omega1.to_bits());
        // A known speed is taken as it is, whatever the velocity of the place.
        let (q, v) = start(heading, u0, omega0);
        let from = [v[0] * heading.cos() + v[1] * heading.sin(), omega0, 0.0];
        let (v, mut memory) = ([9.0, 9.0, omega0], Memory::EMPTY);
        let again = ClosedStart { xi: Some(from), ..ClosedStart::new(&q, &v, &mut memory) };
        let again = ClosedForm::<3, 1>::closed_step(&sleigh, 0.0, h, again).unwrap().unwrap();
        assert_abs_diff_eq!(again.xi[0], u1, epsilon = bound);
        assert_abs_diff_eq!(again.xi[1], omega1, epsilon = bound);
    }

    /// The memory of earlier steps changes the first guess of the search, not its result: also of another sleigh, after a jump of
    /// the velocity, or of the place.
    #[test]
    fn the_step_is_the_same_whatever_is_remembered(
        (m, i, a) in (0.3..3.0, 0.3..3.0, -0.8..0.8), (heading, u0, omega0) in (-3.0..3.0, -1.0..1.0, -1.0..1.0),
        bits in -60..0i32, h in prop_oneof![-0.1..-0.01, 0.01..0.1], steps in 1..20u32,
    ) {
        let [ours, other] = [Sleigh::new(m, i, a).unwrap(), Sleigh::new(i, m, 0.9 * a).unwrap()];
        let omega0 = omega0 * f64::from(bits).exp2();
        for (sleigh, factor, turned) in
            [(ours, 1.0, 0.0), (ours, 0.5, 0.0), (ours, -1.0, 0.0), (ours, 1.0, 1e-9), (ours, 1.0, 2.0), (other, 1.0, 0.0)]
        {
            let (mut q, mut v) = start(heading, u0, omega0);
            let (mut xi, mut memory) = ([u0, omega0, 0.0], Memory::EMPTY);
            for _ in 0..steps {
                let start = ClosedStart { xi: Some(xi), ..ClosedStart::new(&q, &v, &mut memory) };
                let made = ClosedForm::<3, 1>::closed_step(&sleigh, 0.0, h, start).unwrap().unwrap();
                (xi, v) = (made.xi, made.velocity);
                (0..3).for_each(|i| q[i] += made.increment[i]);
            }
            q[2] += turned;
            (xi, v[2]) = (xi.map(|x| factor * x), factor * v[2]);
            let [blank, known] = [Memory::EMPTY, memory].map(|mut memory| {
                let start = ClosedStart { xi: Some(xi), ..ClosedStart::new(&q, &v, &mut memory) };
                ClosedForm::<3, 1>::closed_step(&ours, 0.0, h, start).unwrap().unwrap()
            });
            // Numbers of order one, but for the spin, which has all its digits.
            for (x, y) in blank.increment.iter().chain(&blank.velocity).zip(known.increment.iter().chain(&known.velocity)) {
                assert_abs_diff_eq!(x, y, epsilon = 1e-14);
            }
            assert_relative_eq!(blank.xi[1], known.xi[1], max_relative = 1e-14);
        }
    }

    /// A smooth motion needs one correction a step, once the steps before tell where to begin.
    #[test]
    fn one_correction_is_enough(heading in -3.0..3.0, u0 in -1.0..1.0, omega0 in -1.0..1.0) {
        let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
        let (q, v) = start(heading, u0, omega0);
        let (mut xi, mut v, mut memory, mut corrections) = ([u0, omega0, 0.0], v, Memory::EMPTY, vec![]);
        for _ in 0..100 {
            let start = ClosedStart { xi: Some(xi), ..ClosedStart::new(&q, &v, &mut memory) };
            let made = ClosedForm::<3, 1>::closed_step(&sleigh, 0.0, 0.02, start).unwrap().unwrap();
            (xi, v) = (made.xi, made.velocity);
            corrections.push(made.iterations);
        }
        prop_assert!(corrections[8..].iter().all(|&n| n == 1), "{corrections:?}");
    }

    /// The heading's sine and cosine are turned along, and what rounding does to them does not add up: over as many steps the velocity
    /// keeps the direction of the blade.
    #[test]
    fn the_velocity_stays_along_the_blade(heading in -3.0..3.0, u0 in -1.0..1.0, omega0 in -1.0..1.0, h in 0.01..0.1) {
        let sleigh = Sleigh::new(1.0, 1.0, 0.1).unwrap();
        let (mut q, mut v) = start(heading, u0, omega0);
        let mut memory = Memory::EMPTY;
        for _ in 0..500 {
            let made = ClosedForm::<3, 1>::closed_step(&sleigh, 0.0, h, ClosedStart::new(&q, &v, &mut memory)).unwrap().unwrap();
            v = made.velocity;
            // As a state does, within half a turn.
            (0..3).for_each(|i| q[i] += made.increment[i]);
            q[2] -= TAU * (q[2] / TAU).round();
            let (sin, cos) = q[2].sin_cos();
            // The angle is known to an ulp of four, 4 eps/2, and so are the sine and cosine after 16 turns with a rounding of eps/2 in each.
            assert_abs_diff_eq!(v[1] * cos - v[0] * sin, 0.0, epsilon = 10.0 * f64::EPSILON * v[0].hypot(v[1]));
        }
    }

    /// Back by the same step, the map is its own inverse.
    #[test]
    fn the_step_goes_back(heading in -3.0..3.0, u in -2.0..2.0, omega in -2.0..2.0, h in 0.01..0.2) {
        let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
        let made = step(&sleigh, h, heading, u, omega).unwrap();
        let back = step(&sleigh, -h, heading + made.increment[2], made.xi[0], made.xi[1]).unwrap();
        for i in 0..3 {
            assert_abs_diff_eq!(back.increment[i], -made.increment[i], epsilon = 1e-14);
        }
        assert_abs_diff_eq!(back.xi[0], u, epsilon = 1e-13);
        assert_abs_diff_eq!(back.xi[1], omega, epsilon = 1e-13);
    }

    /// Each end has half of the impulse of a short step, `h/2` times `lambda = (m I/J) u omega`. That changes along the step by
    /// `h (u'/u + omega'/omega) = h (a omega^2/u - c u)` of it, which is below `2 h` here, and the halves differ by as much.
    #[test]
    fn impulses_are_those_of_the_multiplier(heading in -3.0..3.0, u in 1.0..2.0, omega in 0.5..1.0) {
        let (sleigh, h) = (Sleigh::new(1.3, 0.9, 0.5).unwrap(), 1e-5);
        let made = step(&sleigh, h, heading, u, omega).unwrap();
        let lambda = sleigh.mass() * sleigh.inertia() / sleigh.pivot_inertia() * u * omega;
        for [impulse] in made.impulses {
            assert_relative_eq!(impulse, 0.5 * h * lambda, max_relative = 2.0 * h + 1e-10);
        }
        // The whole, at the middle of the step, to second order.
        let whole = made.impulses[0][0] + made.impulses[1][0];
        let [mean_u, mean_omega] = [0.5 * (u + made.xi[0]), 0.5 * (omega + made.xi[1])];
        assert_relative_eq!(whole, h * lambda * mean_u * mean_omega / (u * omega), max_relative = 4.0 * h * h + 1e-10);
    }

    /// The change of the momentum in the plane, `m (P' + a omega n)`, equals the impulses across the blade at both ends.
    #[test]
    fn impulses_change_the_momentum(
        (m, i, a) in (0.1..3.0, 0.5..3.0, -0.8..0.8), heading in -3.0..3.0, u in -1.0..1.0, omega in -2.0..2.0, h in 0.1..0.5,
    ) {
        let sleigh = Sleigh::new(m, i, a).unwrap();
        let made = step(&sleigh, h, heading, u, omega).unwrap();
        let across = |heading: f64| [-heading.sin(), heading.cos()];
        let (n0, n1) = (across(heading), across(heading + made.increment[2]));
        let (_, v0) = start(heading, u, omega);
        for c in 0..2 {
            let momentum = |v: &[f64; 3], n: &[f64; 2]| m * (v[c] + a * v[2] * n[c]);
            let change = momentum(&made.velocity, &n1) - momentum(&v0, &n0);
            let [[first], [last]] = made.impulses;
            // Numbers below ten.
            assert_abs_diff_eq!(change, first * n0[c] + last * n1[c], epsilon = 1e-13);
        }
    }

    /// On a free bearing the rotor keeps its rate in space, `omega + alpha'`.
    #[test]
    fn a_free_rotor_keeps_its_rate(u in -2.0..2.0, omega in -2.0..2.0, rate in -3.0..3.0, h in 0.01..0.2) {
        let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
        let rotor = Flywheel::new(body, 0.2, None).unwrap();
        let (q, v) = start(0.4, u, omega);
        let bare = step(&body, h, 0.4, u, omega).unwrap();
        let ([x, y, heading], [vx, vy, turn]) = (q, v);
        for xi in [None, Some([u, omega, omega + rate, 0.0])] {
            let (q, v) = ([x, y, heading, 0.7], [vx, vy, turn, if xi.is_some() { 9.0 } else { rate }]);
            let mut memory = Memory::EMPTY;
            let start = ClosedStart { xi, ..ClosedStart::new(&q, &v, &mut memory) };
            let made = ClosedForm::<4, 1>::closed_step(&rotor, 0.0, h, start).unwrap().unwrap();
            for i in 0..3 {
                assert_abs_diff_eq!(made.increment[i], bare.increment[i], epsilon = 1e-14);
                assert_abs_diff_eq!(made.velocity[i], bare.velocity[i], epsilon = 1e-14);
            }
            assert_abs_diff_eq!(made.increment[2] + made.increment[3], h * (omega + rate), epsilon = 1e-15);
            assert_abs_diff_eq!(made.velocity[2] + made.velocity[3], omega + rate, epsilon = 4e-15);
            assert_abs_diff_eq!(made.xi[2], omega + rate, epsilon = 1e-15);
        }
    }
}

/// A spin of any size keeps its digits: `omega1 = omega0 (1 - k u)/(1 + k u)` where the blade hardly turns.
#[test]
fn the_smallest_spins_keep_their_digits() {
    let (sleigh, h) = (Sleigh::new(1.0, 1.0, 0.5).unwrap(), 0.3);
    for u in [-3.0f64, -1.0, 2.0] {
        let k = 0.5 * h * sleigh.spin_gain() * u;
        for omega in [1e-9, -1e-100, 1e-300] {
            let made = step(&sleigh, h, 0.0, u, omega).unwrap();
            assert_relative_eq!(made.xi[1], omega * (1.0 - k) / (1.0 + k), max_relative = 16.0 * f64::EPSILON);
        }
    }
}

#[test]
fn where_no_solution_continues_the_motion_there_is_none() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let refused = |h: f64, u: f64, omega: f64| step(&sleigh, h, 0.0, u, omega).unwrap_err();
    // h m a u/(2 J) = h u/5 below -1.
    let ClosedStepError::NoSolution { value, bound, .. } = refused(2.0, -2.6, 1e-12) else { panic!("another error") };
    assert_relative_eq!(value, 1.04, max_relative = 1e-15);
    assert_relative_eq!(bound, 1.0);
    assert!(step(&sleigh, 2.0, 0.0, -2.4, 1e-9).is_ok());
    // A right angle in half a step, where with the mass at the blade the spin stays what it is.
    let wheel = Sleigh::new(1.0, 1.0, 0.0).unwrap();
    for (omega, possible) in [(1.5, true), (-1.5, true), (1.6, false), (-1.6, false)] {
        match step(&wheel, 2.0, 0.0, 0.7, omega) {
            Ok(made) => assert!(possible && (made.xi[1] - omega).abs() <= 4.0 * f64::EPSILON, "{made:?}"),
            Err(ClosedStepError::NoSolution { bound, .. }) => assert!(!possible && bound > 1.5),
            Err(error) => panic!("{error}"),
        }
    }
    for (u, omega) in [(f64::NAN, 0.1), (0.1, f64::NAN), (f64::INFINITY, 0.1), (1e200, 1e-200)] {
        let error = refused(1e200, u, omega);
        assert!(matches!(error, ClosedStepError::NotFinite { .. } | ClosedStepError::NoSolution { .. }), "{error}");
    }
}

/// The first guess has an error of the fourth order in the half turn `d`: at `d = 0.01` the first correction is the last, since it
/// leaves the square of 1e-8. From a guess of second order it would leave 1e-12, and be made again.
#[test]
fn a_small_turn_is_one_correction() {
    for a in [0.5, -0.3] {
        let sleigh = Sleigh::new(1.0, 1.0, a).unwrap();
        for (h, u, omega) in
            [(0.2, 1.0, 0.1), (0.2, -1.5, 0.1), (1.0, 1.0, 0.02), (1.0, -1.0, -0.02), (-0.5, 1.0, 0.04)]
        {
            assert_eq!(step(&sleigh, h, 0.3, u, omega).unwrap().iterations, 1, "{h} {u} {omega}");
        }
        // The control: a large turn is more than one.
        assert!(step(&sleigh, 1.0, 0.3, 1.0, 1.0).unwrap().iterations > 1);
    }
}

/// With the mass at the blade the step is a turn, by the series of sine and cosine or by the functions of the platform.
#[test]
fn sines_have_all_their_digits() {
    let wheel = Sleigh::new(1.0, 1.0, 0.0).unwrap();
    for omega in [0.02_f64, 0.3, 0.49, -0.49, 0.51, 1.0] {
        let made = step(&wheel, 1.0, 0.0, 1.0, omega).unwrap();
        // Half the turn has its sine and cosine to an ulp or two, and the whole has twice that.
        assert_abs_diff_eq!(made.velocity[0], omega.cos(), epsilon = 4.0 * f64::EPSILON);
        assert_abs_diff_eq!(made.velocity[1], omega.sin(), epsilon = 4.0 * f64::EPSILON * omega.abs());
    }
}

/// A motor has no closed step, nor a sleigh whose speed is imposed; what has one says that it has.
#[test]
fn a_driven_rotor_is_not_closed() {
    let body = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let rotor = |torque| Flywheel::new(body, 0.2, torque).unwrap();
    assert!(
        ClosedForm::<4, 1>::has_closed_form(&rotor(None))
            && !ClosedForm::<4, 1>::has_closed_form(&rotor(Some(0.3.into())))
    );
    let servo = Guided::<1>::servo(body, Guide::Speed(0.7.into())).unwrap();
    assert!(!ClosedForm::<3, 2>::has_closed_form(&servo));
    let thrust = || Thrust::new(0.1).unwrap();
    assert!(ClosedForm::<3, 1>::has_closed_form(&With { body, effects: thrust() }));
    assert!(!ClosedForm::<4, 1>::has_closed_form(&With { body: rotor(None), effects: thrust() }));
    let driven = Flywheel::new(Sleigh::new(1.0, 1.0, 0.5).unwrap(), 0.2, Some(0.3.into())).unwrap();
    let (rest, mut memory) = ([0.0; 4], Memory::EMPTY);
    assert!(ClosedForm::<4, 1>::closed_step(&driven, 0.0, 0.1, ClosedStart::new(&rest, &rest, &mut memory)).is_none());
}
