//! How a step is divided.

use dla::{Substeps, Undivided};
use std::ops::ControlFlow;

/// Makes what is long enough, and says how often it was asked.
fn pieces(
    limits: Substeps,
    longest: impl Fn(f64) -> f64,
) -> (Result<ControlFlow<(), u64>, Undivided<&'static str>>, f64) {
    let mut way = 0.0;
    let made = limits.divide(
        (2.0, 8.0),
        "whole",
        |_| true,
        |(t, h), after| {
            assert_eq!((t - 2.0 + h) / 8.0, after);
            if h > longest(t) {
                return Err("too long");
            }
            way += h;
            Ok(ControlFlow::Continue(()))
        },
    );
    (made, way)
}

#[test]
fn parts_fill_the_step_within_their_limits() {
    // A half, a quarter, an eighth: eight parts of one second each.
    assert_eq!(pieces(Substeps::default(), |_| 1.0), (Ok(ControlFlow::Continue(8)), 8.0));
    assert_eq!(pieces(Substeps::new(3, u64::MAX), |_| 1.0), (Ok(ControlFlow::Continue(8)), 8.0));
    // Two of one second, one of two, one of four.
    let growing = |t: f64| if t < 4.0 { 1.0 } else { 8.0 };
    assert_eq!(pieces(Substeps::default(), growing), (Ok(ControlFlow::Continue(4)), 8.0));
    let error = pieces(Substeps::new(2, u64::MAX), |_| 1.0).0.unwrap_err();
    assert_eq!(error, Undivided { tried: 2, time: 2.0, part: 2.0, source: "too long" });
    // Two of two seconds failed, two of one second held after one of two, and there may be no more.
    let error = pieces(Substeps::new(53, 5), |t| if t < 4.0 { 2.0 } else { 1.0 }).0.unwrap_err();
    assert_eq!(error, Undivided { tried: 5, time: 5.0, part: 1.0, source: "too long" });
}

#[test]
fn what_no_part_mends_ends_at_once_and_what_breaks_off_does() {
    let never = |_: (f64, f64), _| -> Result<ControlFlow<()>, &'static str> { panic!("is not asked") };
    let error = Substeps::default().divide((0.0, 1.0), "hopeless", |_| false, never).unwrap_err();
    assert_eq!(error, Undivided { tried: 0, time: 0.0, part: 1.0, source: "hopeless" });
    let mut parts = 0;
    let broken = Substeps::default().divide(
        (0.0, 1.0),
        "whole",
        |_| true,
        |_, _| {
            parts += 1;
            Ok(if parts == 1 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) })
        },
    );
    assert_eq!((broken, parts), (Ok(ControlFlow::Break(())), 2));
}
