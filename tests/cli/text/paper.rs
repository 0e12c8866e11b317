//! Systems as one writes them on paper: no rate is derived by hand, and constraints are equations.

use crate::program::Folder;
use approx::assert_relative_eq;
use serde_json::Value;

const CART: &str = r#"[system]
coordinates = { x = "m", y = "m", th = "angle", a = "angle", b = "angle" }
parameters = { M = 2.0, J = 0.5, m = 0.4, l = 0.6, g = 9.81 }
let.x1 = "x + l*sin(a)*cos(th)"
let.y1 = "y + l*sin(a)*sin(th)"
let.x2 = "x1 + l*sin(b)*cos(th)"
let.y2 = "y1 + l*sin(b)*sin(th)"
let.T = "M/2*(x'^2 + y'^2) + J/2*th'^2 + m/2*(x1'^2 + y1'^2 + (l*a'*sin(a))^2 + x2'^2 + y2'^2 + (l*a'*sin(a) + l*b'*sin(b))^2)"
lagrangian = "T + m*g*l*(2*cos(a) + cos(b))"
constraints = ["x'*sin(th) = y'*cos(th)"]"#;

const TRAILER: &str = r#"[system]
coordinates = { x = "m", y = "m", th = "angle", p = "angle" }
parameters = { M = 3.0, J = 0.7, m = 1.5, I = 0.4, h = 0.5, d = 0.8 }
let.tx = "x - h*cos(th) - d*cos(p)"
let.ty = "y - h*sin(th) - d*sin(p)"
lagrangian = "M/2*(x'^2 + y'^2) + J/2*th'^2 + m/2*(tx'^2 + ty'^2) + I/2*p'^2"
constraints = ["x'*sin(th) = y'*cos(th)", "tx'*sin(p) = ty'*cos(p)"]"#;

/// Yaw, pitch and roll; the angular velocity follows from the rates of the rotation's rows.
const BALL: &str = r#"[system]
coordinates = { x = "m", y = "m", a = "angle", b = "angle", c = "angle" }
parameters = { m = 2.0, r = 0.3, g = 9.81, slope = 0.2 }
let = { ux = "cos(a)*cos(b)", uy = "cos(a)*sin(b)*sin(c) - sin(a)*cos(c)", uz = "cos(a)*sin(b)*cos(c) + sin(a)*sin(c)", vx = "sin(a)*cos(b)", vy = "sin(a)*sin(b)*sin(c) + cos(a)*cos(c)", vz = "sin(a)*sin(b)*cos(c) - cos(a)*sin(c)", wx = "-sin(b)", wy = "cos(b)*sin(c)", wz = "cos(b)*cos(c)", o1 = "wx'*vx + wy'*vy + wz'*vz", o2 = "ux'*wx + uy'*wy + uz'*wz", o3 = "vx'*ux + vy'*uy + vz'*uz" }
lagrangian = "m/2*(x'^2 + y'^2) + m*r^2/5*(o1^2 + o2^2 + o3^2) + m*g*sin(slope)*x"
constraints = ["x' = r*o2", "y' = -r*o1"]
outputs = { spin = "o3" }"#;

/// The run of a system from a start by a method.
fn run(folder: &Folder, system: &str, start: &str, method: &str) -> Value {
    assert!(system.lines().count() <= 10, "{system}");
    folder.write("paper.toml", format!("{system}\n[start]\n{start}\n[run]\nstep = 0.01\nduration = 1.0\n"));
    let run = folder.json(&format!("run paper.toml --method {method} --json"));
    assert!(run["energy"]["max_error"].as_f64().unwrap() < 1e-6, "{run}");
    assert!(run["constraint"]["max"].as_f64().unwrap() < 1e-13, "{run}");
    run["final"].clone()
}

/// The same ends with rates that are written out.
fn as_by_hand(system: &str, start: &str, rates: &[(&str, &str)]) {
    let folder = Folder::new();
    let by_hand = rates.iter().fold(system.to_owned(), |text, (rate, meaning)| {
        assert!(text.contains(rate), "{rate}");
        text.replace(rate, &format!("({meaning})"))
    });
    for method in ["dla8", "gauss8"] {
        let [paper, hand] = [system, &by_hand].map(|system| run(&folder, system, start, method));
        for (key, value) in hand.as_object().unwrap() {
            let (found, expected) = (paper[key].as_f64().unwrap(), value.as_f64().unwrap());
            assert_relative_eq!(found, expected, max_relative = 1e-11, epsilon = 1e-12);
        }
    }
}

#[test]
fn a_double_pendulum_on_a_cart_with_a_knife_edge() {
    let rates = [
        ("x1'", "x' + l*a'*cos(a)*cos(th) - l*sin(a)*th'*sin(th)"),
        ("y1'", "y' + l*a'*cos(a)*sin(th) + l*sin(a)*th'*cos(th)"),
        ("x2'", "x' + l*(a'*cos(a) + b'*cos(b))*cos(th) - l*(sin(a) + sin(b))*th'*sin(th)"),
        ("y2'", "y' + l*(a'*cos(a) + b'*cos(b))*sin(th) + l*(sin(a) + sin(b))*th'*cos(th)"),
    ];
    as_by_hand(CART, "a = 1.0\nb = 1.5\n\"x'\" = 0.5\n\"th'\" = 1.0", &rates);
}

#[test]
fn a_trailer_hitched_behind_its_axle() {
    let rates = [("tx'", "x' + h*th'*sin(th) + d*p'*sin(p)"), ("ty'", "y' - h*th'*cos(th) - d*p'*cos(p)")];
    as_by_hand(TRAILER, "p = 0.4\n\"x'\" = 1.5\n\"th'\" = 0.8", &rates);
}

/// It gains speed as a body of 7/5 of its mass, and keeps its spin.
#[test]
fn a_ball_on_a_tilted_plane() {
    let folder = Folder::new();
    for method in ["dla8", "gauss8", "taylor"] {
        let end = run(&folder, BALL, "b = 0.3\nc = 0.5\n\"x'\" = 0.4\n\"y'\" = -0.7\n\"a'\" = 2.0", method);
        let gained = 5.0 / 7.0 * 9.81 * 0.2_f64.sin();
        for (key, expected) in [("x", 0.4 + gained / 2.0), ("y", -0.7), ("x'", 0.4 + gained), ("y'", -0.7)] {
            assert_relative_eq!(end[key].as_f64().unwrap(), expected, max_relative = 1e-9);
        }
    }
}
