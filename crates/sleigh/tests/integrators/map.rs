//! The closed map as an integrator: what it remembers, and what makes its other steps.

use dla::{Dla, OneStep, Schedule, State, StepError, drive};
use lagrangian::{System, With};
use proptest::prelude::*;
use sleigh::closed::ClosedForm;
use sleigh::effects::{Bowl, Drag, EggCrate, Hill, Hills, MovingMass, Slope, Thrust};
use sleigh::{ClosedMap, Guided, Sleigh, SleighState};

fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// At rest with its centre of mass at the lowest place.
fn well() -> With<Sleigh, Bowl> {
    With { body: sleigh(), effects: Bowl::new([0.7, 0.4], [0.5, 0.0]).unwrap() }
}

/// What the next step begins from is what the method remembers: after other steps to the same place it is not the same.
#[test]
fn memories_after_other_steps_differ() {
    fn after<Sys: ClosedForm<3, 1> + Clone>(system: &Sys, steps: &[f64]) -> Vec<u64> {
        let (mut map, mut state) =
            (ClosedMap::of(system.clone()), State::new([0.0; 3], [0.0; 3], [false, false, true]));
        for h in steps {
            map.step(system, 0.0, *h, &mut state).unwrap();
        }
        OneStep::<3, 1>::memory(&map).iter().map(|x| x.to_bits()).collect()
    }
    fn check<Sys: ClosedForm<3, 1> + Clone>(system: &Sys) {
        assert_eq!(after(system, &[0.5]), after(system, &[0.5]));
        assert_ne!(after(system, &[0.5]), after(system, &[0.25]));
        // A step of another length begins anew.
        assert_eq!(after(system, &[0.5]), after(system, &[0.25, 0.5]));
        // As after many steps, which were all the same; but a heading is turned along for 118 steps.
        assert_eq!(after(system, &[0.5]), after(system, &[0.5; 119]));
        assert_ne!(after(system, &[0.5]), after(system, &[0.5; 118]));
    }
    check(&well());
    check(&sleigh());
}

/// A step that fails leaves the state, and the method with nothing to remember.
#[test]
fn a_step_that_fails_is_forgotten() {
    let (system, start) = (sleigh(), SleighState { speed: 0.1, turn_rate: 0.1, ..SleighState::default() });
    let ((q, v), mut map) = (start.to_coordinates(), ClosedMap::of(sleigh()));
    let fresh = OneStep::<3, 1>::memory(&map);
    let mut state = State::new(q, v, System::<3, 1>::angles(&system));
    map.step(&system, 0.0, 0.1, &mut state).unwrap();
    let before = state;
    assert_ne!(OneStep::<3, 1>::memory(&map), fresh);
    let error = map.step(&system, 0.1, 1e3, &mut state).unwrap_err();
    assert!(matches!(error, StepError::Closed(_)), "{error}");
    assert_eq!((state, OneStep::<3, 1>::memory(&map)), (before, fresh));
}

/// A body without a closed form has the steps of the general method, to the last bit.
#[test]
fn other_bodies_have_general_steps() {
    let table = Guided::turntable(sleigh(), 0.3).unwrap();
    let (q, v) = SleighState { x: 1.0, speed: 0.4, turn_rate: 0.2, ..SleighState::default() }.to_coordinates();
    let start = State::new(q, v, System::<3, 1>::angles(&table));
    let schedule = Schedule { t0: 0.0, step: 0.1, steps: 50 };
    let (mut general, mut closed) = (start, start);
    let mut map = ClosedMap::of(table.clone());
    drive::<3, 1>(&table, &mut Dla::midpoint(), &schedule, &mut general, ()).unwrap();
    drive::<3, 1>(&table, &mut map, &schedule, &mut closed, ()).unwrap();
    assert_eq!(general, closed);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The closed map is the general one: over a run with forces, to what rounding comes to.
    #[test]
    fn closed_and_general_runs_agree(
        z in proptest::array::uniform5(-1.0..1.0f64), k in 0.0..0.4f64, drag in 0.0..0.3f64, free: bool,
    ) {
        fn both<Sys: ClosedForm<3, 1> + Clone>(system: &Sys, start: &SleighState) -> [State<3>; 2] {
            let (q, v) = start.to_coordinates();
            let schedule = Schedule { t0: 0.0, step: 0.05, steps: 40 };
            let run = |method: &mut dyn OneStep<3, 1>| {
                let mut state = State::new(q, v, system.angles());
                drive(system, method, &schedule, &mut state, ()).unwrap();
                state
            };
            [run(&mut ClosedMap::of(system.clone())), run(&mut Dla::midpoint())]
        }
        let start = SleighState { x: z[0], y: z[1], heading: 3.0 * z[2], speed: z[3], turn_rate: z[4] };
        let effects = (Bowl::new([k, k], [0.0; 2]).unwrap(), Drag::new(drag, drag).unwrap());
        let [a, b] = if free { both(&sleigh(), &start) } else { both(&With { body: sleigh(), effects }, &start) };
        // Two seconds of motions of size one, in which an error grows by e^2 at most, and 40 steps of some roundings each.
        for i in 0..3 {
            prop_assert!((a.q()[i] - b.q()[i]).abs() <= 40.0 * 64.0 * f64::EPSILON, "{:?} and {:?}", a.q(), b.q());
            prop_assert!((a.v()[i] - b.v()[i]).abs() <= 40.0 * 64.0 * f64::EPSILON, "{:?} and {:?}", a.v(), b.v());
        }
    }

    /// An effect that says that it has no force has none, whatever the state; one that has a force says so.
    #[test]
    fn an_effect_without_a_force_has_none(
        t in -3.0..3.0f64, q in proptest::array::uniform3(-2.0..2.0f64), v in proptest::array::uniform3(-2.0..2.0f64),
    ) {
        fn check<E: lagrangian::Effect<Sleigh, 3>>(effect: &E, expected: bool, (t, q, v): (f64, [f64; 3], [f64; 3])) {
            assert_eq!(effect.has_force(), expected);
            assert_eq!(effect.force(&sleigh(), t, &q, &v).is_some(), expected);
        }
        let at = (t, q, v);
        check(&(), false, at);
        check(&Slope::new([0.1, 0.2]).unwrap(), false, at);
        check(&Bowl::new([0.1, 0.2], [0.0; 2]).unwrap(), false, at);
        check(&EggCrate::new(0.3, [1.0, 2.0]).unwrap(), false, at);
        check(&Hills::new(vec![Hill { height: 0.1, x: 1.0, y: 1.0, width: 0.5 }]).unwrap(), false, at);
        check(&MovingMass::new(0.1, 0.2, 0.1).unwrap(), false, at);
        let (thrust, drag) = (|| Thrust::new(0.1).unwrap(), || Drag::new(0.1, 0.2).unwrap());
        check(&thrust(), true, at);
        check(&drag(), true, at);
        check(&(Slope::new([0.1, 0.2]).unwrap(), drag()), true, at);
        check(&(Slope::new([0.1, 0.2]).unwrap(), ()), false, at);
        check(&Vec::<Drag>::new(), false, at);
        check(&vec![drag(), drag()], true, at);
    }
}

/// A turn of nearly half a circle in a step: a search from the last step leads to a solution far away, which is none of the motion.
#[test]
fn a_search_that_goes_astray_begins_anew() {
    let sleigh = Sleigh::new(1.742_366_497_515_934_3, 2.742_763_814_089_562, -0.080_240_034_845_077_33).unwrap();
    let start =
        SleighState { speed: -0.363_992_962_674_344_9, turn_rate: 8.159_472_232_238_036, ..SleighState::default() };
    let (q, v) = start.to_coordinates();
    let schedule = Schedule { t0: 0.0, step: 0.357_930_678_136_489_27, steps: 70 };
    let [mut closed, mut general] = [State::new(q, v, sleigh.angles()); 2];
    drive(&sleigh, &mut ClosedMap::of(sleigh), &schedule, &mut closed, ()).unwrap();
    drive(&sleigh, &mut Dla::midpoint(), &schedule, &mut general, ()).unwrap();
    // The position is some hundred metres away.
    for (a, b) in closed.unwrapped().iter().zip(general.unwrapped()) {
        approx::assert_abs_diff_eq!(*a, b, epsilon = 70.0 * 100.0 * f64::EPSILON);
    }
}
