//! A step allocates nothing, whatever the method.

use crate::common::{backward, midpoint_forms, sleigh, state_of};
use allocation_counter::measure;
use dla::{AnyState, Mechanism, Schedule, Subject, make_steps};
use harness::{METHODS, Method, MethodKind};
use sleigh::Taylor;

test_systems::short_and_full! {
    no_method_allocates_in_a_step => check_steps(40);
    no_method_allocates_in_a_step_in_full => check_steps(1000);
}

fn check_steps(steps: u64) {
    let sleigh = sleigh();
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    let system = Subject::from(&sleigh);
    for info in METHODS {
        // Made once for a run, on the heap.
        let mut integrator = system.integrator(&Method::named(info.name, None).unwrap());
        let mut state = AnyState::from(state_of(&sleigh, &backward()));
        // Its equations are derived in the first step.
        let first = u64::from(info.kind == MethodKind::Taylor);
        make_steps(&system, &mut *integrator, &schedule, 0..first, &mut state, &mut ()).unwrap();
        let counts = measure(|| {
            make_steps(&system, &mut *integrator, &schedule, first..steps, &mut state, &mut ()).unwrap();
        });
        assert_eq!(counts.count_total, 0, "{} allocates", info.name);
    }
    let taylor = Box::new(Taylor::of(&sleigh, Method::TOLERANCE).unwrap());
    for (name, mut method) in midpoint_forms(sleigh).into_iter().chain([("taylor", taylor as _)]) {
        let mut state = state_of(&sleigh, &backward());
        let counts = measure(|| {
            for k in 0..steps {
                method.step(&sleigh, schedule.time(k), schedule.step, &mut state).unwrap();
            }
        });
        assert_eq!(counts.count_total, 0, "{name} allocates");
    }
}

/// The control: the counter counts.
#[test]
fn the_counter_counts() {
    let counts = measure(|| {
        std::hint::black_box(vec![1.0f64; 3]);
    });
    assert_eq!(counts.count_total, 1);
}
