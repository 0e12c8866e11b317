//! Scenes of systems of text: what the program makes of them, and what it says of wrong ones.

mod events;
mod steady;

mod analyses;

mod bodies;

mod corners;

mod paper;

mod reactions;

mod tables;

mod trains;

use crate::program::{Folder, TEXTS, csv, keys};

/// A skate on a slope.
const SKATE: &str = "\
title = \"A skate\"
[system]
coordinates = { x = \"m\", y = \"m\", theta = \"angle\" }
parameters = { m = 1.0, J = 0.5, g = 9.81 }
let = { c = \"cos(theta)\", s = \"sin(theta)\" }
lagrangian = \"m/2*(x'^2 + y'^2) + J/2*theta'^2 - m*g*sin(0.1)*x\"
constraints = [\"-x'*s + y'*c\"]
outputs = { speed = \"x'*c + y'*s\" }
[start]
\"x'\" = 1.0
theta_dot = 0.5
[run]
step = 0.02
duration = 2.0
";

/// The sleigh in the words of a text.
const SLEIGH: &str = "\
[system]
coordinates = { x = \"m\", y = \"m\", heading = \"angle\" }
parameters = { m = 1.0, I = 1.0, a = 0.5 }
lagrangian = \"\"\"m/2*((x' - a*heading'*sin(heading))^2 + (y' + a*heading'*cos(heading))^2) + I/2*heading'^2\"\"\"
constraints = [\"y'*cos(heading) - x'*sin(heading)\"]
basis = [[\"cos(heading)\", \"sin(heading)\", \"0\"], [\"0\", \"0\", \"1\"]]
[start]
\"x'\" = -1.0
\"heading'\" = 0.1
[run]
step = 0.05
duration = 20.0
";

/// That two numbers are the same, relative to the second or to one.
fn agree(a: &serde_json::Value, b: &serde_json::Value, within: f64) {
    let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
    assert!((a - b).abs() <= within * b.abs().max(1.0), "{a} {b}");
}

#[test]
fn a_run_tells_every_coordinate_rate_and_output() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let run = folder.json("run skate.toml --json --out run.csv");
    assert_eq!(keys(&run["final"]), ["t", "x", "y", "theta", "x'", "y'", "theta'", "speed"]);
    let [x, y] = ["x'", "y'"].map(|name| run["final"][name].as_f64().unwrap());
    let (sin, cos) = run["final"]["theta"].as_f64().unwrap().sin_cos();
    assert!((run["final"]["speed"].as_f64().unwrap() - (x * cos + y * sin)).abs() < 1e-15);
    assert!(run["constraint"]["max"].as_f64().unwrap() < 1e-15);
    assert!(run["energy"]["max_error"].as_f64().unwrap() < 1e-4);
    let (header, rows) = csv(&folder.read("run.csv"));
    let columns = ["t", "x", "y", "theta", "x'", "y'", "theta'", "energy", "work", "constraint", "speed"];
    assert_eq!(header, columns);
    assert_eq!(rows.len(), 101);
    assert!(
        folder.read("run.csv").starts_with("t [s],x [m],y [m],theta [rad],x' [m/s],y' [m/s],theta' [rad/s],energy [J]")
    );
    assert!(folder.done("run skate.toml").contains("theta'"));
}

#[test]
fn a_sleigh_of_text_is_the_sleigh() {
    same_motion(1.0);
}

#[test]
#[ignore = "slow"]
fn a_sleigh_of_text_is_the_sleigh_in_full() {
    same_motion(20.0);
}

/// The sleigh in the words of a text moves as the sleigh for so long, but for rounding in every step.
fn same_motion(duration: f64) {
    let folder = Folder::new();
    folder.write("sleigh.toml", SLEIGH);
    folder.write("own.toml", crate::program::SCENE);
    for method in ["dla", "dla4", "lobatto4", "gauss8", "energy4", "rk4"] {
        let flags = format!("--json --method {method} --duration {duration}");
        let end = |scene: &str| folder.json(&format!("run {scene} {flags}"))["final"].clone();
        let (text, own) = (end("sleigh.toml"), end("own.toml"));
        for name in ["x", "y", "heading"] {
            agree(&text[name], &own[name], 1e-12 * duration / 20.0);
        }
    }
}

#[test]
fn a_check_tells_shape_rank_and_geometry() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let told = folder.done("check skate.toml");
    for words in ["x [m], y [m], theta [rad]", "1, rank 1", "nonholonomic", "(2, 3)", "derived", "energy", "0.5625 J"] {
        assert!(told.contains(words), "{words}: {told}");
    }
}

#[test]
fn a_comparison_has_a_row_for_each_method() {
    compared(&["dla", "gauss8"], 0.5);
}

#[test]
#[ignore = "slow"]
fn a_comparison_has_a_row_for_each_method_in_full() {
    compared(&["dla", "rk4", "gauss8", "energy4"], 2.0);
}

fn compared(methods: &[&str], duration: f64) {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let methods = methods.join(",");
    let line = format!("compare skate.toml --methods {methods} --duration {duration} --json --report page");
    let compared = folder.json(&line);
    let rows = compared["rows"].as_array().unwrap();
    assert_eq!(rows.len(), methods.split(',').count());
    for row in rows {
        // Errors grow with the time at least.
        assert!(row["error"].as_f64().unwrap() < 1e-3 * duration / 2.0, "{row}");
        assert!(row["final"]["speed"].is_f64());
    }
    assert!(folder.read("page/index.html").contains("A skate"));
}

/// What moves in a start is told.
#[test]
fn a_start_that_slips_is_moved_with_a_note() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE.replace("theta_dot = 0.5", "\"y'\" = 0.5"));
    let outcome = folder.noslip(["run", "skate.toml"]);
    assert_eq!(outcome.code, 0);
    assert!(outcome.stderr.contains("note: the constraints do not admit y' = 0.5"), "{}", outcome.stderr);
}

#[test]
fn errors_show_file_line_column_and_what_is_known() {
    let folder = Folder::new();
    let cases = [
        ("- m*g*sin(0.1)*x", "- m*gg*x", "bad.toml:6:52", "no name `gg` is known here"),
        ("y'*c\"]", "y'*y'\"]", "bad.toml:7:16", "not affine in the rates"),
        ("theta_dot = 0.5", "thet_dot = 0.5", "bad.toml:11:1", "theta_dot"),
        ("outputs", "output", "bad.toml:8:1", "outputs"),
        ("[start]", "[[effects]]\nkind = \"drag\"\n[start]", "bad.toml:9", "add potentials to `lagrangian`"),
        ("lagrangian = ", "lagrangean = ", "bad.toml:6:1", "did you mean `lagrangian`"),
        ("m = 1.0", "m = \"1\"", "bad.toml:4:20", "finite number"),
        ("- m*g*sin(0.1)*x", "- m*g*log(x)", "bad.toml:9", "at the start"),
    ];
    for (from, to, place, words) in cases {
        assert!(SKATE.contains(from));
        folder.write("bad.toml", SKATE.replacen(from, to, 1));
        let outcome = folder.noslip(["check", "bad.toml"]);
        assert_eq!(outcome.code, 2, "{to}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(place) && outcome.stderr.contains(words), "{to}: {}", outcome.stderr);
    }
}

#[test]
fn what_is_not_done_is_refused_with_its_reason() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    for command in ["phase skate.toml", "equilibria skate.toml --picture p.svg"] {
        folder.refused(command, &["system of text"]);
    }
}

/// Whose equations take seconds to derive.
const LONG: [&str; 2] = ["bicycle", "ball-in-bowl"];

#[test]
fn equations_are_those_of_the_book() {
    equations(TEXTS.into_iter().filter(|scene| !LONG.contains(scene)));
}

#[test]
#[ignore = "slow"]
fn equations_are_those_of_the_book_at_length() {
    equations(TEXTS.into_iter());
}

/// The skate of the test has the equations of the book in its own basis: `u' = g sin(slope) cos(theta)`, `theta'' = 0`; these scenes have as many
/// as they have unknowns; a sleigh is refused.
fn equations(scenes: impl Iterator<Item = &'static str>) {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let told = folder.json("equations skate.toml --json");
    assert_eq!(told["unknowns"], serde_json::json!(["x", "y", "theta", "xi1", "xi2"]));
    assert_eq!(told["rates"].as_array().unwrap().len(), 5);
    assert_eq!(told["rates"][4], "0");
    assert_eq!(told["start"].as_array().unwrap().len(), 5);
    let shown = folder.done("equations skate.toml");
    assert!(shown.contains("xi2' = 0") && shown.contains("theta' = xi2"), "{shown}");
    for scene in scenes {
        let told = folder.json(&format!("equations {scene} --json"));
        assert_eq!(told["rates"].as_array().unwrap().len(), told["start"].as_array().unwrap().len(), "{scene}");
    }
    folder.refused("equations turnaround", &["turnaround is a sleigh"]);
}

/// A run goes on from its checkpoint to the same bits.
#[test]
fn runs_resume() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let whole = folder.json("run skate.toml --json");
    folder.done("run skate.toml --checkpoint saved --checkpoint-every 30");
    let resumed = folder.json("run skate.toml --json --resume saved");
    assert_eq!(whole["final"], resumed["final"]);
}

#[test]
fn bundled_texts_run() {
    texts_run("0.1", TEXTS.into_iter().filter(|scene| *scene != "bicycle"));
}

#[test]
#[ignore = "slow"]
fn bundled_texts_run_at_length() {
    texts_run("1", TEXTS.into_iter());
}

/// All for so long, and these are checked too.
fn texts_run(duration: &str, checked: impl Iterator<Item = &'static str>) {
    let folder = Folder::new();
    for scene in TEXTS {
        let run = folder.json(&format!("run {scene} --json --duration {duration}"));
        assert!(run["constraint"]["max"].as_f64().unwrap() < 1e-10, "{run}");
    }
    for scene in checked {
        assert!(folder.done(&format!("check {scene}")).contains("valid"), "{scene}");
    }
}

#[test]
fn precision_measures_a_system_of_text() {
    precision("0.1", "0.02");
}

#[test]
#[ignore = "slow"]
fn precision_measures_a_system_of_text_at_length() {
    precision("2.0", "0.02");
}

/// What accuracy costs is measured on the coordinates.
fn precision(duration: &str, longest: &str) {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE.replace("duration = 2.0", &format!("duration = {duration}")));
    let measured = folder.json(&format!("precision skate.toml --methods dla,gauss8 --longest {longest} --json"));
    assert!(measured["reference"]["error"].as_f64().unwrap() < 1e-11, "{measured}");
    let points = measured["points"].as_array().unwrap();
    for method in ["dla", "gauss8"] {
        assert!(
            points.iter().filter(|point| point["method"] == method && point["error"].is_f64()).count() > 1,
            "{method}"
        );
    }
}

/// The eigenvalues that the benchmark of the bicycle has at three speeds, in the order weave or the slow pair, capsize, castering.
#[test]
#[ignore = "slow"]
fn the_bicycle_has_the_eigenvalues_of_the_benchmark() {
    let folder = Folder::new();
    let benchmark: [(f64, &[[f64; 2]]); 3] = [
        (4.0, &[[0.41325331521125, 3.07910818603206], [-1.42944427361326, 0.0], [-12.15861426576447, 0.0]]),
        (5.0, &[[-0.77534188219585, 4.46486771378823], [-0.32286642900409, 0.0], [-14.07838969279822, 0.0]]),
        (10.0, &[[-3.72016840437287, 10.90681139476287], [0.16105338653172, 0.0], [-24.62459635017404, 0.0]]),
    ];
    for (speed, values) in benchmark {
        let found = folder.noslip([
            "equilibria",
            "bicycle",
            "--json",
            "--set",
            &format!("start.x'={speed}"),
            "--set",
            "start.phi'=0",
        ]);
        assert_eq!(found.code, 0, "{}", found.stderr);
        let found: serde_json::Value = serde_json::from_str(&found.stdout).unwrap();
        let steady = found["equilibria"].as_array().unwrap();
        let ahead = |e: &&serde_json::Value| (e["rates"]["x'"].as_f64().unwrap() - speed).abs() < 1e-9;
        let steady = steady.iter().find(ahead).unwrap_or_else(|| panic!("{found}"));
        let flow: Vec<[f64; 2]> = steady["flow"]
            .as_array()
            .unwrap()
            .iter()
            .map(|value| ["re", "im"].map(|part| value[part].as_f64().unwrap()))
            .collect();
        for value in values {
            let nearest =
                flow.iter().map(|[re, im]| f64::hypot(re - value[0], im - value[1])).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-9, "{speed} m/s: {value:?} is {nearest:e} from {flow:?}");
        }
    }
}

/// A thin disk that rolls upright: `lambda^2 = 4/5 (g/r - 3 spin^2)`, on both sides of its threshold.
#[test]
#[ignore = "slow"]
fn the_disk_is_stable_above_its_threshold() {
    let folder = Folder::new();
    for spin in [1.5_f64, 2.0] {
        let spun = format!("start.psi'={spin}");
        let found = folder.noslip(["equilibria", "falling-disk", "--json", "--set", &spun, "--set", "start.theta=0"]);
        assert_eq!(found.code, 0, "{}", found.stderr);
        let found: serde_json::Value = serde_json::from_str(&found.stdout).unwrap();
        let rate = |e: &serde_json::Value, name: &str| e["rates"][name].as_f64().unwrap();
        let upright = |e: &&serde_json::Value| (rate(e, "psi'") - spin).abs() < 1e-9 && rate(e, "phi'").abs() < 1e-9;
        let steady = found["equilibria"].as_array().unwrap().iter().find(upright).unwrap();
        let square = 0.8 * (9.81 - 3.0 * spin * spin);
        let part = if square < 0.0 { "im" } else { "re" };
        let numbers = steady["flow"].as_array().unwrap().iter().map(|value| value[part].as_f64().unwrap());
        let largest = numbers.fold(0.0, f64::max);
        assert!((largest - square.abs().sqrt()).abs() < 1e-9, "{spin}: {largest}");
        assert_eq!(steady["stable"].as_bool(), Some(square < 0.0));
    }
}
