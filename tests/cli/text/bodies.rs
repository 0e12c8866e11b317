//! Balls on surfaces that turn and a chair with a castor, as bundled, beside what is known of them.

use crate::program::{Folder, csv};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The columns of these names of a run, row by row.
fn columns<const N: usize>(run: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let folder = Folder::new();
    folder.json(&format!("run {run} --json --out run.csv"));
    let (header, rows) = csv(&folder.read("run.csv"));
    let place = |name: &str| header.iter().position(|known| known == name).expect(name);
    let places = names.map(place);
    rows.iter().map(|row| places.map(|place| row[place])).collect()
}

/// How far the values of a column are apart.
fn spread<const N: usize>(rows: &[[f64; N]], column: usize) -> f64 {
    let values = || rows.iter().map(|row| row[column]);
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn a_ball_on_a_turntable_runs_on_a_circle() {
    circles(1.0);
}

#[test]
#[ignore = "slow"]
fn a_ball_on_a_turntable_runs_on_a_circle_at_length() {
    circles(20.0);
}

/// The centre runs on a circle at `Omega I/(I + m R^2)`, which is 2/7 of the table's rate for a solid ball.
fn circles(duration: f64) {
    for (inertia, table) in [(0.004_f64, 2.0_f64), (0.004, -1.3), (0.002, 5.0)] {
        let rate = table * inertia / (inertia + 0.01);
        for (method, within) in [("gauss16", 1e-12), ("dla", 1e-3 * duration / 20.0)] {
            let set = format!("--set system.parameters.I={inertia} --set system.parameters.Omega={table}");
            let rows = columns(
                &format!("ball-on-turntable --method {method} --duration {duration} {set}"),
                ["t", "x", "y", "x'", "y'", "moving", "constraint"],
            );
            let [_, x, y, u, v, moving, _] = rows[0];
            let middle = [x - v / rate, y + u / rate];
            let arm = [x - middle[0], y - middle[1]];
            for [t, x, y, _, _, kept, constraint] in rows {
                let (sin, cos) = (rate * t).sin_cos();
                let found = [x - middle[0], y - middle[1]];
                let known = [cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]];
                let miss = f64::hypot(found[0] - known[0], found[1] - known[1]);
                // The discrete motion is on the same circle; only its rate has an error.
                let off = f64::hypot(found[0], found[1]) - f64::hypot(arm[0], arm[1]);
                let what = format!("{method}, {table} rad/s, {t} s");
                assert!(miss < within && off.abs() < 1e-12, "{what}: {miss:e} {off:e}");
                assert!((kept - moving).abs() < 1e-12 && constraint < 1e-13, "{what}: {kept} {moving} {constraint:e}");
            }
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The rates of the centre from above and of the angular velocity, by Newton and Euler: with the parameters of the scene.
fn newton_euler([x, y, w1, w2, w3]: [f64; 5]) -> [f64; 5] {
    let (mass, radius, inertia, k, gravity, table) = (1.0, 0.1, 0.004, 0.8, 9.81, 0.6);
    let (spin, upright) = ([w1, w2, w3], 1.0 / (1.0 + k * k * (x * x + y * y)).sqrt());
    let normal = [-k * x * upright, -k * y * upright, upright];
    // The velocity, and the rate of the normal.
    let rolled = cross(spin, normal);
    let velocity =
        [radius * rolled[0] - table * (y - radius * normal[1]), radius * rolled[1] + table * (x - radius * normal[0])];
    let bend = -upright.powi(3) * k * k * (x * velocity[0] + y * velocity[1]);
    let turned = [-k * (velocity[0] * upright + x * bend), -k * (velocity[1] * upright + y * bend), bend];
    // The acceleration of the centre without what the rate of the spin adds, less that of gravity; the spin about the normal has no torque.
    let [p, q, r] = cross(spin, turned).map(|part| radius * part);
    let (along, across) = (velocity[0] - radius * turned[0], velocity[1] - radius * turned[1]);
    let torque = cross(normal, [p - table * across, q + table * along, r + gravity]);
    let share = -radius * mass / (inertia + mass * radius * radius);
    [velocity[0], velocity[1], share * torque[0], share * torque[1], share * torque[2]]
}

/// By a method that needs no reduced equations: to derive them takes longer than the run.
#[test]
fn a_ball_in_a_turning_bowl_keeps_its_moving_energy() {
    moving_energy("lobatto5", 0.2, 1e-3);
}

#[test]
#[ignore = "slow"]
fn a_ball_in_a_turning_bowl_keeps_its_moving_energy_at_length() {
    moving_energy("gauss16", 20.0, 0.01);
}

/// `E - Omega J` is kept where the energy is not: that changes by `change` at least. The motion agrees with Newton and Euler. In a bowl at
/// rest the energy is kept.
fn moving_energy(method: &str, duration: f64, change: f64) {
    let names = ["x", "y", "e1'", "e2'", "e3'", "moving", "energy", "constraint"];
    let run = |method: &str| columns(&format!("ball-in-bowl --method {method} --duration {duration}"), names);
    let rows = run(method);
    assert!(spread(&rows, 5) < 1e-12 && spread(&rows, 6) > change, "{} {}", spread(&rows, 5), spread(&rows, 6));
    assert!(rows.iter().all(|row| row[7] < 1e-13));
    assert!(spread(&run("dla"), 5) < 1e-3);

    // At the start the axes of the ball are those of space.
    let [x, y, a, b, c, ..] = rows[0];
    let (mut state, step, steps) = ([x, y, 2.0 * a, 2.0 * b, 2.0 * c], 1e-3_f64, (1e3 * duration) as u32);
    for _ in 0..steps {
        let at =
            |rates: [f64; 5], part: f64| -> [f64; 5] { std::array::from_fn(|k| state[k] + part * step * rates[k]) };
        let first = newton_euler(state);
        let second = newton_euler(at(first, 0.5));
        let third = newton_euler(at(second, 0.5));
        let last = newton_euler(at(third, 1.0));
        state = std::array::from_fn(|k| state[k] + step / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + last[k]));
    }
    let [x, y, ..] = rows[rows.len() - 1];
    let miss = f64::hypot(x - state[0], y - state[1]);
    assert!(miss < 1e-10, "{miss:e}");

    let flags = format!("--duration {duration} --set system.parameters.Omega=0 --json");
    let still = Folder::new().json(&format!("run ball-in-bowl --method {method} {flags}"));
    assert!(number(&still["energy"]["max_error"]) < 1e-12 && number(&still["energy"]["work"]) == 0.0, "{still}");
}

/// Backward the castor flips within half a second.
#[test]
fn a_wheelchair_turns_round_and_its_castor_trails() {
    let run = rolled("gauss8", &format!("--duration 0.5 --event castor={}", -FRAC_PI_2));
    let events = run["events"].as_array().unwrap();
    assert!(events.len() == 1 && number(&events[0]["t"]) > 0.1, "{events:?}");
    assert!(number(&run["final"]["trailing"]) < -0.9 && number(&run["energy"]["work"]) < 0.0, "{run}");
    for (method, within) in [("gauss16", 1e-10), ("dla", 0.05)] {
        let run = rolled(method, &format!("--duration 0.5 {FREE}"));
        assert!(number(&run["energy"]["max_error"]) < within, "{method}: {run}");
        assert!(number(&run["final"]["trailing"]) < -0.9, "{method}: {run}");
    }
}

/// No friction.
const FREE: &str = "--set system.parameters.drag=0 --set system.parameters.swivel=0";

/// A run of the wheelchair, which keeps to its constraints.
fn rolled(method: &str, flags: &str) -> Value {
    let run = Folder::new().json(&format!("run wheelchair --method {method} --json {flags}"));
    assert!(number(&run["constraint"]["max"]) < 1e-13, "{run}");
    run
}

/// After it has flipped, the chair turns round, and the castor swings on until it trails.
#[test]
#[ignore = "slow"]
fn a_wheelchair_turns_round_and_its_castor_trails_in_full() {
    let run = rolled("gauss8", &format!("--event castor={} --event speed=0", -FRAC_PI_2));
    let events = run["events"].as_array().unwrap();
    let [flip, halt] = [0, 1].map(|k| number(&events[k]["t"]));
    assert!(events.len() == 2 && flip < 0.5 && halt > 1.0, "{events:?}");
    let [castor, trailing, speed] = ["castor", "trailing", "speed"].map(|name| number(&run["final"][name]));
    assert!(trailing > 0.999 && (castor + TAU).abs() < 0.1 && speed > 1.0, "{castor} {trailing} {speed}");
    assert!(number(&run["energy"]["work"]) < -100.0, "{run}");

    for (method, within) in [("energy4", 1e-10), ("gauss16", 1e-10), ("dla", 0.05)] {
        let run = rolled(method, FREE);
        assert!(number(&run["energy"]["max_error"]) < within, "{method}: {run}");
        assert!(number(&run["final"]["trailing"]) > 0.999, "{method}: {run}");
    }
}

/// On level ground, with a castor that has hardly any mass, the eigenvalues at the speed `u` are `-u/d` of the castor and
/// `-m a u/(J + m a^2)` of the chair: both stable forward, both unstable backward.
#[test]
fn a_wheelchair_on_level_ground_is_stable_forward() {
    let mut line = "equilibria wheelchair --json --set start.x'=1".to_owned();
    for setting in ["slope=0", "drag=0", "swivel=0", "mc=1e-9", "Jc=1e-9"] {
        line += &format!(" --set system.parameters.{setting}");
    }
    let found = Folder::new().json(&line);
    let (castor, chair) = (1.0 / 0.06, 90.0 * 0.15 / (6.0 + 90.0 * 0.15 * 0.15));
    for speed in [1.0, -1.0] {
        let ahead = |motion: &&Value| (number(&motion["rates"]["x'"]) - speed).abs() < 1e-9;
        let motion = found["equilibria"].as_array().unwrap().iter().find(ahead).expect("a steady motion ahead");
        let flow = motion["flow"].as_array().unwrap();
        for known in [-castor * speed, -chair * speed] {
            let near = |value: &Value| f64::hypot(number(&value["re"]) - known, number(&value["im"])) < 1e-6;
            assert!(flow.iter().any(near), "{known}: {motion}");
        }
        assert_eq!(motion["stable"].as_bool(), Some(speed > 0.0), "{motion}");
    }
}
