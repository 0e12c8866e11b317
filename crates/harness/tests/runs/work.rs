//! The work that is taken off the energy of an assembly.

use super::run;
use super::trains::{made, request, watched};
use assembly::parts::{Trailer, Train};
use assembly::{Assembly, AssemblyState, AssemblySubject};
use dla::{Event, Schedule, Subject};
use harness::{Method, Record};
use lagrangian::linear::larger;
use lagrangian::{Piecewise, System, With};
use sleigh::effects::{Drag, Thrust, Torque};
use sleigh::{Sleigh, SleighState, TimeFunction};

fn lead() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.2).unwrap()
}

fn trailer(bar: f64) -> Trailer {
    Trailer::new(0.5, 0.1, 0.0, 0.0, bar).unwrap()
}

const START: SleighState = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: 1.0, turn_rate: 0.3 };

/// Thrust and torque that change with time on the lead, drag on every blade.
fn driven() -> (Train, AssemblyState) {
    let wave = |size: f64, rate: f64| TimeFunction::Sine { amplitude: size, frequency: rate, phase: 0.3 };
    let effects =
        (Thrust::new(wave(0.8, 1.3)).unwrap(), (Torque::new(wave(0.5, 2.1)).unwrap(), Drag::new(0.1, 0.05).unwrap()));
    let body = |trailer: &Trailer| With { body: trailer.sleigh, effects: Drag::new(0.05, 0.02).unwrap() };
    let train = Train::new(With { body: lead(), effects }, vec![trailer(0.8); 3], body).unwrap();
    let start = train.start(&START, &[0.3, -0.2]);
    (train, start)
}

fn free() -> (Train, AssemblyState) {
    let train = Train::new(lead(), vec![trailer(0.8); 3], |trailer| trailer.sleigh).unwrap();
    let start = train.start(&START, &[0.3, -0.2]);
    (train, start)
}

fn schedule(step: f64, duration: f64) -> Schedule {
    Schedule { t0: 0.0, step, steps: (duration / step).round() as u64 }
}

fn measured((train, start): &(Train, AssemblyState), name: &str, schedule: &Schedule) -> Record {
    let method = Method::named(name, None).unwrap();
    let run = made(train, &method, schedule, start, schedule.steps).record;
    assert!(run.failure.is_none(), "{name}: {:?}", run.failure);
    run
}

test_systems::short_and_full! {
    a_free_train_has_no_work => check_free(0.3);
    a_free_train_has_no_work_in_full => check_free(20.0);
}

/// Without forces nothing is taken off.
fn check_free(duration: f64) {
    let (scene, schedule) = (free(), schedule(0.02, duration));
    for name in ["dla", "dla4"] {
        assert_eq!(measured(&scene, name, &schedule).energy.work.to_bits(), 0.0f64.to_bits(), "{name}");
    }
}

test_systems::short_and_full! {
    the_work_of_a_step_that_an_event_ends => check_ended_step(0.156_789);
    the_work_of_a_step_that_an_event_ends_in_full => check_ended_step(4.567_89);
}

/// Of the step that an event at a time (s) ends only the part before it counts.
fn check_ended_step(time: f64) {
    let (train, start) = driven();
    let schedule = schedule(0.1, 20.0);
    let method = Method::named("dla8", None).unwrap();
    let events = [Event::new("t", |t, _, _| t - time).terminal()];
    let run = watched((&train, &start), &method, &schedule, &events, 1000);
    assert!((run.record.t - time).abs() < 1e-12);
    println!("{:e}", run.record.energy.max_error);
    assert!(run.record.energy.max_error < 1e-10, "{:e}", run.record.energy.max_error);
}

test_systems::short_and_full! {
    one_sleigh_is_measured_as_the_static_sleigh => check_one_sleigh(&["dla"], 2.0);
    one_sleigh_is_measured_as_the_static_sleigh_at_length => check_one_sleigh(&["dla", "dla4"], 20.0);
}

/// An assembly of one sleigh is measured as the sleigh is, for so long (s).
fn check_one_sleigh(names: &[&str], duration: f64) {
    fn compare<Sys>((names, duration): (&[&str], f64), system: &Sys, powered: bool)
    where
        Sys: System<3, 1> + Piecewise + Clone + Send + Sync + 'static,
    {
        let mut alone = Assembly::new();
        let _: [usize; 3] = alone.body("blade", system.clone());
        let (q, v) = START.to_coordinates();
        let start = AssemblyState::new(&alone, &q, &v);
        let schedule = schedule(0.05, duration);
        for name in names {
            let method = Method::named(name, None).unwrap();
            let request = request(&schedule, &start, 2);
            let own = run(&AssemblySubject::from(&alone), &method, &request);
            let fixed = run(&Subject::from(system), &method, &request);
            let (own, fixed) = (own.energy, fixed.energy);
            println!("{name} {:e} {:e} {:e} {:e}", own.work, fixed.work, own.max_error, fixed.max_error);
            assert_eq!(powered, fixed.work != 0.0);
            // The path differs by the rounding of its velocities, a few ulps in each of the steps.
            let rounding = schedule.steps as f64 * 4.0 * f64::EPSILON * (fixed.initial + fixed.work.abs());
            assert!((own.work - fixed.work).abs() < rounding, "{name}");
            assert!((own.max_error - fixed.max_error).abs() < rounding, "{name}");
        }
    }
    let thrust = Thrust::new(TimeFunction::Constant(0.2)).unwrap();
    let runs = (names, duration);
    compare(runs, &With { body: lead(), effects: thrust.clone() }, true);
    let wave = TimeFunction::Sine { amplitude: 0.5, frequency: 2.1, phase: 0.3 };
    let effects = (thrust, (Torque::new(wave).unwrap(), Drag::new(0.1, 0.05).unwrap()));
    compare(runs, &With { body: lead(), effects }, true);
    compare(runs, &lead(), false);
}

/// Pushed from behind, three blades fold and go on.
#[test]
#[ignore = "slow"]
fn pushed_trains_fold_and_go_on() {
    let train = Train::new(lead(), vec![trailer(1.0); 2], |trailer| trailer.sleigh).unwrap();
    let start = train.start(&SleighState { speed: -1.0, turn_rate: 0.05, ..START }, &[0.01, -0.02]);
    let method = Method::named("dla8", None).unwrap();
    let schedule = schedule(0.02, 200.0);
    let run = made(&train, &method, &schedule, &start, 50).record;
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let folded = run.samples.iter().fold(0.0, |most, node| larger(most, node.q[5] - node.q[2]));
    println!("{:e} J of {:e} J, folded by {folded} rad", run.energy.max_error, run.energy.initial);
    assert!(folded > 0.9 * std::f64::consts::FRAC_PI_2);
    // Rounding of 150,000 steps of `dla`, which walks at random.
    assert!(run.energy.max_error < 1e-13);
    assert!(run.constraint_max < 1e-14 && run.leaf_max.unwrap() < 1e-14);
}
