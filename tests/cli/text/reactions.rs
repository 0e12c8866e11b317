//! The forces of constraints, as outputs and as events.

use crate::program::{Folder, csv};
use approx::assert_relative_eq;

/// A bead on the outside of a ball, which it leaves where the ball would have to pull.
const BEAD: &str = "\
[system]
coordinates = { x = \"m\", z = \"m\" }
parameters = { m = 2.0, g = 9.81, r = 1.5 }
lagrangian = \"m/2*(x'^2 + z'^2) - m*g*z\"
positions = { ball = \"x^2 + z^2 = r^2\" }
outputs = { normal = \"2*r*lambda_ball\" }
[start]
x = 0.3
z = 1.4696938456699067
[run]
step = 0.01
duration = 2.0
";

/// The height falls to two thirds (a problem of Newton's Principia).
#[test]
fn a_bead_leaves_a_ball_where_the_force_vanishes() {
    let folder = Folder::new();
    folder.write("bead.toml", BEAD);
    for method in ["dla8", "gauss8", "taylor"] {
        for event in ["normal=0", "lambda_ball=0"] {
            let run = folder.json(&format!("run bead.toml --method {method} --until {event} --json"));
            let end = &run["final"];
            assert_relative_eq!(end["z"].as_f64().unwrap(), 1.469_693_845_669_906_7 * 2.0 / 3.0, max_relative = 1e-9);
            assert!(end["normal"].as_f64().unwrap().abs() < 1e-8, "{end}");
        }
    }
    // At rest it is held by its weight along the normal.
    folder.json("run bead.toml --method dla --duration 0.01 --out bead.csv --json");
    let (names, rows) = csv(&folder.read("bead.csv"));
    let normal = names.iter().position(|name| name == "normal").unwrap();
    assert_relative_eq!(rows[0][normal], 2.0 * 9.81 * 1.469_693_845_669_906_7 / 1.5, max_relative = 1e-12);
}

#[test]
fn a_multiplier_has_no_place_in_a_force() {
    let folder = Folder::new();
    folder.write("bead.toml", BEAD.replace("outputs = { normal", "forces = { x"));
    folder.refused("check bead.toml", &["no name `lambda_ball` is known here"]);
}
