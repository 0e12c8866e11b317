//! A train of the scene format, and the same train as a text.

use crate::program::Folder;

/// A blade that leads another across a turning table.
const TRAIN: &str = "\
[sleigh]
mass = 1.3
inertia = 0.8
offset = 0.4
[start]
x = 0.5
y = -0.2
heading = 0.3
speed = 0.7
turn_rate = 0.4
[run]
step = 0.02
duration = 4.0
[[effects]]
kind = \"turntable\"
rate = 0.3
[[effects]]
kind = \"bowl\"
stiffness = [0.4, 0.2]
[[effects]]
kind = \"trailers\"
count = 1
mass = 0.5
inertia = 0.1
offset = 0.1
hitch = 0.2
bar = 0.8
headings = [0.1]
";

/// The hinge is two constraints on positions; the velocity across each blade agrees with the table.
const WORDS: &str = "\
[system]
coordinates = { x = \"m\", y = \"m\", p = \"angle\", X = \"m\", Y = \"m\", q = \"angle\" }
parameters = { m = 1.3, I = 0.8, a = 0.4, M = 0.5, J = 0.1, A = 0.1, b = 0.2, d = 0.8, w = 0.3, kx = 0.4, ky = 0.2 }
lagrangian = \"\"\"
m/2*((x' - a*p'*sin(p))^2 + (y' + a*p'*cos(p))^2) + I/2*p'^2 + M/2*((X' - A*q'*sin(q))^2 + (Y' + A*q'*cos(q))^2) + J/2*q'^2
- kx/2*((x + a*cos(p))^2 + (X + A*cos(q))^2) - ky/2*((y + a*sin(p))^2 + (Y + A*sin(q))^2)\"\"\"
constraints = [
  \"y'*cos(p) - x'*sin(p) - w*(x*cos(p) + y*sin(p))\",
  \"Y'*cos(q) - X'*sin(q) - w*(X*cos(q) + Y*sin(q))\",
]
positions = [\"x - b*cos(p) - X - d*cos(q)\", \"y - b*sin(p) - Y - d*sin(q)\"]
";

/// The start of the train in the coordinates of the text.
fn start() -> String {
    let (w, b, d) = (0.3, 0.2, 0.8);
    let ([x, y, p, q], [u, omega]) = ([0.5f64, -0.2, 0.3, 0.1], [0.7, 0.4]);
    let ([s, c], [qs, qc]) = ([p.sin(), p.cos()], [q.sin(), q.cos()]);
    let across = w * (x * c + y * s);
    let (vx, vy) = (u * c - across * s, u * s + across * c);
    let (bx, by) = (x - b * c - d * qc, y - b * s - d * qs);
    // The hinge's velocity, split along and across the second blade.
    let (hx, hy) = (vx + b * omega * s, vy - b * omega * c);
    let (along, second) = (hx * qc + hy * qs, w * (bx * qc + by * qs));
    let rate = (hy * qc - hx * qs - second) / d;
    let (bvx, bvy) = (along * qc - second * qs, along * qs + second * qc);
    format!(
        "[start]\nx = {x:?}\ny = {y:?}\np = {p:?}\nX = {bx:?}\nY = {by:?}\nq = {q:?}\n\"x'\" = {vx:?}\n\"y'\" = {vy:?}\n\
         \"p'\" = {omega:?}\n\"X'\" = {bvx:?}\n\"Y'\" = {bvy:?}\n\"q'\" = {rate:?}\n[run]\nstep = 0.02\nduration = 4.0\n"
    )
}

#[test]
fn a_train_on_a_turntable_is_its_text() {
    train_is_text(0.2);
}

#[test]
#[ignore = "slow"]
fn a_train_on_a_turntable_is_its_text_in_full() {
    train_is_text(4.0);
}

/// By different formulas and different linear algebra: as near as round-off leaves them in two hundred steps of order one, or in fewer.
fn train_is_text(duration: f64) {
    let folder = Folder::new();
    let run = |line: &str| folder.json(&format!("run {line} --duration {duration} --json"));
    folder.write("train.toml", TRAIN);
    folder.write("words.toml", format!("{WORDS}{}", start()));
    for method in ["dla", "dla8"] {
        let train = run(&format!("train.toml --method {method}"));
        let words = run(&format!("words.toml --method {method}"));
        let (first, last, text) = (&train["final"], &train["last"], &words["final"]);
        for (own, there) in [
            (&first["x"], &text["x"]),
            (&first["y"], &text["y"]),
            (&first["heading"], &text["p"]),
            (&first["turn_rate"], &text["p'"]),
            (&last["x"], &text["X"]),
            (&last["y"], &text["Y"]),
            (&last["heading"], &text["q"]),
        ] {
            super::agree(own, there, 1e-11 * duration / 4.0);
        }
        assert!(train["constraint"]["max"].as_f64().unwrap() < 1e-13, "{}", train["constraint"]);
    }
    // The table does work, and the balance of the energy counts it.
    let train = run("train.toml --method dla8");
    let energy = &train["energy"];
    assert!(energy["work"].as_f64().unwrap().abs() > 1e-3, "{energy}");
    assert!(energy["max_error"].as_f64().unwrap() < 1e-6, "{energy}");
    // Without the table it is another motion.
    folder.write("still.toml", TRAIN.replace("rate = 0.3", "rate = 0.0"));
    let still = run("still.toml --method dla8");
    let apart = (still["last"]["x"].as_f64().unwrap() - train["last"]["x"].as_f64().unwrap()).abs();
    assert!(apart > 0.01 * duration / 4.0, "{apart:e}");
}
