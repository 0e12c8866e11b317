//! The sleigh's hand-made equations against the automatic ones, and its two sets of coordinates against each other.

use approx::assert_relative_eq;
use lagrangian::{
    Motion, Reduced, System, constraint_residual, energy, quasi_velocities, reduced_acceleration, velocity_of,
};
use proptest::prelude::*;
use sleigh::{CentreOfMass, Sleigh, SleighError, SleighState};

/// Masses and inertias over six orders of magnitude, the centre of mass ahead, behind and over the blade.
fn sleighs() -> impl Strategy<Value = Sleigh> {
    let size = || (-3.0..3.0f64).prop_map(|e| 10f64.powf(e));
    (size(), size(), prop_oneof![4 => -2.0..2.0, 1 => Just(0.0), 1 => -1e-9..1e-9])
        .prop_map(|(m, i, a)| Sleigh::new(m, i, a).unwrap())
}

fn vectors() -> impl Strategy<Value = [f64; 3]> {
    proptest::array::uniform3(-3.0..3.0f64)
}

proptest! {
    /// Also for velocities that slip, as with an unprojected method.
    #[test]
    fn accelerations_by_hand(sleigh in sleighs(), q in vectors(), v in vectors()) {
        let by_hand = sleigh.motion(0.0, &q, &v).unwrap();
        let automatic = Motion::automatic(&sleigh, 0.0, &q, &v).unwrap();
        // The solve loses digits with the condition of the mass matrix, up to (J + m)/I; velocities are below 6.
        let rounding = 1e-13 * (1.0 + (sleigh.pivot_inertia() + sleigh.mass()) / sleigh.inertia()) * 36.0;
        for i in 0..3 {
            assert_relative_eq!(by_hand.acceleration[i], automatic.acceleration[i], epsilon = rounding);
        }
        let force = sleigh.mass() + sleigh.pivot_inertia();
        assert_relative_eq!(by_hand.multiplier[0], automatic.multiplier[0], epsilon = rounding * force);
    }

    #[test]
    fn reduced_accelerations_by_hand(sleigh in sleighs(), q in vectors(), xi in vectors()) {
        let xi = [xi[0], xi[1], 0.0];
        let by_hand = sleigh.reduced_motion(0.0, &q, &xi).unwrap();
        let automatic = reduced_acceleration(&sleigh, 0.0, &q, &xi).unwrap();
        for i in 0..3 {
            // The last place is the slip's, which stays zero.
            assert_relative_eq!(by_hand[i], automatic[i], epsilon = 1e-13, max_relative = 1e-13);
        }
        let v = velocity_of(&sleigh, 0.0, &q, &xi).unwrap();
        let back = quasi_velocities(&sleigh, 0.0, &q, &v).unwrap();
        for i in 0..3 {
            assert_relative_eq!(back[i], xi[i], epsilon = 1e-14);
        }
    }

    #[test]
    fn basis_vectors_are_admissible(sleigh in sleighs(), q in vectors()) {
        for w in sleigh.admissible_basis(0.0, &q).unwrap().vectors() {
            prop_assert!(constraint_residual(&sleigh, 0.0, &q, w)[0].abs() <= 1e-15);
        }
        let com = CentreOfMass(sleigh);
        for w in com.admissible_basis(0.0, &q).unwrap().vectors() {
            prop_assert!(constraint_residual(&com, 0.0, &q, w)[0].abs() <= 1e-15);
        }
    }

    /// Energy, slip and accelerations do not depend on the coordinates.
    #[test]
    fn both_coordinates_are_one_sleigh(sleigh in sleighs(), q in vectors(), v in vectors()) {
        let com = CentreOfMass(sleigh);
        let (cq, cv) = com.from_blade(&q, &v);
        let scale = (sleigh.mass() + sleigh.pivot_inertia()) * 36.0;
        assert_relative_eq!(energy(&sleigh, 0.0, &q, &v), energy(&com, 0.0, &cq, &cv), epsilon = 1e-13 * scale);
        let slip = constraint_residual(&sleigh, 0.0, &q, &v)[0];
        assert_relative_eq!(slip, constraint_residual(&com, 0.0, &cq, &cv)[0], epsilon = 1e-13);
        let turning = |motion: Motion<3, 1>| (motion.acceleration[2], motion.multiplier[0]);
        let (a, b) = (turning(sleigh.motion(0.0, &q, &v).unwrap()), turning(Motion::of(&com, 0.0, &cq, &cv).unwrap()));
        assert_relative_eq!(a.0, b.0, epsilon = 1e-11, max_relative = 1e-10);
        assert_relative_eq!(a.1, b.1, epsilon = 1e-11 * scale, max_relative = 1e-10);
        let (q2, v2) = com.to_blade(&cq, &cv);
        for i in 0..3 {
            assert_relative_eq!(q2[i], q[i], epsilon = 1e-14);
            assert_relative_eq!(v2[i], v[i], epsilon = 1e-14, max_relative = 1e-14);
        }
    }

    #[test]
    fn energy_on_the_constraint(sleigh in sleighs(), heading in -3.0..3.0f64, u in -3.0..3.0f64, omega in -3.0..3.0f64) {
        let state = SleighState { heading, speed: u, turn_rate: omega, ..SleighState::default() };
        let (q, v) = state.to_coordinates();
        let expected = 0.5 * (sleigh.mass() * u * u + sleigh.pivot_inertia() * omega * omega);
        assert_relative_eq!(energy(&sleigh, 0.0, &q, &v), expected, epsilon = 1e-13, max_relative = 1e-13);
        prop_assert!(constraint_residual(&sleigh, 0.0, &q, &v)[0].abs() <= 1e-15 * 3.0);
        let back = SleighState::from_coordinates(&q, &v);
        assert_relative_eq!(back.speed, u, epsilon = 1e-14);
    }
}

#[test]
fn impossible_sleighs_are_refused() {
    for (mass, inertia) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (f64::INFINITY, 1.0), (1.0, 0.0), (1.0, -2.0)] {
        assert!(matches!(Sleigh::new(mass, inertia, 0.5), Err(SleighError::NotPositive { .. })), "{mass} {inertia}");
    }
    for offset in [f64::NAN, f64::INFINITY, 1e200] {
        assert!(matches!(Sleigh::new(1.0, 1.0, offset), Err(SleighError::NotFinite { .. })), "{offset}");
    }
}
