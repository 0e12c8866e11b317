//! Systems that give no basis of their admissible velocities move in one that is derived, and keep what methods promise.

#![allow(dead_code, reason = "not every system of the benches is used")]

#[path = "../../../benches/text/systems.rs"]
mod systems;
#[path = "../../../benches/text/without.rs"]
mod without;

use noslip::dla::{Gauss, Mechanics, Rebased};
use noslip::prelude::*;
use noslip::{Sleigh, SleighState, StepError, constraint_residual};
use without::Without;

/// The state at the end of a run.
fn end<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &mut dyn OneStep<N, M>,
    (q, v): ([f64; N], [f64; N]),
    (duration, steps): (f64, u64),
) -> Result<State<N>, StepError> {
    let mut state = State::new(q, v, [false; N]);
    let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
    drive(system, method, &schedule, &mut state, ()).map_err(|error| error.source)?;
    Ok(state)
}

/// How far two states are apart.
fn distance<const N: usize>(a: &State<N>, b: &State<N>) -> f64 {
    let pairs = a.q().iter().zip(b.q()).chain(a.v().iter().zip(b.v()));
    pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

/// Bases in use along a run, and what the methods keep in them.
fn check<Sys, const N: usize, const M: usize>(
    name: &str,
    system: Sys,
    start: ([f64; N], [f64; N]),
    (duration, steps): (f64, u64),
    forced: bool,
) where
    Sys: System<N, M> + Clone,
{
    let reference = end(&system, &mut method!("gauss16"), start, (duration, steps)).unwrap();
    let bare = Without::<_, false>(system);
    let refused = end(&bare, &mut method!("gauss16"), start, (duration, steps)).unwrap_err();
    assert!(refused.to_string().contains("`WithBasis`"), "{name}: {refused}");
    let derived = WithBasis::new(bare, 0.0, &start.0);

    let found = end(&derived, &mut method!("gauss16"), start, (duration, steps)).unwrap();
    // Some hundred ulp a step, of numbers up to ten.
    assert!(distance(&found, &reference) < 1e-10, "{name}: {:e}", distance(&found, &reference));
    let slip = constraint_residual(&derived, duration, found.q(), found.v());
    assert!(slip.iter().all(|slip| slip.abs() < 1e-12), "{name}: {slip:?}");

    for (method, order) in [("dla", 2.0), ("gauss4", 4.0), ("energy4", 4.0)] {
        let [far, near] = [steps, 2 * steps].map(|steps| {
            let mut method: Box<dyn OneStep<N, M>> = match method {
                "dla" => Box::new(method!("dla")),
                "gauss4" => Box::new(method!("gauss4")),
                _ => Box::new(method!("energy4")),
            };
            end(&derived, &mut *method, start, (duration, steps)).unwrap()
        });
        if method == "energy4" && !forced {
            let energy = |state: &State<N>| noslip::energy(&derived, 0.0, state.q(), state.v());
            let first = noslip::energy(&derived, 0.0, &start.0, &start.1);
            assert!((energy(&near) - first).abs() < 1e-12 * (1.0 + first.abs()), "{name}");
        }
        let [far, near] = [far, near].map(|state| distance(&state, &reference));
        let found = (far / near).log2();
        // The next terms of the expansion are some tenths of the first at these steps; below 1e-11 the reference counts.
        assert!((found - order).abs() < 0.5 || near < 1e-11, "{name}, {method}: order {found}, {far:e}");
    }
}

fn sleigh(run: (f64, u64)) {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let start = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    check("sleigh", sleigh, start, run, false);
    // The basis of the beginning is bad where the blade has turned a quarter.
    let derived = WithBasis::new(Without::<_, false>(sleigh), 0.0, &start.0);
    let quarter = [0.0, 0.0, std::f64::consts::FRAC_PI_2];
    let at = |q: &[f64; 3]| System::<3, 1>::near(&derived, 0.0, q, 0).unwrap().1;
    assert_ne!(at(&start.0), at(&quarter));
}

test_systems::short_and_full! {
    the_sleigh_turns_around => sleigh((2.0, 20));
    the_sleigh_turns_around_in_full => sleigh((10.0, 200));
}

/// The control: where the method keeps the basis of the beginning, a blade that turns by more than a quarter is lost.
#[test]
fn a_basis_that_stays_is_lost() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let start = SleighState { speed: 1.0, turn_rate: 1.0, ..SleighState::default() }.to_coordinates();
    let derived = WithBasis::new(Without::<_, false>(sleigh), 0.0, &start.0);
    let reference = end(&sleigh, &mut method!("gauss16"), start, (10.0, 100)).unwrap();
    let good = end(&derived, &mut Rebased::new(Gauss::new::<2>()), start, (10.0, 100)).unwrap();
    assert!(distance(&good, &reference) < 1e-4, "{:e}", distance(&good, &reference));
    let lost = end(&derived, &mut Gauss::new::<2>(), start, (10.0, 100));
    assert!(
        lost.as_ref().map_or(true, |lost| distance(lost, &reference) > 2.0 * distance(&good, &reference)),
        "{lost:?}"
    );
}

fn roller_racer(run: (f64, u64)) {
    let racer = test_systems::RollerRacer { m: 1.0, I1: 0.4, I2: 0.1, d1: 0.5, d2: 0.3 };
    let (q, v) = test_systems::Model::start(&racer);
    check("roller racer", racer, (q, v), run, false);
}

test_systems::short_and_full! {
    the_roller_racer_turns => roller_racer((0.4, 10));
    the_roller_racer_turns_in_full => roller_racer((8.0, 200));
}

fn rolling_disk(run: (f64, u64)) {
    let disk = test_systems::RollingDisk { m: 1.0, R: 0.5, I: 0.125, J: 0.0625 };
    let (q, v) = test_systems::Model::start(&disk);
    check("rolling disk", disk, (q, v), run, false);
}

test_systems::short_and_full! {
    the_rolling_disk_turns => rolling_disk((2.0, 50));
    the_rolling_disk_turns_in_full => rolling_disk((8.0, 200));
}

/// The text in Rust that gives no basis moves as the text that gives one.
fn snakeboard((duration, steps): (f64, u64)) {
    let start = ([0.0, 0.0, 0.0, 0.0, -0.5], [0.0; 5]);
    let given = systems::Snakeboard::default();
    check("snakeboard", given, start, (duration, steps), true);
    let half = (duration, steps / 2);
    let reference = end(&systems::Snakeboard::default(), &mut method!("gauss16"), start, half).unwrap();
    let text = WithBasis::new(systems::SnakeboardWithoutBasis::default(), 0.0, &start.0);
    let found = end(&text, &mut method!("gauss16"), start, half).unwrap();
    assert!(distance(&found, &reference) < 1e-10, "{:e}", distance(&found, &reference));
    let refused = end(&systems::SnakeboardWithoutBasis::default(), &mut method!("gauss16"), start, half).unwrap_err();
    assert!(refused.to_string().contains("`WithBasis`"), "{refused}");
}

test_systems::short_and_full! {
    a_text_without_a_basis => snakeboard((0.3, 10));
    a_text_without_a_basis_at_length => snakeboard((6.0, 1200));
}

/// Rows that say the same are an error, and so are constraints that are not affine.
#[test]
fn what_has_no_basis() {
    /// Two blades side by side.
    #[derive(Clone)]
    struct Parallel(Sleigh);
    impl System<3, 2> for Parallel {
        fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
            System::lagrangian(&self.0, t, q, v)
        }
        fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
            let ([row], [b]) = System::constraint(&self.0, t, q);
            ([row; 2], [b; 2])
        }
    }
    let start = ([0.0; 3], [1.0, 0.0, 0.0]);
    let system = WithBasis::new(Parallel(Sleigh::new(1.0, 1.0, 0.5).unwrap()), 0.0, &start.0);
    let error = end(&system, &mut method!("gauss4"), start, (1.0, 10)).unwrap_err();
    assert!(matches!(error, StepError::Dependent(_)), "{error}");

    /// A point of constant speed.
    #[derive(Clone)]
    struct Isokinetic;
    impl System<2, 1> for Isokinetic {
        fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
            (v[0] * v[0] + v[1] * v[1]) * 0.5
        }
        fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
            ([[S::zero(); 2]], [S::zero()])
        }
        fn nonlinear<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[Option<S>; 1]> {
            Some([Some(v[0] * v[0] + v[1] * v[1] - 1.0)])
        }
    }
    let start = ([0.0; 2], [1.0, 0.0]);
    let error = end(&WithBasis::new(Isokinetic, 0.0, &start.0), &mut method!("gauss4"), start, (1.0, 10)).unwrap_err();
    assert!(error.to_string().contains("affine"), "{error}");
}
