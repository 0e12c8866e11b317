//! The work that is taken off the energy of an assembly is that of the method's own forces.

use assembly::parts::{Trailer, Train};
use assembly::{Assembly, AssemblyMethod, AssemblyReport, AssemblyState, AssemblyWork, Solver, SparseEnergy};
use dla::Schedule;
use harness::{AssemblyEvent, AssemblyNodes, Method, Record, Request, run_assembly, run_assembly_watched};
use lagrangian::linear::larger;
use lagrangian::{Piecewise, System, With};
use proptest::prelude::*;
use sleigh::effects::{Drag, Thrust, Torque};
use sleigh::{Sleigh, SleighState, TimeFunction};

/// A sleigh under a constant thrust of 0.2 N with one trailer, bent by 0.5 rad less its heading.
fn thrust() -> (Train, AssemblyState) {
    let lead = With { body: lead(), effects: Thrust::new(TimeFunction::Constant(0.2)).unwrap() };
    let train = Train::new(lead, vec![trailer(1.0)], |trailer| trailer.sleigh).unwrap();
    let start = train.start(&START, &[0.5]);
    (train, start)
}

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

fn measured((train, start): &(Train, AssemblyState), name: &str, schedule: &Schedule) -> Record<3> {
    let method = Method::named(name, None).unwrap();
    let run = run_assembly(&train.assembly, &method, schedule, start, schedule.steps, &mut ());
    assert!(run.failure.is_none(), "{name}: {:?}", run.failure);
    run.record
}

/// Rounding that walks at random, a few ulps of the largest energy a step.
fn rounding(record: &Record<3>) -> f64 {
    let size = record.energy.initial.max(record.energy.last) + record.energy.work.abs();
    4.0 * f64::EPSILON * size * (record.steps as f64).sqrt()
}

#[test]
fn the_energy_changes_by_the_work_of_the_discrete_forces() {
    check_work(&[0.04], 2.0);
}

#[test]
#[ignore = "slow"]
fn the_energy_changes_by_the_work_of_the_discrete_forces_at_length() {
    check_work(&[0.04, 0.02, 0.01], 20.0);
}

/// By theory the energy changes by the work of the discrete forces, whatever the step; the control is the midpoint rule, whose
/// energy does not.
fn check_work(steps: &[f64], duration: f64) {
    for scene in [thrust(), driven()] {
        for &step in steps {
            let schedule = schedule(step, duration);
            let kept = measured(&scene, "energy2", &schedule);
            println!("{step}: {:e} of {:e} J", kept.energy.max_error, rounding(&kept));
            assert!(kept.energy.work.abs() > 0.1);
            assert!(kept.energy.max_error < rounding(&kept), "{step}: {:e}", kept.energy.max_error);
            let control = measured(&scene, "dla", &schedule);
            assert!(control.energy.max_error > 1e-8, "{step}: {:e}", control.energy.max_error);
        }
    }
}

/// A train of up to four trailers that something pushes, brakes and turns.
fn any_train() -> impl Strategy<Value = (Train, AssemblyState)> {
    let forces = (-1.0..1.0f64, -0.5..0.5f64, 0.0..0.5f64, 0.0..0.3f64);
    (forces, proptest::collection::vec(0.5..1.5f64, 1..5), -0.5..0.5f64).prop_map(
        |((push, torque, along, turning), bars, bend)| {
            let drag = || Drag::new(along, turning).unwrap();
            let effects = (Thrust::new(push).unwrap(), (Torque::new(torque).unwrap(), drag()));
            let body = |trailer: &Trailer| With { body: trailer.sleigh, effects: drag() };
            let trailers = bars.into_iter().map(trailer).collect();
            let train = Train::new(With { body: lead(), effects }, trailers, body).unwrap();
            let start = train.start(&START, &[bend, 0.0, -bend]);
            (train, start)
        },
    )
}

/// Whatever acts on the train, and however long the step.
fn check_balance(scene: &(Train, AssemblyState), step: f64, steps: u64) -> Result<(), TestCaseError> {
    let kept = measured(scene, "energy2", &Schedule { t0: 0.0, step, steps });
    prop_assert!(kept.energy.max_error < rounding(&kept), "{:e} J", kept.energy.max_error);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4))]

    #[test]
    fn the_balance_of_any_train(scene in any_train(), step in 0.005..0.05f64) {
        check_balance(&scene, step, 20)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    #[ignore = "slow"]
    fn the_balance_of_any_train_at_length(scene in any_train(), step in 0.005..0.05f64) {
        check_balance(&scene, step, 200)?;
    }
}

#[test]
fn a_free_train_has_no_work() {
    check_free(0.3);
}

#[test]
#[ignore = "slow"]
fn a_free_train_has_no_work_in_full() {
    check_free(20.0);
}

/// Without forces nothing is taken off.
fn check_free(duration: f64) {
    let (scene, schedule) = (free(), schedule(0.02, duration));
    for name in ["energy2", "dla", "dla4", "lobatto3"] {
        assert_eq!(measured(&scene, name, &schedule).energy.work.to_bits(), 0.0f64.to_bits(), "{name}");
    }
    let kept = measured(&scene, "energy2", &schedule);
    assert!(kept.energy.max_error < rounding(&kept), "{:e}", kept.energy.max_error);
}

/// By so much, relatively, every velocity is off in a wrong step.
const WRONG: f64 = 1e-10;

/// What the error of the energy would be by the work that the forces do along the polynomial through the nodes, or after a step
/// that is not the method's.
fn energy_error(schedule: &Schedule, along: bool, wrong: bool) -> f64 {
    let (train, start) = thrust();
    let assembly = &train.assembly;
    let (mut method, mut work) = (SparseEnergy::new(assembly, Solver::Best).unwrap(), AssemblyWork::default());
    let (mut state, initial, mut most) = (start.clone(), assembly.energy(0.0, &start), 0.0);
    for k in 0..schedule.steps {
        let (t0, t1, before) = (schedule.time(k), schedule.time(k + 1), state.clone());
        let report = method.step(assembly, t0, schedule.step, &mut state).unwrap();
        assert!(report.work.unwrap() > 0.0);
        if wrong && k == schedule.steps / 2 {
            state = faster(assembly, &state, 1.0 + WRONG);
        }
        let report = if along { AssemblyReport { work: None, ..report } } else { report };
        work.step(assembly, (t0, &before), (t1, &state), &report);
        most = larger(most, assembly.energy(t1, &state) - initial - work.total());
    }
    most
}

/// A wrong step at an energy (J) of `least` and more.
fn check_wrong_step(schedule: &Schedule, least: f64) {
    let (right, wrong) = (energy_error(schedule, false, false), energy_error(schedule, false, true));
    println!("{right:e} {wrong:e}");
    assert!(wrong > 2.0 * WRONG * least && right < 1e-3 * wrong);
}

#[test]
fn another_work_and_another_step_are_seen() {
    // Along the polynomial it is of second order.
    let [coarse, fine] = [0.04, 0.02].map(|step| energy_error(&schedule(step, 1.2), true, false));
    assert!((coarse / fine / 4.0 - 1.0).abs() < 0.1 && fine > 1e-12, "{coarse:e} {fine:e}");
    check_wrong_step(&schedule(0.04, 1.2), 0.5);
}

#[test]
#[ignore = "slow"]
fn another_work_and_another_step_are_seen_in_full() {
    for (step, known) in [(0.04, 3.1e-6), (0.02, 7.8e-7), (0.01, 1.9e-7)] {
        let error = energy_error(&schedule(step, 20.0), true, false);
        println!("{step}: {error:e}");
        assert!((error / known - 1.0).abs() < 0.05, "{step}: {error:e}");
    }
    check_wrong_step(&schedule(0.02, 20.0), 1.0);
}

/// The same place with all velocities multiplied.
fn faster(assembly: &Assembly, state: &AssemblyState, by: f64) -> AssemblyState {
    let of = |what: &dyn Fn(usize) -> f64| (0..state.len()).map(what).collect::<Vec<_>>();
    AssemblyState::new(assembly, &of(&|i| state.unwrapped(i)), &of(&|i| by * state.v(i)))
}

#[test]
fn the_work_of_a_step_that_an_event_ends() {
    check_ended_step(0.156_789);
}

#[test]
#[ignore = "slow"]
fn the_work_of_a_step_that_an_event_ends_in_full() {
    check_ended_step(4.567_89);
}

/// Of the step that an event at a time (s) ends only the part before it counts.
fn check_ended_step(time: f64) {
    let (train, start) = driven();
    let schedule = schedule(0.1, 20.0);
    for (name, most) in [("energy2", 1e-14), ("dla8", 1e-10)] {
        let method = Method::named(name, None).unwrap();
        let at = |t: f64, _: &AssemblyState| t - time;
        let events = [AssemblyEvent::new("t", true, at)];
        let (run, ..) = run_assembly_watched(
            &train.assembly,
            &method,
            &schedule,
            (&start, AssemblyNodes::Kept(1000)),
            (&events, 4),
            &mut (),
        );
        assert!((run.record.t - time).abs() < 1e-12);
        println!("{name} {:e}", run.record.energy.max_error);
        assert!(run.record.energy.max_error < most, "{name}: {:e}", run.record.energy.max_error);
    }
}

#[test]
fn one_sleigh_is_measured_as_the_static_sleigh() {
    check_one_sleigh(&["dla", "energy2"], 2.0);
}

#[test]
#[ignore = "slow"]
fn one_sleigh_is_measured_as_the_static_sleigh_at_length() {
    // Of higher order the sleigh alone measures its work by the stages of the method.
    check_one_sleigh(&["dla", "dla4", "lobatto3", "lobatto4", "energy2"], 20.0);
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
            let own = run_assembly(&alone, &method, &schedule, &start, 400, &mut ()).record;
            let fixed = harness::run(system, &method, &Request { schedule, q, v, samples: 2 }, &mut ());
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
    let method = Method::named("lobatto5", None).unwrap();
    let schedule = schedule(0.02, 200.0);
    let run = run_assembly(&train.assembly, &method, &schedule, &start, 50, &mut ());
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let folded = run.nodes.iter().fold(0.0, |most, node| larger(most, node.q[5] - node.q[2]));
    println!("{:e} J of {:e} J, folded by {folded} rad", run.record.energy.max_error, run.record.energy.initial);
    assert!(folded > 0.9 * std::f64::consts::FRAC_PI_2);
    assert!(run.record.energy.max_error < 1e-14);
    assert!(run.record.constraint_max < 1e-14 && run.record.leaf_max.unwrap() < 1e-14);
}
