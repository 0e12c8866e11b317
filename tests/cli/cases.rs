//! Files that people who try such programs write, and files that were damaged: `tests/cases/`. What the program says of each.

use crate::program::{Folder, csv};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
}

/// A folder with that file in it.
pub(super) fn folder(file: &str) -> Folder {
    let folder = Folder::new();
    folder.write(file, fs::read(cases().join(file)).unwrap());
    folder
}

/// What is refused, and the words of the message.
const REFUSED: [(&str, &str, &[&str]); 9] = [
    ("check", "dotted-key.toml", &["dotted-key.toml:11:1", "keys of fewer than 80 parts"]),
    ("check", "energy-nan.toml", &["`start.speed`", "energy-nan.toml:6:9", "kinetic energy", "1e308", "m/s"]),
    ("run", "servo-overflow.toml", &["`effects.servo.speed`", "kinetic energy", "m/s"]),
    ("check", "long-number.toml", &["`effects.thrust.force.times`", "1e308 does not come before 2.0"]),
    ("ensemble", "sweep-count.toml", &["sweep-count.toml:3", "`count`", "without a point or an exponent"]),
    ("ensemble", "sweep-method.toml", &["sweep-method.toml:2:10", "`method` names no known method", "`dla`"]),
    ("ensemble", "sweep-same-key.toml", &["sweep-same-key.toml:6", "`start.speed` varies already, at line 3"]),
    ("ensemble", "sweep-uniform.toml", &["sweep-uniform.toml:4", "larger end first"]),
    ("section", "r23_section.toml --plane z=0", &["no quantity `z`", "heading"]),
];

#[test]
fn what_is_wrong_is_refused_with_its_place_and_what_is_right() {
    for (command, rest, told) in REFUSED {
        let folder = folder(rest.split(' ').next().unwrap());
        let outcome = folder.line(&format!("{command} {rest}"));
        assert_eq!(outcome.code, 2, "{rest}: {outcome:?}");
        outcome.assert_told(rest, told);
        let long = |word: &str| word.chars().filter(char::is_ascii_digit).count() > 20;
        assert!(!outcome.stderr.split_whitespace().any(long), "{rest}: {}", outcome.stderr);
    }
}

#[test]
fn old_or_damaged_spools_are_refused_and_an_empty_one_is_a_beginning() {
    let parts = fs::read_dir(cases()).unwrap().map(|entry| entry.unwrap().path());
    let parts: Vec<PathBuf> = parts.filter(|path| path.extension().is_some_and(|ending| ending == "part")).collect();
    assert_eq!(parts.len(), 6);
    for (part, out) in parts.iter().flat_map(|part| ["d.csv", "d.npz"].map(|out| (part, out))) {
        let folder = Folder::new();
        let sweep = fs::read_to_string(cases().join("sweep.toml")).unwrap();
        folder.write("sweep.toml", sweep.replace("duration = 1000.0", "duration = 1.0"));
        fs::copy(part, folder.join(&format!("{out}.part"))).unwrap();
        let outcome = folder.line(&format!("ensemble sweep.toml --out {out} --resume"));
        if part.ends_with("part-empty.part") {
            assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""), "{out}");
        } else {
            outcome.assert_refused(out, &[&format!("{out}.part:1: "), "another version", "--force begins anew"]);
        }
    }
}

/// The rows of a comparison that fails, none of which is called bounded.
fn failed_rows(file: &str) -> Vec<String> {
    let outcome = folder(file).line(&format!("compare {file} --methods dla,rk4"));
    assert_eq!(outcome.code, 1, "{outcome:?}");
    let rows: Vec<String> = outcome.stdout.lines().skip(2).map(str::to_owned).collect();
    assert!(!rows.concat().contains("bounded"), "{}", outcome.stdout);
    rows
}

#[test]
#[ignore = "slow"]
fn what_blows_up_is_called_diverged_in_full() {
    let rows = failed_rows("verdict-bounded.toml");
    assert!(rows[0].contains(" diverged ") && rows[1].contains("failed at step 195, from t = 9.7 s: "), "{rows:?}");
}

#[test]
fn methods_that_fail_have_no_numbers() {
    let rows = failed_rows("verdict-no-step.toml");
    assert!(rows[0].contains("failed at step 1, from t = 0 s: "), "{rows:?}");

    let hint = folder("hint-zero.toml").line("run hint-zero.toml").stderr;
    assert!(hint.contains("shorten the step to 5e-18 of its length") && !hint.contains("0.00 "), "{hint}");
    let title = folder("title-control.toml").line("run title-control.toml");
    assert!(title.code == 0 && !title.stdout.contains(['\u{1b}', '\u{7}']), "{title:?}");
}

/// Where a run of a case ends.
fn end(line: &str) -> Value {
    let file = line.split(' ').next().unwrap();
    folder(file).json(&format!("run {line} --json"))
}

fn at(run: &Value, name: &str) -> f64 {
    run["final"][name].as_f64().unwrap()
}

/// Events within steps of three periods, and how many there are; drives and turns with steps of one length, a ramp with steps of another.
fn motions(events: &str, count: usize, step: &str, ramp: &str) {
    // All crossings are found.
    let crossed = end(&format!("r05_events.toml --method dop853 --event x=0.05 --step 2 {events}"));
    assert_eq!(crossed["events"].as_array().unwrap().len(), count);
    // Drives and turns whose ends are on no node of equal steps.
    for file in ["r21_stop_and_turn.toml", "r21_two_pi.toml"] {
        let run = end(&format!("{file} --step {step}"));
        assert!((at(&run, "x") - 2.0).abs() < 1e-12 && at(&run, "y").abs() < 1e-12, "{file}: {run}");
        assert!((at(&run, "heading") - std::f64::consts::TAU).abs() < 1e-12, "{file}: {run}");
    }
    let run = end("r21_end_between.toml");
    assert!((at(&run, "t") - 7.777).abs() < 1e-12 && (at(&run, "speed") - 1.0).abs() < 1e-12, "{run}");
    // A speed that rises by 0.2 m/s^2 to 1 m/s, while the body turns at 0.2 rad/s: quadratures of the imposed velocity.
    let run = end(&format!("r12_ramp.toml --method gauss8 --step {ramp}"));
    let (sin, cos) = f64::sin_cos(1.0);
    let (sin8, cos8) = f64::sin_cos(8.0);
    let risen = [5.0 * (sin + cos - 1.0), 5.0 * (sin - cos)];
    assert!((at(&run, "x") - risen[0] - 5.0 * (sin8 - sin)).abs() < 1e-12, "{run}");
    assert!((at(&run, "y") - risen[1] - 5.0 * (cos - cos8)).abs() < 1e-12, "{run}");
}

#[test]
fn motions_end_where_they_should() {
    motions("--event-samples 50 --duration 2", 7, "0.1", "0.5");
}

#[test]
#[ignore = "slow"]
fn motions_end_where_they_should_in_full() {
    motions("--event-samples 200", 20, "0.01", "0.05");
}

/// Methods with their steps and errors on a train that backs up, and methods on one that is pushed.
fn trains(backing: &[(&str, f64)], pushing: &[&str]) {
    // A trailer that a driven tractor backs up: tan(f/2) = tan(f0/2) e^(t/d) for its angle f.
    let backed = folder("r13_driven_train.toml");
    for (method, error) in backing {
        let run = backed.json(&format!("run r13_driven_train.toml --method {method} --out t.csv --force --json"));
        assert!((at(&run, "x") + 10.0).abs() < 1e-12 && at(&run, "y").abs() < 1e-12, "{run}");
        let (names, rows) = csv(&backed.read("t.csv"));
        let column = |name: &str| names.iter().position(|known| known == name).unwrap();
        let last = rows.last().unwrap();
        let angle = last[column("heading_1")] - last[column("heading")];
        assert!((angle - 1.276_815_674_662_5).abs() < *error, "{method}: {angle}");
        // The servo pays for what the trailer takes.
        let energy = run["energy"]["max_error"].as_f64().unwrap();
        assert!(energy < 1e-9 * run["energy"]["initial"].as_f64().unwrap(), "{run}");
    }
    // A train of 1.5 kg that is pushed by 0.2 N for 5 s, and then runs on.
    for method in pushing {
        let run = end(&format!("r13_train_with_table.toml --method {method}"));
        let (rate, gained) = (0.2 / 1.5, 1.0 + 5.0 * 0.2 / 1.5);
        assert!((at(&run, "speed") - gained).abs() < 1e-12, "{method}: {run}");
        assert!((at(&run, "x") - 5.0 - 12.5 * rate - 5.0 * gained).abs() < 1e-11, "{method}: {run}");
        assert!(run["energy"]["max_error"].as_f64().unwrap() < 1e-12, "{method}: {run}");
    }
}

#[test]
fn trains_end_where_they_should() {
    // Of the second order, with steps ten times as long as those of an error of 1e-5.
    trains(&[("dla4 --step 0.1", 1e-5), ("dla --step 0.1", 2e-3)], &["dla --step 0.1", "dla4 --step 0.1"]);
}

#[test]
#[ignore = "slow"]
fn trains_end_where_they_should_at_length() {
    trains(&[("dla8 --step 0.1", 1e-9), ("dla8", 1e-9), ("dla4", 1e-6), ("dla", 1e-3)], &["dla", "dla4"]);
}

/// What comes to rest, or hardly moves, goes on.
fn rests(sleigh: &str, train: &str, swing: f64) {
    for line in [format!("r22_settle.toml {sleigh}"), format!("r22_settle_train.toml {train}")] {
        let run = end(&line);
        assert!(run.get("failure").is_none() && at(&run, "speed").abs() < 1e-3, "{line}: {run}");
    }
    let run = end(&format!("r22_tiny_swing.toml --method dla4 --duration {swing}"));
    let speed = 1e-10 * f64::cos(f64::sqrt(3.0) * swing);
    assert!((at(&run, "speed") - speed).abs() < 1e-14 * swing, "{run}");
}

#[test]
fn what_comes_to_rest_goes_on() {
    rests("--duration 60", "--duration 60 --step 0.2", 20.0);
}

#[test]
#[ignore = "slow"]
fn what_comes_to_rest_goes_on_at_length() {
    rests("--duration 400", "--duration 150", 100.0);
}

/// Runs, the work that is done in them (J), how far the work may be off, and the error of the energy. The works come from steps a twentieth as
/// long, and from other methods; the error of the energy is the error of the motion.
const WORKS: [(&str, f64, f64, f64); 8] = [
    ("braking --method dop853 --step 5", -2.056_231_320_936_5, 1e-12, 1e-12),
    ("braking --method gauss-adaptive --step 5", -2.056_231_320_936_5, 1e-12, 1e-12),
    ("braking --method taylor --step 5", -2.056_231_320_936_5, 1e-11, 1e-11),
    // Of order 8, at a step where polynomials of degree five through the nodes are off by 4.6e-8 J.
    ("braking --method dla8 --step 0.25", -2.056_231_320_936_5, 2e-9, 2e-9),
    ("braking --method lobatto5 --step 0.25", -2.056_231_320_936_5, 2e-9, 2e-9),
    ("damped_spring.toml --method gauss16", -0.496_173_142_496_883, 1e-14, 1e-15),
    ("moving_row.toml --method gauss-adaptive --step 0.2", 4.254_260_520_223, 1e-6, 1e-9),
    // Friction stops it within a fiftieth of the step, of its energy of 0.5 J.
    ("brake.toml --method dop853", -0.5, 1e-13, 1e-13),
];

/// The work is integrated as the motion is: at the stages of a method, or over the steps of its own.
#[test]
fn work_is_as_right_as_the_motion() {
    let number = |run: &Value, key: &str| run["energy"][key].as_f64().unwrap();
    for (line, work, off, error) in WORKS {
        let run = if line.contains(".toml") { end(line) } else { Folder::new().json(&format!("run {line} --json")) };
        assert!((number(&run, "work") - work).abs() < off, "{line}: {run}");
        assert!(number(&run, "max_error") < error, "{line}: {run}");
    }
    // A constraint that moves does work too.
    let run = end("moving_pivot.toml --method dop853 --step 0.5 --duration 5");
    assert!(number(&run, "max_error") < 1e-9 && number(&run, "work").abs() > 1.0, "{run}");
    // The control: a method of order 2 is off by its own error.
    let run = Folder::new().json("run braking --method dla --step 0.25 --json");
    assert!(number(&run, "max_error") > 1e-3, "{run}");
}

/// A mass pushed by half waves, one pushed once and braked, and one that swings through free play: corners, jumps and powers of 3/2.
fn corners(tolerances: &[(f64, &str)]) {
    for (tolerance, step) in tolerances {
        for (file, of, right) in [
            ("r47_half_waves.toml", "x'", 20.0 / 3.0),
            ("r35_pulse_text.toml", "x'", 0.512_566_928_897_79),
            ("r36_max_power.toml", "x", -0.724_739_706_153_2),
        ] {
            let run = end(&format!("{file} --method gauss-adaptive --step {step} --tolerance {tolerance:e}"));
            let off = (at(&run, of) - right).abs();
            assert!(off < 30.0 * tolerance * (1.0 + right.abs()), "{file}, {tolerance:e}: {off:e}");
        }
    }
}

#[test]
fn corners_and_jumps_are_seen() {
    corners(&[(1e-6, "1"), (1e-9, "0.1")]);
}

#[test]
#[ignore = "slow"]
fn corners_and_jumps_are_seen_at_length() {
    corners(&[(1e-6, "0.1"), (1e-9, "1"), (1e-9, "2"), (1e-12, "1"), (1e-12, "2"), (1e-13, "1")]);
}

/// A constraint with speeds of 1e10: a step that would need more steps of its own than anybody waits for ends with an error.
#[test]
#[ignore = "slow"]
fn steps_that_would_not_end_are_given_up_at_length() {
    for method in ["gauss-adaptive", "dop853"] {
        let outcome = folder("fast_basis.toml").line(&format!("run fast_basis.toml --method {method}"));
        outcome.assert_told(method, &["step 1"]);
        assert_eq!(outcome.code, 1, "{method}: {outcome:?}");
    }
}

/// A straight motion, a ridge, and a circle that crosses a plane: what more the commands say.
fn analyses(line: &str, ridge: &str, circle: &str) {
    let found = folder("r09_unstable_line.toml").json(&format!("lyapunov r09_unstable_line.toml {line} --json"));
    assert_eq!((found["verdict"].as_str(), found["unstable"].as_bool()), (Some("steady"), Some(true)), "{found}");
    assert!((found["exponents"][0].as_f64().unwrap() - 0.4).abs() < 1e-6, "{found}");
    let found = folder("r09_ridge.toml").line(&format!("lyapunov r09_ridge.toml {ridge} --json"));
    assert!(!found.stdout.contains("\"chaotic\""), "{found:?}");

    let sections = folder("r23_section.toml");
    sections
        .done(&format!("section r23_section.toml --plane y=0.5 --direction rising --starts 3 {circle} --out s.csv"));
    let text = sections.read("s.csv");
    let (names, rows) = csv(&text);
    let mut distinct = names.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), names.len(), "{names:?}");
    // The number of a start is a whole one.
    assert!(
        !rows.is_empty()
            && text.lines().skip(1).all(|line| line.starts_with(['0', '1', '2']) && line.as_bytes()[1] == b',')
    );
    let first: Vec<f64> = rows.iter().filter(|row| row[0] == 0.0).map(|row| row[1]).collect();
    // On a circle of one metre in 2 pi seconds.
    let right = |k: usize| std::f64::consts::FRAC_PI_3 + std::f64::consts::TAU * k as f64;
    assert!(first.iter().enumerate().all(|(k, t)| (t - right(k)).abs() < 1e-2), "{first:?}");
}

#[test]
fn analyses_say_what_a_motion_is() {
    analyses("--settle 40 --duration 40 --step 0.5", "--duration 90 --step 0.5", "--duration 20");
}

#[test]
#[ignore = "slow"]
fn analyses_say_what_a_motion_is_in_full() {
    analyses("--duration 300", "--duration 90", "");
}

#[test]
fn a_sweep_on_a_grid_with_samples_has_all_of_its_members() {
    let folder = folder("r19_sweep.toml");
    let sweep = folder.read("r19_sweep.toml");
    let sweep = sweep.replace("count = 4000", "count = 8").replace("duration = 20.0", "duration = 0.5");
    folder.write("r19_sweep.toml", sweep);
    folder.done("ensemble r19_sweep.toml --out r.csv");
    let text = folder.read("r.csv");
    let numbers: Vec<u64> = text.lines().skip(1).map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert!(numbers.into_iter().eq(0..16));
    // The numbers of the members are integers in the arrays too, and are read back as the others are.
    folder.done("ensemble r19_sweep.toml --out r.npz");
    let bytes = fs::read(folder.join("r.npz")).unwrap();
    let integers = bytes.windows(14).filter(|window| window == b"'descr': '<i8'").count();
    assert_eq!(integers, 2, "`member` and `failed`");
    let differences = folder.line("diff r.csv r.npz").stdout;
    let member = differences.lines().find(|line| line.starts_with(" member ")).unwrap();
    assert_eq!(member.split_whitespace().collect::<Vec<_>>(), ["member", "0"]);
}
