//! `noslip lyapunov`, `noslip section` and `noslip ensemble`.

mod ensembles;
use crate::program::{Folder, SCENE, csv, keys};
use approx::assert_abs_diff_eq;
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// A run of so long, and a shorter one.
fn exponents(long: &str, short: &str) {
    let folder = Folder::new();
    let line = format!("lyapunov egg-crate-attractor --step 0.1 {long}");
    let found = folder.json(&format!("{line} --out run.csv --json"));
    let expected = [
        "scene",
        "method",
        "step",
        "duration",
        "energy",
        "exponents",
        "ci",
        "sum",
        "divergence_mean",
        "verdict",
        "convergence",
        "dimension",
    ];
    assert_eq!(keys(&found), expected);
    let (exponents, ci) = (numbers(&found["exponents"]), numbers(&found["ci"]));
    assert!(exponents.len() == 5 && exponents.is_sorted_by(|a, b| a >= b), "{exponents:?}");
    assert!(ci.iter().all(|ci| *ci > 0.0) && ci.len() == 5);
    let sum = found["sum"].as_f64().unwrap();
    assert_abs_diff_eq!(sum, exponents.iter().sum::<f64>(), epsilon = 1e-15);
    assert_abs_diff_eq!(sum, found["divergence_mean"].as_f64().unwrap(), epsilon = 1e-4);
    assert_abs_diff_eq!(found["energy"].as_f64().unwrap(), 1.2, epsilon = 1e-3);
    // The estimates on the way end where the run does.
    let (names, rows) = csv(&folder.read("run.csv"));
    assert_eq!(names[..2], ["t", "exponent_1"]);
    assert_eq!(rows.last().unwrap()[1..], exponents);
    let text = folder.done(&line);
    for told in ["exponent 5", "mean divergence", "dimension", "verdict"] {
        assert!(text.contains(told), "{told}: {text}");
    }
    // The start is given another energy by its velocities, and one exponent is the first of all.
    let line = format!("lyapunov egg-crate-attractor --step 0.1 {short} --energy 2 --exponents 1 --method dla --json");
    let one = folder.json(&line);
    assert_eq!(one["exponents"].as_array().unwrap().len(), 1);
    assert_abs_diff_eq!(one["energy"].as_f64().unwrap(), 2.0, epsilon = 1e-12);
    assert!(one.get("dimension").is_none() && one["ci"][0].is_f64());
}

#[test]
fn exponents_are_told_with_what_they_sum_up_to() {
    exponents("--duration 10 --settle 0", "--duration 10 --settle 0");
}

#[test]
#[ignore = "slow"]
fn exponents_are_told_with_what_they_sum_up_to_in_full() {
    exponents("--duration 300", "--duration 20");
}

/// Straight and unstable: backward with the centre of mass ahead. And a ridge in both directions, down which a sleigh slides.
const LINE: &str = "[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.5\n[start]\nspeed = -1.0\nturn_rate = 0.0\n\
    [run]\nstep = 0.1\nduration = 100.0\n";
const RIDGE: &str = "[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.0\n[start]\nx = 0.01\nspeed = 0.0\nturn_rate = 0.0\n\
    [run]\nstep = 0.05\nduration = 100.0\n[[effects]]\nkind = \"bowl\"\nstiffness = [-1.0, -1.0]\n";

/// To and fro along a line through the middle of a well.
const SWING: &str = "[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.0\n[start]\nspeed = 1.0\nturn_rate = 0.0\n\
    [run]\nstep = 0.1\nduration = 100.0\n[[effects]]\nkind = \"bowl\"\nstiffness = [1.0, 1.0]\n";

/// A positive exponent alone is no chaos. The commands, and the period of the orbit (s).
fn verdicts(lines: [&str; 2], orbit: &str, period: f64, ridge: &str) {
    let folder = Folder::new();
    folder.write("line.toml", LINE);
    folder.write("ridge.toml", RIDGE);
    folder.write("swing.toml", SWING);
    folder.write("well.toml", include_str!("../../docs/chaos/well.toml"));
    let line = folder.json(&format!("lyapunov line.toml {} --json", lines[0]));
    assert_eq!((&line["verdict"], &line["unstable"]), (&Value::from("steady"), &Value::from(true)));
    for ((exponent, ci), known) in numbers(&line["exponents"]).iter().zip(numbers(&line["ci"])).zip([0.4, 0.0]) {
        assert_abs_diff_eq!(*exponent, known, epsilon = ci);
    }
    let text = folder.done(&format!("lyapunov line.toml {}", lines[1]));
    assert!(text.contains("steady: ") && !text.contains("chaotic") && !text.contains("dimension"), "{text}");

    let orbit = folder.json(&format!("lyapunov {orbit} --json"));
    assert_eq!((&orbit["verdict"], &orbit["unstable"]), (&Value::from("periodic"), &Value::from(false)));
    assert_abs_diff_eq!(orbit["period"].as_f64().unwrap(), period, epsilon = 1e-3);

    let short = folder.json(&format!("lyapunov ridge.toml {ridge} --json"));
    assert_eq!((&short["verdict"], short.get("failure")), (&Value::from("running away"), None));
    assert_abs_diff_eq!(numbers(&short["exponents"])[0], 1.0, epsilon = 0.05);
}

#[test]
fn steady_periodic_and_runaway_motions_are_named() {
    let swing = "swing.toml --settle 0 --duration 60 --step 0.3";
    verdicts(["--duration 100 --step 0.5"; 2], swing, std::f64::consts::TAU, "--duration 20 --step 0.2");
}

#[test]
#[ignore = "slow"]
fn steady_periodic_and_runaway_motions_are_named_in_full() {
    let well = "well.toml --step 0.05 --energy 8 --settle 100 --duration 300";
    verdicts(["--duration 200"; 2], well, 6.8976, "--duration 20");
}

/// Later the exponents of the ridge have no digits, and the sum of all is not what it must be.
fn without_digits(rests: &[&str]) {
    let folder = Folder::new();
    folder.write("ridge.toml", RIDGE);
    for rest in rests {
        let outcome = folder.line(&format!("lyapunov ridge.toml {rest} --json"));
        assert_eq!(outcome.code, 1, "{rest}: {outcome:?}");
        for told in ["sum of the exponents", "by the divergence", "shorter steps"] {
            assert!(outcome.stderr.contains(told), "{rest}: {outcome:?}");
        }
        let found: Value = serde_json::from_str(&outcome.stdout).unwrap();
        assert_eq!(found["verdict"], Value::from("running away"), "{rest}");
        if let (Some(sum), Some(divergence)) = (found["sum"].as_f64(), found["divergence_mean"].as_f64()) {
            assert_abs_diff_eq!(sum, divergence, epsilon = 1e-2);
            assert_abs_diff_eq!(numbers(&found["exponents"])[0], 1.0, epsilon = 0.1);
        }
    }
}

#[test]
fn exponents_without_digits_are_an_error() {
    without_digits(&["--duration 60 --settle 60 --step 0.5"]);
}

#[test]
#[ignore = "slow"]
fn exponents_without_digits_are_an_error_in_full() {
    without_digits(&["--duration 60", "--duration 90", "--duration 60 --settle 60"]);
}

/// The free sleigh, a flywheel, and a turntable: `dla` and `gauss8` agree to the order of the first.
fn free_scenes(duration: &str) {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    for scene in ["scene.toml", "flywheel", "turntable"] {
        let sum = |method: &str| {
            let more = format!("--duration {duration} --settle 0 --method {method}");
            let found = folder.json(&format!("lyapunov {scene} --step 0.02 {more} --json"));
            assert_abs_diff_eq!(
                found["sum"].as_f64().unwrap(),
                found["divergence_mean"].as_f64().unwrap(),
                epsilon = if method == "dla" { 2e-3 } else { 2e-5 }
            );
            found["sum"].as_f64().unwrap()
        };
        assert_abs_diff_eq!(sum("dla"), sum("gauss8"), epsilon = 2e-3);
    }
}

#[test]
fn every_free_scene_has_exponents() {
    free_scenes("1");
}

#[test]
#[ignore = "slow"]
fn every_free_scene_has_exponents_in_full() {
    free_scenes("4");
}

fn maps(duration: &str) {
    let folder = Folder::new();
    let line = format!("lyapunov bowl --step 0.1 {duration} --map speed=-1:1:4 --map turn_rate=0:1:3");
    let on = |threads: &str, rest: &str| {
        let mut command = folder.command(format!("{line} {rest}").split_whitespace());
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let one = on("1", "--json");
    assert_eq!(one, on("3", "--json"));
    let found: Value = serde_json::from_str(&one).unwrap();
    let rows = found["exponents"].as_array().unwrap();
    assert_eq!((rows.len(), rows[0].as_array().unwrap().len(), &found["failed"]), (3, 4, &Value::from(0)));
    let verdicts = found["verdicts"].as_array().unwrap();
    assert_eq!((verdicts.len(), verdicts[0].as_array().unwrap().len()), (3, 4));
    assert!(verdicts.iter().flat_map(|row| row.as_array().unwrap()).all(Value::is_string));
    on("2", "--out map.csv");
    let (names, cells) = csv(&folder.read("map.csv"));
    assert_eq!((names.len(), cells.len()), (4, 12));
    assert_eq!(cells[5][2].to_bits(), found["exponents"][1][1].as_f64().unwrap().to_bits());
    // Cells that the energy does not allow stay empty.
    let text = on("2", "--energy -1 --out map.svg");
    assert!(text.contains("12 outside the energy surface") && folder.read("map.svg").starts_with("<svg"), "{text}");
}

#[test]
fn a_map_does_not_depend_on_the_threads() {
    maps("--duration 1 --settle 0");
}

#[test]
#[ignore = "slow"]
fn a_map_does_not_depend_on_the_threads_in_full() {
    maps("--duration 40");
}

/// Sections of `starts` starts over `duration` s, with at least `least` points of each start; and of `short` seconds.
fn points(starts: u32, duration: f64, least: usize, short: f64) {
    let folder = Folder::new();
    let line = format!("section bowl --step 0.1 --plane center_y=0.25 --starts {starts} --duration {duration}");
    let told = folder.done(&format!("{line} --out points.csv"));
    assert!(told.contains("center_y=0.25, rising"), "{told}");
    let (names, rows) = csv(&folder.read("points.csv"));
    assert_eq!(names, ["start", "t", "x", "y", "heading", "speed", "turn_rate", "shown_heading", "shown_turn_rate"]);
    let of = |start: u32| rows.iter().filter(|row| row[0].to_bits() == f64::from(start).to_bits()).count();
    assert!((0..starts).all(|start| of(start) >= least), "{told}");
    for row in &rows {
        let [x, y, heading, u, omega] = row[2..7] else { panic!("{row:?}") };
        let (sin, cos) = heading.sin_cos();
        let [cx, cy] = [x + 0.5 * cos, y + 0.5 * sin];
        // Located to rounding.
        assert_abs_diff_eq!(cy, 0.25, epsilon = 1e-13);
        // It rises: C' = u e + a omega n.
        assert!(u * sin + 0.5 * omega * cos > 0.0, "{row:?}");
        let energy = 0.5 * u * u + 0.625 * omega * omega + 0.05 * (cx * cx + cy * cy);
        assert_abs_diff_eq!(energy, 0.5 + 0.00625 + 0.0125, epsilon = 1e-7);
        assert!(row[7].abs() <= std::f64::consts::PI);
    }
    let found = folder.json(&format!("{line} --json"));
    let points: usize = found["starts"].as_array().unwrap().iter().map(|s| s["points"].as_array().unwrap().len()).sum();
    assert_eq!(points, rows.len());
    assert_eq!(found["starts"][0]["points"][0][1].as_f64().unwrap().to_bits(), rows[0][7].to_bits());
    let section = format!("section bowl --step 0.1 --plane heading=0 --duration {short}");
    folder.done(&format!("{section} --axes along,across --starts 2 --out points.svg"));
    assert!(folder.read("points.svg").contains("along [m]"));
    // Every column has a name of its own, and one that no other has keeps it.
    folder.done(&format!("{section} --axes along,speed --starts 1 --out axes.csv"));
    let (names, _) = csv(&folder.read("axes.csv"));
    assert_eq!(names[2..], ["x", "y", "heading", "speed", "turn_rate", "along", "shown_speed"]);
    // On the blade's line through the contact point lies the centre of mass, so both have one place across.
    folder.done("section bowl --step 0.1 --plane speed=0 --duration 6 --axes across,y --starts 1 --out across.csv");
    let (_, rows) = csv(&folder.read("across.csv"));
    assert!(!rows.is_empty(), "no point");
    for row in &rows {
        let (sin, cos) = row[4].sin_cos();
        assert_abs_diff_eq!(row[7], row[3] * cos - row[2] * sin, epsilon = 1e-12);
    }
}

#[test]
fn the_points_of_a_section_are_on_its_plane_and_of_one_energy() {
    points(2, 10.0, 1, 2.0);
}

#[test]
#[ignore = "slow"]
fn the_points_of_a_section_are_on_its_plane_and_of_one_energy_in_full() {
    points(3, 300.0, 4, 50.0);
}

/// DynamicalSystemsBase issue 175: the direction of a section was the other way round. On the circle `y = 1 - cos t` rises through 1/2 at
/// `pi/3 + 2 pi k`. A plane that is touched is not crossed.
#[test]
fn a_section_has_the_direction_that_was_asked_for() {
    use std::f64::consts::{FRAC_PI_3, TAU};
    let folder = Folder::new();
    let start = "[start]\nspeed = 1.0\nturn_rate = 1.0\n[run]\nstep = 0.1\nduration = 20.0\n";
    folder.write("circle.toml", format!("[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.0\n{start}"));
    let times = |plane: &str| -> Vec<f64> {
        let line = format!("section circle.toml --starts 1 --duration 20 --json --plane {plane}");
        let found = folder.json(&line);
        let points = found["starts"][0]["points"].as_array().unwrap();
        points.iter().map(|point| point[0].as_f64().unwrap()).collect()
    };
    let rising = [FRAC_PI_3, FRAC_PI_3 + TAU, FRAC_PI_3 + 2.0 * TAU, FRAC_PI_3 + 3.0 * TAU].map(|t| (t, t < 20.0));
    let rising: Vec<f64> = rising.into_iter().filter(|(_, within)| *within).map(|(t, _)| t).collect();
    let falling: Vec<f64> = [1.0, 2.0, 3.0].map(|k| k * TAU - FRAC_PI_3).to_vec();
    let mut both = [rising.clone(), falling.clone()].concat();
    both.sort_by(f64::total_cmp);
    for (direction, expected) in [("rising", rising), ("falling", falling), ("both", both)] {
        let found = times(&format!("y=0.5 --direction {direction}"));
        assert_eq!(found.len(), expected.len(), "{direction}: {found:?}");
        found.iter().zip(&expected).for_each(|(t, expected)| assert_abs_diff_eq!(*t, *expected, epsilon = 1e-12));
    }
    assert_eq!(times("y=2.000001 --direction both").len(), 0);
    assert_eq!(times("y=2 --direction both").len(), 0);
    // The control: a little lower it is crossed twice a turn, and samples that are as far apart may have missed some.
    let outcome = folder.line("section circle.toml --starts 1 --duration 20 --plane y=1.9999 --direction both --json");
    let found: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let start = &found["starts"][0];
    assert_eq!((start["points"].as_array().unwrap().len(), start["in_doubt"].as_u64()), (6, Some(3)));
    assert!(outcome.stderr.starts_with("warning: ") && outcome.stderr.contains("--step"), "{outcome:?}");
    let outcome = folder.line("section circle.toml --starts 1 --duration 20 --plane y=0.5");
    assert!(outcome.code == 0 && outcome.stderr.is_empty(), "{outcome:?}");
}

/// A section of one plane over `duration` s, and one at each of `periods` periods.
fn sections_in_time(duration: f64, periods: usize) {
    let folder = Folder::new();
    let outcome = folder.line(&format!("section shaker --plane speed=0 --starts 1 --duration {duration}"));
    assert!(
        outcome.code == 0 && outcome.stderr.starts_with("note: ") && outcome.stderr.contains("t=PERIOD"),
        "{outcome:?}"
    );
    let long = 1.5 * periods as f64 + 1.0;
    let found = folder.json(&format!("section shaker --plane t=1.5 --starts 1 --duration {long} --json"));
    let times: Vec<f64> =
        found["starts"][0]["points"].as_array().unwrap().iter().map(|point| point[0].as_f64().unwrap()).collect();
    assert_eq!(times.len(), periods);
    times.iter().zip(1..).for_each(|(t, k)| assert_abs_diff_eq!(*t, 1.5 * f64::from(k), epsilon = 1e-12));
}

#[test]
fn a_scene_that_depends_on_time_has_a_section_at_each_period() {
    sections_in_time(2.0, 2);
}

#[test]
#[ignore = "slow"]
fn a_scene_that_depends_on_time_has_a_section_at_each_period_in_full() {
    sections_in_time(20.0, 6);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = Folder::new();
    let jumps = "[[effects]]\nkind = \"thrust\"\nforce = { times = [0.0, 1.0], values = [0.0, 1.0] }\n";
    folder.write("jumps.toml", format!("{SCENE}{jumps}"));
    for (line, told) in [
        ("lyapunov bowl --exponents 6", &["--exponents", "1 to 5"][..]),
        ("lyapunov bowl --exponents 0", &["--exponents", "of 1 or more"]),
        ("lyapunov bowl --method gni", &["gni", "multiplier"]),
        ("lyapunov bowl --method rk4", &["gauss4"]),
        ("lyapunov bowl --method energy2", &["energy2", "gauss8"]),
        ("lyapunov bowl --method euler", &["euler"]),
        ("lyapunov bowl --duration 0", &["duration"]),
        ("lyapunov bowl --settle -1", &["--settle", "of 0 or more"]),
        ("lyapunov bowl --energy -3", &["--energy", "at rest"]),
        ("lyapunov bowl --out run.txt", &["run.txt", ".csv", ".svg"]),
        ("lyapunov planimeter", &["imposes velocities"]),
        ("lyapunov jumps.toml --duration 2", &["jump", "t = 1.0 s"]),
        ("lyapunov bowl --map speed=-1:1:4", &["--map", "twice"]),
        ("lyapunov bowl --map speed=-1:1:4 --map speed=-1:1:4", &["--map", "speed"]),
        ("lyapunov bowl --map speed=1:-1:4 --map y=0:1:4", &["NAME=FROM:TO:CELLS"]),
        ("lyapunov bowl --map speed=-1:1:0 --map y=0:1:4", &["NAME=FROM:TO:CELLS"]),
        ("lyapunov bowl --map along=-1:1:2 --map y=0:1:4", &["along", "turn_rate"]),
        ("section bowl", &["--plane"]),
        ("section bowl --plane z=0", &["`z`", "center_y"]),
        ("section bowl --plane y", &["NAME=VALUE"]),
        ("section bowl --plane y=nan", &["nan", "NAME=VALUE"]),
        ("section bowl --plane t=0", &["period"]),
        ("section bowl --plane t=1e-3", &["period", "step"]),
        ("section bowl --plane y=0 --starts 0", &["--starts", "of 1 or more"]),
        ("section bowl --plane y=0 --axes speed", &["--axes", "two different"]),
        ("section bowl --plane y=0 --axes speed,speed", &["--axes", "two different"]),
        ("section bowl --plane y=0 --direction up", &["--direction", "rising"]),
        ("section planimeter --plane y=0", &["imposes velocities"]),
    ] {
        folder.refused(line, told);
    }
    assert_eq!(folder.names(), ["jumps.toml"]);
}

/// A step that is too long ends the run: the known part is shown, and the exit code is 1.
#[test]
fn a_run_that_fails_says_so() {
    let folder = Folder::new();
    folder.write("scene.toml", crate::program::FAILING);
    for line in [
        "lyapunov scene.toml --method dla --settle 0 --duration 29",
        "section scene.toml --method dla --plane heading=0.1 --starts 1 --duration 29",
    ] {
        let outcome = folder.line(line);
        assert_eq!(outcome.code, 1, "{line}: {outcome:?}");
        assert!(!outcome.stdout.is_empty() && outcome.stderr.contains("error: "), "{line}: {outcome:?}");
    }
}
