//! A step allocates nothing, whatever the method.

use crate::common::{backward, midpoint_forms, sleigh, state_of};
use allocation_counter::measure;
use dla::{Schedule, Stepper};
use harness::{METHODS, Method, MethodKind};
use sleigh::Taylor;

#[test]
fn no_method_allocates_in_a_step() {
    check_steps(40);
}

#[test]
#[ignore = "slow"]
fn no_method_allocates_in_a_step_in_full() {
    check_steps(1000);
}

fn check_steps(steps: u64) {
    let sleigh = sleigh();
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    for info in METHODS {
        // Made once for a run, on the heap.
        let mut stepper: Stepper<'_, 3, 1> = match info.kind {
            MethodKind::Taylor => Box::new(Taylor::of(&sleigh, Method::TOLERANCE).unwrap()),
            _ => Method::named(info.name, None).unwrap().stepper(),
        };
        let mut state = state_of(&sleigh, &backward());
        let counts = measure(|| {
            dla::drive(&sleigh, &mut *stepper, &schedule, &mut state, &mut ()).unwrap();
        });
        assert_eq!(counts.count_total, 0, "{} allocates", info.name);
    }
    for (name, mut method) in midpoint_forms(sleigh) {
        let mut state = state_of(&sleigh, &backward());
        let counts = measure(|| {
            dla::drive(&sleigh, &mut method, &schedule, &mut state, &mut ()).unwrap();
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
