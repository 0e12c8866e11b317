//! What a run looks for on the way, and what is told of it, for systems of text.

use super::{SKATE, SLEIGH, agree};
use crate::program::Folder;
use serde_json::Value;
use std::f64::consts::{PI, TAU};

fn times(run: &Value) -> Vec<f64> {
    run["events"].as_array().unwrap().iter().map(|event| event["t"].as_f64().unwrap()).collect()
}

/// The knife edge turns at 1 rad/s, and its speed is `0.5 + g sin(slope) sin(t)`.
#[test]
fn events_are_coordinates_rates_and_outputs() {
    let folder = Folder::new();
    let run = |flags: &str| folder.json(&format!("run knife-edge --method gauss16 --step 0.25 --json {flags}"));
    let near = |found: &[f64], known: &[f64]| {
        assert_eq!(found.len(), known.len(), "{found:?}");
        found.iter().zip(known).for_each(|(a, b)| assert!((a - b).abs() < 1e-9, "{a} {b}"));
    };
    // An angle crosses its value in every turn, one whose turns count in one.
    near(&times(&run("--event theta=1.5")), &[1.5, 1.5 + TAU, 1.5 + 2.0 * TAU]);
    near(&times(&run("--event unwrapped_theta=7")), &[7.0]);
    near(&times(&run("--event speed=0.5 --duration 10")), &[PI, 2.0 * PI, 3.0 * PI]);
    let push = 9.81 * 0.1_f64.sin();
    // v cos(theta), at the first time at which it falls to zero: where the blade points across the slope.
    near(&times(&run("--event x_dot=0 --duration 2")), &[0.5 * PI]);
    let energy = 0.5 * 0.25 + 0.25;
    assert!(times(&run(&format!("--event energy={} --duration 10", energy + 1.0))).is_empty());
    let ended = run("--until theta=2 --event speed=1");
    near(&times(&ended), &[(0.5 / push).asin(), 2.0]);
    assert!((ended["final"]["t"].as_f64().unwrap() - 2.0).abs() < 1e-9);
    let event = &ended["events"][0];
    assert!((event["speed"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{event}");
    assert_eq!(event["rising"].as_bool(), Some(true));
}

/// `sin(W t + 0.3)`, whose turns are shorter than the steps, has a zero in every half turn; where it is quicker than any samples show that
/// is said.
#[test]
fn fast_outputs_are_found_or_in_doubt() {
    let folder = Folder::new();
    folder.write(
        "fast.toml",
        "[system]\ncoordinates = { x = \"m\" }\nlagrangian = \"x'^2/2\"\noutputs = { o = \"sin(W*t + 0.3)\" }\n\
         parameters = { W = 1000.0 }\n[start]\n\"x'\" = 1.0\n[run]\nstep = 0.1\nduration = 2.0\n",
    );
    for (rate, count) in [(220.0, 140), (250.0, 159), (1000.0, 636)] {
        let run = folder.json(&format!("run fast.toml --set system.parameters.W={rate} --event o=0 --json"));
        let found = times(&run);
        assert_eq!((found.len(), run["events_in_doubt"].as_u64()), (count, Some(0)), "{rate}");
        for (k, t) in found.iter().enumerate() {
            assert!((t - ((k + 1) as f64 * PI - 0.3) / rate).abs() < 1e-12, "{rate}: {k} {t}");
        }
    }
    let outcome = folder.line("run fast.toml --set system.parameters.W=1e7 --duration 0.3 --event o=0");
    assert!(outcome.code == 0 && outcome.stderr.contains("in 3 steps"), "{outcome:?}");
    // Near crossings are told with how near they are, and how far the samples are apart.
    let swing = folder.read("fast.toml").replace("x'^2/2", "(x'^2 - x^2)/2").replace("= 2.0", "= 3.0");
    folder.write("swing.toml", swing);
    let outcome = folder.line("run swing.toml --method gauss8 --event x=0.99999999 --json");
    let run: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let found = times(&run);
    let apart = format!("only {:.2e} s, and samples are up to 2.50e-2 s apart", found[1] - found[0]);
    assert!(found.len() == 2 && outcome.stderr.contains(&apart), "{outcome:?}");
}

/// The contact point of the disk runs on a circle of radius `R phi' / theta'`.
#[test]
fn the_disk_meets_lines_where_its_circle_does() {
    let folder = Folder::new();
    let run = folder.json("run rolling-disk --method gauss16 --json --event x=1 --duration 8 --out disk.csv");
    let first = 0.7_f64.asin() / 0.7;
    let found = times(&run);
    for (a, b) in found.iter().zip([first, PI / 0.7 - first]) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    assert_eq!(found.len(), 2);
    assert!(folder.done("run rolling-disk --until y=1").contains("y=1, rising"));
}

#[test]
fn a_quantity_that_is_none_is_refused_with_those_there_are() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let known = ["`spede`", "theta'", "speed", "energy", "unwrapped_theta"];
    folder.refused("run skate.toml --event spede=0 --out run.csv", &known);
    folder.refused("run rolling-disk --until heading=0", &["`heading`", "phi, theta, x'"]);
    folder.refused("run skate.toml --event speed", &["NAME=VALUE"]);
    assert_eq!(folder.names(), ["skate.toml"]);
}

/// The same events at the same times as of the sleigh, with the same states.
#[test]
fn events_of_a_sleigh_of_text_are_those_of_the_sleigh() {
    let folder = Folder::new();
    folder.write("sleigh.toml", SLEIGH);
    folder.write("own.toml", crate::program::SCENE);
    let flags = "--method gauss16 --duration 20 --json --event heading=1 --event x=-2 --event y=0.1";
    let found = |scene: &str| folder.json(&format!("run {scene} {flags}"))["events"].clone();
    let (text, own) = (found("sleigh.toml"), found("own.toml"));
    let (text, own) = (text.as_array().unwrap(), own.as_array().unwrap());
    assert!(text.len() == own.len() && text.len() >= 3, "{text:?} {own:?}");
    for (a, b) in text.iter().zip(own) {
        assert_eq!((&a["event"], &a["rising"]), (&b["event"], &b["rising"]));
        for name in ["t", "x", "y", "heading"] {
            agree(&a[name], &b[name], 1e-11);
        }
    }
}

/// What is beside a file says which scene made it, with the numbers that were used, and that scene makes it again.
#[test]
fn the_scene_beside_a_file_makes_it_again() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE.replace("theta_dot = 0.5", "\"y'\" = 0.5"));
    for scene in ["skate.toml", "bicycle", "snakeboard"] {
        let line = format!("run {scene} --set start.x=0.25 --duration 0.5 --out run.csv --force");
        assert_eq!(folder.line(&line).code, 0);
        let beside: Value = serde_json::from_str(&folder.read("run.csv-metadata.json")).unwrap();
        folder.write("again.toml", beside["notes"][0]["scene"].as_str().unwrap());
        folder.done("run again.toml --duration 0.5 --out again.csv --force");
        let rows = |name: &str| crate::program::csv(&folder.read(name));
        let ((names, first), (again, second)) = (rows("run.csv"), rows("again.csv"));
        assert_eq!(names, again);
        for (a, b) in first.iter().flatten().zip(second.iter().flatten()) {
            assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0), "{scene}: {a} {b}");
        }
    }
}

/// Of two coordinates, which is less to draw.
#[test]
fn a_run_of_text_makes_a_page() {
    let folder = Folder::new();
    folder.write(
        "spring.toml",
        "[system]\ncoordinates = { along = \"m\", across = \"m\" }\nlagrangian = \"(along'^2 + across'^2 - along^2)/2\"\n\
         constraints = [\"across' - along*along'\"]\n[start]\nalong = 1.0\n[run]\nstep = 0.05\nduration = 0.5\n",
    );
    assert_page(&folder, "spring.toml", "across");
}

#[test]
#[ignore = "slow"]
fn a_run_of_text_makes_a_page_at_length() {
    let folder = Folder::new();
    for scene in ["rolling-disk", "bicycle"] {
        assert_page(&folder, &format!("{scene} --duration 1"), "theta");
    }
}

fn assert_page(folder: &Folder, run: &str, named: &str) {
    folder.done(&format!("run {run} --report page --force"));
    let page = folder.read("page/index.html");
    assert!(page.contains(named) && page.contains("<svg"), "{run}");
}
