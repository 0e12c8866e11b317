//! The equations that guided and laden sleighs give by hand against what automatic derivatives make of their Lagrangians and constraints.

use super::{sine, sleigh};
use approx::assert_relative_eq;
use lagrangian::{Dual, Effect, EffectSlope, Lanes, Motion, Piecewise, Reduced, System, With, reduced_acceleration};
use proptest::prelude::*;
use sleigh::effects::{MovingMass, Slope, Thrust};
use sleigh::{ClosedPath, Formula, Guide, Guided, Pulses, Sleigh, TimeFunction};

/// Some fifty terms of order one to a hundred, each rounded, and the solution of an equation whose matrix has a condition below ten.
const ROUNDING: f64 = 1e-11;

fn formula() -> TimeFunction {
    TimeFunction::Formula(Formula::new("0.3*t*exp(-t^2/9) + 0.1").unwrap())
}

/// A mass on an ellipse, one on the blade that comes and goes, one that rests.
fn masses() -> [MovingMass; 3] {
    [
        MovingMass::new(0.4, sine(0.3, 2.0, 0.1), sine(0.2, 1.5, 1.0)).unwrap(),
        MovingMass::new(0.7, formula(), 0.0).unwrap(),
        MovingMass::new(0.2, -0.3, 0.4).unwrap(),
    ]
}

/// The equations by hand agree with the Lagrangian, alone and under a thrust and a slope; on numbers that carry derivatives too.
fn check<const K: usize, const M: usize>(body: Guided<K>, t: f64, q: &[f64; 3], z: &[f64; 3])
where
    Guided<K>: System<3, M> + Reduced<3, M>,
{
    let bare = body.reduced_motion(t, q, z).unwrap();
    same(&bare, &reduced_acceleration(&body, t, q, z).unwrap(), 3 - M);
    if let Some(hand) = body.motion(t, q, z) {
        let automatic = Motion::automatic(&body, t, q, z).unwrap();
        same(&hand.acceleration, &automatic.acceleration, 3);
        same(&hand.multiplier, &automatic.multiplier, M);
    }

    // Lane by lane, and with a derivative in time.
    let lanes = body.reduced_motion(Lanes([t; 8]), &q.map(|x| Lanes([x; 8])), &z.map(|x| Lanes([x; 8]))).unwrap();
    same(&lanes.map(|x| x.0[5]), &bare, 3 - M);
    let at = |t| body.reduced_motion(t, q, z).unwrap();
    let seeded = body.reduced_motion(Dual::<f64, 1>::variable(t, 0), &q.map(Dual::fixed), &z.map(Dual::fixed)).unwrap();
    // Central differences are right to 1e-10 times the third derivative, and as rounded as 1e-16/1e-5.
    for k in 0..3 - M {
        assert_relative_eq!(
            seeded[k].eps[0],
            (at(t + 1e-5)[k] - at(t - 1e-5)[k]) / 2e-5,
            epsilon = 1e-6,
            max_relative = 1e-6
        );
    }

    let effects = (Thrust::new(sine(0.6, 1.3, 0.4)).unwrap(), Slope::new([0.3, -0.2]).unwrap());
    let pushed = With { body, effects };
    same(&pushed.reduced_motion(t, q, z).unwrap(), &reduced_acceleration(&pushed, t, q, z).unwrap(), 3 - M);
    if let Some(hand) = pushed.motion(t, q, z) {
        let automatic = Motion::automatic(&pushed, t, q, z).unwrap();
        same(&hand.acceleration, &automatic.acceleration, 3);
        same(&hand.multiplier, &automatic.multiplier, M);
    }
}

fn same(hand: &[f64], automatic: &[f64], places: usize) {
    for k in 0..places {
        assert_relative_eq!(hand[k], automatic[k], epsilon = ROUNDING, max_relative = ROUNDING);
    }
}

proptest! {
    #[test]
    fn by_hand(
        t in -3.0..3.0f64, q in proptest::array::uniform3(-2.0..2.0f64), z in proptest::array::uniform3(-2.0..2.0f64),
        rate in prop_oneof![Just(0.0), -1.0..1.0f64], carried in 0..4usize, pulsed in any::<bool>(),
    ) {
        let masses = || masses()[..carried].to_vec();
        let imposed = || {
            if pulsed {
                TimeFunction::Pulses(Pulses::new(vec![-4.0, 4.0], vec![3.0]).unwrap()).piece(0.0)
            } else {
                sine(0.8, 1.1, 0.5)
            }
        };
        check(Guided::turntable(sleigh(), rate).unwrap().carrying(masses()), t, &q, &z);
        for guide in [Guide::Speed(imposed()), Guide::TurnRate(imposed())] {
            let servo = Guided::<1>::servo(sleigh(), guide).unwrap().on_turntable(rate).unwrap();
            check(servo.carrying(masses()), t, &q, &z);
        }
        // Nothing is left to be known where both velocities are imposed.
        let servo = Guided::<2>::servo(sleigh(), imposed(), formula()).unwrap().carrying(masses());
        prop_assert_eq!(servo.reduced_motion(t, &q, &z), Some([0.0; 3]));
        let path = ClosedPath::circle(1.0, [0.0, 0.0], 2.0).unwrap();
        let tracer = Guided::<2>::tracer(sleigh(), path).unwrap().carrying(masses());
        prop_assert_eq!(tracer.reduced_motion(t, &q, &z), Some([0.0; 3]));
    }

    /// A mass that a body carries is the mass that acts on a body as an effect.
    #[test]
    fn carried_or_added(t in -3.0..3.0f64, q in proptest::array::uniform3(-2.0..2.0f64), v in proptest::array::uniform3(-2.0..2.0f64)) {
        let carrying = Guided::from(sleigh()).carrying(masses().to_vec());
        let added = With { body: sleigh(), effects: masses().to_vec() };
        let (one, other) = (System::<3, 1>::lagrangian(&carrying, t, &q, &v), added.lagrangian(t, &q, &v));
        assert_relative_eq!(one, other, epsilon = ROUNDING);
        let hand = Reduced::<3, 1>::motion(&carrying, t, &q, &v).unwrap();
        same(&hand.acceleration, &Motion::of(&added, t, &q, &v).unwrap().acceleration, 3);
        // As an effect it is no force that a body could answer to.
        prop_assert_eq!(Effect::<Sleigh, 3>::slope(&masses()[0], &sleigh(), t, &q), EffectSlope::Unknown);
    }
}
