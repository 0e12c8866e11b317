//! Requests that are wrong: exit 2, what is accepted on standard error, and nothing done.

use crate::program::{Folder, SCENE, methods};

/// What is wrong with a scene: the text to replace, what by, and what the message must name besides the file.
type Fault = (&'static str, &'static str, &'static [&'static str]);

const FAULTS: [Fault; 15] = [
    ("mass = 1.0", "masss = 1.0", &[":3:1", "sleigh.masss", "`mass`, `inertia`, `offset`", "did you mean `mass`"]),
    ("mass = 1.0\n", "", &[":2:", "sleigh.mass", "is missing", "greater than 0, in kg"]),
    ("mass = 1.0", "mass = nan", &[":3:8", "sleigh.mass", "finite", "greater than 0, in kg"]),
    ("mass = 1.0", "mass = -1.0", &[":3:8", "sleigh.mass", "-1.0", "greater than 0, in kg"]),
    ("mass = 1.0", "mass = \"1 kg\"", &[":3:8", "sleigh.mass", "a string", "greater than 0, in kg"]),
    ("mass = 1.0", "mass = 1e999", &[":3:8", "sleigh.mass", "1e999", "greater than 0, in kg"]),
    ("mass = 1.0", "mass =", &[":3:", "sleigh.mass", "greater than 0, in kg"]),
    ("speed = -1.0", "speed = inf", &[":7:9", "start.speed", "a finite number, in m/s"]),
    ("step = 0.05", "step = 0", &[":10:8", "run.step", "greater than 0, in s"]),
    ("step = 0.05", "step = 3", &[":10:8", "run.step", "at most the duration"]),
    ("step = 0.05", "step = 1e-300", &[":10:8", "run.step", "1e12 steps"]),
    ("[run]", "[run]\nmethod = \"euler\"", &[":10:10", "run.method", "euler", "`dla`", "`rk4`"]),
    ("[run]", "[run]\nmethod = 4", &[":10:10", "run.method", "an integer", "a string"]),
    ("[run]", "[run]\nalpha = 2", &[":10:9", "run.alpha", "from 0 to 1"]),
    ("[run]", "[walk]", &["walk", "`run`"]),
];

#[test]
fn bad_scenes_are_refused_with_file_line_field_and_what_is_accepted() {
    let folder = Folder::new();
    for (good, bad, told) in FAULTS {
        let text = SCENE.replacen(good, bad, 1);
        assert_ne!(text, SCENE, "{good}");
        folder.write("bad.toml", text);
        for command in ["check", "run", "compare --report pages", "run --out run.csv"] {
            let outcome = folder.line(&format!("{command} bad.toml"));
            outcome.assert_refused(bad, told);
            outcome.assert_told(bad, &["bad.toml", "accepted"]);
        }
        assert_eq!(folder.names(), ["bad.toml"], "{bad}");
    }
}

#[test]
fn what_is_no_scene_is_refused() {
    let folder = Folder::new();
    folder.write("empty.toml", "");
    folder.write("latin1.toml", b"title = \"\xe9t\xe9\"\n");
    folder.write("zeros.toml", [0; 100]);
    std::fs::create_dir(folder.join("folder.toml")).unwrap();
    let before = folder.names();
    for (scene, told) in [
        ("empty.toml", &["empty.toml", "the scene is empty", "[sleigh]"][..]),
        ("latin1.toml", &["latin1.toml:1:10", "not UTF-8", "0xe9"]),
        ("zeros.toml", &["zeros.toml:1"]),
        ("folder.toml", &["folder.toml", "directory", "accepted"]),
        ("missing.toml", &["missing.toml", "accepted", "turnaround, straight, circle"]),
        ("Turnaround", &["Turnaround", "did you mean `turnaround`", "accepted"]),
        ("", &["accepted"]),
        (&"a".repeat(5000), &["too long"]),
        ("a\u{1b}[31mb\nc", &["accepted"]),
    ] {
        for command in ["check", "run", "compare"] {
            let outcome = folder.noslip([command, scene]);
            outcome.assert_refused(scene, told);
            assert!(!outcome.stderr.contains('\u{1b}'), "{}", outcome.stderr);
        }
    }
    assert_eq!(folder.names(), before);
}

#[test]
fn flags_that_make_no_sense_are_refused() {
    let folder = Folder::new();
    let all = methods().iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    for (flags, told) in [
        ("--step nan", &["--step", "greater than 0, in s"][..]),
        ("--step inf", &["--step", "finite"]),
        ("--step 0", &["--step", "greater than 0, in s"]),
        ("--step -0.1", &["--step", "greater than 0, in s"]),
        ("--step 1e-300", &["--step", "1e12 steps", "at least"]),
        ("--step 1e3", &["--step", "at most the duration"]),
        ("--step fast", &["--step", "fast", "numbers like"]),
        ("--step", &["--step"]),
        ("--duration 0", &["--duration", "greater than 0, in s"]),
        ("--duration 1e300", &["--duration", "1e12 steps", "at most"]),
        ("--duration 1e-9", &["--duration", "at least the step"]),
        ("--alpha 2", &["--alpha", "from 0 to 1"]),
        ("--alpha nan", &["--alpha"]),
        ("--every 0", &["--every", "a whole number of 1 or more"]),
        ("--every -1", &["--every", "a whole number of 1 or more"]),
        ("--every 1.5", &["--every", "a whole number of 1 or more"]),
        ("--every 99999999999999999999", &["--every"]),
        ("--method nope", &["--method", "nope", &all]),
        ("--method dla,rk4", &["--method", &all]),
        ("--method DLA", &["--method", "did you mean `dla`"]),
        ("--bogus", &["--bogus"]),
        ("--step 0.1 --step 0.2", &["--step"]),
        ("--out", &["--out"]),
        ("circle", &["circle"]),
    ] {
        folder.refused(&format!("run turnaround --json {flags}"), told);
    }
    for flag in ["--method", "--out", "--step"] {
        folder.noslip(["run", "turnaround", flag, ""]).assert_refused(flag, &[flag]);
    }
    for line in ["walk", "run", "check", "list", "list everything", "new", "--json", "compare turnaround --every 2"] {
        folder.refused(line, &[]);
    }
    assert!(folder.names().is_empty());
}

#[test]
fn the_smallest_and_largest_numbers_do_no_harm() {
    let families = ["dla", "lobatto4", "gauss8", "gauss-adaptive", "taylor", "energy2", "gni", "rk4", "dop853"];
    extremes_do_no_harm(&families.map(str::to_owned));
}

#[test]
#[ignore = "slow"]
fn the_smallest_and_largest_numbers_do_no_harm_at_length() {
    extremes_do_no_harm(&methods());
}

fn extremes_do_no_harm(methods: &[String]) {
    let folder = Folder::new();
    for (step, duration) in [("5e-324", "5e-324"), ("1e-320", "1e-318"), ("1e308", "1e308"), ("1e-5", "1e-5")] {
        for method in methods {
            let line = format!("run turnaround --step {step} --duration {duration} --method {method}");
            let outcome = folder.line(&line);
            assert!(matches!(outcome.code, 0 | 1), "{line}: {outcome:?}");
            assert_eq!(outcome.stderr.starts_with("error: "), outcome.code == 1, "{line}: {outcome:?}");
            assert!(!outcome.stderr.contains("panicked"), "{line}: {outcome:?}");
            assert!(outcome.stdout.lines().all(|line| line.len() < 120), "{}", outcome.stdout);
        }
    }
}
