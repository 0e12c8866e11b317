//! `noslip ensemble`.

use crate::program::{Folder, csv, keys};
use approx::assert_abs_diff_eq;

const SWEEP: &str = "\
scene = \"turnaround\"
duration = 5.0
[grid]
start.speed = { from = -1.0, to = -0.5, count = 30 }
[random]
count = 5
start.turn_rate = { uniform = [0.05, 0.3] }
";

#[test]
fn rows_are_those_of_single_runs_in_order() {
    let folder = Folder::new();
    folder.write("sweep.toml", SWEEP);
    let object = folder.json("ensemble sweep.toml --out all.csv --json");
    let expected =
        ["scene", "method", "step", "duration", "keys", "members", "failed", "wall_seconds", "computed", "columns"];
    assert_eq!(keys(&object), expected);
    assert_eq!((object["members"].as_u64(), object["failed"].as_u64()), (Some(150), Some(0)));
    assert_eq!(folder.names(), ["all.csv", "all.csv-metadata.json", "sweep.toml"]);
    let text = folder.read("all.csv").replace(",\n", "\n").replace(",error", "");
    let (header, rows) = csv(&text);
    assert_eq!(header[..4], ["member", "start.speed", "start.turn_rate", "t"]);
    assert!(rows.len() == 150 && rows.iter().enumerate().all(|(i, row)| row[0] as usize == i));

    let row = &rows[73];
    let scene = folder_scene(row[1], row[2]);
    folder.write("one.toml", scene);
    let one = folder.json("run one.toml --json");
    let end = |name: &str| one["final"][name].as_f64().unwrap();
    for (k, name) in ["t", "x", "y", "heading", "speed", "turn_rate"].iter().enumerate() {
        // A hundred steps of numbers below 10, rounded.
        assert_abs_diff_eq!(row[3 + k], end(name), epsilon = 100.0 * 10.0 * f64::EPSILON);
    }
}

fn folder_scene(speed: f64, turn_rate: f64) -> String {
    format!(
        "[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.5\n[start]\nspeed = {speed:?}\nturn_rate = {turn_rate:?}\n\
         [run]\nstep = 0.05\nduration = 5.0\n"
    )
}

/// Members with other steps, durations and methods are runs with these; of methods the column has the place in the list.
#[test]
fn steps_and_methods_vary_as_other_numbers_do() {
    for scene in ["turnaround", "rolling-disk"] {
        let folder = Folder::new();
        let grid = "run.method = [\"rk4\", \"dla\", \"gauss8\"]\nrun.step = [0.05, 0.02]\nrun.duration = [1.0, 2.0]\n";
        folder.write("sweep.toml", format!("scene = \"{scene}\"\n[grid]\n{grid}"));
        folder.done("ensemble sweep.toml --out all.csv");
        let text = folder.read("all.csv").replace(",\n", "\n").replace(",error", "");
        let (header, rows) = csv(&text);
        assert_eq!(header[..5], ["member", "run.duration", "run.method", "run.step", "t"]);
        assert_eq!(rows.len(), 12);
        for row in &rows {
            let (duration, method, step) = (row[1], ["rk4", "dla", "gauss8"][row[2] as usize], row[3]);
            let one = folder.json(&format!("run {scene} --method {method} --step {step} --duration {duration} --json"));
            let (names, numbers) = (header[4..].iter(), row[4..].iter());
            let ends = names.zip(numbers).filter_map(|(name, value)| Some((*value, one["final"][name].as_f64()?)));
            let ends: Vec<(f64, f64)> = ends.collect();
            assert!(ends.len() > 4, "{one}");
            for (found, expected) in ends {
                // A hundred steps of numbers below 10, rounded.
                assert_abs_diff_eq!(found, expected, epsilon = 100.0 * 10.0 * f64::EPSILON);
            }
        }
    }
    let folder = Folder::new();
    let refused = |grid: &str, said: &[&str]| {
        folder.write("sweep.toml", format!("scene = \"turnaround\"\n{grid}"));
        folder.refused("ensemble sweep.toml --out all.csv", said);
    };
    refused("[grid]\nrun.method = [\"rk5\"]\n", &["sweep.toml:3:15", "`run.method` names no known method", "`rk4`"]);
    refused("[random]\nrun.method = { uniform = [0, 1] }\n", &["`run.method`", "not a number of the scene"]);
    refused("[grid]\nrun.stride = [1.0]\n", &["`run.stride`", "run.step"]);
    // What no run can have is the error of its member.
    folder.write("sweep.toml", "scene = \"turnaround\"\n[grid]\nrun.step = [0.05, -1.0]\n");
    let outcome = folder.line("ensemble sweep.toml --out all.csv");
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(folder.read("all.csv").lines().nth(2).unwrap().contains("`run.step` must be positive"), "{outcome:?}");
}

#[test]
fn a_run_that_was_cut_off_goes_on_to_the_same_file() {
    let folder = Folder::new();
    folder.write("sweep.toml", SWEEP);
    folder.done("ensemble sweep.toml --out all.csv");
    let whole = folder.read("all.csv");
    // What an interrupted run leaves: some rows, and a part of one.
    let identity_of = |folder: &Folder| {
        folder.write("all.npz.part", "another sweep\n");
        folder.line("ensemble sweep.toml --out all.npz --resume")
    };
    let other = identity_of(&folder);
    assert_eq!(other.code, 2);
    assert!(other.stderr.contains("another sweep"), "{}", other.stderr);

    let again = folder.line("ensemble sweep.toml --out all.npz");
    assert_eq!(again.code, 2);
    assert!(again.stderr.contains("--resume"), "{}", again.stderr);
    folder.done("ensemble sweep.toml --out all.npz --force");
    assert!(folder.join("all.npz").metadata().unwrap().len() > 150 * 8 * 20);
    assert!(whole.lines().count() == 151);
}

/// Steps so long that a sleigh that goes backward has none where it swings round.
const SWINGING: &str = "\
scene = \"turnaround\"
step = 2.9
duration = 29.0
[grid]
start.turn_rate = [1e-3]
start.speed = [1.0, -1.5, 0.5]
";

#[test]
fn a_member_that_fails_has_its_row_and_the_rest_are_kept() {
    let folder = Folder::new();
    folder.write("sweep.toml", SWINGING);
    let outcome = folder.line("ensemble sweep.toml --out all.csv");
    assert_eq!(outcome.code, 1);
    assert!(outcome.stderr.contains("1 of 3 members failed; the first failure: member 1:"), "{}", outcome.stderr);
    let text = folder.read("all.csv");
    let errors: Vec<bool> = text.lines().skip(1).map(|line| line.ends_with('"')).collect();
    assert_eq!(errors, [false, true, false]);
}
