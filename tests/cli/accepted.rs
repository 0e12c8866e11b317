//! Steps that a method must not accept in silence: they turn too far, leave their branch, or change the energy.

use super::cases::folder;
use crate::program::{Folder, Outcome};
use serde_json::Value;

/// The run of a scene of `tests/cases`, or of a bundled one.
fn run(line: &str) -> Outcome {
    folder(line.split(' ').next().unwrap()).line(&format!("run {line} --json"))
}

fn object(outcome: &Outcome) -> Value {
    serde_json::from_str(&outcome.stdout).unwrap()
}

fn refused(line: &str, reasons: &[&str]) {
    let outcome = run(line);
    let object = object(&outcome);
    let told = format!("{} {}", object["failure"]["reason"], object["failure"]["hint"]);
    assert_eq!(outcome.code, 1, "{line}: {outcome:?}");
    assert!(reasons.iter().all(|reason| told.contains(reason)), "{line}: {told}");
}

/// A spin of half a turn in a step and more is refused, by the scenes that have a closed form of the step as by those that have none.
#[test]
fn turns_that_a_step_cannot_tell_are_refused() {
    for line in [
        "bowl --set start.turn_rate=70 --duration 1 --method dla",
        "bowl --set start.turn_rate=150 --duration 1 --method dla",
        "bowl --set start.turn_rate=150 --duration 1 --method dla8",
        "flywheel --set start.turn_rate=100 --duration 1 --method lobatto3",
        "hills --set start.turn_rate=300 --duration 1 --method dla4",
    ] {
        let outcome = Folder::new().line(&format!("run {line} --json"));
        let failure = &object(&outcome)["failure"];
        assert_eq!(outcome.code, 1, "{line}: {outcome:?}");
        let reason = failure["reason"].as_str().unwrap();
        assert!(
            reason.contains("coordinate 3 would turn by") && reason.contains("tells turns below pi rad"),
            "{reason}"
        );
    }
    // Shorter steps than the one that is named go on, and so does a method with stages that see the turn.
    for line in ["--step 0.02 --method dla4", "--method gauss16"] {
        let outcome = Folder::new().line(&format!("run bowl --set start.turn_rate=100 --duration 1 {line} --json"));
        assert_eq!(outcome.code, 0, "{outcome:?}");
    }
}

/// A parallelogram falls through the place where its rods are in one line, 0.708450 s after the start: right there, and 27 rad on, or a
/// refusal that names it.
#[test]
fn where_the_rank_drops_no_other_branch_is_taken() {
    let names = ["row 1 of the constraint vanishes at t = 0.70", "the rank drops there"];
    for method in ["dla", "dla4", "dla --substep"] {
        refused(&format!("r41_four_bar.toml --duration 1 --method {method}"), &names);
    }
    // By its equation of motion in the angle alone, to the order of the method over a second; or refused.
    let through = |outcome: &Outcome| (object(outcome)["final"]["a"].as_f64().unwrap() + 1.834_557).abs() < 1e-5;
    let lobatto = run("r41_four_bar.toml --duration 1 --method lobatto3");
    assert!(lobatto.code == 0 && through(&lobatto), "{lobatto:?}");
    for method in ["gauss8", "gauss-adaptive --step 0.02", "dop853 --step 0.02"] {
        let outcome = run(&format!("r41_four_bar.toml --duration 1 --method {method}"));
        let named = names.iter().all(|name| outcome.stdout.contains(name));
        assert!(if outcome.code == 0 { through(&outcome) } else { named }, "{method}: {outcome:?}");
    }
    // Explicit steps do not hold positions, and go off a little more at each of the fourteen drops of ten seconds.
    let mut stopped = 0;
    for method in ["rk4", "rk4-projected"] {
        for step in [5e-3, 1e-2, 2e-2, 4e-2] {
            let outcome = run(&format!("r41_four_bar.toml --method {method} --step {step}"));
            let right = || (object(&outcome)["final"]["a"].as_f64().unwrap() + 30.343_945).abs() < 3e-3;
            let named = outcome.stdout.contains("of the constraint vanish") && outcome.stdout.contains(names[1]);
            assert!(if outcome.code == 0 { right() } else { named }, "{method}, {step}: {outcome:?}");
            stopped += outcome.code;
        }
    }
    assert!(stopped > 0);
}

/// Two masses with a spring of 1e20 N/m between them. A spring of 750 N/m is not lost beside it, so nothing rests.
#[test]
fn a_weak_force_beside_a_stiff_one_is_not_rounding() {
    refused("r38_stiff_masses.toml --duration 0.01 --method gauss8", &["of its length fail as well"]);
    refused(
        "r38_stiff_masses.toml --duration 0.01 --set system.parameters.k2=1e10 --method lobatto3",
        &["the step is too long: forces that change with the place"],
    );
    // The right motion, 0.5 cos(sqrt(375) t), to the order of the method.
    let run = object(&run("r38_stiff_masses.toml --set system.parameters.k2=1e10 --duration 0.1 --method dla"));
    let right = 0.5 * (0.1 * 375.0_f64.sqrt()).cos();
    assert!((run["final"]["x1"].as_f64().unwrap() - right).abs() < 1e-4, "{run}");
}

/// Who loses a tenth of the energy in a step says so, and is not called bounded.
#[test]
fn a_step_that_changes_the_energy_is_told() {
    let outcome = run("turntable-long-step.toml --method dla");
    let told = object(&outcome);
    assert!(outcome.code == 0 && outcome.stderr.contains("warning: dla: the step to t = 0.174662 s"), "{outcome:?}");
    assert_eq!(told["energy"]["jump"]["steps"], 10);
    assert_eq!(told["warnings"].as_array().unwrap().len(), 1);
    let verdict = |line: &str| {
        let outcome = folder("turntable-long-step.toml").line(&format!("compare {line} --json"));
        object(&outcome)["rows"][0]["energy"]["verdict"].as_str().unwrap().to_owned()
    };
    assert_eq!(verdict("turntable-long-step.toml --methods dla"), "diverged");
    assert_eq!(verdict("bowl --set start.turn_rate=60 --duration 20 --methods dla"), "undecided");
    // The controls.
    assert_eq!(verdict("bowl --duration 20 --methods dla"), "random walk");
    assert!(object(&run("r22_tiny_swing.toml")).get("warnings").is_none());
}

/// A coordinate of next to no inertia divides the round-off of its momentum; who is left with few digits says so.
#[test]
fn velocities_that_hold_few_digits_are_told() {
    let light = |method: &str| {
        let line = "bowl --duration 5 --step 0.05 --set start.turn_rate=0.1 --set sleigh.offset=0 --set sleigh.inertia";
        object(&folder("r22_tiny_swing.toml").line(&format!("run {line}=2e-12 --method {method} --json")))
    };
    let told = light("energy4");
    assert!(told["warnings"][0].as_str().unwrap().contains("uncertain by"), "{told}");
    // The control: the same motion by another formula, and by the same method with more inertia.
    assert!(light("gauss8").get("warnings").is_none());
}
