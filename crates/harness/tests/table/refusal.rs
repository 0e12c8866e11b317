//! What a method cannot do it refuses, with an error that says why; what it can do it does.

use crate::table::case::Rows;
use crate::table::rows::{kinds, named, table};
use crate::table::tools::{method, refuses};
use dla::{Schedule, StepError};
use harness::METHODS;

/// Every method on the rows; how often one was refused.
fn refused(rows: &Rows, steps: u64) -> usize {
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    let mut refused = 0;
    for case in rows {
        for info in METHODS {
            let mut nodes = 0;
            let outcome = case.run(&method(info.name), &case.start(), &schedule, &mut |_| nodes += 1);
            match (refuses(info, case.facts()), outcome) {
                (None, outcome) => {
                    assert!(outcome.is_ok(), "{}, {}: {outcome:?}", case.name(), info.name);
                    assert_eq!(nodes, steps + 1);
                }
                (Some(reason), outcome) => {
                    let error = outcome.unwrap_err();
                    let of_its_kind = matches!(error.source, StepError::Unsupported { .. } | StepError::Reduced(_));
                    assert!(of_its_kind, "{}, {}: {error:?}", case.name(), info.name);
                    assert!(error.to_string().contains(reason), "{}, {}: {error}", case.name(), info.name);
                    assert_eq!((error.step, nodes), (1, 1), "only the start was seen");
                    refused += 1;
                }
            }
        }
    }
    refused
}

#[test]
fn refusals_are_errors_that_say_why() {
    let mut rows = kinds();
    rows.push(named("moving everything, no basis"));
    // Four energy methods on three rows, what needs a basis on the row without one, and four energy methods and `gni` on the row
    // with a constraint on positions.
    assert_eq!(refused(&rows, 2), 4 * 3 + 11 + 5);
}

#[test]
#[ignore = "slow"]
fn refusals_are_errors_that_say_why_in_full() {
    let rows = table();
    // One more row that moves, and one more with constraints on positions.
    assert_eq!(refused(&rows, 20), 4 * 4 + 11 + 5 * 2);
}
