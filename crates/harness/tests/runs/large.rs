//! Baselines on sixty coordinates, on threads with the stack that methods count on.

#[allow(unreachable_pub, reason = "shared with the tests of another crate")]
#[path = "../../../dla/tests/large/fleet.rs"]
mod fleet;

use dla::{OneStep, StackUse};
use fleet::{Balls, Ended, Fleet, on_stack};
use harness::{Dop853, ImplicitMidpoint, Rk4, Rk4Projected, Rk4Reduced};

fn ends<Method: OneStep<60, 20>>(method: impl FnOnce() -> Method + Send + 'static) -> Ended {
    on_stack::<Fleet<60, true>, _, 60, 20>(StackUse::LIMIT, method).unwrap()
}

/// To the errors of their orders; only those in a basis, or projected, stay on the constraint.
#[test]
#[ignore = "slow"]
fn sixty_by_baselines() {
    for (end, error, slip) in [
        (ends(|| Rk4), 1e-8, 1e-8),
        (ends(|| Rk4Projected), 1e-8, 1e-13),
        (ends(|| Rk4Reduced), 1e-8, 1e-13),
        (ends(ImplicitMidpoint::default), 2e-4, 1e-4),
        (ends(|| Dop853::new(1e-10)), 1e-9, 1e-13),
    ] {
        assert!(end.error <= error && end.slip <= slip, "{end:?}");
    }
    let projected = on_stack::<Balls<60, false>, _, 60, 20>(StackUse::LIMIT, || Rk4Projected).unwrap();
    assert!(projected.error <= 1e-8 && projected.slip <= 1e-13 && projected.off <= 1e-8, "{projected:?}");
}
