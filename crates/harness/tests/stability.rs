//! Checks of runs see what is wrong with them, and verdicts are made of the checks.

use dla::{NewtonError, RunError, Stage, StepError};
use harness::stability::check::{constant, largest, measured, rounding, sign_kept, truncation};
use harness::stability::{Case, Claim, Finding, Outcome, Recorded, Seen, Trial, VALUES, claims, judge};
use harness::{METHODS, MethodKind};

fn node(t: f64, values: [f64; VALUES]) -> Seen {
    Seen { t, values, energy_error: 0.0, constraint: 0.0 }
}

const CASE: Case = Case { name: "case", hard: "", shows: "", bar: "", claim: Claim::Order, refusable: false };

fn failing(source: StepError) -> Recorded {
    Recorded { nodes: vec![node(0.0, [0.0; VALUES])], failure: Some(RunError::new(1, 0.0, source)), late: false }
}

/// Each check with numbers that meet its bar, and with the fault that it is for; a number that is none meets no bar.
#[test]
fn checks_see_the_fault_that_they_are_for() {
    let swings = |h: f64| move |k: i32| (h * f64::from(k)).cos();
    let walk = |by: f64| (0..1000).map(move |k| 1.0 + by * f64::from(k) * f64::EPSILON);
    for (name, sound, broken) in [
        ("a size", largest("size", (0..100).map(swings(0.1)), 1.0), largest("size", [0.5, 1.0 + 1e-15], 1.0)),
        ("no number", largest("size", [0.0], 1.0), largest("size", [0.0, f64::NAN, 0.0], 1.0)),
        ("a spin that turns round", sign_kept([1e-300, 1.0, 2.0]), sign_kept([1e-300, -1e-300, 1.0])),
        ("a spin that is lost", sign_kept([-1e-12, -1e-300]), sign_kept([-1e-12, 0.0])),
        // One rounding in each of a thousand steps, and ten times what rounding can do.
        ("rounding", constant(walk(1.0), rounding(1000, 1.0)), constant(walk(160.0), rounding(1000, 1.0))),
        ("an integral without a start", constant([1.0], 0.0), constant([f64::NAN, 1.0], 1.0)),
        // At half the step an error of order two is a quarter, which a method of order four may not have.
        (
            "an order",
            measured("error", 0.25, truncation(2, 0.5, 1.0)),
            measured("error", 0.25, truncation(4, 0.5, 1.0)),
        ),
    ] {
        assert!(sound.holds(), "{name}: {sound:?}");
        assert!(!broken.holds(), "{name}: {broken:?}");
    }
}

/// What is made of runs: a number that is none, a run without end and a silent error fail even where nothing is claimed.
#[test]
fn verdicts() {
    let fine =
        Recorded { nodes: (0..=10).map(|k| node(0.1 * f64::from(k), [1.0; VALUES])).collect(), ..Recorded::default() };
    let found = |measured| Finding { what: "it", measured, bar: 1.0 };
    let with = |run: &Recorded, measured: f64| {
        let mut trial = Trial::new("run", run);
        trial.add([found(0.0), found(measured)]);
        trial
    };
    let outcome = |case: Case, claim, trial: Trial| judge(&case, claim, &[trial]).outcome;
    let refusable = Case { refusable: true, ..CASE };
    assert_eq!(outcome(CASE, Ok(()), with(&fine, 0.5)), Outcome::Pass);
    for measured in [1.5, f64::NAN, f64::INFINITY] {
        assert_eq!(outcome(CASE, Ok(()), with(&fine, measured)), Outcome::Failed);
        assert_eq!(outcome(CASE, Err("why not"), with(&fine, measured)), Outcome::Refused);
    }
    assert_eq!(outcome(CASE, Err("why not"), with(&fine, 0.5)), Outcome::Pass);

    let history = dla::History::new();
    let source = NewtonError::IterationLimit { iterations: 30, correction: 1.0, history };
    let honest = failing(StepError::Newton { stage: Stage::Increment, source });
    assert_eq!(outcome(CASE, Ok(()), with(&honest, 0.5)), Outcome::Failed);
    assert_eq!(outcome(refusable, Ok(()), with(&honest, 0.5)), Outcome::Refused);
    assert_eq!(outcome(refusable, Ok(()), with(&honest, 1.5)), Outcome::Failed, "the part before the error counts");
    let unable = failing(StepError::Unsupported { reason: "not mine" });
    assert_eq!(outcome(CASE, Ok(()), with(&unable, 0.5)), Outcome::Refused);

    let mut lost = fine.clone();
    lost.nodes[3].values[2] = f64::NAN;
    let endless = Recorded { late: true, ..fine.clone() };
    for broken in [lost, endless] {
        for claim in [Ok(()), Err("why not")] {
            assert_eq!(outcome(refusable, claim, with(&broken, 0.5)), Outcome::Failed);
        }
    }
    // Of several runs the worst is told.
    let verdict = judge(&CASE, Ok(()), &[with(&fine, 0.5), with(&fine, 0.9), with(&fine, 0.1)]);
    assert!((verdict.worst.unwrap().measured - 0.9).abs() < f64::EPSILON && verdict.why.contains("run"));
}

/// The table of claims says what its methods say of themselves.
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
