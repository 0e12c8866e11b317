//! Bowls, drag, rotors, jumps.

use crate::curves::Upright::{Decades, Linear};
use crate::curves::{SPEED, SPIN, curve, in_time, markers, peaks, trace};
use crate::free::exact;
use crate::program::{Program, Setup};
use harness::stability::Seen;
use report::Chart;
use std::error::Error;

type Drawn = Result<Chart, Box<dyn Error>>;

pub(crate) fn stiff_bowl(program: &Program) -> Drawn {
    // sqrt(k/m) h = 10.
    let stiffness = 4e4;
    let effects = format!("[[effects]]\nkind = \"bowl\"\nstiffness = [{stiffness:?}, {stiffness:?}]\n");
    let start = [1.0, 0.0, 0.0, 0.0, 0.0];
    let setup = Setup { body: [1.0, 1.0, 0.0], start, effects: &effects, ..Setup::free(0.0, 0.0, 0.05, 3.0) };
    let (mut layers, mut refused) = (Vec::new(), Vec::new());
    for method in ["dla", "dla8", "dla-trapezoid", "rk4", "gauss8"] {
        let nodes = program.run(method, &setup)?;
        if nodes.len() == 1 {
            refused.push([0.0, 1.0]);
            continue;
        }
        // Beyond this a run has left the bowl.
        let inside: Vec<Seen> = nodes.into_iter().take_while(|node| node.values[0].abs() < 1e8).collect();
        layers.push(trace(method, &inside, |node| node.values[0].abs()));
    }
    layers.push(markers("gauss8: refused", refused));
    Ok(in_time("A bowl that oscillates more than once in a step", "|x| [m]", Decades, layers))
}

pub(crate) fn turning_points(program: &Program) -> Drawn {
    let effects = "[[effects]]\nkind = \"bowl\"\nstiffness = [1.0, 1.0]\n";
    let setup = Setup { start: [0.5, 0.0, 0.0, 0.0, 0.0], effects, ..Setup::free(0.0, 0.0, 0.05, 20.0) };
    let speed = program.run("energy2", &setup)?;
    let mut layers = vec![trace("|u|", &speed, |node| node.values[SPEED].abs())];
    for method in ["energy2", "dla", "rk4"] {
        layers.push(peaks(&format!("energy error, {method}"), &program.run(method, &setup)?, |node| node.energy_error));
    }
    Ok(in_time("From rest, through turning points", "|u| [m/s], energy error [J]", Decades, layers))
}

pub(crate) fn heavy_drag(program: &Program) -> Drawn {
    let run = |coefficient: f64, step: f64| {
        let effects = format!("[[effects]]\nkind = \"drag\"\nalong = {coefficient:?}\n");
        program.run("dla", &Setup { effects: &effects, ..Setup::free(1.0, 0.0, step, 0.4) })
    };
    let speed = |node: &Seen| node.values[SPEED];
    // c h/m = 10, on the mean velocity of the step.
    let overshooting = (0..=8).map(|k| [0.05 * f64::from(k), (-4.0f64 / 6.0).powi(k)]);
    let layers = vec![
        curve("midpoint rule, c h/m = 10", overshooting.collect()),
        trace("dla, a tenth of the step", &run(200.0, 0.005)?, speed),
        trace("dla, c h/m = 1.5", &run(30.0, 0.05)?, speed),
        markers("dla, c h/m = 10: refused", [[0.0, 1.0]]),
    ];
    Ok(in_time("Drag that stops within a step", "u [m/s]", Linear, layers))
}

pub(crate) fn fast_rotor(program: &Program) -> Drawn {
    let effects = "[[effects]]\nkind = \"flywheel\"\ninertia = 0.2\nrotor_rate = 1e6\n";
    let without = Setup::free(-1.0, 0.3, 0.05, 10.0);
    let with = Setup { effects, ..without };
    let exact = exact(&without)?;
    let off = |node: &Seen| (node.values[SPIN] - exact.at(node.t).turn_rate).abs();
    let mut layers = Vec::new();
    for method in ["dla", "gauss8"] {
        layers.push(peaks(&format!("{method}, no rotor"), &program.run(method, &without)?, off));
        layers.push(peaks(&format!("{method}, rotor at 1e6 rad/s"), &program.run(method, &with)?, off));
    }
    // The same spin as a difference of momenta in half the digits.
    let mut single = program.run("gauss8", &without)?;
    for node in &mut single {
        let (all, carried) = (1.25 * node.values[SPIN] + 2e5, 2e5f32);
        node.values[SPIN] = f64::from(all as f32 - carried) / 1.25;
    }
    layers.push(peaks("momenta in half the digits", &single, off));
    Ok(in_time("A rotor that carries nearly all of the momentum", "error of the spin [rad/s]", Decades, layers))
}

pub(crate) fn jumps(program: &Program) -> Drawn {
    let effects = "[[effects]]\nkind = \"thrust\"\nforce = { times = [0.0, 1.0, 2.5], values = [2.0, -3.0, 1.0] }\n";
    let setup = Setup { effects, ..Setup::free(0.5, 0.0, 0.0625, 4.0) };
    let speed = |t: f64| 0.5 + 2.0 * t.min(1.0) - 3.0 * (t - 1.0).clamp(0.0, 1.5) + (t - 2.5).max(0.0);
    // Steps of 0.3 s that know the force where they begin.
    let force = |t: f64| {
        if t < 1.0 {
            2.0
        } else if t < 2.5 {
            -3.0
        } else {
            1.0
        }
    };
    let mut across = vec![[0.0, 0.5]];
    for k in 0..13 {
        let [t, u] = across[across.len() - 1];
        across.push([0.3 * f64::from(k + 1), u + 0.3 * force(t)]);
    }
    let exact = (0..=80).map(|k| 0.05 * f64::from(k)).map(|t| [t, speed(t)]);
    let layers = vec![
        curve("closed form", exact.collect()),
        trace("dla, a node at every jump", &program.run("dla", &setup)?, |node| node.values[SPEED]),
        curve("steps across the jumps", across),
    ];
    Ok(in_time("A thrust that jumps at 1 s and 2.5 s", "u [m/s]", Linear, layers))
}
