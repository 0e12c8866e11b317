//! Trains whose forces or imposed velocities jump, and trains with a rotor: against the static systems and against known motions.

use super::run;
use super::trains::{end_of, request};
use crate::common::goes_on_to_the_same_bits;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use assembly::parts::{Trailer, Train};
use assembly::{AssemblyState, AssemblySubject};
use dla::{Schedule, Subject};
use harness::{Method, Record, Request, Run};
use lagrangian::linear::larger;
use lagrangian::{Piecewise, System, With};
use sleigh::effects::{Drag, Thrust, Torque};
use sleigh::{Flywheel, Guide, Guided, Ramp, Sleigh, SleighState, Table, TimeFunction};

const START: SleighState = SleighState { x: 0.3, y: -0.2, heading: 0.4, speed: 1.0, turn_rate: 0.3 };
/// No jump of the tables below is at a node of equal steps.
const SCHEDULE: Schedule = Schedule { t0: 0.0, step: 0.05, steps: 80 };
const FEW: [&str; 2] = ["dla", "dla4"];
const METHODS: [&str; 4] = ["dla", "dla4", "dla6", "dla8"];

fn lead() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.2).unwrap()
}

fn steps(times: &[f64], values: &[f64]) -> TimeFunction {
    TimeFunction::Table(Table::new(times.to_vec(), values.to_vec()).unwrap())
}

fn ramps(times: &[f64], values: &[f64]) -> TimeFunction {
    TimeFunction::Ramp(Ramp::new(times.to_vec(), values.to_vec()).unwrap())
}

fn trailers() -> Vec<Trailer> {
    vec![Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap(); 2]
}

fn made(train: &Train, name: &str, start: &AssemblyState) -> Record {
    let method = Method::named(name, None).unwrap();
    let request = request(&SCHEDULE, start, 10);
    let run = run(&AssemblySubject::from(&train.assembly), &method, &request);
    assert!(run.failure.is_none(), "{name}: {:?}", run.failure);
    run
}

/// A train without trailers moves as its lead does as a static system, and has the same work and energy error.
fn as_the_static_system<Sys, const M: usize>(system: &Sys, names: &[&str])
where
    Sys: System<3, M> + Piecewise + Clone + Send + Sync + 'static,
{
    let alone = Train::new(system.clone(), Vec::new(), |trailer| trailer.sleigh).unwrap();
    let (q, v) = START.to_coordinates();
    let start = AssemblyState::new(&alone.assembly, &q, &v);
    for &name in names {
        let own = made(&alone, name, &start);
        let method = Method::named(name, None).unwrap();
        let request = Request { schedule: SCHEDULE, q: q.into(), v: v.into(), samples: 10 };
        let fixed = run(&Subject::from(system), &method, &request);
        assert!(fixed.failure.is_none(), "{name}: {:?}", fixed.failure);
        // A few units in the last place in each step.
        let rounding = 16.0 * 80.0 * f64::EPSILON * (1.0 + fixed.energy.work.abs());
        for i in 0..3 {
            assert_abs_diff_eq!(own.q[i], fixed.q[i], epsilon = rounding);
            assert_abs_diff_eq!(own.v[i], fixed.v[i], epsilon = rounding);
        }
        assert!(fixed.energy.work.abs() > 0.01, "{name}");
        assert_abs_diff_eq!(own.energy.work, fixed.energy.work, epsilon = rounding);
        assert_abs_diff_eq!(own.energy.max_error, fixed.energy.max_error, epsilon = rounding);
        assert_abs_diff_eq!(own.t, 4.0, epsilon = 1e-12);
    }
}

test_systems::short_and_full! {
    tables_of_forces_and_velocities_act_on_a_lead_as_on_a_sleigh => check_tables(&FEW);
    tables_of_forces_and_velocities_act_on_a_lead_as_on_a_sleigh_in_full => check_tables(&METHODS);
}

fn check_tables(names: &[&str]) {
    let thrust = Thrust::new(steps(&[0.0, 1.013, 2.7], &[0.5, -0.4, 0.8])).unwrap();
    let torque = Torque::new(ramps(&[0.5, 1.5, 3.131], &[0.0, 0.6, -0.2])).unwrap();
    as_the_static_system(&With { body: lead(), effects: (thrust, (torque, Drag::new(0.1, 0.05).unwrap())) }, names);
    // From the speed of the start on, so that both begin on the constraint.
    let speed = Guide::Speed(steps(&[0.0, 1.013, 2.7], &[1.0, 1.7, 0.4]));
    as_the_static_system(&With { body: Guided::<1>::servo(lead(), speed).unwrap(), effects: () }, names);
    let both = Guided::<2>::servo(lead(), ramps(&[0.7, 1.9], &[1.0, 0.5]), steps(&[0.0, 2.03], &[0.3, -0.5])).unwrap();
    as_the_static_system(&With { body: both, effects: () }, names);
}

test_systems::short_and_full! {
    an_imposed_speed_that_jumps_pulls_the_train_along => check_imposed_speed(&FEW);
    an_imposed_speed_that_jumps_pulls_the_train_along_in_full => check_imposed_speed(&METHODS);
}

/// A servo that jumps jerks the whole train: all blades of a straight one have its speed at once, and the impulse does the work.
fn check_imposed_speed(names: &[&str]) {
    let speed = Guide::Speed(steps(&[0.0, 1.013], &[1.0, 3.0]));
    let body = With { body: Guided::<1>::servo(lead(), speed).unwrap(), effects: () };
    let train = Train::new(body, trailers(), |trailer| trailer.sleigh).unwrap();
    let start = train.start(&SleighState { turn_rate: 0.0, ..START }, &[]);
    for &name in names {
        let run = made(&train, name, &start);
        let way = 1.013 + 3.0 * (4.0 - 1.013);
        for blade in 0..=2 {
            let (before, after) = (train.blade(start.q(), start.v(), blade), train.blade(&run.q, &run.v, blade));
            assert_abs_diff_eq!(f64::hypot(after.x - before.x, after.y - before.y), way, epsilon = 1e-12);
            assert_abs_diff_eq!(after.speed, 3.0, epsilon = 1e-13);
        }
        // 1/2 (1 + 2 * 0.5) (9 - 1).
        assert_abs_diff_eq!(run.energy.work, 8.0, epsilon = 1e-11);
        assert!(run.energy.max_error < 1e-11, "{name}: {:e}", run.energy.max_error);
        assert!(run.constraint_max < 1e-13 && run.leaf_max.unwrap() < 1e-14, "{name}");
    }
}

/// A table that has jumped before the run begins holds its last value, from the start on.
#[test]
fn a_table_that_ends_before_the_run_holds_its_last_value() {
    let speed = Guide::Speed(steps(&[-2.0, -1.0], &[5.0, 1.0]));
    let body = With { body: Guided::<1>::servo(lead(), speed).unwrap(), effects: () };
    let train = Train::new(body, trailers(), |trailer| trailer.sleigh).unwrap();
    let start = train.start(&SleighState { turn_rate: 0.0, ..START }, &[]);
    let run = made(&train, "dla", &start);
    let (before, after) = (train.blade(start.q(), start.v(), 0), train.blade(&run.q, &run.v, 0));
    assert_abs_diff_eq!(f64::hypot(after.x - before.x, after.y - before.y), 4.0, epsilon = 1e-12);
    assert!(run.constraint_max < 1e-13 && run.energy.work.abs() < 1e-12, "{run:?}");
}

/// A bent train that is jerked and pushed, behind whose lead nothing is straight.
fn jerked() -> (Train, AssemblyState) {
    let speed = Guide::Speed(steps(&[0.0, 1.013, 2.9], &[1.0, 1.7, 0.4]));
    let effects = (Torque::new(ramps(&[0.5, 1.5, 3.131], &[0.0, 0.6, -0.2])).unwrap(), Drag::new(0.1, 0.05).unwrap());
    let body = With { body: Guided::<1>::servo(lead(), speed).unwrap(), effects };
    let train = Train::new(body, trailers(), |trailer| trailer.sleigh).unwrap();
    let start = train.start(&START, &[0.1, -0.3]);
    (train, start)
}

/// The end of the bent train after `steps` steps of a method.
fn jerked_end(name: &str, steps: u64) -> Vec<f64> {
    let (train, start) = jerked();
    let method = Method::named(name, None).unwrap();
    let schedule = Schedule { t0: 0.0, step: 4.0 / steps as f64, steps };
    end_of(&train, &method, &schedule, &start)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| larger(most, a - b))
}

/// The error of `steps` steps and of twice as many.
fn check_order(name: &str, order: f64, steps: u64, right: &[f64]) {
    let [coarse, fine] = [steps, 2 * steps].map(|steps| distance(&jerked_end(name, steps), right));
    println!("{name}: {coarse:e} {fine:e}");
    // The shares of the pieces are whole numbers of steps.
    assert_relative_eq!((coarse / fine).log2(), order, epsilon = 0.35);
}

/// Every piece has steps of its own, so that the methods keep their orders across jumps.
#[test]
fn methods_keep_their_orders_across_jumps() {
    check_order("dla", 2.0, 40, &jerked_end("dla4", 40));
}

#[test]
#[ignore = "slow"]
fn methods_keep_their_orders_across_jumps_in_full() {
    let (train, start) = jerked();
    let right = jerked_end("dla8", 640);
    for (name, order) in [("dla", 2.0), ("dla4", 4.0)] {
        check_order(name, order, 80, &right);
    }
    // A step for a tolerance is looked for across the jumps too.
    let dla4 = Method::named("dla4", None).unwrap();
    let (system, place) = (AssemblySubject::from(&train.assembly), (&start.unwrapped()[..], start.v()));
    let found = Run::of(&system, &dla4).recommended(place, (4.0, 1e-5)).unwrap();
    assert!(distance(&jerked_end("dla4", found.steps), &right) < 1e-5, "{found:?}");
}

test_systems::short_and_full! {
    a_run_across_jumps_goes_on_from_its_files => check_files(&["dla"], 20);
    a_run_across_jumps_goes_on_from_its_files_at_length => check_files(&["dla", "dla4"], 1);
}

/// Saved before, at and after a jump, a run goes on with the same bits; so does one that has fewer steps than pieces fail at once.
fn check_files(names: &[&str], every: u64) {
    let (train, start) = jerked();
    let system = AssemblySubject::from(&train.assembly);
    for &name in names {
        let method = Method::named(name, None).unwrap();
        goes_on_to_the_same_bits(&system, &method, &request(&SCHEDULE, &start, 10), every);
    }
    let few = Schedule { t0: 0.0, step: 2.0, steps: 2 };
    let run = run(&system, &Method::named("dla", None).unwrap(), &request(&few, &start, 1));
    let said = run.failure.unwrap().to_string();
    assert!(run.steps == 0 && said.contains("fewer steps than pieces"), "{said}");
}

test_systems::short_and_full! {
    a_rotor_in_the_lead_is_a_flywheel => check_flywheel(&FEW);
    a_rotor_in_the_lead_is_a_flywheel_in_full => check_flywheel(&METHODS);
}

/// The angle of the rotor is counted in space there, and against the body in the static system: one is a linear function of the other.
fn check_flywheel(names: &[&str]) {
    let torque = || steps(&[0.0, 1.013, 2.7], &[0.5, -0.4, 0.8]);
    for motor in [None, Some(torque())] {
        let free = motor.is_none();
        let rotor = || Train::new(lead(), Vec::new(), |trailer| trailer.sleigh).unwrap();
        let alone = rotor().with_rotor(0.7, 2.0, motor.clone()).unwrap();
        let start = alone.start(&START, &[]);
        let fixed = Flywheel::new(lead(), 0.7, motor).unwrap();
        let ([x, y, heading], [vx, vy, rate]) = START.to_coordinates();
        let (q, v) = (vec![x, y, heading, 0.0], vec![vx, vy, rate, 2.0]);
        let request = Request { schedule: SCHEDULE, q, v, samples: 10 };
        for &name in names {
            let own = made(&alone, name, &start);
            let method = Method::named(name, None).unwrap();
            let fixed = run(&Subject::from(&fixed), &method, &request);
            let rounding = 16.0 * 80.0 * f64::EPSILON * (10.0 + fixed.energy.work.abs());
            for i in 0..3 {
                assert_abs_diff_eq!(own.q[i], fixed.q[i], epsilon = rounding);
            }
            let [angle, relative] = alone.rotor(&own.q, &own.v).unwrap();
            assert_abs_diff_eq!(angle, fixed.q[3], epsilon = rounding);
            assert_abs_diff_eq!(relative, fixed.v[3], epsilon = rounding);
            assert_abs_diff_eq!(own.energy.work, fixed.energy.work, epsilon = rounding);
            assert_eq!(free, fixed.energy.work == 0.0, "{name}");
        }
    }
    let heavy = Train::new(lead(), Vec::new(), |trailer| trailer.sleigh).unwrap().with_rotor(0.0, 1.0, None);
    assert!(heavy.unwrap_err().to_string().contains("inertia of the rotor must be finite and positive"));
}

test_systems::short_and_full! {
    a_train_with_a_rotor => check_rotor(["dla"]);
    a_train_with_a_rotor_in_full => check_rotor(METHODS);
}

/// On a free bearing the rotor changes nothing and keeps its rate in space; a motor turns the train the other way, and their angular
/// impulses cancel in what the rotor has.
fn check_rotor(names: impl IntoIterator<Item = &'static str>) {
    let train = || Train::new(lead(), trailers(), |trailer| trailer.sleigh).unwrap();
    let (bare, free) = (train(), train().with_rotor(0.7, 2.0, None).unwrap());
    let motor = train().with_rotor(0.7, 2.0, Some(TimeFunction::Constant(0.5))).unwrap();
    for name in names {
        let [without, with, driven] =
            [&bare, &free, &motor].map(|train| made(train, name, &train.start(&START, &[0.1, -0.3])));
        let most = 1e-12;
        for i in 0..9 {
            assert_abs_diff_eq!(without.q[i], with.q[i], epsilon = most);
        }
        assert_abs_diff_eq!(with.v[9], 2.3, epsilon = most);
        // I_r phi'' = tau.
        assert_abs_diff_eq!(driven.v[9], 2.3 + 4.0 * 0.5 / 0.7, epsilon = 10.0 * most);
        assert!((driven.q[2] - with.q[2]).abs() > 0.5, "{name}");
        assert!(driven.energy.work.abs() > 1.0, "{name}");
        let most = if name == "dla" { 1e-2 } else { 1e-4 };
        assert!(driven.energy.max_error < most, "{name}: {:e}", driven.energy.max_error);
    }
}
