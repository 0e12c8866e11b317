//! Files that people who try such programs write, and files that were damaged: `tests/cases/`. What the program says of each.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

#[path = "common/program.rs"]
mod program;

use program::{Folder, csv};
use std::fs;
use std::path::{Path, PathBuf};

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
}

/// A folder with that file in it.
fn folder(file: &str) -> Folder {
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

#[test]
fn methods_that_fail_have_no_numbers_and_what_blows_up_is_called_diverged() {
    let text = |file: &str| {
        let outcome = folder(file).line(&format!("compare {file} --methods dla,rk4"));
        assert_eq!(outcome.code, 1, "{outcome:?}");
        let rows: Vec<String> = outcome.stdout.lines().skip(2).map(str::to_owned).collect();
        assert!(!rows.concat().contains("bounded"), "{}", outcome.stdout);
        rows
    };
    let rows = text("verdict-no-step.toml");
    assert!(rows[0].contains("failed at step 1, from t = 0 s: "), "{rows:?}");
    let rows = text("verdict-bounded.toml");
    assert!(rows[0].contains(" diverged ") && rows[1].contains("failed at step 195, from t = 9.7 s: "), "{rows:?}");

    let hint = folder("hint-zero.toml").line("run hint-zero.toml").stderr;
    assert!(hint.contains("shorten the step to 5e-18 of its length") && !hint.contains("0.00 "), "{hint}");
    let title = folder("title-control.toml").line("run title-control.toml");
    assert!(title.code == 0 && !title.stdout.contains(['\u{1b}', '\u{7}']), "{title:?}");
}

#[test]
fn motions_end_where_they_should() {
    let end = |line: &str| {
        let file = line.split(' ').next().unwrap();
        folder(file).json(&format!("run {line} --json"))
    };
    let at = |run: &serde_json::Value, name: &str| run["final"][name].as_f64().unwrap();
    // All crossings are found, also within steps of three periods.
    let crossed = end("r05_events.toml --method dop853 --event x=0.05 --event-samples 200 --step 2");
    assert_eq!(crossed["events"].as_array().unwrap().len(), 20);
    // Drives and turns whose ends are on no node of equal steps.
    for file in ["r21_stop_and_turn.toml", "r21_two_pi.toml"] {
        let run = end(file);
        assert!((at(&run, "x") - 2.0).abs() < 1e-12 && at(&run, "y").abs() < 1e-12, "{file}: {run}");
        assert!((at(&run, "heading") - std::f64::consts::TAU).abs() < 1e-12, "{file}: {run}");
    }
    let run = end("r21_end_between.toml");
    assert!((at(&run, "t") - 7.777).abs() < 1e-12 && (at(&run, "speed") - 1.0).abs() < 1e-12, "{run}");
    // A speed that rises by 0.2 m/s^2 to 1 m/s, while the body turns at 0.2 rad/s: quadratures of the imposed velocity.
    let run = end("r12_ramp.toml --method gauss8");
    let (sin, cos) = f64::sin_cos(1.0);
    let (sin8, cos8) = f64::sin_cos(8.0);
    let risen = [5.0 * (sin + cos - 1.0), 5.0 * (sin - cos)];
    assert!((at(&run, "x") - risen[0] - 5.0 * (sin8 - sin)).abs() < 1e-12, "{run}");
    assert!((at(&run, "y") - risen[1] - 5.0 * (cos - cos8)).abs() < 1e-12, "{run}");
    // A trailer that a driven tractor backs up: tan(f/2) = tan(f0/2) e^(t/d) for its angle f.
    let backed = folder("r13_driven_train.toml");
    for (method, error) in [("lobatto5", 1e-9), ("dla4", 1e-6), ("dla", 1e-3)] {
        let run = backed.json(&format!("run r13_driven_train.toml --method {method} --out t.csv --force --json"));
        assert!((at(&run, "x") + 10.0).abs() < 1e-12 && at(&run, "y").abs() < 1e-12, "{run}");
        let (names, rows) = csv(&backed.read("t.csv"));
        let column = |name: &str| names.iter().position(|known| known == name).unwrap();
        let last = rows.last().unwrap();
        let angle = last[column("heading_1")] - last[column("heading")];
        assert!((angle - 1.276_815_674_662_5).abs() < error, "{method}: {angle}");
        // The servo pays for what the trailer takes.
        let energy = run["energy"]["max_error"].as_f64().unwrap();
        assert!(energy < 1e-9 * run["energy"]["initial"].as_f64().unwrap(), "{run}");
    }
    // A train of 1.5 kg that is pushed by 0.2 N for 5 s, and then runs on.
    for method in ["dla", "dla4", "lobatto3"] {
        let run = end(&format!("r13_train_with_table.toml --method {method}"));
        let (rate, gained) = (0.2 / 1.5, 1.0 + 5.0 * 0.2 / 1.5);
        assert!((at(&run, "speed") - gained).abs() < 1e-12, "{method}: {run}");
        assert!((at(&run, "x") - 5.0 - 12.5 * rate - 5.0 * gained).abs() < 1e-11, "{method}: {run}");
        assert!(run["energy"]["max_error"].as_f64().unwrap() < 1e-12, "{method}: {run}");
    }
    // What comes to rest, or hardly moves, goes on.
    for line in ["r22_settle.toml --duration 400", "r22_settle_train.toml --duration 150"] {
        let run = end(line);
        assert!(run.get("failure").is_none() && at(&run, "speed").abs() < 1e-3, "{line}: {run}");
    }
    let run = end("r22_tiny_swing.toml --method dla4");
    assert!((at(&run, "speed") - 1e-10 * f64::cos(f64::sqrt(3.0) * 100.0)).abs() < 1e-12, "{run}");
    // The energy of a train under a force, by a method that balances its work.
    let run = end("r13_train_thrust.toml --method energy2");
    assert!(run["energy"]["max_error"].as_f64().unwrap() < 1e-12, "{run}");
}

#[test]
fn analyses_say_what_a_motion_is() {
    let found = folder("r09_unstable_line.toml").json("lyapunov r09_unstable_line.toml --duration 300 --json");
    assert_eq!((found["verdict"].as_str(), found["unstable"].as_bool()), (Some("steady"), Some(true)), "{found}");
    assert!((found["exponents"][0].as_f64().unwrap() - 0.4).abs() < 1e-6, "{found}");
    let found = folder("r09_ridge.toml").line("lyapunov r09_ridge.toml --duration 90 --json");
    assert!(!found.stdout.contains("\"chaotic\""), "{found:?}");

    let sections = folder("r23_section.toml");
    sections.done("section r23_section.toml --plane y=0.5 --direction rising --starts 3 --out s.csv");
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
fn a_sweep_on_a_grid_with_samples_has_all_of_its_members() {
    let folder = folder("r19_sweep.toml");
    let sweep = folder.read("r19_sweep.toml").replace("count = 4000", "count = 8");
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
