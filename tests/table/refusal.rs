//! What a method cannot do it refuses, with an error that says why; what it can do it does.

use crate::rows::table;
use crate::tools::{method, refuses};
use dla::{Schedule, StepError};
use harness::METHODS;

#[test]
fn refusals_are_errors_that_say_why() {
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 20 };
    let mut refused = 0;
    for case in table() {
        for info in METHODS {
            let mut nodes = 0;
            let outcome = case.run(&method(info.name), &case.start(), &schedule, &mut |_| nodes += 1);
            match (refuses(info, case.facts()), outcome) {
                (None, outcome) => {
                    assert!(outcome.is_ok(), "{}, {}: {outcome:?}", case.name(), info.name);
                    assert_eq!(nodes, 21);
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
    // Four energy methods on four rows, what needs a basis on the row without one, and four energy methods and `gni` on two rows
    // with constraints on positions; the series on every row.
    assert_eq!(refused, 4 * 4 + 10 + 5 * 2 + table().len());
}
