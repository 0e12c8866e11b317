//! Derivatives of Lagrangian, forces and constraints by the dual numbers of the methods and by those of `num-dual`.

use super::{sine, sleigh};
use approx::assert_relative_eq;
use lagrangian::{Dual, Effect, HyperDual, Lanes, Motion, Reduced, Scalar, System, With, reduced_acceleration};
use num_dual::{Dual64, HyperDual64};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, EggCrate, Hill, Hills, MovingMass, Slope, Thrust, Torque};
use sleigh::{ClosedPath, Flywheel, Guided, Sleigh};
use std::array::from_fn;

type Fields = (Slope, Bowl, EggCrate, Hills);
type Drives = (Drag, Thrust, Torque, MovingMass);
type Everything = With<Flywheel<Sleigh>, (Fields, Drives)>;

fn everything() -> Everything {
    let hill = Hill { height: 0.5, x: 0.3, y: -0.4, width: 0.8 };
    let fields = (
        Slope::new([0.3, -0.2]).unwrap(),
        Bowl::new([0.4, 0.15], [0.2, -0.3]).unwrap(),
        EggCrate::new(0.3, [1.0, 1.4]).unwrap(),
        Hills::new(vec![hill, Hill { height: -0.7, x: -1.0, ..hill }]).unwrap(),
    );
    let drives = (
        Drag::new(0.2, 0.1).unwrap(),
        Thrust::new(sine(0.6, 1.3, 0.4)).unwrap(),
        Torque::new(sine(0.2, 0.7, -0.4)).unwrap(),
        MovingMass::new(0.4, sine(0.3, 2.0, 0.1), sine(0.2, 1.5, 1.0)).unwrap(),
    );
    let body = Flywheel::new(sleigh(), 0.2, Some(sine(0.3, 1.1, 0.2))).unwrap();
    With { body, effects: (fields, drives) }
}

/// Some fifty terms of order one to ten, each rounded: far below a wrong term.
const ROUNDING: f64 = 1e-13;

/// `(t, q, v)` as one list of nine.
fn parts<S: Scalar>(z: &[S; 9]) -> (S, [S; 4], [S; 4]) {
    (z[0], from_fn(|i| z[1 + i]), from_fn(|i| z[5 + i]))
}

fn lagrangian<S: Scalar>(system: &Everything, z: [S; 9]) -> S {
    let (t, q, v) = parts(&z);
    system.lagrangian(t, &q, &v)
}

fn force<S: Scalar>(system: &Everything, z: [S; 9]) -> [S; 4] {
    let (t, q, v) = parts(&z);
    system.force(t, &q, &v).unwrap()
}

proptest! {
    #[test]
    fn of_the_lagrangian_and_the_forces(z in proptest::array::uniform9(-2.0..2.0f64)) {
        let system = everything();
        let ours = lagrangian(&system, Dual::<f64, 9>::variables(&z));
        let pushes = force(&system, Dual::<f64, 9>::variables(&z));
        let unit = |i: usize| from_fn::<f64, 9, _>(|k| if k == i { 1.0 } else { 0.0 });
        let second = lagrangian(&system, from_fn(|i| HyperDual::<f64, 9, 9>::linear(z[i], unit(i), unit(i))));
        for i in 0..9 {
            let along = |k: usize| if k == i { Dual64::from(z[k]).derivative() } else { Dual64::from(z[k]) };
            assert_relative_eq!(ours.eps[i], lagrangian(&system, from_fn(along)).eps, epsilon = ROUNDING);
            let theirs = force(&system, from_fn(along));
            for k in 0..4 {
                assert_relative_eq!(pushes[k].eps[i], theirs[k].eps, epsilon = ROUNDING);
            }
            for j in 0..9 {
                let mut theirs: [HyperDual64; 9] = z.map(HyperDual64::from);
                theirs[i] = theirs[i].derivative1();
                theirs[j] = theirs[j].derivative2();
                assert_relative_eq!(second.e12[i][j], lagrangian(&system, theirs).eps1eps2, epsilon = 10.0 * ROUNDING);
            }
        }
        // The methods that keep the energy evaluate on eight lanes.
        let lanes = lagrangian(&system, z.map(Lanes::constant));
        let value = lagrangian(&system, z);
        prop_assert!(lanes.0.iter().all(|lane| (lane - value).abs() < ROUNDING * 10.0));
        assert_relative_eq!(ours.re, value, epsilon = ROUNDING);
    }

    #[test]
    fn of_the_constraints(t in -3.0..3.0f64, q in proptest::array::uniform3(-2.0..2.0f64)) {
        let path = ClosedPath::circle(0.7, [0.1, 0.2], 6.0).unwrap();
        let servo = Guided::<2>::servo(sleigh(), sine(0.8, 1.1, 0.5), sine(0.9, 0.7, 1.2)).unwrap();
        for system in [servo, Guided::<2>::tracer(sleigh(), path).unwrap()] {
            let system = system.on_turntable(0.35).unwrap();
            let z = [t, q[0], q[1], q[2]];
            let ours = Dual::<f64, 4>::variables(&z);
            let (a, b) = system.constraint(ours[0], &[ours[1], ours[2], ours[3]]);
            for i in 0..4 {
                let z: [Dual64; 4] =
                    from_fn(|k| if k == i { Dual64::from(z[k]).derivative() } else { Dual64::from(z[k]) });
                let (their_a, their_b) = system.constraint(z[0], &[z[1], z[2], z[3]]);
                for k in 0..3 {
                    assert_relative_eq!(b[k].eps[i], their_b[k].eps, epsilon = ROUNDING);
                    for j in 0..3 {
                        assert_relative_eq!(a[k][j].eps[i], their_a[k][j].eps, epsilon = ROUNDING);
                    }
                }
            }
        }
    }

    /// What the effects and the bodies give by hand against what the dual numbers make of their Lagrangians.
    #[test]
    fn by_hand(t in -3.0..3.0f64, z in proptest::array::uniform7(-2.0..2.0f64)) {
        let Everything { body, effects: (fields, (drag, thrust, torque, mass)) } = everything();
        let (q, v) = ([z[0], z[1], z[2]], [z[3], z[4], z[5]]);
        let zero = [Dual::<f64, 3>::zero(); 3];
        let l = fields.lagrangian(&sleigh(), Dual::fixed(t), &Dual::variables(&q), &zero).unwrap();
        let lagrangian::EffectSlope::Known(slope) = fields.slope(&sleigh(), t, &q) else { panic!("four potentials") };
        for i in 0..3 {
            assert_relative_eq!(slope[i], l.eps[i], epsilon = ROUNDING);
        }

        let known = With { body: sleigh(), effects: (fields.clone(), drag.clone(), thrust.clone(), torque.clone()) };
        let (hand, automatic) = (Motion::of(&known, t, &q, &v).unwrap(), Motion::automatic(&known, t, &q, &v).unwrap());
        for i in 0..3 {
            assert_relative_eq!(hand.acceleration[i], automatic.acceleration[i], epsilon = 10.0 * ROUNDING);
        }
        assert_relative_eq!(hand.multiplier[0], automatic.multiplier[0], epsilon = 10.0 * ROUNDING);

        let xi = [z[3], z[4], z[5], 0.0];
        let q = [z[0], z[1], z[2], z[6]];
        let known = With { body: body.clone(), effects: (fields, drag, thrust, torque) };
        let (hand, automatic) =
            (known.reduced_motion(t, &q, &xi).unwrap(), reduced_acceleration(&known, t, &q, &xi).unwrap());
        for i in 0..4 {
            assert_relative_eq!(hand[i], automatic[i], epsilon = 10.0 * ROUNDING);
        }
        // Velocities in the Lagrangian are nobody's potential.
        let shaken = With { body, effects: (mass,) };
        prop_assert!(shaken.reduced_motion(t, &q, &xi).is_none());
    }

    /// The basis is orthogonal to the rows, for every kind of guide.
    #[test]
    fn the_basis_is_admissible(t in -3.0..3.0f64, q in proptest::array::uniform4(-2.0..2.0f64)) {
        fn check<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N]) {
            let (a, _) = system.constraint(t, q);
            let basis = system.admissible_basis(t, q).unwrap();
            for row in &a {
                for w in basis.vectors() {
                    let product: f64 = (0..N).map(|i| row[i] * w[i]).sum();
                    assert!(product.abs() <= 4.0 * f64::EPSILON && w.iter().any(|w| *w != 0.0), "{a:?} {w:?}");
                }
            }
        }
        let body = [q[0], q[1], q[2]];
        check(&Guided::turntable(sleigh(), 0.35).unwrap(), t, &body);
        for guide in [sleigh::Guide::Speed(0.7.into()), sleigh::Guide::TurnRate(0.7.into())] {
            let servo = Guided::<1>::servo(sleigh(), guide).unwrap();
            check(&servo, t, &body);
            check(&Flywheel::new(servo, 0.2, None).unwrap(), t, &q);
        }
        check(&everything(), t, &q);
    }
}
