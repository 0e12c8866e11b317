//! `noslip run`: what it computes and prints.

mod events;

use crate::program::{FAILING, Folder, SCENE, SCENES, csv, keys, methods};
use serde_json::Value;
use std::process::Stdio;
use std::time::{Duration, Instant};

const KEYS: [&str; 11] = [
    "scene",
    "method",
    "order",
    "step",
    "steps",
    "duration",
    "wall_seconds",
    "newton",
    "energy",
    "constraint",
    "final",
];
const FINAL: [&str; 6] = ["t", "x", "y", "heading", "speed", "turn_rate"];

/// A circle of radius 1 m, at 1 rad/s: `x = sin t`, `y = 1 - cos t`.
const CIRCLE: &str = r#"
[sleigh]
mass = 1.0
inertia = 1.0
offset = 0.0
[start]
speed = 1.0
turn_rate = 1.0
[run]
step = 0.1
duration = 20.0
"#;

/// A light trailer, which the first blade does not feel.
const TRAILER: &str = "[[effects]]
kind = \"trailers\"
count = 1
mass = 1e-9
inertia = 1e-9
offset = 0.0
hitch = 0.0
bar = 0.5
";

fn assert_shape(run: &Value) {
    assert_eq!(keys(run), KEYS);
    assert_eq!(keys(&run["newton"]), ["mean", "max"]);
    assert_eq!(keys(&run["energy"]), ["initial", "final", "work", "max_error"]);
    assert_eq!(keys(&run["constraint"]), ["max"]);
    assert_eq!(keys(&run["final"]), FINAL);
    assert!(run["scene"].is_string() && run["method"].is_string());
    assert!(run["order"].is_u64() && run["steps"].is_u64() && run["newton"]["max"].is_u64());
    let numbers = [&run["step"], &run["duration"], &run["wall_seconds"], &run["newton"]["mean"]];
    assert!(numbers.iter().all(|number| number.is_f64()), "{run}");
    for object in ["energy", "constraint", "final"] {
        assert!(run[object].as_object().unwrap().values().all(Value::is_f64), "{run}");
    }
    let (steps, step) = (run["steps"].as_u64().unwrap(), run["step"].as_f64().unwrap());
    assert_eq!(run["duration"].as_f64().unwrap(), steps as f64 * step);
    assert_eq!(run["duration"], run["final"]["t"]);
    assert!(run["wall_seconds"].as_f64().unwrap() > 0.0);
}

#[test]
fn every_bundled_scene_and_a_file_run() {
    scenes_run(" --duration 0.5", &SCENES[..2]);
}

#[test]
#[ignore = "slow"]
fn every_bundled_scene_and_a_file_run_in_full() {
    scenes_run("", &SCENES);
}

/// Every scene gives an object, and these a text too.
fn scenes_run(flags: &str, as_text: &[&str]) {
    let folder = Folder::new();
    folder.write("my scene.toml", SCENE);
    for scene in SCENES {
        let run = folder.json(&format!("run {scene} --json{flags}"));
        assert_shape(&run);
        assert_eq!((run["scene"].as_str(), run["method"].as_str()), (Some(scene), Some("dla")));
    }
    for scene in as_text {
        assert!(folder.done(&format!("run {scene}{flags}")).contains(&format!("({scene})")));
    }
    let outcome = folder.noslip(["run", "my scene.toml", "--json"]);
    let run: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_shape(&run);
    assert_eq!((outcome.code, run["scene"].as_str(), run["steps"].as_u64()), (0, Some("my scene"), Some(40)));
    assert_eq!(folder.names(), ["my scene.toml"]);
}

/// What the pages of the gallery say of motions with a closed form. The runs are of order 16, so that nothing but rounding is
/// left: some `1e3` steps with numbers of some units.
#[test]
fn scenes_do_what_their_pages_say() {
    let folder = Folder::new();
    let end = |scene: &str, key: &str| {
        folder.json(&format!("run {scene} --method gauss16 --json"))["final"][key].as_f64().unwrap()
    };
    let rounding = 1e4 * f64::EPSILON;
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < rounding, "{found} {expected}");
    // Four rounds of forward d = 1, pivot -p, back d, pivot p.
    let p = 0.5_f64;
    near(end("parking", "x"), 4.0 * (1.0 - p.cos()));
    near(end("parking", "y"), 4.0 * p.sin());
    near(end("parking", "heading"), 0.0);
    // A cycloid across the slope: g = w = 1, from rest.
    let t = 20.0_f64;
    near(end("skate", "x"), 0.5 * t.sin() * t.sin());
    near(end("skate", "y"), 0.5 * (t - 0.5 * (2.0 * t).sin()));
    // With psi = theta - phi and phi the angle of the tracer: psi' = rho cos psi - 1.
    let (rho, begin) = (0.2_f64, std::f64::consts::FRAC_PI_2);
    let (root, ratio) = ((1.0 - rho * rho).sqrt(), ((1.0 - rho) / (1.0 + rho)).sqrt());
    let phase = ((0.5 * begin).tan() / ratio).atan() - root * std::f64::consts::PI;
    // The branch: the tracer has gone once around, and the blade has turned by less than a right angle.
    let psi = 2.0 * (ratio * phase.tan()).atan();
    let turn = (psi - begin).rem_euclid(std::f64::consts::TAU);
    near(end("planimeter", "heading"), begin + turn);
    let area = std::f64::consts::PI * rho * rho;
    assert!((turn - area).abs() < 0.05 * area && turn > area, "{turn} {area}");
}

#[test]
fn the_default_run_has_the_values_of_its_scene() {
    let run = Folder::new().json("run turnaround --json");
    assert_eq!((run["order"].as_u64(), run["steps"].as_u64()), (Some(2), Some(800)));
    assert_eq!((run["step"].as_f64(), run["duration"].as_f64()), (Some(0.05), Some(40.0)));
    // (m v^2 + (I + m a^2) w^2) / 2 with v = -1 and w = 0.1.
    assert!((run["energy"]["initial"].as_f64().unwrap() - 0.50625).abs() <= 1e-16);
    assert!(run["energy"]["max_error"].as_f64().unwrap() < 1e-3);
    assert!(run["constraint"]["max"].as_f64().unwrap() <= 1e-14);
    let (mean, max) = (run["newton"]["mean"].as_f64().unwrap(), run["newton"]["max"].as_u64().unwrap());
    assert!(0.0 < mean && mean <= max as f64 && max <= 10, "{mean} {max}");
    let drift = run["energy"]["final"].as_f64().unwrap() - run["energy"]["initial"].as_f64().unwrap();
    assert!(drift.abs() <= run["energy"]["max_error"].as_f64().unwrap());
    // It has turned round and glides forward with all of its energy.
    assert!((run["final"]["speed"].as_f64().unwrap() - 1.0125f64.sqrt()).abs() < 1e-3, "{run}");
}

#[test]
fn every_listed_method_runs() {
    let folder = Folder::new();
    let listed = folder.json("list methods --json");
    for method in listed.as_array().unwrap() {
        let name = method["name"].as_str().unwrap();
        let run = folder.json(&format!("run turnaround --method {name} --duration 5 --json"));
        assert_shape(&run);
        assert_eq!(run["method"], method["name"]);
        // With the weight that it has by default, 1/2, dla-alpha is of order 2.
        let order = if name == "dla-alpha" { Some(2) } else { method["order"].as_u64() };
        assert_eq!(run["order"].as_u64(), order, "{name}");
        assert!(run["energy"]["max_error"].as_f64().unwrap() < 0.1, "{run}");
        assert!(run["newton"]["mean"].as_f64().unwrap() <= run["newton"]["max"].as_u64().unwrap() as f64);
    }
    assert!(methods().iter().any(|name| name == "dla"));
}

#[test]
fn step_duration_and_alpha_override_the_scene() {
    let folder = Folder::new();
    let run = folder.json("run turnaround --step 0.01 --duration 3 --json");
    assert_eq!((run["steps"].as_u64(), run["step"].as_f64()), (Some(300), Some(0.01)));
    // A step that does not divide the duration is shortened.
    let run = folder.json("run turnaround --step 0.3 --duration 1 --json");
    assert_eq!((run["steps"].as_u64(), run["step"].as_f64()), (Some(4), Some(0.25)));
    let order =
        |alpha: &str| folder.json(&format!("run circle --method dla-alpha --alpha {alpha} --json"))["order"].clone();
    assert_eq!((order("0.5"), order("0.3"), order("0"), order("1")), (2.into(), 1.into(), 1.into(), 1.into()));
    let ends = ["0.2", "0.8"].map(|alpha| {
        folder.json(&format!("run turnaround --method dla-alpha --alpha {alpha} --json"))["final"]["x"].clone()
    });
    assert_ne!(ends[0], ends[1]);
    // A weight for a method that has none is pointed out.
    let outcome = folder.line("run circle --alpha 0.3 --json");
    assert_eq!(outcome.code, 0);
    assert!(outcome.stderr.starts_with("warning: --alpha "), "{}", outcome.stderr);
}

#[test]
fn the_printed_end_is_the_last_row_to_the_bit() {
    let folder = Folder::new();
    for method in methods() {
        let line = format!("run turnaround --duration 3 --method {method} --json --force --out all.csv");
        let run = folder.json(&line);
        let (names, rows) = csv(&folder.read("all.csv"));
        for name in FINAL {
            let column = names.iter().position(|other| other == name).unwrap();
            let (printed, written) = (run["final"][name].as_f64().unwrap(), rows.last().unwrap()[column]);
            assert_eq!(printed.to_bits(), written.to_bits(), "{method}: {name}");
        }
        assert_eq!(run["energy"]["final"].as_f64().unwrap(), rows.last().unwrap()[6]);
        let worst = rows.iter().map(|row| row[7]).fold(0.0, f64::max);
        assert_eq!(run["constraint"]["max"].as_f64().unwrap(), worst, "{method}");
    }
}

#[test]
fn a_run_that_fails_keeps_and_tells_what_is_valid() {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    let outcome = folder.line("run large.toml --json --out valid.csv");
    let run: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(outcome.code, 1);
    assert_eq!(keys(&run), [&KEYS[..], &["failure"]].concat());
    assert_eq!(keys(&run["failure"]), ["step", "time", "reason", "iterations", "corrections", "hint"]);
    assert!(run["failure"]["hint"].as_str().unwrap().starts_with("shorten the step to 0."), "{run}");
    let (steps, t) = (run["steps"].as_u64().unwrap(), run["final"]["t"].as_f64().unwrap());
    assert!(0 < steps && steps < 10);
    assert_eq!((run["failure"]["step"].as_u64(), run["failure"]["time"].as_f64()), (Some(steps + 1), Some(t)));
    let place = format!("dla failed at step {}, from t = {t} s: ", steps + 1);
    let valid = format!("valid up to t = {t} s ({steps} steps)");
    outcome.assert_told("run", &[&place, run["failure"]["reason"].as_str().unwrap(), &valid]);
    let (_, rows) = csv(&folder.read("valid.csv"));
    assert_eq!((rows.len() as u64, rows.last().unwrap()[0]), (steps + 1, t));
    assert!(rows.iter().all(|row| row[..8].iter().all(|number| number.is_finite())));

    let text = folder.line("run large.toml");
    assert_eq!(text.code, 1);
    assert!(text.stdout.contains(&format!("{steps} of 2.9 s")), "{}", text.stdout);
}

/// What a program prints, but for the time it took.
fn timeless(mut run: Value) -> Value {
    run["wall_seconds"].take();
    run
}

/// The number of steps of a checkpoint.
fn steps_of(checkpoint: &str) -> u64 {
    let steps = checkpoint.lines().find_map(|line| line.strip_prefix("k: ")).unwrap();
    u64::from_str_radix(steps, 16).unwrap()
}

#[test]
fn a_killed_run_is_resumed_to_the_same_bits() {
    // In a binary fraction of a second, so that all durations have the same step.
    killed_and_resumed("--step 0.001953125", 50, |saved| format!("--duration {}", (saved + 300) as f64 / 512.0));
}

#[test]
#[ignore = "slow"]
fn a_killed_run_is_resumed_to_the_same_bits_at_length() {
    killed_and_resumed("--step 0.002", 20_000, |_| "--duration 800".to_owned());
}

/// Stopped by force in the middle, whenever that happens to be, a run goes on from its last checkpoint to the same end, which lies after
/// the steps that were saved.
fn killed_and_resumed(step: &str, every: u64, end: impl Fn(u64) -> String) {
    let folder = Folder::new();
    let line = format!("run turnaround --method gauss16 {step} --json --every 100");
    let saved = format!("{line} --duration 800 --checkpoint saved --checkpoint-every {every}");
    let mut child = folder.command(saved.split_whitespace()).stdout(Stdio::null()).spawn().unwrap();
    let begin = Instant::now();
    while !folder.join("saved").exists() {
        assert!(begin.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(), "no checkpoint");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success(), "it was not stopped");

    let line = format!("{line} {}", end(steps_of(&folder.read("saved"))));
    let resumed = folder.json(&format!("{line} --resume saved --out rest.csv"));
    let whole = folder.json(&format!("{line} --out whole.csv"));
    assert_eq!(timeless(resumed), timeless(whole));
    let (rest, whole) = (folder.read("rest.csv"), folder.read("whole.csv"));
    let (rest, whole): (Vec<_>, Vec<_>) = (rest.lines().collect(), whole.lines().collect());
    // All rows that come after the checkpoint, under the same header.
    assert!(1 < rest.len() && rest.len() < whole.len() && rest[0] == whole[0], "{} {}", rest.len(), whole.len());
    assert_eq!(rest[1..], whole[whole.len() + 1 - rest.len()..]);
}

const TRAIN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/train.toml");

#[test]
fn a_resumed_run_has_the_bits_of_the_whole() {
    resumed_as_whole(&[
        ("turnaround --duration 1", "gni", 7),
        ("turnaround --duration 1", "dop853", 3),
        ("turnaround --duration 0.25", "energy4", 2),
        ("turntable --duration 1", "dla", 13),
        ("parking --duration 1.5", "lobatto3", 20),
    ]);
}

#[test]
fn a_resumed_train_has_the_bits_of_the_whole() {
    for (duration, method) in [("0.1", "dla"), ("0.06", "dla4")] {
        let train = format!("{TRAIN} --duration {duration}");
        resumed_as_whole(&[(train.as_str(), method, 2)]);
    }
}

#[test]
#[ignore = "slow"]
fn a_resumed_run_has_the_bits_of_the_whole_at_length() {
    resumed_as_whole(&[
        ("turnaround", "gni", 333),
        ("turnaround", "dop853", 77),
        ("turnaround", "energy4", 500),
        ("bowl", "dla4", 701),
        ("turntable", "dla", 100),
        // At a jump of the imposed velocity, and between two.
        ("parking", "dla", 100),
        ("parking", "lobatto3", 70),
        (TRAIN, "dla", 300),
        (TRAIN, "dla4", 700),
    ]);
}

/// The last checkpoint of a run that ended by itself, of scenes with forces, jumps and moving constraints, and of methods that
/// remember something.
fn resumed_as_whole(runs: &[(&str, &str, u64)]) {
    let folder = Folder::new();
    for (scene, method, every) in runs {
        let line = format!("run {scene} --method {method} --json");
        let whole = folder.json(&line);
        let saved = folder.json(&format!("{line} --checkpoint saved --checkpoint-every {every} --force"));
        assert_eq!(timeless(whole.clone()), timeless(saved), "{line}: saving changes nothing");
        let steps = whole["steps"].as_u64().unwrap();
        // The last checkpoint is that of the end.
        assert!(folder.read("saved").contains(&format!("\nk: {steps:016x}\n")) && steps > *every, "{steps}");
        let resumed = folder.json(&format!("{line} --resume saved"));
        assert_eq!(timeless(whole), timeless(resumed), "{line}");
    }
}

#[test]
fn a_checkpoint_of_another_run_is_refused() {
    let folder = Folder::new();
    folder.done("run turnaround --checkpoint saved --checkpoint-every 300");
    let written = folder.read("saved");
    folder.refused("run circle --resume saved", &["saved", "scene", "`turnaround`", "`circle`"]);
    folder.refused("run turnaround --method dla4 --resume saved", &["method", "`dla`", "`dla4`"]);
    folder.refused("run turnaround --step 0.01 --resume saved", &["step", "`0.05`", "`0.01`"]);
    folder.refused("run turnaround --resume none", &["none"]);
    folder.refused("run turnaround --checkpoint saved", &["saved exists already", "--force"]);
    folder.refused("run turnaround --checkpoint-every 10", &["--checkpoint"]);
    folder.refused("run turnaround --resume saved --event speed=0", &["`events` is `-`", "`speed=0`"]);
    folder.write("cut", &written[..written.len() / 2]);
    folder.refused("run turnaround --resume cut", &["cut", "damaged"]);
    folder.write("noise", b"\xff\xfe");
    folder.refused("run turnaround --resume noise", &["not a checkpoint"]);
    folder.write("newer", written.replacen("checkpoint 5", "checkpoint 7", 1));
    folder.refused("run turnaround --resume newer", &["version 7"]);
    // The scene of a name may change.
    folder.write("scene.toml", SCENE);
    folder.done("run scene.toml --checkpoint other --checkpoint-every 10");
    folder.write("scene.toml", SCENE.replace("offset = 0.5", "offset = 0.6"));
    folder.refused("run scene.toml --resume other", &["contents"]);
    // It may be overwritten by the run that goes on from it; from its end nothing is left to save.
    folder.done("run turnaround --resume saved --checkpoint saved --checkpoint-every 700");
    assert_eq!(folder.read("saved"), written);
}

#[test]
fn a_negative_duration_goes_backward_in_time() {
    back_and_mirrored(&["turnaround"], &["gauss-adaptive", "dop853"], 0.5);
    back_and_mirrored(&["bowl"], &["dla", "gauss16", "energy4", "rk4-reduced"], 0.5);
}

#[test]
#[ignore = "slow"]
fn a_negative_duration_goes_backward_in_time_at_length() {
    let methods = ["dla", "dla8", "lobatto3", "gauss16", "gauss-adaptive", "energy4", "rk4", "rk4-reduced", "dop853"];
    back_and_mirrored(&["turnaround", "bowl"], &methods, 10.0);
}

/// Backward in time the sleigh moves as forward with its velocities reversed, where no force depends on time or velocity.
fn back_and_mirrored(scenes: &[&str], methods: &[&str], duration: f64) {
    let folder = Folder::new();
    let end = |line: &str| folder.json(&format!("run {line} --step 0.05 --json"))["final"].clone();
    for (scene, method) in scenes.iter().flat_map(|scene| methods.iter().map(move |method| (scene, method))) {
        let back = end(&format!("{scene} --duration -{duration} --method {method}"));
        let mirrored = "--set start.speed=1.0 --set start.turn_rate=-0.1";
        let forth = end(&format!("{scene} --duration {duration} --method {method} {mirrored}"));
        assert_eq!(back["t"].as_f64(), Some(-duration), "{back}");
        // Two hundred steps of numbers below 20, and solvers that stop at rounding.
        assert_reversed(&back, &forth, 1e-10 * duration / 10.0, &format!("{method} in {scene}"));
    }
}

fn assert_reversed(back: &Value, forth: &Value, error: f64, what: &str) {
    for (key, sign) in [("x", 1.0), ("y", 1.0), ("heading", 1.0), ("speed", -1.0), ("turn_rate", -1.0)] {
        let [back, forth] = [back, forth].map(|end| end[key].as_f64().unwrap());
        assert!((back - sign * forth).abs() < error, "{what}: {key} {back} and {forth}");
    }
}

/// Backward to a place, and a table of times that is met in its order.
#[test]
fn a_run_backward_meets_events_and_tables() {
    let folder = Folder::new();
    let run = folder.json("run turnaround --duration -7 --method taylor --event y=-0.2 --json --out back.csv");
    let (_, rows) = csv(&folder.read("back.csv"));
    assert!(rows.windows(2).all(|pair| pair[1][0] < pair[0][0]) && rows.last().unwrap()[0] == -7.0, "{run}");
    let metadata = folder.read("back.csv-metadata.json");
    assert!(metadata.contains("--duration -7.0") && !metadata.contains("--step -"), "{metadata}");
    // A servo that jumps at -2 s and 1 s.
    let table = "[[effects]]\nkind = \"servo\"\nspeed = { times = [-9.0, -2.0, 1.0], values = [1.0, 3.0, 5.0] }\nturn_rate = 0.0\n";
    folder.write("scene.toml", format!("{SCENE}{table}"));
    let back = folder.json("run scene.toml --duration -5 --step 0.3 --set start.heading=0 --json")["final"].clone();
    assert!((back["x"].as_f64().unwrap() + 2.0 * 3.0 + 3.0 * 1.0).abs() < 1e-12, "{back}");
    folder.refused("compare turnaround --methods dla --duration -5", &["--duration", "greater than 0"]);
    folder.refused("run turnaround --duration -5 --tolerance 1e-6", &["--tolerance", "backward"]);
    folder.refused("run turnaround --duration 0", &["greater than 0"]);
}

#[test]
fn a_train_goes_backward_in_time() {
    train_backward(0.1);
}

#[test]
#[ignore = "slow"]
fn a_train_goes_backward_in_time_in_full() {
    train_backward(3.0);
}

fn train_backward(duration: f64) {
    let folder = Folder::new();
    let back = folder.json(&format!("run {TRAIN} --duration -{duration} --method dla4 --json --out train.csv"));
    let (_, rows) = csv(&folder.read("train.csv"));
    assert!(rows.windows(2).all(|pair| pair[1][0] < pair[0][0]) && rows.last().unwrap()[0] == -duration, "{back}");
    // Nothing drives it, so with all velocities reversed it runs there forward in time.
    let reversed = "--set start.speed=-1.0 --set start.turn_rate=-0.8";
    let forth = folder.json(&format!("run {TRAIN} --duration {duration} {reversed} --method dla4 --json"));
    assert_reversed(&back["last"], &forth["last"], 1e-10 * duration / 3.0, "a train");
    folder.refused(&format!("run {TRAIN} --duration -3 --tolerance 1e-4"), &["--tolerance", "backward"]);
}

/// Of a method with steps of its own a tolerance is what each of them aims for, on the command line and in the scene.
#[test]
fn a_tolerance_is_that_of_own_steps() {
    let folder = Folder::new();
    for method in ["gauss-adaptive", "taylor", "dop853"] {
        let end = |flags: &str| {
            let run = folder.json(&format!("run bowl --method {method} --step 5 --duration 20 --json {flags}"));
            assert_eq!(run["steps"].as_u64(), Some(4), "{run}");
            ["x", "y", "heading"].map(|key| run["final"][key].as_f64().unwrap())
        };
        let [exact, loose, set] = ["", "--tolerance 1e-5", "--set run.tolerance=1e-5"].map(end);
        assert_eq!(loose.map(f64::to_bits), set.map(f64::to_bits), "{method}");
        let off = (0..3).map(|i| (exact[i] - loose[i]).abs()).fold(0.0, f64::max);
        // A hundred own steps of 1e-5 at most, which 20 s in the bowl enlarge by less than ten times; and no two methods agree to the bit.
        assert!(off > 0.0 && off < 4e-2, "{method}: {off:e}");
    }
    folder.refused("run bowl --method taylor --tolerance 0", &["tolerance", "positive"]);
    // A train has no such methods.
    folder.write("train.toml", format!("{CIRCLE}{TRAILER}"));
    for (method, flag) in
        [("gauss-adaptive", "--tolerance 1e-6"), ("taylor", "--tolerance 1e-6"), ("lobatto3", ""), ("energy2", "")]
    {
        let refused = folder.line(&format!("run train.toml --method {method} {flag}"));
        assert!(refused.code == 1 && refused.stderr.contains("take dla, dla4, dla6 or dla8"), "{method}: {refused:?}");
    }
}

/// Series of what only Rust knows: a thrust that is a formula of time, one from a table with jumps, and friction that is smoothed.
#[test]
fn series_of_every_effect() {
    let folder = Folder::new();
    let scenes = [
        "[[effects]]\nkind = \"thrust\"\nforce = \"0.2*t*exp(-t) + max(0, sin(3*t))\"\n",
        "[[effects]]\nkind = \"thrust\"\nforce = { times = [0.0, 1.0, 2.5], values = [0.1, -0.2, 0.3] }\n",
        "[[effects]]\nkind = \"quadratic_drag\"\nalong = 0.3\n[[effects]]\nkind = \"friction\"\nalong = 0.1\nturning = 0.02\n\
         [[effects]]\nkind = \"hills\"\nhills = [{ x = 1.0, y = 0.2, height = 0.1, width = 0.5 }]\n",
    ];
    for (k, effects) in scenes.iter().enumerate() {
        let file = format!("effects-{k}.toml");
        folder.write(&file, format!("{CIRCLE}{effects}"));
        let end = |method: &str| {
            let run = folder.json(&format!("run {file} --method {method} --step 0.02 --duration 4 --json"));
            ["x", "y", "heading"].map(|key| run["final"][key].as_f64().unwrap())
        };
        let [series, stages] = ["taylor --tolerance 1e-14", "gauss16"].map(end);
        let off = (0..3).map(|i| (series[i] - stages[i]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-11, "{effects}: {series:?} and {stages:?}");
    }
}

/// A step is where the nodes lie, whose own steps are as the tolerance says; of all other methods both would choose the step.
#[test]
fn a_step_goes_with_the_tolerance_of_own_steps() {
    let folder = Folder::new();
    let steps = |flags: &str| folder.json(&format!("run bowl --duration 20 --step 2 --json {flags}"))["steps"].clone();
    assert_eq!(steps("--method gauss-adaptive --tolerance 1e-8").as_u64(), Some(10));
    folder.refused("run bowl --step 2 --tolerance 1e-8", &["--step and --tolerance", "dla"]);
    // Systems of formulas have the same methods, also where their basis of admissible velocities is changed on the way: the disk turns by
    // 1.4 in each of these steps, and rolls on as fast as it did.
    for method in ["gauss-adaptive", "dop853"] {
        let run = folder.json(&format!("run rolling-disk --method {method} --step 2 --duration 20 --json"));
        let rolled = ["phi", "phi'"].map(|key| run["final"][key].as_f64().unwrap());
        assert!((rolled[0] - 40.0).abs() < 1e-9 && (rolled[1] - 2.0).abs() < 1e-10, "{method}: {run}");
    }
}

#[test]
fn a_step_is_found_for_a_tolerance() {
    let folder = Folder::new();
    let end = |line: &str| {
        let run = folder.json(line);
        let coordinate = |name: &str| run["final"][name].as_f64().unwrap();
        (["x", "y", "heading"].map(coordinate), run["steps"].as_u64().unwrap())
    };
    let (exact, _) = end("run turnaround --method gauss16 --json");
    let (found, steps) = end("run turnaround --method gauss8 --tolerance 1e-6 --json");
    let error = exact.iter().zip(&found).fold(0.0f64, |error, (a, b)| error.max((a - b).abs()));
    assert!((1e-7..=1e-6).contains(&error), "{error:e} with {steps} steps");
    folder.refused("run turnaround --tolerance -1", &["--tolerance", "positive"]);
    folder.refused("run turnaround --tolerance 1e-3 --step 0.1", &["--step"]);
    let out_of_reach = folder.line("run turnaround --method gauss8 --tolerance 1e-17");
    assert_eq!(out_of_reach.code, 1);
    assert!(out_of_reach.stderr.contains("out of reach: the best error found is about "), "{}", out_of_reach.stderr);
}
