//! Equations in the axes of the sleigh are those on the plane.

use approx::assert_abs_diff_eq;
use lagrangian::{Reduced, With};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, EggCrate, QuadraticDrag, Thrust, Torque};
use sleigh::series::{InOwnAxes, OwnAxes, PushInOwnAxes};
use sleigh::{Sleigh, SleighState, TimeFunction};

/// `(u', omega')` at this place in the axes of the sleigh.
fn accelerations(axes: &OwnAxes, [x, y]: [f64; 2], [u, omega]: [f64; 2]) -> [f64; 2] {
    let OwnAxes { lead, gain, along, turning, damping, .. } = axes;
    [
        lead * omega * omega - damping[0] * u + along[0] + along[1] * x,
        -gain * u * omega - damping[1] * omega + turning[0] + turning[1] * y,
    ]
}

/// The place in axes of this heading about `center`.
fn own(state: &SleighState, center: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = state.heading.sin_cos();
    let (x, y) = (state.x - center[0], state.y - center[1]);
    [cos * x + sin * y, cos * y - sin * x]
}

proptest! {
    #[test]
    fn they_are_the_reduced_equations(
        m in 0.1..10.0f64, inertia in 0.1..10.0f64, a in -2.0..2.0f64, k in -1.0..1.0f64,
        center in proptest::array::uniform2(-3.0..3.0f64), z in proptest::array::uniform5(-3.0..3.0f64),
        push in proptest::array::uniform2(-3.0..3.0f64), drag in proptest::array::uniform2(0.0..3.0f64),
    ) {
        let sleigh = Sleigh::new(m, inertia, a).unwrap();
        let state = SleighState { x: z[0], y: z[1], heading: z[2], speed: z[3], turn_rate: z[4] };
        let (q, _) = state.to_coordinates();
        let xi = [z[3], z[4], 0.0];
        let bowl = || Bowl::new([k, k], center).unwrap();
        let (thrust, torque) = (Thrust::new(push[0]).unwrap(), Torque::new(push[1]).unwrap());
        let effects = (bowl(), thrust, torque, Drag::new(drag[0], drag[1]).unwrap());
        let pushed = With { body: sleigh, effects };
        let cases = [
            (sleigh.own_axes(), [0.0; 2], sleigh.reduced_motion(0.0, &q, &xi)),
            (pushed.own_axes(), own(&state, center), pushed.reduced_motion(0.0, &q, &xi)),
        ];
        for (axes, place, expected) in cases {
            let (found, expected) = (accelerations(&axes.unwrap(), place, [z[3], z[4]]), expected.unwrap());
            for i in 0..2 {
                // Some twenty operations on forces of tens of newtons, on masses from 0.1 kg on.
                assert_abs_diff_eq!(found[i], expected[i], epsilon = 1e-11 * (1.0 + expected[i].abs()));
            }
        }
        prop_assert_eq!(sleigh.own_axes().unwrap().center, None);
        prop_assert_eq!(pushed.own_axes().unwrap().center, Some(center));
        // A list of effects is what a tuple of them is.
        let list = With { body: sleigh, effects: vec![bowl(), bowl()] };
        prop_assert_eq!(list.own_axes(), With { body: sleigh, effects: (bowl(), bowl()) }.own_axes());
    }
}

/// What is not of second degree there has none, nor have two wells about two points.
#[test]
fn others_have_none() {
    fn axes<E: PushInOwnAxes>(effects: E) -> Option<OwnAxes> {
        With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects }.own_axes()
    }
    let bowl = |stiffness, center| Bowl::new(stiffness, center).unwrap();
    assert!(axes(()).is_some() && axes(Vec::<Bowl>::new()).is_some());
    assert!(axes((bowl([0.1, 0.1], [1.0, 0.0]), bowl([0.2, 0.2], [1.0, 0.0]))).is_some());
    assert!(axes((bowl([0.1, 0.1], [1.0, 0.0]), bowl([0.2, 0.2], [1.0, 0.1]))).is_none());
    assert!(axes(bowl([0.1, 0.2], [0.0; 2])).is_none());
    assert!(axes((Drag::new(0.1, 0.1).unwrap(), bowl([0.1, 0.1], [0.0; 2]))).is_some());
    assert!(axes(QuadraticDrag::new(0.1, 0.1).unwrap()).is_none());
    assert!(axes(EggCrate::new(0.1, [1.0, 1.0]).unwrap()).is_none());
    let swing = || TimeFunction::Sine { amplitude: 0.5, frequency: 2.0, phase: 0.3 };
    assert!(axes(Thrust::new(swing()).unwrap()).is_none() && axes(Torque::new(swing()).unwrap()).is_none());
}
