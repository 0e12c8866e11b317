//! Runs of assemblies.
use approx::assert_abs_diff_eq;
use assembly::parts::{Trailer, Train};
use dla::Schedule;
use harness::{Method, Progress, run_assembly};
use lagrangian::With;
use sleigh::effects::{Drag, Thrust};
use sleigh::{Sleigh, SleighState, TimeFunction};

const SCHEDULE: Schedule = Schedule { t0: 0.0, step: 0.02, steps: 200 };

fn train() -> Train {
    let trailers = vec![Trailer::new(0.5, 0.1, 0.1, 0.2, 0.8).unwrap(); 3];
    let effects = (Drag::new(0.3, 0.1).unwrap(), Thrust::new(TimeFunction::Constant(0.4)).unwrap());
    let lead = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects };
    Train::new(lead, trailers, |trailer| trailer.sleigh).unwrap()
}

/// The work of drag and thrust is taken off the energy; what is left is of the order of the method.
#[test]
fn a_run_of_a_train_is_measured() {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, turn_rate: 0.5, ..SleighState::default() }, &[0.1, 0.2]);
    let run = |name: &str| {
        let method = Method::named(name, None).unwrap();
        run_assembly(&train.assembly, &method, &SCHEDULE, &start, 10, &mut ())
    };
    let [second, fourth] = ["dla", "dla4"].map(run);
    for run in [&second, &fourth] {
        let record = &run.record;
        assert_eq!((record.steps, run.nodes.len(), record.samples.len()), (200, 21, 21));
        assert_abs_diff_eq!(record.t, 4.0, epsilon = 1e-12);
        assert!(record.constraint_max < 1e-14 && record.leaf_max.unwrap() < 1e-14);
        assert!(record.energy.work.abs() > 0.1);
        assert!(record.newton.mean >= 1.0 && record.wall_seconds > 0.0);
    }
    // Simpson's rule leaves 1e-8 of the work; order 2 leaves 1e-4.
    assert!(fourth.record.energy.max_error < 1e-6, "{:e}", fourth.record.energy.max_error);
    assert!(second.record.energy.max_error > fourth.record.energy.max_error);
}

/// What the methods of a few coordinates cannot do they refuse.
#[test]
fn other_methods_refuse_trains() {
    let train = train();
    let start = train.start(&SleighState::default(), &[]);
    let method = Method::named("rk4", None).unwrap();
    let run = run_assembly(&train.assembly, &method, &SCHEDULE, &start, 10, &mut ());
    assert!(run.record.refusal().unwrap().contains("dla8"));
    assert_eq!(run.record.steps, 0);
}

/// Somebody who stops a run as soon as asked.
struct Impatient;

impl Progress for Impatient {
    fn advance(&mut self, _steps: u64) {}

    fn stops(&self) -> bool {
        true
    }
}

#[test]
fn an_interrupted_run_keeps_what_is_made() {
    let train = train();
    let start = train.start(&SleighState { speed: 1.0, ..SleighState::default() }, &[]);
    let method = Method::named("dla", None).unwrap();
    let long = Schedule { steps: 100_000_000, ..SCHEDULE };
    let run = run_assembly(&train.assembly, &method, &long, &start, long.steps, &mut Impatient);
    assert!(run.record.interrupted && run.record.steps > 0);
    assert_abs_diff_eq!(run.nodes.last().unwrap().t, run.record.t);
}
