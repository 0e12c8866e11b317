//! An adaptive method has a tolerance in place of the step: its error follows that, and hardly the step.

use crate::table::rows::named;
use crate::table::tools::slope;
use harness::Method;

#[test]
fn the_error_follows_the_tolerance() {
    let case = named("free sleigh");
    let exact = case.exact_from(&case.start(), case.duration()).unwrap();
    let dop853 = Method::named("dop853", None).unwrap();
    let error = |tolerance: f64, steps: u64| {
        case.end(&dop853.with_tolerance(tolerance).unwrap(), steps).unwrap().distance(&exact)
    };
    for steps in [1, 8] {
        let ladder = [1e-5, 1e-7, 1e-9, 1e-11].map(|tolerance| (tolerance, error(tolerance, steps)));
        println!("{steps} intervals: {ladder:?}");
        for (tolerance, error) in ladder {
            // Some ten steps, each with an error of the tolerance, which the motion makes at most a hundred times larger.
            assert!(error <= 1e3 * tolerance, "{steps} intervals, tolerance {tolerance:e}: {error:e}");
        }
        if steps == 1 {
            // Over one long interval the error is nearly proportional to it.
            let power = slope(&ladder);
            assert!((0.8..=1.2).contains(&power), "the error goes with tolerance^{power}");
        }
    }
    // The default asks for as much as there is to have.
    let default = case.end(&dop853, 80).unwrap().distance(&exact);
    assert!(default <= 1e-12, "default tolerance: {default:e}");
}
