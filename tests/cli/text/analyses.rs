//! Exponents, sections, sweeps and costs of systems of text, beside known values and beside the sleigh.

use super::{SKATE, SLEIGH, agree};
use crate::program::{Folder, SCENE, csv};
use serde_json::Value;
use std::f64::consts::TAU;

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// What a zero exponent may show over `time`, after `before`: see the page on chaos.
fn bias(before: f64, time: f64) -> f64 {
    3.0 * (time / before).ln_1p() / time
}

#[test]
fn integrable_systems_have_no_exponent_but_zero() {
    integrable(1.0, 4.0);
}

#[test]
#[ignore = "slow"]
fn integrable_systems_have_no_exponent_but_zero_in_full() {
    integrable(6.0, 60.0);
}

/// Everything about these two is known in closed form: neighbours part company like powers of the time. The blade of the knife edge
/// turns round, so that its derived basis changes on the way.
fn integrable(settle: f64, duration: f64) {
    let folder = Folder::new();
    for (scene, count) in [("rolling-disk", 6), ("knife-edge", 5)] {
        let line = format!("lyapunov {scene} --duration {duration} --settle {settle} --step 0.05 --json");
        let found = folder.json(&line);
        let exponents = numbers(&found["exponents"]);
        assert_eq!(exponents.len(), count, "{scene}");
        let most = bias(settle, duration);
        assert!(exponents.iter().all(|exponent| exponent.abs() < most), "{scene}: {exponents:?}");
        let [sum, mean] = ["sum", "divergence_mean"].map(|name| found[name].as_f64().unwrap());
        // The divergence in the derived basis is summed up by the trapezoidal rule.
        assert!((sum - mean).abs() < 0.05_f64.powi(2) && sum.abs() < most, "{scene}: {sum} {mean}");
        assert_ne!(found["verdict"], "chaotic", "{scene}");
    }
    // The disk rolls evenly, which is seen in a basis that moves with it.
    let basis = r#"system.basis=[["R*cos(theta)","R*sin(theta)","1","0"],["0","0","0","1"]]"#;
    let line = format!("lyapunov rolling-disk --set {basis} --duration {} --json", duration.min(20.0));
    assert_eq!(folder.json(&line)["verdict"], "steady");
}

#[test]
fn exponents_do_not_depend_on_the_coordinates_of_a_pendulum() {
    pendulum("10", &["gauss8", "dla"], 0.15);
}

#[test]
#[ignore = "slow"]
fn exponents_do_not_depend_on_the_coordinates_of_a_pendulum_at_length() {
    // The end of `gauss4` is moved onto the circle by more than the derivative of its step allows for, and is refused.
    pendulum("300", &["gauss8", "dla", "dla4", "gauss6"], 0.15);
}

/// A driven pendulum by its angle, and by two coordinates on a circle: directions off the circle have no exponent. One motion, and where
/// it is chaotic and long the same two exponents to their scatter; the sum is minus the friction.
fn pendulum(duration: &str, methods: &[&str], within: f64) {
    let folder = Folder::new();
    let run = "[run]\nstep = 0.05\nduration = 100.0\n";
    folder.write(
        "angle.toml",
        format!(
            "[system]\ncoordinates = {{ th = \"angle\" }}\nlagrangian = \"th'^2/2 + cos(th)\"\n\
             forces = {{ th = \"-0.5*th' + 1.15*cos(2*t/3)\" }}\n[start]\nth = 0.5\n{run}"
        ),
    );
    folder.write(
        "circle.toml",
        format!(
            "[system]\ncoordinates = {{ x = \"m\", y = \"m\" }}\nlagrangian = \"(x'^2 + y'^2)/2 - y\"\n\
             positions = [\"x^2 + y^2 - 1\"]\nforces = {{ x = \"-0.5*x' - y*1.15*cos(2*t/3)\", \
             y = \"-0.5*y' + x*1.15*cos(2*t/3)\" }}\n[start]\nx = 0.479425538604203\ny = -0.8775825618903728\n{run}"
        ),
    );
    for method in methods {
        let [angle, circle] = ["angle", "circle"].map(|scene| {
            folder.json(&format!("lyapunov {scene}.toml --method {method} --duration {duration} --settle 1 --json"))
        });
        let [angle, circle] = [angle, circle].map(|found| {
            let exponents = numbers(&found["exponents"]);
            assert!(found.get("dimension").is_some() && found.get("failure").is_none(), "{method}: {found}");
            assert!((exponents.iter().sum::<f64>() + 0.5).abs() < within, "{method}: {found}");
            exponents
        });
        assert_eq!((angle.len(), circle.len()), (2, 2), "{method}");
        for (a, b) in angle.iter().zip(&circle) {
            assert!((a - b).abs() < within, "{method}: {angle:?} {circle:?}");
        }
    }
    folder.refused("lyapunov circle.toml --exponents 3", &["from 1 to 2"]);
}

#[test]
fn a_disk_that_falls_has_the_exponent_of_its_fall() {
    falling("4", "10");
}

#[test]
#[ignore = "slow"]
fn a_disk_that_falls_has_the_exponent_of_its_fall_in_full() {
    falling("30", "10");
}

/// A thin disk that rolls upright too slowly falls at the rate `lambda^2 = 4/5 (g/r - 3 spin^2)`; its shape has room for one coordinate more.
fn falling(duration: &str, settle: &str) {
    let folder = Folder::new();
    let found = folder.noslip([
        "lyapunov",
        "falling-disk",
        "--set",
        "start.psi'=1.5",
        "--set",
        "start.theta=0",
        "--duration",
        duration,
        "--settle",
        settle,
        "--step",
        "0.05",
        "--json",
    ]);
    assert_eq!(found.code, 0, "{}", found.stderr);
    let found: Value = serde_json::from_str(&found.stdout).unwrap();
    let exponents = numbers(&found["exponents"]);
    let falls = (0.8_f64 * (9.81 - 3.0 * 1.5 * 1.5)).sqrt();
    assert_eq!(exponents.len(), 8);
    for (exponent, known) in [(exponents[0], falls), (exponents[7], -falls)] {
        assert!((exponent - known).abs() < 1e-5, "{exponent} {known}");
    }
    assert_eq!((found["verdict"].as_str(), found["unstable"].as_bool()), (Some("steady"), Some(true)));
}

#[test]
fn a_sleigh_of_text_has_the_exponents_and_sections_of_the_sleigh() {
    same_analyses([("1.5", "0.5"), ("1", "0.5")], ("0.1", "1.5"));
}

#[test]
#[ignore = "slow"]
fn a_sleigh_of_text_has_the_exponents_and_sections_of_the_sleigh_in_full() {
    same_analyses([("20", "2"), ("5", "1")], ("1", "20"));
}

/// The numbers of the sleigh and of the sleigh in the words of a text are the same: exponents and maps of such durations and times to settle, and a
/// section through a heading for so long.
fn same_analyses([exponents, map]: [(&str, &str); 2], (heading, duration): (&str, &str)) {
    let folder = Folder::new();
    folder.write("text.toml", SLEIGH);
    folder.write("own.toml", SCENE);
    let both = |line: &str| ["text", "own"].map(|scene| folder.json(&line.replace("SCENE", &format!("{scene}.toml"))));
    for method in ["gauss8", "dla"] {
        let (duration, settle) = exponents;
        let flags = format!("--step 0.05 --duration {duration} --settle {settle} --json");
        let [text, own] = both(&format!("lyapunov SCENE --method {method} {flags}"));
        for (a, b) in text["exponents"].as_array().unwrap().iter().zip(own["exponents"].as_array().unwrap()) {
            agree(a, b, 1e-8);
        }
        agree(&text["divergence_mean"], &own["divergence_mean"], 1e-9);
        assert_eq!(text["verdict"], own["verdict"]);
    }
    let flags = format!("--axes y,x --direction both --duration {duration} --step 0.05 --json");
    let [text, own] = both(&format!("section SCENE --plane heading={heading} {flags}"));
    let points = |found: &Value| found["starts"][0]["points"].as_array().unwrap().clone();
    let (text, own) = (points(&text), points(&own));
    assert!(!own.is_empty() && text.len() == own.len());
    for (a, b) in text.iter().zip(&own) {
        (0..3).for_each(|k| agree(&a[k], &b[k], 1e-9));
    }
    let flags = format!("--step 0.05 --duration {} --settle {} --json", map.0, map.1);
    let [text, own] = both(&format!("lyapunov SCENE --map x=0:1:2 --map heading=0:1:2 {flags}"));
    for (a, b) in text["exponents"].as_array().unwrap().iter().zip(own["exponents"].as_array().unwrap()) {
        (0..2).for_each(|k| agree(&a[k], &b[k], 1e-7));
    }
}

#[test]
fn a_section_of_a_text_is_where_it_should_be() {
    section("--step 0.05 --duration 7 --starts 3", 1);
}

#[test]
#[ignore = "slow"]
fn a_section_of_a_text_is_where_it_should_be_in_full() {
    section("--step 0.02 --duration 20 --starts 4", 3);
    Folder::new().done("section rolling-disk --plane x=1 --duration 10 --out disk.svg");
}

/// In every turn the knife edge has its speed again, and all starts of a section have the energy of the first.
fn section(flags: &str, turns: usize) {
    let folder = Folder::new();
    let line = "section knife-edge --plane theta=0 --axes speed,energy --out s.csv --json";
    let found = folder.json(&format!("{line} {flags}"));
    assert_eq!(found["axes"], serde_json::json!(["speed", "energy"]));
    let first = found["starts"][0]["points"].as_array().unwrap();
    assert_eq!(first.len(), turns);
    for (k, point) in first.iter().enumerate() {
        assert!((point[0].as_f64().unwrap() - TAU * (k + 1) as f64).abs() < 1e-9, "{point}");
        assert!((point[1].as_f64().unwrap() - 0.5).abs() < 1e-9, "{point}");
    }
    let (header, rows) = csv(&folder.read("s.csv"));
    assert_eq!(header[..6], ["start", "t", "x", "y", "theta", "x'"]);
    let energy = header.iter().position(|name| name == "energy").unwrap();
    assert!(rows.iter().any(|row| row[0] > 0.0));
    assert!(rows.iter().all(|row| (row[energy] - 0.375).abs() < 1e-9), "{rows:?}");
}

#[test]
fn a_section_of_a_text_is_a_picture() {
    let folder = Folder::new();
    folder.done("section rolling-disk --plane x=1 --duration 2 --out disk.svg");
    assert!(folder.read("disk.svg").contains("<svg"));
}

#[test]
fn what_a_text_does_not_have_is_refused_with_what_it_has() {
    let folder = Folder::new();
    folder.refused("section rolling-disk --plane heading=0", &["--plane", "`heading`", "phi, theta"]);
    folder.refused("section rolling-disk --plane x=0 --axes x,speed", &["--axes", "`speed`", "theta'"]);
    folder.refused("lyapunov knife-edge --map speed=0:1:2 --map x=0:1:2", &["--map", "`speed`", "theta'"]);
    folder.refused("lyapunov knife-edge --method rk4", &["gauss4"]);
    folder.refused("lyapunov knife-edge --exponents 6", &["from 1 to 5"]);
}

/// `speed = v0 + g sin(slope)/w sin(w t)` of the knife edge that turns at the rate `w`.
#[test]
fn parameters_and_starts_of_a_text_vary_in_a_sweep() {
    let folder = Folder::new();
    folder.write(
        "sweep.toml",
        "scene = \"knife-edge\"\nmethod = \"gauss8\"\nduration = 3.0\n[grid]\n\"parameters.slope\" = [0.05, 0.2]\n\"start.theta_dot\" = \
         { from = 0.5, to = 1.5, count = 3 }\n[output]\nexponent = true\n",
    );
    let told = folder.json("ensemble sweep.toml --out rows.csv --json");
    assert_eq!((told["members"].as_u64(), told["failed"].as_u64()), (Some(6), Some(0)));
    let (header, rows) = csv(&folder.read("rows.csv").replace(",error", "").replace(",\n", "\n"));
    let column = |name: &str| header.iter().position(|known| known == name).unwrap_or_else(|| panic!("{header:?}"));
    assert!(!header.iter().any(|name| name == "theta_min"));
    for row in &rows {
        let [slope, w, t, speed, high, exponent] =
            ["parameters.slope", "start.theta_dot", "t", "speed", "speed_max", "exponent"]
                .map(|name| row[column(name)]);
        let known = 0.5 + 9.81 * slope.sin() / w * (w * t).sin();
        assert!((speed - known).abs() < 1e-9 && high >= speed, "{row:?}");
        assert!(exponent.abs() < bias(0.3, 2.7), "{row:?}");
    }
    folder.done("ensemble sweep.toml --out rows.npz");
}

#[test]
fn a_sweep_of_a_sleigh_of_text_has_the_rows_of_the_sleigh() {
    let folder = Folder::new();
    folder.write("text.toml", SLEIGH);
    folder.write("own.toml", SCENE);
    let rows = |scene: &str, mass: &str| {
        let sweep = format!(
            "scene = \"{scene}.toml\"\nmethod = \"gauss8\"\nduration = 10.0\n[grid]\n\"{mass}\" = [0.5, 2.0]\n\"start.x\" = [0.0, 1.0]\n\
             [random]\nseed = 3\ncommon = true\n\"start.y\" = {{ uniform = [0.0, 1.0] }}\n"
        );
        folder.write(&format!("{scene}-sweep.toml"), sweep);
        folder.done(&format!("ensemble {scene}-sweep.toml --out {scene}.csv"));
        csv(&folder.read(&format!("{scene}.csv")).replace(",error", "").replace(",\n", "\n"))
    };
    let ((names, text), (others, own)) = (rows("text", "parameters.m"), rows("own", "sleigh.mass"));
    assert_eq!((text.len(), own.len()), (4, 4));
    let column = |header: &[String], name: &str| header.iter().position(|known| known == name).unwrap();
    for (a, b) in text.iter().zip(&own) {
        for name in ["start.x", "start.y", "t", "x", "y", "heading", "x_min", "y_max", "energy", "energy_deviation"] {
            let (a, b) = (a[column(&names, name)], b[column(&others, name)]);
            assert!((a - b).abs() < 1e-10, "{name}: {a} {b}");
        }
    }
}

#[test]
fn a_sweep_refuses_what_the_text_does_not_have() {
    let folder = Folder::new();
    folder.write("skate.toml", SKATE);
    let sweep = |key: &str, values: &str| {
        folder.write("sweep.toml", format!("scene = \"skate.toml\"\n[grid]\n\"{key}\" = {values}\n"));
        folder.line("ensemble sweep.toml --out rows.csv --force")
    };
    for key in ["parameters.mm", "start.z", "sleigh.mass", "effects.0.height", "system.let.c", "run.stride"] {
        sweep(key, "[1.0]").assert_refused(key, &["sweep.toml:3", "parameters.NAME"]);
    }
    let failed = sweep("parameters.J", "[0.5, 0.0]");
    assert_eq!(failed.code, 1, "{failed:?}");
    assert!(failed.stderr.contains("1 of 2 members failed"), "{failed:?}");
}

/// The operations of the formulas are counted: two squares, a difference and a half; a product; a product.
#[test]
fn a_cost_counts_the_operations_of_the_formulas() {
    let folder = Folder::new();
    folder.write(
        "spring.toml",
        "[system]\ncoordinates = { x = \"m\", y = \"m\" }\nlagrangian = \"(x'^2 + y'^2 - x^2)/2\"\nconstraints = [\"y' - x*x'\"]\n\
         forces = { x = \"-0.1*x'\" }\n[start]\nx = 1.0\n[run]\nstep = 0.05\nduration = 5.0\n",
    );
    let found = folder.json("cost spring.toml --json");
    let rows = found["rows"].as_array().unwrap();
    assert_eq!((&rows[0]["effects"], &rows[1]["effects"]), (&serde_json::json!([]), &serde_json::json!(["forces"])));
    assert!(rows.iter().all(|row| row["ns_per_step"].as_f64().unwrap() > 0.0));
    assert_eq!(found["operations"], serde_json::json!({"lagrangian": 6, "constraints": 1, "forces": 1}), "{found}");
    assert!(folder.done("cost rolling-disk").contains("operations: "));
}
