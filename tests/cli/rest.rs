//! `noslip run` and `noslip compare` of motions that are small or come to rest: every method, from a file.

use crate::program::Folder;
use std::fmt::Write as _;

/// A well with drag, and the step that resolves its oscillation and its damping.
struct Well {
    mass: f64,
    offset: f64,
    frequency: f64,
    damping: f64,
    center: [f64; 2],
}

/// Every decade of stiffness, mass and damping, and a centre of mass on the blade, ahead of it and behind.
const WELLS: [Well; 6] = [
    Well { mass: 1.0, offset: 0.5, frequency: 2.0, damping: 0.2, center: [0.3, 0.7] },
    Well { mass: 0.01, offset: 0.0, frequency: 0.1, damping: 1.0, center: [-4.0, 2.0] },
    Well { mass: 100.0, offset: -0.3, frequency: 20.0, damping: 0.3, center: [0.3, 0.7] },
    Well { mass: 1.0, offset: 1.5, frequency: 5.0, damping: 0.05, center: [0.0, 0.0] },
    Well { mass: 3.0, offset: -1.0, frequency: 0.7, damping: 0.5, center: [1e3, -2e3] },
    Well { mass: 0.1, offset: 0.1, frequency: 300.0, damping: 0.4, center: [2.0, 3.0] },
];

impl Well {
    fn scene(&self, steps: f64) -> String {
        let Self { mass, offset, frequency, damping, center: [x, y] } = self;
        let stiffness = mass * frequency * frequency;
        let mut text = String::new();
        let _ = write!(
            text,
            "[sleigh]\nmass = {mass:?}\ninertia = {mass:?}\noffset = {offset:?}\n\
             [start]\nx = {:?}\ny = {y:?}\nspeed = {:?}\nturn_rate = {:?}\n\
             [run]\nstep = {:?}\nduration = {:?}\n\
             [[effects]]\nkind = \"bowl\"\nstiffness = [{stiffness:?}, {:?}]\ncenter = [{x:?}, {y:?}]\n\
             [[effects]]\nkind = \"drag\"\nalong = {:?}\nturning = {:?}\n",
            x + 0.1,
            0.1 * frequency,
            0.2 * frequency,
            0.2 / frequency,
            steps * 0.2 / frequency,
            0.4 * stiffness,
            damping * mass * frequency,
            0.5 * damping * mass * frequency,
        );
        text
    }
}

/// The steps in which all of these wells come to rest.
const STEPS: f64 = 2000.0;

/// A well that is damped so much that some hundred steps are enough, and one method of each family: those that need no more than these
/// are at rest to rounding.
#[test]
fn every_method_comes_to_rest_in_a_well() {
    let long = ["dla", "gauss-adaptive", "dop853"].map(|method| (method, 400.0));
    let short = ["lobatto3", "gauss4", "energy2", "gni", "rk4"].map(|method| (method, 40.0));
    let settled: usize =
        [&long[..], &short].concat().iter().map(|(method, steps)| settled(&WELLS[1..2], *steps, &[method])).sum();
    assert!(settled >= long.len(), "{settled} runs have come to rest");
}

#[test]
#[ignore = "slow"]
fn every_method_comes_to_rest_in_a_well_at_length() {
    let methods = crate::program::methods();
    let methods: Vec<&str> = methods.iter().map(String::as_str).collect();
    let settled = settled(&WELLS, STEPS, &methods);
    assert!(settled > 50, "{settled} runs have come to rest");
}

/// No method gives a well with drag up, and what has come to rest is where no force is left to move it. So many runs have come to rest.
fn settled(wells: &[Well], steps: f64, methods: &[&str]) -> usize {
    let (folder, mut settled) = (Folder::new(), 0);
    for (k, well) in wells.iter().enumerate() {
        let file = format!("well-{k}.toml");
        folder.write(&file, well.scene(steps));
        for method in methods {
            let run = folder.json(&format!("run {file} --method {method} --json"));
            let number = |key: &str| run["final"][key].as_f64().unwrap_or_else(|| panic!("{file}, {method}: {run}"));
            let [x, y, heading] = ["x", "y", "heading"].map(number);
            let [speed, rate] = ["speed", "turn_rate"].map(number);
            // What the rounding of the place moves in a time of the oscillation.
            let place = 1.0 + well.center[0].abs() + well.center[1].abs();
            let noise = 256.0 * f64::EPSILON * well.frequency * place;
            if speed.abs() > noise || rate.abs() > noise {
                continue;
            }
            settled += 1;
            let (sin, cos) = heading.sin_cos();
            let force = [x + well.offset * cos - well.center[0], 0.4 * (y + well.offset * sin - well.center[1])];
            let along = force[0] * cos + force[1] * sin;
            let across = well.offset * (force[1] * cos - force[0] * sin);
            assert!(along.abs() <= 1e-9 && across.abs() <= 1e-9, "{file}, {method}: {along:e} and {across:e} m");
        }
    }
    settled
}
