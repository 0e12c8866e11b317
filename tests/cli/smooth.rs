//! Smooth motions on which the iterations of some methods have failed, and what no method can do, with its cause.

use crate::program::Folder;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn folder(file: &str) -> Folder {
    let folder = Folder::new();
    folder.write(file, fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(file)).unwrap());
    folder
}

fn run(line: &str) -> Value {
    folder(line.split(' ').next().unwrap()).json(&format!("run {line} --json"))
}

/// A run, a number of its end, what that is by a method of another kind with steps much shorter, and how near it comes: the error of the method.
type Case = (&'static str, &'static str, f64, f64);

const SHORT: [Case; 11] = [
    // The force is zero at the start, and large at once. The phase of the method of order 2 lags by (h w)^2/12 of it.
    ("stiff-oscillator.toml --method energy8", "y", -1.326_437_947_0e-4, 1e-11),
    ("stiff-oscillator.toml --method energy2", "y", -1.326_437_947_0e-4, 4e-5),
    // A circle of radius v/w. The inertia is next to none, so that the rate of the heading has the digits that m v^2 leaves: it is
    // rounded to the part eps m v^2/(I w^2) = 3e-7.
    ("light-heading.toml --method energy8", "y", -1.039_407_848_813_8, 1e-6),
    ("light-heading.toml --method energy2", "speed", 0.555_687_525_785_308_9, 1e-6),
    // The rate of a momentum is a difference of large terms, and vanishes.
    ("flywheel-energy2.toml --method energy4", "x", -30.981_815_656_098, 1e-10),
    // The basis that is best where a step begins is singular within it.
    ("basis-crossing.toml --method gauss8", "x", -19.960_743_342, 1e-5),
    ("basis-change-energy.toml --method energy2", "x", -0.023_909_741_7, 1e-4),
    ("basis-change-energy.toml --method energy4", "x", -0.023_909_741_7, 1e-6),
    // Friction stops the train within the step, from which Newton's method does not contract.
    ("train-friction.toml", "x", 0.086_328_5, 2e-3),
    ("turntable --set effects.0.rate=20 --duration 2 --method gauss8", "x", 1.942_074_16, 1e-4),
    // The iteration does not contract: the spin decays within the step. With two stages the highest coefficient of a smooth motion is large.
    ("turntable --set effects.0.rate=20 --duration 2 --method gauss4", "x", 1.942_074_16, 1e-4),
];

/// A ball turns by more than a radian in a step; the place at the end is on its conic section.
const LONG: [Case; 2] = [
    ("free-turntable.toml --method gauss16 --step 0.2", "x", 0.118_391_84, 1e-8),
    ("free-turntable.toml --method gauss16 --step 0.2", "y", -0.220_883_74, 1e-8),
];

fn ends(cases: &[Case]) {
    for (line, name, right, near) in cases {
        let run = match line.split([' ', '.']).next() {
            Some("turntable") => Folder::new().json(&format!("run {line} --json")),
            // Next to no inertia, and so few digits, of which the run warns.
            Some("light-heading") => {
                let outcome = folder("light-heading.toml").line(&format!("run {line} --json"));
                assert!(outcome.code == 0 && outcome.stderr.contains("round-off leaves the velocities"), "{outcome:?}");
                serde_json::from_str(&outcome.stdout).unwrap()
            }
            _ => run(line),
        };
        let end = run["final"][name].as_f64().unwrap();
        assert!((end - right).abs() <= *near, "{line}: {end:e}, not {right:e}");
    }
}

#[test]
fn smooth_motions_are_not_refused() {
    ends(&SHORT);
}

#[test]
#[ignore = "slow"]
fn smooth_motions_are_not_refused_at_length() {
    ends(&LONG);
}

/// Where a train rests all corrections are the rounding of large reactions, and may grow by chance: it keeps its place.
fn rests(lines: &[&str]) {
    for line in lines {
        let end = run(&format!("train-rests.toml --method {line}"));
        assert!((end["final"]["x"].as_f64().unwrap() - 0.002_500_649_704_480_474).abs() < 1e-14, "{line}: {end}");
        assert!(end["final"]["speed"].as_f64().unwrap().abs() < 1e-15, "{line}: {end}");
    }
}

#[test]
fn trains_at_rest_stay() {
    rests(&["dla --duration 6.5"]);
}

#[test]
#[ignore = "slow"]
fn trains_at_rest_stay_at_length() {
    rests(&["dla --duration 500", "dla4 --duration 500", "dla6 --duration 500", "dla8 --duration 500"]);
}

/// A coordinate of 1e-14 kg holds its constraint as any other does.
#[test]
fn light_coordinates_hold_their_constraint() {
    let run = run("hill-disc.toml --method dla --duration 1.5 --set start.s'=1.8");
    assert!(run["constraint"]["max"].as_f64().unwrap() < 2e-15, "{run}");
}

/// Runs that cannot be made, and words of why.
const REFUSED: [(&str, &[&str]); 7] = [
    ("two-wheels-one-axle.toml --method gauss8", &["rows 1 and 2 of the constraint are linearly dependent"]),
    ("two-wheels-one-axle.toml --method dop853", &["rows 1 and 2 of the constraint are linearly dependent"]),
    ("two-wheels-one-axle.toml --method energy2", &["rows 1 and 2 of the constraint are linearly dependent"]),
    ("two-wheels-one-axle.toml --method rk4-projected", &["rows 1 and 2 of the constraint are linearly dependent"]),
    ("gear-without-mass.toml --method lobatto3", &["mass matrix is singular", "`dla`, `gauss`"]),
    ("gear-without-mass.toml --method lobatto5", &["mass matrix is singular", "`dla`, `gauss`"]),
    ("light-sleigh.toml --method lobatto3", &["mass matrix is singular or nearly so"]),
];

#[test]
fn what_a_method_cannot_do_is_told_with_its_cause() {
    for (line, told) in REFUSED {
        let outcome = folder(line.split(' ').next().unwrap()).line(&format!("run {line}"));
        assert_ne!(outcome.code, 0, "{line}: {outcome:?}");
        for words in told {
            assert!(outcome.stderr.contains(words), "{line}: {}", outcome.stderr);
        }
    }
    // The positive controls: what the messages recommend does it. x = cos(3 t/2).
    let end = run("gear-without-mass.toml --method gauss8");
    assert!((end["final"]["x"].as_f64().unwrap() - (15.0_f64).cos()).abs() < 1e-10, "{end}");
    let end = run("two-wheels-one-axle.toml --method dla");
    assert!((end["final"]["theta"].as_f64().unwrap() - 7.263_07).abs() < 1e-4, "{end}");
}
