//! Every check of the hard cases sees a stepper that is broken in the way that the case is about, and passes the same
//! stepper unbroken.

mod checks;
mod claims;
mod fields;
mod places;
mod rest;
mod sleigh;
mod spins;

use dla::{NewtonError, RunError, Schedule, Stage, StepError};
use harness::stability::{Case, Claim, Finding, Outcome, Recorded, Seen, Trial, VALUES, judge};

/// A run of a stepper that is no method of the crate: `step` moves what the case looks at.
pub(crate) fn recorded(
    start: [f64; VALUES],
    schedule: Schedule,
    step: impl FnMut(f64, &mut [f64; VALUES]),
) -> Recorded {
    energetic(start, schedule, |_| 0.0, step)
}

/// The same with an energy.
pub(crate) fn energetic(
    start: [f64; VALUES],
    schedule: Schedule,
    energy: impl Fn(&[f64; VALUES]) -> f64,
    mut step: impl FnMut(f64, &mut [f64; VALUES]),
) -> Recorded {
    let (mut values, first) = (start, energy(&start));
    let seen =
        |t, values: [f64; VALUES]| Seen { t, values, energy_error: (energy(&values) - first).abs(), constraint: 0.0 };
    let mut nodes = vec![seen(schedule.t0, values)];
    for k in 0..schedule.steps {
        step(schedule.time(k), &mut values);
        nodes.push(seen(schedule.time(k + 1), values));
    }
    Recorded { nodes, ..Recorded::default() }
}

pub(crate) use sleigh::schedule;

/// The unbroken stepper meets the bar, the broken one does not.
pub(crate) fn control(name: &str, sound: impl Into<Option<Finding>>, broken: impl Into<Option<Finding>>) {
    let (sound, broken) = (sound.into().unwrap(), broken.into().unwrap());
    println!(
        "{name:<18} {:<40} bar {:.1e}: {:.1e}, broken {:.1e}",
        sound.what, sound.bar, sound.measured, broken.measured
    );
    assert!(sound.holds(), "{name}: the sound stepper has {:e}, above {:e}", sound.measured, sound.bar);
    assert!(!broken.holds(), "{name}: the broken stepper has {:e}, within {:e}", broken.measured, broken.bar);
}

const CASE: Case = Case { name: "case", hard: "", shows: "", bar: "", claim: Claim::Order, refusable: false };

fn failing(source: StepError) -> Recorded {
    let node = Seen { t: 0.0, values: [0.0; VALUES], energy_error: 0.0, constraint: 0.0 };
    Recorded { nodes: vec![node], failure: Some(RunError::new(1, 0.0, source)), late: false }
}

/// What is made of runs: a number that is none, a run without end and a silent error fail even where nothing is claimed.
#[test]
fn verdicts() {
    let fine = recorded([1.0; VALUES], schedule(0.1, 1.0), |_, _| {});
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
