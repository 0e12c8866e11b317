//! The table of claims says what its methods say of themselves.

use harness::stability::{Claim, claims};
use harness::{METHODS, MethodKind};

#[test]
fn who_claims_what() {
    for info in METHODS {
        let claimed = |claim| claims(info.kind, claim).is_ok();
        // Every method answers for its order, but the counter-example.
        assert_eq!(claimed(Claim::Order), info.kind != MethodKind::Gni, "{}", info.name);
        assert_eq!(claimed(Claim::StableLine), info.kind != MethodKind::Gni, "{}", info.name);
        assert_eq!(claimed(Claim::Constraint), info.keeps.contains("constraint"), "{}", info.name);
        assert_eq!(claimed(Claim::Energy), info.keeps.contains("energy"), "{}", info.name);
        let explicit = matches!(info.kind, MethodKind::Rk4 | MethodKind::Rk4Projected | MethodKind::Rk4Reduced)
            || info.kind.is_adaptive();
        assert_eq!(claimed(Claim::Symmetry), !explicit && info.kind != MethodKind::Gni, "{}", info.name);
    }
}
