//! What tables, pages, pictures and files say of a method that failed or blew up.

use crate::program::{Folder, SCENE, keys};
use proptest::prelude::*;
use serde_json::Value;

/// Turns so fast that the first step of `dla` fails, while `dop853`, which chooses its own steps, goes on.
fn no_step() -> String {
    SCENE.replace("turn_rate = 0.1", "turn_rate = 255.0").replace("duration = 2.0", "duration = 40.0")
}

/// A ridge of a stiffness (N/m): the motion runs away.
fn ridge(stiffness: &str) -> String {
    let text = SCENE.replace("duration = 2.0", "duration = 60.0");
    format!("{text}[[effects]]\nkind = \"bowl\"\nstiffness = {stiffness}\n")
}

/// The motion runs away like `exp(t)`.
const LOW: &str = "[-1.0, 0.1]";
/// And like `exp(10 t)`.
const HIGH: &str = "[-100.0, -100.0]";

fn rows(outcome: &crate::program::Outcome) -> Vec<Value> {
    serde_json::from_str::<Value>(&outcome.stdout).unwrap()["rows"].as_array().unwrap().clone()
}

/// The row of a method in the table on the terminal, or what is said of the method behind it.
fn line<'a>(text: &'a str, method: &str) -> &'a str {
    let is_row = |line: &&str| [format!(" {method} "), format!("{method}: ")].iter().any(|head| line.starts_with(head));
    text.lines().find(is_row).unwrap()
}

#[test]
fn a_method_that_made_no_step_has_no_numbers() {
    let folder = Folder::new();
    folder.write("fast.toml", no_step());
    let outcome = folder.line("compare fast.toml --methods dla,dop853 --json --report pages");
    assert_eq!(outcome.code, 1);
    let rows = rows(&outcome);
    let [failed, made] = &rows[..] else { panic!("{rows:?}") };
    assert_eq!(keys(&failed["failure"])[..3], ["step", "time", "reason"]);
    assert_eq!((failed["failure"]["step"].as_u64(), failed["failure"]["time"].as_f64()), (Some(1), Some(0.0)));
    assert!(failed.get("error").is_none() && failed["energy"].get("verdict").is_none(), "{failed}");
    // The control: a method that reached the end has both.
    assert!(made["error"].is_f64() && made["energy"]["verdict"].is_string() && made.get("failure").is_none(), "{made}");

    let text = folder.line("compare fast.toml --methods dla,dop853").stdout;
    let reason = "failed at step 1, from t = 0 s: ";
    assert!(line(&text, "dla").contains(reason) && !line(&text, "dla").contains("bounded"), "{text}");
    assert!(!line(&text, "dop853").contains("failed"), "{text}");
    let page = folder.read("pages/index.html");
    assert!(page.contains(&format!("<td colspan=\"12\">{reason}")), "{page}");
    let numbers = folder.read("pages/fast.csv");
    let header: Vec<&str> = numbers.lines().next().unwrap().split(',').collect();
    let cells: Vec<&str> = numbers.lines().nth(1).unwrap().splitn(header.len(), ',').collect();
    let cell = |name: &str| cells[header.iter().position(|other| *other == name).unwrap()];
    for empty in ["steps", "constraint [m/s]", "energy error [J]", "verdict", "end error [m or rad]", "x [m]"] {
        assert_eq!(cell(empty), "", "{empty}");
    }
    assert_eq!((cell("method"), cell("failed at step"), cell("failed at t [s]")), ("dla", "1", "0.0"));
    assert!(!cell("failure").is_empty());
}

/// On a ridge over `duration` s; `rk4` fails after more than `steps` steps. The first command does `more` besides.
fn diverged(folder: &Folder, (stiffness, duration, steps): (&str, f64, u64), more: &str) {
    folder.write("ridge.toml", ridge(stiffness));
    let compare = format!("compare ridge.toml --methods dla,rk4 --duration {duration}");
    let outcome = folder.line(&format!("{compare} --json {more}"));
    let rows = rows(&outcome);
    assert_eq!(rows[0]["energy"]["verdict"].as_str(), Some("diverged"));
    assert!(rows[1]["failure"]["step"].as_u64() > Some(steps) && rows[1]["energy"].get("verdict").is_none());
    let text = folder.line(&compare).stdout;
    assert!(!text.contains("bounded") && line(&text, "rk4").contains("failed at step"), "{text}");
}

fn pictures_of_what_blows_up(folder: &Folder) {
    // Before the end: rk4 blows up at 9.7 s, where the others are some hundred metres away.
    let short = ridge(LOW).replace("duration = 60.0", "duration = 9.75").replace("ridge", "short");
    folder.write("short.toml", short);
    folder.line("compare short.toml --methods dla,rk4 --report short");
    for picture in ["path", "energy"] {
        let drawn = folder.read(&format!("short/short-{picture}.svg"));
        assert!(drawn.contains("rk4"), "{picture}");
    }
    let page = folder.read("short/index.html");
    assert!(
        page.contains("Curves that leave the picture: rk4.") && page.contains("A cross marks where a run failed: rk4.")
    );
    assert!(!folder.read("short/short-path.svg").contains("×10⁴²"));
}

#[test]
fn what_blows_up_is_called_diverged_and_does_not_scale_the_pictures() {
    diverged(&Folder::new(), (HIGH, 4.0, 10), "");
}

#[test]
fn what_blows_up_does_not_scale_the_pictures() {
    pictures_of_what_blows_up(&Folder::new());
}

#[test]
#[ignore = "slow"]
fn what_blows_up_is_called_diverged_and_does_not_scale_the_pictures_in_full() {
    let folder = Folder::new();
    diverged(&folder, (LOW, 60.0, 100), "--report pages");
    pictures_of_what_blows_up(&folder);
    // The control: of runs that reach the end no picture speaks of failures.
    folder.done("compare turnaround --duration 2 --methods dla,rk4 --report fine");
    assert!(!folder.read("fine/index.html").contains("A cross marks"));
}

fn well(scenes: &[&str], more: &str) {
    for scene in scenes {
        let outcome = Folder::new().line(&format!("compare {scene} --json {more}"));
        for row in rows(&outcome) {
            assert_ne!(row["energy"]["verdict"].as_str(), Some("diverged"), "{scene}: {row}");
        }
    }
}

#[test]
fn long_runs_that_are_well_are_not_called_diverged() {
    well(&["turnaround", "egg-crate-chaos", "braking"], "--methods dla,rk4 --duration 10");
}

#[test]
#[ignore = "slow"]
fn long_runs_that_are_well_are_not_called_diverged_in_full() {
    let scenes = ["turnaround", "bowl", "egg-crate", "egg-crate-chaos", "hills", "braking", "flywheel", "parking"];
    well(&scenes, "--methods dla,gauss8,rk4");
}

#[test]
fn precision_says_why_no_run_of_a_method_succeeds() {
    let folder = Folder::new();
    folder.write("fast.toml", no_step().replace("duration = 40.0", "duration = 1.0"));
    let outcome = folder.line("precision fast.toml --methods rk4,gauss8 --longest 0.0000001 --wide --csv points.csv");
    let told = outcome.stdout.lines().filter(|line| line.starts_with(" gauss8 "));
    let told: Vec<bool> = told.map(|line| line.contains("failed: step 1, from t = 0 s: ")).collect();
    assert_eq!(told, [true, true], "{}", outcome.stdout);
    // No error of a run that failed is a number.
    for line in folder.read("points.csv").lines().filter(|line| line.contains("failed: ")) {
        assert_eq!(line.split(',').nth(4), Some(""), "{line}");
    }
}

/// The scene of a case, and the sizes that its energy is compared with: its speed and its turn rate.
#[derive(Debug)]
struct Case {
    text: String,
    speed: f64,
    turn_rate: f64,
}

/// Scenes from harmless to hopeless.
fn cases() -> impl Strategy<Value = Case> {
    let turn_rate = prop_oneof![-1.0..1.0, -300.0..300.0];
    let stiffness = prop::array::uniform2(-4.0..4.0);
    let step = prop_oneof![0.01..0.1, 0.1..2.0];
    (-3.0..3.0, turn_rate, stiffness, step, 1_u32..300).prop_map(|(speed, turn_rate, stiffness, step, steps)| {
        let duration = step * f64::from(steps);
        let text = SCENE
            .replace("speed = -1.0", &format!("speed = {speed:?}"))
            .replace("turn_rate = 0.1", &format!("turn_rate = {turn_rate:?}"))
            .replace("step = 0.05", &format!("step = {step:?}"))
            .replace("duration = 2.0", &format!("duration = {duration:?}"));
        let text = format!("{text}[[effects]]\nkind = \"bowl\"\nstiffness = {stiffness:?}\n");
        Case { text, speed, turn_rate }
    })
}

/// A method that fails has neither a verdict nor an error, one that does not has both.
fn a_failure_is_not_bounded(case: &Case) -> Result<(), TestCaseError> {
    let folder = Folder::new();
    folder.write("any.toml", &case.text);
    let outcome = folder.line("compare any.toml --methods dla,dla4,rk4,gauss4,lobatto3 --json --report pages");
    let rows = rows(&outcome);
    let failed = rows.iter().filter(|row| row.get("failure").is_some()).count();
    prop_assert_eq!(outcome.code == 1, failed > 0, "{}", outcome.stderr);
    for row in &rows {
        let verdict = row["energy"].get("verdict").and_then(Value::as_str);
        if row.get("failure").is_some() {
            prop_assert_eq!((verdict, row.get("error")), (None, None));
            prop_assert!(row["failure"]["step"].as_u64() > Some(0) && row["failure"]["reason"].is_string());
        } else {
            prop_assert!(verdict.is_some() && row.get("error").is_some(), "{}", row);
            let (energy, turn) = (&row["energy"], case.turn_rate);
            let size = energy["initial"].as_f64().unwrap().abs() + 0.5 * (case.speed * case.speed + turn * turn);
            let beyond = energy["max_error"].as_f64().is_none_or(|error| error > 1e3 * size);
            prop_assert!(!(beyond && verdict == Some("bounded")), "{}", row);
        }
    }
    prop_assert_eq!(folder.read("pages/index.html").matches("failed at step").count(), failed);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, max_shrink_iters: 8, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "slow"]
    fn a_failure_is_never_bounded_at_length(case in cases()) {
        a_failure_is_not_bounded(&case)?;
    }
}
