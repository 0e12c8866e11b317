//! Events of `noslip run`.

use super::{CIRCLE, TRAILER, TRAIN};
use crate::program::{Folder, csv};
use serde_json::Value;
use std::f64::consts::{PI, TAU};

/// The closed form of the scene: the speed is zero at `asinh(u0/(k w0)) / kappa`, after 7.17 s.
#[test]
fn events_are_found_and_end_a_run() {
    let folder = Folder::new();
    let (spin, energy_speed) = (1.25f64.sqrt() * 0.1, 1.0125f64.sqrt());
    let turnaround = (1.0 / spin).asinh() / (0.5 * energy_speed / 1.25);
    let run = |line: &str| folder.json(&format!("run turnaround --duration 8 {line} --json"));
    let found = run("--method gauss16 --event speed=0 --event heading=1.5");
    let events = found["events"].as_array().unwrap();
    assert_eq!((events[0]["event"].as_str(), events[1]["event"].as_str()), (Some("heading=1.5"), Some("speed=0")));
    assert!((events[0]["heading"].as_f64().unwrap() - 1.5).abs() <= 4.0 * f64::EPSILON);
    assert!((events[1]["t"].as_f64().unwrap() - turnaround).abs() <= 1e-12, "{found}");
    assert_eq!((events.len(), events[1]["rising"].as_bool(), found["steps"].as_u64()), (2, Some(true), Some(160)));
    assert_eq!(run("--event x=1e9")["events"].as_array().unwrap().len(), 0);

    let ended = run("--method gauss16 --until speed=0 --event x=100 --out path.csv");
    let (_, rows) = csv(&folder.read("path.csv"));
    let t = ended["final"]["t"].as_f64().unwrap();
    assert!((t - turnaround).abs() <= 1e-12 && ended["final"]["speed"].as_f64().unwrap().abs() <= 1e-15, "{ended}");
    assert_eq!((rows.last().unwrap()[0], ended["duration"].as_f64().unwrap()), (t, t));
    assert_eq!(ended["steps"].as_u64().unwrap() + 1, rows.len() as u64);
    assert!(folder.done("run turnaround --duration 8 --event speed=0").contains("speed=0, rising, at t = 7.17"));
    // The force of the blade is `m u omega I/J`: its sign is that of the speed, for the sleigh turns one way only.
    let found = run("--method gauss16 --event constraint_force=0");
    assert!((found["events"][0]["t"].as_f64().unwrap() - turnaround).abs() <= 1e-12, "{found}");
    folder.refused("run turnaround --event spede=0", &["spede", "turn_rate"]);
    folder.refused("run turnaround --event speed=0:up", &["`up` is not a direction", ":rising or :falling"]);
    folder.refused("run turnaround --until speed=fast", &["fast"]);
}

#[test]
fn events_of_a_train_are_those_of_its_first_blade() {
    first_blade("0.1", "0.002");
}

#[test]
#[ignore = "slow"]
fn events_of_a_train_are_those_of_its_first_blade_in_full() {
    first_blade("1.5", "0.5");
}

/// The train comes to such a `y` before it ends at such an `x`.
fn first_blade(x: &str, y: &str) {
    let folder = Folder::new();
    let run = folder.json(&format!("run {TRAIN} --until x={x} --event y={y} --json --out train.csv"));
    let (_, rows) = csv(&folder.read("train.csv"));
    let (events, t) = (run["events"].as_array().unwrap(), run["final"]["t"].as_f64().unwrap());
    let named: Vec<_> = events.iter().map(|event| event["event"].as_str().unwrap().to_owned()).collect();
    assert_eq!(named, [format!("y={y}"), format!("x={x}")]);
    let end: f64 = x.parse().unwrap();
    assert!((run["final"]["x"].as_f64().unwrap() - end).abs() < 1e-14 && events[1]["t"].as_f64() == Some(t), "{run}");
    assert_eq!((rows.last().unwrap()[0], run["steps"].as_u64().unwrap() + 1), (t, rows.len() as u64));
}

/// How often an event happens, in any direction, rising and falling.
fn counts(folder: &Folder, line: &str) -> [usize; 3] {
    let count = |way: &str| {
        let run = folder.json(&format!("run {} --json", line.replace("WAY", way)));
        run["events"].as_array().unwrap().len()
    };
    ["", ":rising", ":falling"].map(count)
}

#[test]
fn events_have_a_direction() {
    let lines = [
        "turnaround --event speed=0WAY --duration 8 --step 0.2",
        "circle --event heading=1.5WAY --duration 16 --step 0.4",
        "scene.toml --event x=0.05WAY --duration 0.6 --step 0.02",
    ];
    directions(&lines, [[1, 1, 0], [2, 2, 0], [2, 1, 1]]);
}

#[test]
#[ignore = "slow"]
fn events_have_a_direction_in_full() {
    let lines =
        ["turnaround --event speed=0WAY", "circle --event heading=1.5WAY", "scene.toml --event x=0.05WAY --step 0.01"];
    directions(&lines, [[1, 1, 0], [5, 5, 0], [20, 10, 10]]);
}

/// One direction only, which of an angle is the same in every turn: one takes 4 pi seconds. To and fro, it is as often the one as the other.
fn directions(lines: &[&str; 3], expected: [[usize; 3]; 3]) {
    let folder = Folder::new();
    folder.write("scene.toml", TO_AND_FRO);
    assert_eq!(lines.map(|line| counts(&folder, line)), expected);
    // And what ends the run is in that direction.
    let end = |way: &str| {
        folder.json(&format!("run scene.toml --method gauss16 --step 0.01 --until x=0.05{way} --json"))["final"]["t"]
            .as_f64()
    };
    let [first, second] = [":rising", ":falling"].map(|way| end(way).unwrap());
    let sixth = PI / 6.0;
    assert!((first - 0.1 * sixth).abs() < 1e-6 && (second - 0.5 * sixth).abs() < 1e-6, "{first} and {second}");
}

/// A train is asked for its first blade.
#[test]
fn events_of_a_train_have_a_direction() {
    assert_eq!(counts(&Folder::new(), &format!("{TRAIN} --event x=0.03WAY --duration 0.06")), [1, 1, 0]);
}

#[test]
#[ignore = "slow"]
fn events_of_a_train_have_a_direction_at_length() {
    let [any, rising, falling] = counts(&Folder::new(), &format!("{TRAIN} --event x=0.5WAY"));
    assert_eq!(rising + falling, any);
}

#[test]
fn events_are_saved_and_found_again() {
    events_again(&["dop853"], ["0.02", "0.6", "0.2"], 5, 2);
}

#[test]
#[ignore = "slow"]
fn events_are_saved_and_found_again_in_full() {
    events_again(&["dla", "gauss16", "dop853"], ["0.01", "6", "2.5"], 50, 20);
}

/// A saved run keeps its events, `count` in its whole duration, and goes on with the events of the shorter run.
fn events_again(methods: &[&str], [step, long, short]: [&str; 3], every: u64, count: usize) {
    let folder = Folder::new();
    folder.write("scene.toml", TO_AND_FRO);
    for method in methods {
        let run = format!("run scene.toml --method {method} --step {step} --event x=0.05 --json");
        let until = format!("--duration {long} --until x=0.0999:rising");
        let save = |name: &str| format!("--checkpoint {name}.save --checkpoint-every {every} --force");
        let whole = folder.json(&format!("{run} --duration {long}"));
        let saved = folder.json(&format!("{run} --duration {long} {}", save("whole")));
        folder.json(&format!("{run} --duration {short} {}", save("part")));
        let resumed = folder.json(&format!("{run} --duration {long} --resume part.save"));
        assert_eq!(saved["events"], resumed["events"], "{method}");
        let times = |run: &Value| -> Vec<f64> {
            run["events"].as_array().unwrap().iter().map(|event| event["t"].as_f64().unwrap()).collect()
        };
        assert_eq!(times(&whole).len(), count, "{method}");
        assert_times(&times(&saved), &times(&whole), 1e-12);
        // What ends the run ends the saved one, and again from the last save before it.
        let ended = folder.json(&format!("{run} {until}"));
        let saved = folder.json(&format!("{run} {until} --checkpoint end.save --checkpoint-every 3 --force"));
        let again = folder.json(&format!("{run} {until} --resume end.save"));
        assert_eq!((&saved["events"], &saved["final"]), (&again["events"], &again["final"]), "{method}");
        assert_times(&times(&saved), &times(&ended), 1e-12);
        assert!(saved["final"]["t"].as_f64().unwrap() < 0.2, "{saved}");
        // Others are another run.
        folder.refused("run scene.toml --resume part.save --step 0.01 --event x=0.06", &["part.save", "another run"]);
    }
    // So it is of a train.
    let train = format!("run {TRAIN} --event x=0.05 --json --duration");
    let whole = folder.json(&format!("{train} 0.1"));
    folder.json(&format!("{train} 0.08 --checkpoint t.save"));
    assert_eq!(folder.json(&format!("{train} 0.1 --resume t.save"))["events"], whole["events"]);
}

/// The speed is `cos 10 t` at any time: the place is `sin(10 t)/10`, and crosses 0.05 twenty times in 6 s.
const TO_AND_FRO: &str = r#"
[sleigh]
mass = 1.0
inertia = 1.0
offset = 0.3
[start]
speed = 1.0
turn_rate = 0.0
[run]
step = 0.1
duration = 6.0
[[effects]]
kind = "servo"
speed = { amplitude = 1.0, frequency = 10.0, phase = 1.5707963267948966 }
turn_rate = 0.0
"#;

fn times(run: &Value) -> Vec<f64> {
    run["events"].as_array().unwrap().iter().map(|event| event["t"].as_f64().unwrap()).collect()
}

fn assert_times(found: &[f64], expected: &[f64], error: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
    let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= error);
    assert!(near, "{found:?} for {expected:?}");
}

/// SciPy issue 9228: two of three roots within a step are not found. An adaptive method is looked at in its own steps; where a method
/// of constant steps misses some, that is said, and more samples or shorter steps find them.
#[test]
fn events_within_long_steps() {
    let folder = Folder::new();
    folder.write("scene.toml", TO_AND_FRO);
    let in_turn = |k: u32| [PI / 6.0, 5.0 * PI / 6.0].map(|phase| (phase + f64::from(k) * TAU) / 10.0);
    let expected: Vec<f64> = (0..10).flat_map(in_turn).collect();
    for (method, more, error) in [
        ("dop853 --step 2", "", 1e-9),
        ("dop853 --step 0.6", "", 1e-9),
        ("dop853 --step 6", " --event-samples 2", 1e-9),
        ("gauss16 --step 0.1", "", 1e-12),
        // Long steps know the motion to some digits, but can be looked at more closely.
        ("gauss16 --step 1", " --event-samples 40", 0.01),
    ] {
        let line = format!("run scene.toml --method {method} --event x=0.05{more} --json");
        let run = folder.json(&line);
        assert_times(&times(&run), &expected, error);
        assert_eq!(run["events_in_doubt"].as_u64(), Some(0), "{line}");
    }
    // As many as its samples make, and that is told.
    let line = "run scene.toml --method gauss16 --step 2 --event x=0.05";
    let outcome = folder.line(line);
    assert!(outcome.code == 0 && outcome.stderr.starts_with("warning: "), "{outcome:?}");
    assert!(outcome.stderr.contains("--event-samples") && outcome.stderr.contains("5.00e-1 s"), "{outcome:?}");
    let outcome = folder.line(&format!("{line} --json"));
    let run: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert!(run["events_in_doubt"].as_u64() > Some(0) && times(&run).len() < 20, "{run}");
    assert!(outcome.stderr.starts_with("warning: "), "{outcome:?}");
    assert_eq!(run["events"][0]["spacing"].as_f64(), Some(0.5));
    // A run without events has no such key, and one without doubt says nothing.
    assert_eq!(folder.json("run scene.toml --json").get("events_in_doubt"), None);
    folder.done("run scene.toml --method gauss16 --event x=0.05");
}

/// Of a train too, and the samples have their limits.
#[test]
fn events_have_a_number_of_samples() {
    let folder = Folder::new();
    let run = |more: &str| folder.json(&format!("run {TRAIN} --until x=0.05 --json{more}"));
    let (step, spacing) = (run("")["step"].as_f64().unwrap(), |run: Value| run["events"][0]["spacing"].as_f64());
    let apart = |run: Value, samples: f64| assert!((spacing(run).unwrap() - step / samples).abs() < 1e-15);
    apart(run(""), 4.0);
    let run = run(" --event-samples 3");
    assert_eq!(run["events_in_doubt"].as_u64(), Some(0));
    apart(run, 3.0);
    let line = format!("run {TRAIN} --event heading=1.5");
    for samples in ["0", "-3", "x", "1e3", "10001"] {
        folder.refused(&format!("{line} --event-samples {samples}"), &["--event-samples", "from 1 to 10000"]);
    }
    folder.refused("run turnaround --event-samples 8", &["--event", "--until"]);
    assert!(folder.line("run turnaround --duration 0.1 --until speed=0 --event-samples 10000").code == 0);
}

/// SciPy issues 17066 and 19418: an event exactly at a node doubled the time or ended in a crash.
#[test]
fn events_at_nodes_happen_once() {
    let folder = Folder::new();
    folder.write("line.toml", CIRCLE.replace("turn_rate = 1.0", "turn_rate = 0.0"));
    // An explicit method is at the nodes to its rounding.
    for (method, error) in [("dla", 0.0), ("gauss8", 0.0), ("dop853", 1e-14)] {
        let line = format!("run line.toml --method {method} --step 0.25 --duration 4 --json");
        let events = "--event x=0 --event x=0.25 --event x=1 --event x=3.75 --event x=4";
        let run = folder.json(&format!("{line} {events}"));
        assert_times(&times(&run), &[0.25, 1.0, 3.75, 4.0], error);
        assert_eq!(run["steps"].as_u64(), Some(16));
        let run = folder.json(&format!("{line} {events} --until x=1 --out {method}.csv"));
        assert_times(&times(&run), &[0.25, 1.0, 1.0], error);
        let (names, rows) = csv(&folder.read(&format!("{method}.csv")));
        let [t, x] = ["t", "x"].map(|name| names.iter().position(|other| other == name).unwrap());
        let last = rows.last().unwrap();
        assert_eq!((rows.len(), last[x], run["final"]["t"].as_f64()), (5, 1.0, Some(last[t])), "{method}");
        assert!((last[t] - 1.0).abs() <= error, "{method}");
    }
}

#[test]
fn events_and_sections_agree_on_angles() {
    events_and_sections(&[(-1.0, TAU - 1.0)], 8.0);
}

#[test]
#[ignore = "slow"]
fn events_and_sections_agree_on_angles_in_full() {
    let headings = [(PI, PI), (-PI, PI), (1.0, 1.0), (-1.0, TAU - 1.0), (0.0, TAU), (2.0 * TAU + 1.0, 1.0)];
    events_and_sections(&headings, 20.0);
}

/// The scene of a circle for so long.
fn circle_of(duration: f64) -> String {
    CIRCLE.replace("duration = 20.0", &format!("duration = {duration:?}"))
}

/// A heading is an angle: an event of it happens in every turn, as a section through it does.
fn events_and_sections(headings: &[(f64, f64)], duration: f64) {
    let folder = Folder::new();
    folder.write("circle.toml", circle_of(duration));
    folder.write("back.toml", circle_of(duration).replace("turn_rate = 1.0", "turn_rate = -1.0"));
    let section = |line: &str| -> Vec<f64> {
        let found = folder.json(&format!("section {line} --starts 1 --duration {duration} --json"));
        let points = found["starts"][0]["points"].as_array().unwrap();
        points.iter().map(|point| point[0].as_f64().unwrap()).collect()
    };
    let run = |line: &str| folder.json(&format!("run {line} --method gauss8 --json"));
    let within =
        |times: &mut dyn Iterator<Item = f64>| -> Vec<f64> { times.filter(|t| 0.0 < *t && *t < duration).collect() };
    for (heading, first) in headings {
        let expected = within(&mut (0..4).map(|k| first + f64::from(k) * TAU));
        let found = run(&format!("circle.toml --event heading={heading}"));
        assert_times(&times(&found), &expected, 1e-13);
        assert_times(&section(&format!("circle.toml --plane heading={heading} --direction both")), &expected, 1e-13);
        assert_times(&section(&format!("circle.toml --plane heading={heading}")), &expected, 1e-13);
        for event in found["events"].as_array().unwrap() {
            assert_eq!(event["rising"].as_bool(), Some(true), "it turns to the left in every turn");
        }
        // The other way round.
        let expected = within(&mut (0..5).map(|k| f64::from(k) * TAU - first));
        let found = run(&format!("back.toml --event heading={heading}"));
        assert_times(&times(&found), &expected, 1e-13);
        assert!(found["events"].as_array().unwrap().iter().all(|event| event["rising"].as_bool() == Some(false)));
        assert_times(&section(&format!("back.toml --plane heading={heading} --direction falling")), &expected, 1e-13);
    }
}

#[test]
fn turns_are_counted() {
    events_of_turns(1, 8.0);
}

#[test]
#[ignore = "slow"]
fn turns_are_counted_in_full() {
    events_of_turns(2, 20.0);
}

/// With its turns, a heading happens in one of them: here after `count` turns.
fn events_of_turns(count: u32, duration: f64) {
    let folder = Folder::new();
    folder.write("circle.toml", circle_of(duration));
    let run = |line: &str| folder.json(&format!("run circle.toml {line} --method gauss8 --json"));
    let turns = f64::from(count) * TAU + 1.0;
    assert_times(&times(&run(&format!("--event unwrapped_heading={turns}"))), &[turns], 1e-13);
    assert!(times(&run("--event unwrapped_heading=-1")).is_empty());
    let ended = run(&format!("--until unwrapped_heading={turns} --event heading=0.5"));
    let expected: Vec<f64> = (0..=count).map(|k| 0.5 + f64::from(k) * TAU).chain([turns]).collect();
    assert_times(&times(&ended), &expected, 1e-13);
    assert_eq!(run("--until heading=1")["events"].as_array().unwrap().len(), 1);
}

#[test]
fn a_train_meets_angles_in_every_turn() {
    angles_of_a_train(8.0, "0.2", 2);
}

#[test]
#[ignore = "slow"]
fn a_train_meets_angles_in_every_turn_in_full() {
    angles_of_a_train(20.0, "0.1", 4);
}

/// Of the first blade: its trailer is light, and it goes round as without.
fn angles_of_a_train(duration: f64, step: &str, turns: usize) {
    let folder = Folder::new();
    folder.write("train.toml", format!("{}{TRAILER}", circle_of(duration)));
    let line = format!("run train.toml --method dla4 --step {step}");
    let found = folder.json(&format!("{line} --event heading=1 --event unwrapped_heading=1 --json"));
    let names: Vec<_> = found["events"].as_array().unwrap().iter().map(|event| event["event"].as_str()).collect();
    assert_eq!(names.iter().filter(|name| **name == Some("heading=1")).count(), turns, "{found}");
    assert_eq!(names.iter().filter(|name| **name == Some("unwrapped_heading=1")).count(), 1, "{found}");
}
