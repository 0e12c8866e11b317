//! Angles that are refused or counted, forces with corners and jumps, and coordinates without inertia.

use super::agree;
use crate::program::Folder;
use serde_json::json;

/// A scene of a system by its lines, a start and the length of its run (s).
fn scene(system: &str, start: &str, [step, duration]: [f64; 2]) -> String {
    format!("[system]\n{system}\n[start]\n{start}\n[run]\nstep = {step:?}\nduration = {duration:?}\n")
}

/// `check` and `run` say the same of an angle that a formula does not take for one; in `rad` the motion is the right one.
#[test]
fn an_angle_has_the_period_of_a_turn_or_is_refused() {
    let crank = "coordinates = { a = \"angle\", b = \"angle\", c = \"angle\" }
lagrangian = \"0.02*a'^2 + 0.05*c'^2 + 0.06*b'^2\"
positions = [\"0.5*cos(a) + 1.2*cos(b) - 0.8*cos(c) - 1\", \"0.5*sin(a) + 1.2*sin(b) - 0.8*sin(c)\", \"a - 0.3 - 2*t\"]";
    let spring = "coordinates = { theta = \"angle\" }\nlagrangian = \"theta'^2/2 - theta^2/2\"";
    let steered = "coordinates = { d = \"angle\" }\nlagrangian = \"d'^2/2\"\nforces = { d = \"-4*d\" }";
    let cases = [
        (scene(spring, "theta = 4.0", [0.01, 10.0]), "system.lagrangian", "theta"),
        (scene(crank, "a = 0.3", [0.01, 20.0]), "system.positions", "a"),
        (scene(steered, "\"d'\" = 30.0", [0.01, 3.0]), "system.forces.d", "d"),
    ];
    let folder = Folder::new();
    for (text, field, angle) in &cases {
        folder.write("s.toml", text);
        let told = [format!("`{field}` is wrong"), format!("angle `{angle}`"), "give it the unit `rad`".to_owned()];
        for command in ["check", "run"] {
            folder.refused(&format!("{command} s.toml"), &told.each_ref().map(String::as_str));
        }
    }
    let end = |text: &str, flags: &str| {
        folder.write("s.toml", text.replace("\"angle\"", "\"rad\""));
        folder.json(&format!("run s.toml --json {flags}"))["final"].clone()
    };
    let spun = end(&cases[0].0, "--method gauss8 --step 0.1");
    agree(&spun["theta"], &json!(4.0 * f64::cos(10.0)), 1e-9);
    // Once round, and on the branch that it was started on.
    let turned = end(&cases[1].0, "--method dop853 --step 0.5 --duration 3");
    agree(&turned["a"], &json!(6.3), 1e-12);
    // Amplitude 15 rad: the largest angle is reached at pi/4 s.
    let steered = end(&cases[2].0, &format!("--method gauss16 --step 0.1 --duration {}", std::f64::consts::FRAC_PI_4));
    agree(&steered["d"], &json!(15.0), 1e-12);
}

/// What is told counts the turns of an angle, as its column.
#[test]
fn outputs_count_turns() {
    let folder = Folder::new();
    let turns =
        "coordinates = { theta = \"angle\" }\nlagrangian = \"theta'^2/2\"\noutputs = { turns = \"theta/(2*pi)\" }";
    folder.write("s.toml", scene(turns, "\"theta'\" = 2.0", [0.1, 10.0]));
    let run = folder.json("run s.toml --json --event turns=3");
    agree(&run["final"]["turns"], &json!(10.0 / std::f64::consts::PI), 1e-14);
    agree(&run["events"][0]["t"], &json!(3.0 * std::f64::consts::PI), 1e-12);
}

/// Forces of time with corners and jumps, as texts and as thrusts: steps end there, and the end is the integral.
#[test]
fn corners_and_jumps_of_time_are_nodes() {
    let pulse = "10*(sign(t - 1) - sign(t - 1.05))";
    let text =
        |force: &str| format!("coordinates = {{ x = \"m\" }}\nlagrangian = \"x'^2/2\"\nforces = {{ x = \"{force}\" }}");
    let folder = Folder::new();
    folder.write("waves.toml", scene(&text("max(0, sin(3*t))"), "", [1.0, 20.0]));
    folder.write("pulse.toml", scene(&text(&format!("-x' + {pulse}")), "\"x'\" = 1.0", [0.1, 2.0]));
    folder.write("spring.toml", scene(&text("-x + abs(t - 0.7)"), "x = 0.7", [0.5, 2.0]));
    let sleigh = "[sleigh]\nmass = 1.0\ninertia = 1.0\noffset = 0.0\n[start]\nspeed = 1.0\nturn_rate = 0.0\n[run]\nstep = 0.1\nduration = 2.0\n\
                  [[effects]]\nkind = \"drag\"\nalong = 1.0\n[[effects]]\nkind = \"thrust\"\n";
    folder.write("thrust.toml", format!("{sleigh}force = \"{pulse}\"\n"));
    folder.write(
        "square.toml",
        format!(
            "{}force = \"sign(sin(t))\"\n",
            sleigh.replace("along = 1.0", "along = 0.0").replace("= 2.0", "= 10.0")
        ),
    );
    // `x = 0.7 - t + 2 max(0, t - 0.7 - sin(t - 0.7))` and so on: `x'' = -x + |t - 0.7|`, `x(0) = 0.7`, `x'(0) = 0`.
    let turn = |t: f64| 0.7 - t + f64::sin(t) + 2.0 * (t - 0.7 - f64::sin(t - 0.7));
    let drag = 0.512_566_928_897_79;
    let cases = [
        ("waves", "x'", 20.0 / 3.0),
        ("pulse", "x'", drag),
        ("spring", "x", turn(2.0)),
        ("thrust", "speed", drag),
        // Three half waves, and what is left of the fourth against them.
        ("square", "speed", 1.0 + 4.0 * std::f64::consts::PI - 10.0),
    ];
    for (name, quantity, expected) in cases {
        for method in ["gauss-adaptive", "dop853", "gauss16"] {
            let run = folder.json(&format!("run {name}.toml --json --method {method}"));
            agree(&run["final"][quantity], &json!(expected), 1e-11);
        }
    }
    // Methods with nodes at the ends of steps see each side from its own side: linear forces are exact.
    for method in ["dla", "dla-trapezoid", "lobatto3", "rk4"] {
        let run = folder.json(&format!("run square.toml --json --method {method}"));
        agree(&run["final"]["speed"], &json!(cases[4].2), 1e-13);
    }
    folder.write(
        "mass.toml",
        format!("{}\n", sleigh.replace("thrust", "moving_mass")) + "mass = 1.0\nx = \"abs(sin(t))\"\n",
    );
    folder.refused("check mass.toml", &["`effects[1].moving_mass.x`", "jump", "smooth formula"]);
}

#[test]
#[ignore = "slow"]
fn more_corners_than_a_run_may_have_are_refused() {
    let folder = Folder::new();
    let system = "coordinates = { x = \"m\" }\nlagrangian = \"x'^2/2\"\nforces = { x = \"sign(sin(1e6*t))\" }";
    folder.write("many.toml", scene(system, "", [0.1, 2000.0]));
    folder.refused("check many.toml", &["`run.duration`", "1e5 corners", "tanh"]);
}

/// A slot without force of half width 1, and beyond it a force that begins with a power or a root of `max(0, d)`.
#[test]
fn powers_of_what_is_flat_are_smooth_there() {
    let slot = |potential: &str, force: &str| {
        let system = format!(
            "coordinates = {{ x = \"m\" }}\nlagrangian = \"x'^2/2 - {potential}\"\nforces = {{ x = \"{force}\" }}"
        );
        scene(&system, "\"x'\" = 0.5", [0.01, 10.0])
    };
    let folder = Folder::new();
    let cases = [
        (slot("max(0, abs(x) - 1)^1.5", "0"), -0.724_739_706_153_2),
        (slot("0*x", "-sign(x)*sqrt(max(0, x^2 - 1))"), -0.738_387_919_716_8),
        (slot("sqrt(max(0, x^2 - 1))^3", "0"), 0.198_875_193_287_4),
    ];
    for (text, expected) in cases {
        folder.write("s.toml", text);
        // Its tolerance is 1e-12, and a corner magnifies.
        let end = folder.json("run s.toml --json --method dop853 --step 1")["final"]["x"].clone();
        agree(&end, &json!(expected), 2e-9);
        for method in ["dla", "dla4", "lobatto3", "energy4", "rk4", "gauss8", "rk4-reduced"] {
            let free = folder.json(&format!("run s.toml --json --duration 0.1 --method {method}"));
            agree(&free["final"]["x"], &json!(0.05), 1e-15);
        }
    }
}

/// A force of 1 N on a block that friction of 2 N holds.
const FRICTION: &str = "coordinates = { x = \"m\" }\nlagrangian = \"x'^2/2 + x\"\nforces = { x = \"-2*sign(x')\" }";

/// Where a force jumps at rest no step is short enough, and the message says what to write.
fn held_by_friction(methods: &[&str]) -> Folder {
    let folder = Folder::new();
    folder.write("s.toml", scene(FRICTION, "\"x'\" = -1.0", [0.01, 1.0]));
    for method in methods {
        let outcome = folder.line(&format!("run s.toml --method {method}"));
        assert_eq!(outcome.code, 1, "{outcome:?}");
        outcome.assert_told(method, &["coordinate 0", "`sign(v)`", "`tanh(v/eps)`", "valid up to t = 0.3"]);
        assert!(!outcome.stderr.contains("of its length"), "{outcome:?}");
    }
    folder
}

/// Steps of its own are shortened to rounding first.
#[test]
#[ignore = "slow"]
fn friction_by_sign_is_told_from_own_steps() {
    turns_round(&held_by_friction(&["dop853", "gauss-adaptive"]), &[1e-4]);
}

#[test]
fn friction_by_sign_is_told_from_a_long_step() {
    let methods = ["dla", "gauss8", "lobatto3", "rk4", "rk4-projected", "rk4-reduced"];
    turns_round(&held_by_friction(&methods), &[1e-2, 1e-3]);
}

/// The positive control: a block that friction does not hold turns round after 0.2 s. The force jumps by 4 N, and 4 N times the step is the
/// error of the velocity for the 0.8 s after.
fn turns_round(folder: &Folder, steps: &[f64]) {
    folder.write("s.toml", scene(&FRICTION.replace("+ x", "+ 3*x"), "\"x'\" = -1.0", [0.01, 1.0]));
    for method in ["rk4", "rk4-reduced"] {
        for step in steps {
            let end = folder.json(&format!("run s.toml --json --method {method} --step {step}"))["final"]["x"].clone();
            agree(&end, &json!(0.22), 0.8 * 4.0 * step);
        }
    }
}

/// A force may be smooth and yet as steep as a jump: the tolerance is kept, beside `gauss16` with steps of 0.5 ms.
#[test]
fn steep_forces_are_seen_by_adaptive_methods() {
    let folder = Folder::new();
    let cases = [("tanh(x'/0.002)", 0.480_244_645_183_2), ("x'/sqrt(x'^2 + 4e-6)", 0.480_255_744_745_8)];
    for (shape, expected) in cases {
        let block = format!(
            "coordinates = {{ x = \"m\" }}\nlagrangian = \"x'^2/2 - 2*x^2\"\nforces = {{ x = \"-0.2*{shape}\" }}"
        );
        folder.write("s.toml", scene(&block, "x = 2.0", [1.5, 12.0]));
        for method in ["gauss-adaptive", "dop853"] {
            let end = folder.json(&format!("run s.toml --json --method {method}"))["final"]["x"].clone();
            agree(&end, &json!(expected), 5e-10);
        }
    }
}

/// The contact parameter of a disc on a hill has no inertia; two positions determine it.
#[test]
fn constraints_determine_what_has_no_inertia() {
    let disc = "coordinates = { x = \"m\", y = \"m\", s = \"m\", phi = \"angle\" }
let = { f = \"0.3*exp(-s^2/0.125)\", fs = \"-s/0.0625*f\", n = \"sqrt(1 + fs^2)\" }
lagrangian = \"0.25*(x'^2 + y'^2) + 0.0003125*phi'^2 - 4.905*y\"
positions = [\"x - s + 0.05*fs/n\", \"y - f - 0.05/n\"]
constraints = [\"(x' + fs*y')/n + 0.05*phi'\"]";
    let folder = Folder::new();
    for (speed, expected) in [(2.0, 1.262_856_38), (1.9, -1.715_390_45), (1.8, -1.879_356_87)] {
        folder.write("s.toml", scene(disc, &format!("s = -1.0\n\"s'\" = {speed:?}"), [1e-3, 2.0]));
        let run = folder.json("run s.toml --json --method dop853 --step 0.1");
        agree(&run["final"]["s"], &json!(expected), 1e-8);
    }
    let run = folder.json("run s.toml --json --method dla --duration 0.1");
    assert!(run["constraint"]["max"].as_f64().unwrap() < 1e-14);
    // The kinetic metric is none, and the projection onto the positions takes another.
    folder.write("s.toml", scene(disc, "s = -1.0\n\"s'\" = 2.0", [1e-3, 0.6]));
    let [gauss, other] =
        ["gauss8", "dop853"].map(|method| folder.json(&format!("run s.toml --json --method {method}")));
    agree(&gauss["final"]["s"], &other["final"]["s"], 1e-9);
    let loose = "coordinates = { x = \"m\", y = \"m\" }\nlagrangian = \"x'^2/2\"\nconstraints = [\"x' - t\"]";
    folder.write("s.toml", scene(loose, "", [0.1, 1.0]));
    folder.refused("check s.toml", &["`system.lagrangian`", "does not contain the rate", "do not determine it"]);
}

/// An error is told with its place in the file: a basis, names in the head of files, lists too deep, a start.
#[test]
fn faults_are_told_where_they_are() {
    let skate = |more: &str| {
        format!(
            "coordinates = {{ x = \"m\", y = \"m\", theta = \"angle\" }}\nlagrangian = \"(x'^2 + y'^2 + theta'^2)/2\"\n\
             constraints = [\"y'*cos(theta) - x'*sin(theta)\"]\n{more}"
        )
    };
    let cases = [
        (skate("basis = [[\"1\", \"1\", \"0\"], [\"0\", \"0\", \"1\"]]"), "", "s.toml:5:9", "`system.basis`"),
        (skate("outputs = { \"=1+1\" = \"x\" }"), "", "s.toml:5:22", "`system.outputs.\"=1+1\"`"),
        (skate("outputs = { \"a,b\" = \"x\" }"), "", "s.toml:5:21", "`system.outputs.\"a,b\"`"),
        (skate("").replace("x = \"m\"", "x = \"m\\nx\""), "", "s.toml:2:21", "`system.coordinates.x`"),
        (
            skate("").replace("^2)/2", "^2)/2 - 1/x"),
            "x = 0.0",
            "s.toml:6:1",
            "`start` gives no state: the Lagrangian is",
        ),
        (skate(&format!("basis = {}{}", "[".repeat(100), "]".repeat(100))), "", "s.toml:5:1", "fewer than 80 deep"),
    ];
    let folder = Folder::new();
    for (system, start, place, told) in cases {
        folder.write("s.toml", scene(&system, start, [0.1, 1.0]));
        folder.refused("check s.toml", &[place, told]);
    }
}

/// As many outputs as a file holds are read in a time that grows with their number.
#[test]
fn many_outputs_are_read_at_once() {
    let outputs = |count: usize| {
        let list: Vec<String> = (0..count).map(|k| format!("o{k} = \"x + {k}\"")).collect();
        scene(
            &format!("coordinates = {{ x = \"m\" }}\nlagrangian = \"x'^2/2\"\noutputs = {{ {} }}", list.join(", ")),
            "",
            [0.1, 1.0],
        )
    };
    let folder = Folder::new();
    let mut times = Vec::new();
    for count in [500, 5000] {
        folder.write("s.toml", outputs(count));
        let begin = std::time::Instant::now();
        let words = folder.done("check s.toml").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&format!("o{} = {}", count - 1, count - 1)));
        times.push(begin.elapsed().as_secs_f64());
    }
    // Ten times as many take ten times as long, where the square would be a hundred; a process takes some time to begin.
    assert!(times[1] < 30.0 * times[0].max(0.05), "{times:?}");
}
