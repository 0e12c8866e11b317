//! The free sleigh: spins, steps, offsets.

use crate::broken::{self, BODY, Broken, straight};
use crate::curves::Upright::{Decades, Linear};
use crate::curves::{SPIN, X, Y, chart, curve, in_time, markers, peaks, trace};
use crate::program::{Program, Setup};
use harness::stability::Seen;
use report::{Chart, Layer};
use sleigh::{Exact, Sleigh, SleighState};
use std::error::Error;

type Drawn = Result<Chart, Box<dyn Error>>;

/// The closed form of a run.
pub(crate) fn exact(setup: &Setup<'_>) -> Result<Exact, Box<dyn Error>> {
    let ([mass, inertia, offset], [x, y, heading, speed, turn_rate]) = (setup.body, setup.start);
    Ok(Exact::new(&Sleigh::new(mass, inertia, offset)?, &SleighState { x, y, heading, speed, turn_rate })?)
}

/// How far a node is from its place (m).
pub(crate) fn astray(exact: &Exact) -> impl Fn(&Seen) -> f64 {
    move |node| {
        let now = exact.at(node.t);
        (node.values[X] - now.x).hypot(node.values[Y] - now.y)
    }
}

fn spin(node: &Seen) -> f64 {
    node.values[SPIN].abs()
}

pub(crate) fn tiny_spin(program: &Program) -> Drawn {
    let setup = Setup::free(-1.0, -1e-300, 0.2, 1800.0);
    let broken = |broken| straight(broken, -1.0, -1e-300, setup.step, setup.duration).nodes;
    let layers = vec![
        trace("dla", &program.run("dla", &setup)?, spin),
        trace("absolute tolerance of 1e-13", &broken(Broken::AbsoluteTolerance(1e-13)), spin),
    ];
    Ok(in_time("A spin of 1e-300 rad/s turns the sleigh around", "|w| [rad/s]", Decades, layers))
}

/// In units of the least number: less than half a unit is lost in every product.
pub(crate) fn subnormal_spin(program: &Program) -> Drawn {
    const LEAST: f64 = 5e-324;
    const UNITS: [f64; 3] = [1.0, 30.0, 300.0];
    let mut layers = Vec::new();
    for method in ["dla", "dla-trapezoid"] {
        let runs = UNITS.map(|units| program.run(method, &Setup::free(-1.0, units * LEAST, 0.05, 40.0)));
        let units = |nodes: &Vec<Seen>| nodes.iter().map(|node| [node.t, node.values[SPIN] / LEAST]).collect();
        let curves = runs.into_iter().map(|run| run.map(|nodes| units(&nodes))).collect::<Result<_, _>>()?;
        layers.push(Layer::Curves { label: method.to_owned(), curves });
    }
    Ok(in_time("The least numbers: a spin that keeps its sign", "w [4.9e-324 rad/s]", Decades, layers))
}

pub(crate) fn there_and_back(program: &Program) -> Drawn {
    let mut layers = Vec::new();
    for method in ["dla", "gauss8", "rk4-reduced", "gni"] {
        let setup = Setup::free(1.0, 0.3, 0.05, 40.0);
        let there = program.run(method, &setup)?;
        let [x, y, heading, speed, spin, _] = there[there.len() - 1].values;
        let mut back = program.run(method, &Setup { start: [x, y, heading, -speed, -spin], ..setup })?;
        // The distance from the node of the way there.
        for (node, before) in back.iter_mut().zip(there.iter().rev()) {
            node.values[X] -= before.values[X];
            node.values[Y] -= before.values[Y];
        }
        layers.push(peaks(method, &back, |node| node.values[X].hypot(node.values[Y])));
    }
    Ok(in_time("On the way back: how far from the way there", "distance [m]", Decades, layers))
}

/// What a step of `dla` solves for its mean spin `w`, as in the closed form of its map:
/// `w (1 + k U) = omega` with `U = (u + a w sin d)/cos d`, `d = h w/2`, `k = h c/2`.
pub(crate) fn long_step(_program: &Program) -> Drawn {
    let (u, omega, a, gain) = (0.1, 1.2, 0.5, 0.4);
    let residual = |h: f64, w: f64| {
        let d = 0.5 * h * w;
        w * (1.0 + 0.5 * h * gain * (u + a * w * d.sin()) / d.cos()) - omega
    };
    let (most, fine) = (4.0, 8000);
    let (mut layers, mut roots) = (Vec::new(), Vec::new());
    for h in [0.5, 1.0, 2.0] {
        let points: Vec<[f64; 2]> =
            (0..=fine).map(|k| -6.0 + 12.0 * f64::from(k) / f64::from(fine)).map(|w| [w, residual(h, w)]).collect();
        // Sign changes that are no poles.
        roots.extend(
            points.windows(2).filter(|p| p[0][1] * p[1][1] <= 0.0 && p[0][1].abs() < 1.0).map(|p| [p[0][0], 0.0]),
        );
        let within = |[w, r]: [f64; 2]| [w, if r.abs() <= most { r } else { f64::NAN }];
        layers.push(curve(&format!("h omega = {}", h * omega), points.into_iter().map(within).collect()));
    }
    layers.push(markers("solutions", roots));
    Ok(chart(
        "The equation of a long step has more than one solution",
        ["w [rad/s]", "residual [rad/s]"],
        [false; 2],
        layers,
    ))
}

pub(crate) fn step_lengths(program: &Program) -> Drawn {
    let setup = Setup { start: [1.0, 0.0, 0.3, -1.0, 0.3], ..Setup::free(0.0, 0.0, 1e-12, 1e-9) };
    let plain = broken::run(Broken::PlainSums, BODY, setup.start, broken::schedule(setup.step, setup.duration));
    // The turn of a nanosecond is below its rounding.
    let off = |node: &Seen| (node.values[X] - 1.0 + node.t * 0.3f64.cos()) / f64::EPSILON;
    let layers = vec![trace("dla", &program.run("dla", &setup)?, off), trace("sums as they are", &plain.nodes, off)];
    Ok(in_time("A thousand steps of 1e-12 s", "error of x [2.2e-16 m]", Linear, layers))
}

pub(crate) fn negative_substeps(program: &Program) -> Drawn {
    // More than all of the energy.
    const LOST: f64 = 1e4;
    let setup = Setup::free(-1.0, 1e-8, 4.0, 160.0);
    let exact = exact(&setup)?;
    let times = (0..=1600).map(|k| 0.1 * f64::from(k));
    let mut layers = vec![curve("closed form", times.map(|t| [t, exact.at(t).turn_rate]).collect())];
    let mut ends = Vec::new();
    for method in ["dla4", "dla6", "dla8", "rk4"] {
        let nodes = program.run(method, &setup)?;
        let end = &nodes[nodes.len() - 1];
        if end.t < setup.duration && spin(end) < LOST {
            ends.push([end.t, spin(end)]);
        }
        let before: Vec<Seen> = nodes.into_iter().take_while(|node| spin(node) < LOST).collect();
        layers.push(trace(method, &before, spin));
    }
    layers.push(markers("refused", ends));
    Ok(in_time("Steps of 4 s, through an unstable line", "|w| [rad/s]", Decades, layers))
}

pub(crate) fn offsets(program: &Program) -> Drawn {
    let mut layers = Vec::new();
    for offset in [0.5, 1e-3, 1e-12, 0.0] {
        let setup = Setup { body: [1.0, 1.0, offset], ..Setup::free(-1.0, 0.3, 0.05, 20.0) };
        layers.push(peaks(&format!("dla, a = {offset:?} m"), &program.run("dla", &setup)?, astray(&exact(&setup)?)));
    }
    let setup = Setup { body: [1.0, 1.0, 1e-12], ..Setup::free(-1.0, 0.3, 0.05, 20.0) };
    let schedule = broken::schedule(setup.step, setup.duration);
    let one_sided = broken::run(Broken::OneSided, setup.body, setup.start, schedule).nodes;
    layers.push(peaks("Euler, a = 1e-12 m", &one_sided, astray(&exact(&setup)?)));
    Ok(in_time("Smaller and smaller offsets", "error of the place [m]", Decades, layers))
}
