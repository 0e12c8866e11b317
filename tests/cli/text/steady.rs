//! Steady motions of systems of text, beside places and eigenvalues by other means: closed forms, and SymPy with SciPy.

use crate::program::Folder;
use serde_json::Value;
use std::f64::consts::PI;

const RUN: &str = "[run]\nstep = 0.01\nduration = 2.0\n";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

fn complex(list: &Value) -> Vec<[f64; 2]> {
    list.as_array().unwrap().iter().map(|z| ["re", "im"].map(|part| number(&z[part]))).collect()
}

/// The steady motions of a text.
fn steady(text: &str, flags: &str) -> Vec<Value> {
    let folder = Folder::new();
    folder.write("text.toml", text);
    let outcome = folder.line(&format!("equilibria text.toml --json {flags}"));
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let found: Value = serde_json::from_str(&outcome.stdout).unwrap();
    found["equilibria"].as_array().unwrap().clone()
}

/// That the eigenvalues of a flow are these, each with its conjugate, to 1e-8.
fn assert_flow(motion: &Value, known: &[[f64; 2]]) {
    let flow = complex(&motion["flow"]);
    assert_eq!(flow.len(), known.len(), "{motion}");
    for known in known {
        let nearest = flow.iter().map(|z| f64::hypot(z[0] - known[0], z[1] - known[1])).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-8, "{known:?} is {nearest:e} from {flow:?}");
    }
}

/// The multipliers of the map of `dla` are `exp(h z)` of the flow's `z`, but for `(h z)^3/12`, and as many.
fn assert_map(motion: &Value, h: f64) {
    let (flow, map) = (complex(&motion["flow"]), complex(&motion["map"]));
    assert_eq!(flow.len(), map.len(), "{motion}");
    for [re, im] in flow {
        let of_flow = [(h * re).exp() * (h * im).cos(), (h * re).exp() * (h * im).sin()];
        let nearest =
            map.iter().map(|z| f64::hypot(z[0] - of_flow[0], z[1] - of_flow[1])).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 0.5 * (h * re.hypot(im)).powi(3) + 1e-8, "{nearest:e}: {motion}");
    }
}

/// Pendula by `x` and `y` on the unit circle: the places are on it, and there are two eigenvalues, not three.
#[test]
fn a_pendulum_in_the_plane_rests_on_its_circle() {
    for friction in [0.0, 0.4] {
        let text = format!(
            "[system]\ncoordinates = {{ x = \"m\", y = \"m\" }}\nlagrangian = \"(x'^2 + y'^2)/2 - 9*y\"\n\
             positions = [\"x^2 + y^2 - 1\"]\nforces = {{ x = \"-{friction}*x'\", y = \"-{friction}*y'\" }}\n\
             [start]\nx = 0.6\ny = -0.8\n{RUN}"
        );
        let found = steady(&text, "");
        assert_eq!(found.len(), 2, "{found:?}");
        for (motion, y) in found.iter().zip([-1.0, 1.0]) {
            let place = ["x", "y"].map(|name| number(&motion["depends_on"][name]));
            assert!(place[0].abs() < 1e-12 && (place[1] - y).abs() < 1e-12, "{motion}");
            let (half, stable) = (0.5 * friction, y < 0.0);
            let root = (9.0_f64 + if stable { -half * half } else { half * half }).sqrt();
            match stable {
                true => assert_flow(motion, &[[-half, root], [-half, -root]]),
                false => assert_flow(motion, &[[-half + root, 0.0], [-half - root, 0.0]]),
            }
            assert_map(motion, 0.01);
            assert_eq!((motion["stable"].as_bool(), motion["family"].as_u64()), (Some(stable), Some(0)));
        }
        // On the circle `dla` is the leapfrog of the angle: two steps in a radian of the swing.
        let limit = number(&found[0]["step_limit"]);
        assert!((limit - 2.0 / 3.0).abs() < 1e-6 && found[0]["step_limit_reason"] == "unstable", "{limit}");
        // A method whose steps have no derivative on such constraints says so.
        let by_rk4 = &steady(&text, "--method rk4")[0];
        assert!(by_rk4["map"].is_null() && by_rk4["map_failure"].as_str().unwrap().contains("dla"), "{by_rk4}");
        assert!(by_rk4["step_limit"].is_null() && by_rk4["step_limit_reason"] == "unknown", "{by_rk4}");
    }
}

/// What is cyclic may be held by a position: a bead on a table that slides along `x` keeps the eigenvalues of its other coordinate, and both of
/// the table's motion.
#[test]
fn a_position_that_a_cyclic_coordinate_follows_takes_one_direction() {
    let text = format!(
        "[system]\ncoordinates = {{ x = \"m\", y = \"m\", z = \"m\" }}\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 - 2*y^2\"\n\
         positions = [\"z - x - 0.3*y\"]\n[start]\nx = 0.2\ny = 0.5\nz = 0.35\n{RUN}"
    );
    let found = steady(&text, "");
    let rest = found.last().unwrap();
    // With z = x + 0.3 y the mass of y is 1.09 - 0.3^2/2 once x follows: 2 x' + 0.3 y' is kept.
    let swing = (4.0 / (1.09 - 0.045_f64)).sqrt();
    assert_flow(rest, &[[0.0, swing], [0.0, -swing], [0.0, 0.0]]);
    assert_map(rest, 0.01);
    assert_eq!((rest["stable"].as_bool(), rest["family"].as_u64()), (Some(true), Some(1)), "{rest}");
}

/// Lines of rest places: rows on rates leave more places at rest than equations.
#[test]
fn families_of_rest_places_are_found() {
    for (rows, forces) in
        [("y' - 0.39*x'", "x = \"-0.117*x'\""), ("y' - 0.5*cos(y)*x'", "x = \"0\""), ("y' - x*x'", "y = \"-y'\"")]
    {
        let text = format!(
            "[system]\ncoordinates = {{ x = \"m\", y = \"m\" }}\n\
             lagrangian = \"0.4*x'^2 + 0.45*y'^2 - 2*(x + 0.28)^2 - 2*(y - 0.29)^2\"\n\
             constraints = [\"{rows}\"]\nforces = {{ {forces} }}\n[start]\nx = 0.05\ny = -0.31\n{RUN}"
        );
        let found = steady(&text, "");
        let rest = &found[0];
        let [x, y] = ["x", "y"].map(|name| number(&rest["depends_on"][name]));
        let slope = match rows {
            "y' - 0.39*x'" => 0.39,
            "y' - x*x'" => x,
            _ => 0.5 * y.cos(),
        };
        // No force along the admissible direction (1, slope).
        let force = 4.0 * (x + 0.28) + slope * 4.0 * (y - 0.29);
        assert!(force.abs() < 1e-11, "{rows}: {force:e}");
        assert_eq!((rest["family"].as_u64(), rest["flow"].as_array().unwrap().len()), (Some(1), 3), "{rest}");
        assert_map(rest, 0.01);
        // The map of `dla` at rest is Cayley's, stable at all steps, and no limit is told.
        assert!(rest["step_limit"].is_null() && number(&rest["stable_up_to"]) > 1.0, "{rest}");
        if rows == "y' - 0.39*x'" {
            let (mass, stiffness) = (0.8 + 0.9 * 0.39 * 0.39, 4.0_f64 + 4.0 * 0.39 * 0.39);
            let half = 0.5 * 0.117 / mass;
            let swing = (stiffness / mass - half * half).sqrt();
            assert_flow(rest, &[[-half, swing], [-half, -swing], [0.0, 0.0]]);
        }
    }
}

/// Two wells and the hill between them, from a start in one of them; and the words on the search.
#[test]
fn several_rests_are_found_from_several_places() {
    let text = format!(
        "[system]\ncoordinates = {{ x = \"m\", th = \"angle\" }}\nlagrangian = \"(x'^2 + th'^2)/2 - (x^2 - 1)^2/4 + cos(th)\"\n\
         [start]\nx = 0.8\nth = 0.1\n{RUN}"
    );
    let found = steady(&text, "");
    // Five at least of the six, each of them once.
    let known = [-1.0, 0.0, 1.0].map(|x| [0.0, PI].map(|th| [x, th])).concat();
    let is_at = |e: &Value, place: &[f64; 2]| {
        let [x, th] = ["x", "th"].map(|name| number(&e["depends_on"][name]));
        (x - place[0]).abs() < 1e-9 && (th.cos() - place[1].cos()).abs() < 1e-12
    };
    assert!(found.iter().all(|e| known.iter().any(|place| is_at(e, place))), "{found:?}");
    let met: Vec<usize> = known.iter().map(|place| found.iter().filter(|e| is_at(e, place)).count()).collect();
    assert!(met.iter().all(|count| *count <= 1) && met.iter().sum::<usize>() >= 5, "{met:?}");
    assert_eq!(found.iter().filter(|e| e["stable"] == true).count(), 2);
    let folder = Folder::new();
    folder.write("text.toml", text);
    let told = folder.done("equilibria text.toml");
    assert!(told.contains("\nsearched: rest from 25 places up to "), "{told}");
    // None where there is none: a constant push, and the message says where was looked.
    folder.write("pushed.toml", folder.read("text.toml").replace("(x^2 - 1)^2/4", "x"));
    let outcome = folder.line("equilibria pushed.toml");
    assert_eq!(outcome.code, 1);
    outcome.assert_told("pushed", &["rest was looked for from 25 places", "nearer"]);
}

#[test]
fn a_bowl_has_no_limit_of_the_step() {
    no_limit(&BOWLS[..1]);
}

#[test]
#[ignore = "slow"]
fn bowls_and_friction_have_no_limit_of_the_step_at_length() {
    no_limit(&BOWLS);
}

/// Sleighs with one parameter of rest places: body and start, then what acts.
const BOWLS: [(&str, &str); 4] = [
    ("0.868 1.461 -0.128 -0.258 -0.059 1.393 -0.419 -0.822", "bowl 0.359 0.669"),
    ("0.577 1.284 0.449 -0.419 0.442 1.71 0.209 0.088", "friction 0.183 0.553 0.12 0.457;bowl 1.164 0.841"),
    (
        "1.154 1.007 0.161 -0.301 -0.176 2.037 0.416 -0.445",
        "friction 0.199 0.271 0.165 0.217;egg_crate 0.197 1.844 1.932;bowl 1.129 1.444",
    ),
    ("1.934 1.442 0.221 0.479 -0.443 2.421 0.409 0.336", "bowl 1.217 0.649;egg_crate 0.101 1.244 0.986"),
];

/// At rest the steps of `dla` are those of the midpoint rule, whose map is stable wherever the flow is: a limit below some seconds would be false.
fn no_limit(bowls: &[(&str, &str)]) {
    for (numbers, effects) in bowls {
        let keys = ["mass", "inertia", "offset", "x", "y", "heading", "speed", "turn_rate"];
        let mut text = "[sleigh]\n".to_owned();
        for (i, (key, number)) in keys.iter().zip(numbers.split(' ')).enumerate() {
            text += &format!("{}{key} = {number}\n", if i == 3 { "[start]\n" } else { "" });
        }
        text += "[run]\nstep = 0.05\nduration = 10.0\n";
        for effect in effects.split(';') {
            let words: Vec<&str> = effect.split(' ').collect();
            text += &match words[..] {
                ["bowl", x, y] => format!("[[effects]]\nkind = \"bowl\"\nstiffness = [{x}, {y}]\n"),
                ["egg_crate", height, x, y] => {
                    format!("[[effects]]\nkind = \"egg_crate\"\nheight = {height}\nwave_number = [{x}, {y}]\n")
                }
                ["friction", along, smoothing, turning, turning_smoothing] => format!(
                    "[[effects]]\nkind = \"friction\"\nalong = {along}\nsmoothing = {smoothing}\nturning = {turning}\n\
                     turning_smoothing = {turning_smoothing}\n"
                ),
                _ => unreachable!("{effect}"),
            };
        }
        let found = steady(&text, "");
        let stable: Vec<&Value> = found.iter().filter(|e| e["stable"] == true).collect();
        assert!(!stable.is_empty(), "{found:?}");
        for rest in stable {
            assert!(rest["step_limit"].is_null() && number(&rest["stable_up_to"]) > 1.0, "{numbers}: {rest}");
            assert_map(rest, 0.05);
            assert_eq!(rest["family"].as_u64(), Some(1));
        }
    }
}

/// A coordinate that the equations do not contain has its place if a position determines it, and any place if not.
#[test]
fn places_that_positions_determine_are_told() {
    let text = |position: &str| {
        format!(
            "[system]\ncoordinates = {{ x = \"m\", y = \"m\", z = \"m\" }}\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 - x^2/2\"\n\
             positions = [\"{position}\"]\n[start]\nx = 0.5\n{RUN}"
        )
    };
    let place = |position: &str| steady(&text(position), "")[0]["depends_on"].clone();
    let determined = place("y - cos(x) - 1");
    assert!((number(&determined["y"]) - 2.0).abs() < 1e-12 && determined["z"].is_null(), "{determined}");
    let open = place("y - z - cos(x)");
    assert!(number(&open["x"]).abs() < 1e-12 && open["y"].is_null() && open["z"].is_null(), "{open}");
}

/// Near a double root a search ends in motions of 1e-9 m/s: they are the rest beside them, with all of its family.
#[test]
#[ignore = "slow"]
fn slow_motions_beside_a_rest_are_that_rest() {
    let path = format!("{}/tests/cases/rest-double-root.toml", env!("CARGO_MANIFEST_DIR"));
    let found = steady(&std::fs::read_to_string(path).unwrap(), "");
    let near: Vec<&Value> = found.iter().filter(|e| (number(&e["depends_on"]["y"]) + 0.307016).abs() < 1e-5).collect();
    assert_eq!(near.len(), 1, "{found:?}");
    assert!(near[0]["family"] == 1 && near[0]["rates"]["x'"] == 0.0, "{}", near[0]);
}

/// Random systems with positions, rows and forces: places on the constraints where nothing is pushed, and their eigenvalues.
#[test]
#[ignore = "slow"]
fn rest_places_of_random_systems_have_their_eigenvalues_at_length() {
    random(&["rest-eh0", "rest-eh16", "rest-eh19"]);
}

/// By SymPy: the residual of the position, and of isolated places the eigenvalues; of a family how many are zero.
fn random(files: &[&str]) {
    for file in files {
        let path = format!("{}/tests/cases/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        let found = steady(&std::fs::read_to_string(path).unwrap(), "");
        let at = |motion: &Value, name: &str| number(&motion["depends_on"][name]);
        for motion in &found {
            let miss = match *file {
                "rest-eh0" => {
                    let (zeta, x) = (at(motion, "zeta"), at(motion, "X"));
                    zeta * (2.0 + zeta.cos()) / 2.0 - 0.5 / (1.0 + x * x)
                }
                "rest-eh16" => {
                    let (q, x) = (at(motion, "q1"), at(motion, "x"));
                    q * (2.0 + q.cos()) / 2.0 - 0.5 * x.sin()
                }
                _ => {
                    let (beta, q) = (at(motion, "beta"), at(motion, "q1"));
                    0.57 * (q + 0.2 * q.sin()) - (2.0 * beta).cos() / 1.12
                }
            };
            assert!(miss.abs() < 1e-13, "{file}: {miss:e}");
            assert_map(motion, 0.01);
        }
        let first = &found[0];
        if *file == "rest-eh19" {
            let place = [at(first, "beta") + 0.7965411522, at(first, "q1") + 0.0290892031];
            assert!(place.iter().all(|off| off.abs() < 1e-9), "{first}");
            assert_flow(first, &[[-0.26079537923, 1.75479549545], [-0.26079537923, -1.75479549545]]);
            assert!(found.len() >= 4, "{found:?}");
        } else {
            assert_eq!((first["family"].as_u64(), first["stable"].as_bool()), (Some(2), Some(true)), "{first}");
            assert_eq!(complex(&first["flow"]).iter().filter(|z| z[0] == 0.0 && z[1] == 0.0).count(), 2, "{first}");
        }
    }
}
