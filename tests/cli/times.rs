//! Times, and numbers that are not finite: no scene without a valid step, no run without an end, no NaN with exit code 0.

use crate::program::{Folder, SCENE, csv};
use std::f64::consts::TAU;

fn servo(duration: f64, times: &[f64], speed: &[f64], turn_rate: &[f64]) -> String {
    let text = SCENE.replace("duration = 2.0", &format!("duration = {duration:?}"));
    format!(
        "{text}[[effects]]\nkind = \"servo\"\nspeed = {{ times = {times:?}, values = {speed:?} }}\n\
         turn_rate = {{ times = {times:?}, values = {turn_rate:?} }}\n"
    )
}

/// Drives of 5 s, a turn of 2 pi at 1 rad/s between them: no step divides all of it.
fn two_pi() -> String {
    servo(10.0 + TAU, &[0.0, 5.0, 5.0 + TAU], &[0.2, 0.0, 0.2], &[0.0, 1.0, 0.0])
}

#[test]
fn every_scene_has_a_valid_step() {
    valid_steps(&["dla", "gauss8", "dop853"], "compare turn.toml --methods dla,rk4");
}

#[test]
#[ignore = "slow"]
fn every_scene_has_a_valid_step_in_full() {
    let compared = "compare turn.toml --methods dla,rk4,gauss8 --report pages";
    valid_steps(&["dla", "dla4", "gauss8", "rk4", "dop853"], compared);
}

fn valid_steps(methods: &[&str], compared: &str) {
    let folder = Folder::new();
    folder.write("turn.toml", two_pi());
    for method in methods {
        folder.done(&format!("run turn.toml --method {method} --out {method}.csv"));
        let (_, rows) = csv(&folder.read(&format!("{method}.csv")));
        let last = rows.last().unwrap();
        assert!((last[1] - 2.0).abs() < 1e-9 && (last[3] - TAU).abs() < 1e-9, "{method}: {last:?}");
        for jump in [0.0, 5.0, 5.0 + TAU, 10.0 + TAU] {
            let off = rows.iter().map(|row| (row[0] - jump).abs()).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-12, "{method}: no node at {jump}, but {off} away");
        }
        assert!(rows.windows(2).all(|pair| pair[1][0] - pair[0][0] <= 0.05 * (1.0 + 1e-9)), "{method}");
    }
    // The command line may ask for any duration and step.
    for flags in ["--duration 7.77", "--duration 8 --step 0.02", "--step 0.037", "--duration 3", "--step 3"] {
        folder.done(&format!("run turn.toml {flags}"));
    }
    folder.done("check turn.toml");
    folder.done(compared);
}

#[test]
fn a_run_with_steps_of_its_own_is_resumed_to_the_same_bits() {
    let folder = Folder::new();
    folder.write("turn.toml", two_pi());
    let whole = folder.json("run turn.toml --json");
    folder.done("run turn.toml --checkpoint a.save --checkpoint-every 130");
    // The last checkpoint is that of the end; one in the middle is what an interrupted run leaves.
    let again = folder.json("run turn.toml --json --resume a.save");
    for key in ["final", "energy", "constraint", "steps", "step"] {
        assert_eq!(whole[key], again[key], "{key}");
    }
}

#[test]
fn the_file_is_judged_after_the_command_line() {
    let folder = Folder::new();
    folder.write("long.toml", SCENE.replace("step = 0.05", "step = 5.0"));
    folder.refused("run long.toml", &["long.toml:10:8", "`run.step`", "at most the duration"]);
    folder.done("run long.toml --step 0.1");
    folder.done("run long.toml --duration 50 --method dop853");
    folder.write("other.toml", SCENE.replace("[run]", "[run]\nmethod = \"euler\""));
    folder.refused("run other.toml", &["other.toml:10:10", "`run.method`", "euler"]);
    folder.done("run other.toml --method rk4");
    folder.refused("run other.toml --method nope", &["--method", "nope"]);
    folder.refused("run long.toml --duration 1", &["--duration", "at least the step, 5.0 s"]);
}

#[test]
fn an_energy_that_is_not_finite_is_refused_with_its_field() {
    let folder = Folder::new();
    folder.write("fast.toml", SCENE.replace("speed = -1.0", "speed = 1e308"));
    folder.write("spin.toml", SCENE.replace("turn_rate = 0.1", "turn_rate = 1e200"));
    folder.write("heavy.toml", SCENE.replace("mass = 1.0", "mass = 1e308").replace("speed = -1.0", "speed = 10.0"));
    folder.write(
        "far.toml",
        format!(
            "{}[[effects]]\nkind = \"bowl\"\nstiffness = [1.0, 1.0]\n",
            SCENE.replace("[start]", "[start]\nx = 1e200")
        ),
    );
    folder.write("driven.toml", servo(3.0, &[0.0, 1.0, 2.0], &[1.0, 1e308, 0.0], &[0.0, 0.0, 0.0]));
    for command in ["check", "run", "compare"] {
        folder.refused(
            &format!("{command} fast.toml"),
            &["fast.toml:7:9", "`start.speed`", "kinetic energy", "accepted"],
        );
        folder.refused(&format!("{command} spin.toml"), &["`start.turn_rate`", "kinetic energy"]);
        folder.refused(&format!("{command} heavy.toml"), &["`start.speed`", "kinetic energy"]);
        folder.refused(&format!("{command} far.toml"), &["`start.x`", "not a finite number"]);
        folder.refused(&format!("{command} driven.toml"), &["`effects.servo.speed`", "kinetic energy", "m/s"]);
    }
    // The control: large, and finite.
    folder.write("large.toml", SCENE.replace("speed = -1.0", "speed = 1e150"));
    folder.done("check large.toml");
}

#[test]
fn everything_has_a_limit() {
    let folder = Folder::new();
    folder.refused("lyapunov valley --duration 50 --settle 1e308", &["--settle", "1e12 steps", "accepted: at most"]);
    folder.refused("phase planimeter --loops 1000000000000000000", &["--loops", "1e12 steps", "accepted: at most"]);
    let slow = "[[effects]]\nkind = \"tracer\"\npath = { circle = { radius = 0.1 }, period = 9e18 }\n";
    folder.write("slow.toml", format!("{SCENE}{slow}"));
    folder.refused("phase slow.toml --loops 3", &["--loops", "1e12 steps"]);
    folder.refused("precision turnaround --longest 1e19", &["--longest", "at most 86400"]);
    folder.refused("lyapunov valley --map x=0:1:3", &["--map must be given twice"]);
}

#[test]
fn control_signs_of_a_title_are_written_out() {
    let folder = Folder::new();
    let title = "title = \"a\\u001b[31mred\\u001b]0;window title\\u0007\"";
    folder.write("title.toml", SCENE.replace("title = \"A test\"", title));
    for command in ["check", "run", "compare --methods dla,rk4", "cost"] {
        let text = folder.done(&format!("{command} title.toml"));
        assert!(!text.contains(['\u{1b}', '\u{7}']) && text.contains("a\\u{1b}[31mred"), "{command}: {text}");
    }
}
