//! Systems that no scene has.

use crate::curves::Upright::Linear;
use crate::curves::{curve, in_time, level, markers, upper_edge};
use crate::program::Program;
use dla::{Dla, Energy, Node, OneStep, Rk4Reduced, Schedule, State, Trajectory, drive};
use lagrangian::System;
use report::Chart;
use sleigh::{Exact, Sleigh, SleighState};
use std::error::Error;
use std::f64::consts::PI;
use test_systems::{CompoundPendulum, ContactOscillator};

noslip::system! {
    /// Two blades side by side, parallel: the second says what the first does.
    struct ParallelBlades;
    coordinates = { x = "m", y = "m", theta = "angle" }
    parameters = { m = 1.0, I = 1.0, a = 0.5 }
    let = { across = "y'*cos(theta) - x'*sin(theta)" }
    lagrangian = "m/2*(x'^2 + y'^2) + m*a*theta'*across + (I + m*a^2)/2*theta'^2"
    constraints = ["across", "across"]
}

noslip::system! {
    /// A blade, and a guide that lets go at `x = 1 m`.
    struct BladeAndGuide;
    coordinates = { x = "m", y = "m", theta = "angle" }
    parameters = { m = 1.0, I = 1.0, a = 0.5 }
    let = { across = "y'*cos(theta) - x'*sin(theta)" }
    lagrangian = "m/2*(x'^2 + y'^2) + m*a*theta'*across + (I + m*a^2)/2*theta'^2"
    constraints = ["across", "(x - 1)*theta'"]
}

type Drawn = Result<Chart, Box<dyn Error>>;

/// The nodes of a run; of one that is refused on its way, those before.
fn nodes<Sys: System<3, M>, const M: usize>(
    system: &Sys,
    mut method: impl OneStep<3, M>,
    (q, v): ([f64; 3], [f64; 3]),
    (step, steps): (f64, u64),
) -> Vec<Node> {
    let mut state = State::new(q, v, system.angles());
    let mut trajectory = Trajectory::every(1);
    // A refusal is part of the picture.
    let _refused = drive(system, &mut method, &Schedule { t0: 0.0, step, steps }, &mut state, &mut trajectory);
    trajectory.nodes().to_vec()
}

pub(crate) fn parallel_blades(_program: &Program) -> Drawn {
    let (u, omega, a) = (-1.0, 0.3, 0.5);
    let sleigh = Sleigh::new(1.0, 1.0, a)?;
    let start = SleighState { speed: u, turn_rate: omega, ..SleighState::default() };
    let exact = Exact::new(&sleigh, &start)?;
    let gain = sleigh.spin_gain();
    // u' = a w^2 and w' = -2 c u w, where each blade has the force of one: w = W sech(s), s = s0 + 2 c U t.
    let speed = f64::hypot(u, omega * (a / (2.0 * gain)).sqrt());
    let begin = -f64::acosh((2.0 * gain / a).sqrt() * speed / omega);
    let gudermann = |s: f64| 2.0 * (0.5 * s).tanh().atan();
    let turned = |t: f64| (gudermann(begin + 2.0 * gain * speed * t) - gudermann(begin)) / (2.0 * a * gain).sqrt();
    let times = |count: u32| (0..=count).map(move |k| 20.0 * f64::from(k) / f64::from(count));
    let dla = nodes(&ParallelBlades::default(), Dla::midpoint(), start.to_coordinates(), (0.05, 400));
    let layers = vec![
        curve("dla, two blades", dla.iter().map(|node| [node.t, node.q[2]]).collect()),
        curve("the force counted twice", times(200).map(|t| [t, turned(t)]).collect()),
        markers("closed form, one blade", times(20).map(|t| [t, exact.at(t).heading])),
    ];
    Ok(in_time("Two parallel blades are one", "heading [rad]", Linear, layers))
}

pub(crate) fn dropping_row(_program: &Program) -> Drawn {
    let run = nodes(&BladeAndGuide::default(), Dla::midpoint(), ([0.0; 3], [1.0, 0.0, 0.0]), (0.0625, 32));
    let way: Vec<[f64; 2]> = run.iter().map(|node| [node.t, node.q[0]]).collect();
    let end = way[way.len() - 1];
    let layers = vec![
        curve("dla", way),
        curve("as if nothing were", vec![end, [2.0, 2.0]]),
        level("where the row vanishes", 1.0, 2.0),
        markers("dla: refused", [end]),
    ];
    Ok(in_time("A guide (x - 1) w = 0 that lets go", "x [m]", Linear, layers))
}

pub(crate) fn pseudo_holonomic(_program: &Program) -> Drawn {
    let pendulum = CompoundPendulum::new(1.3, 0.4, 0.9, 9.81).pseudo_holonomic();
    let (start, steps) = (pendulum.state_at(1.2, 0.3), (0.1, 20_000));
    let off = |nodes: Vec<Node>| {
        let hinge = |node: &Node| pendulum.hinge(&[node.q[0], node.q[1], node.q[2]]);
        upper_edge(nodes.iter().map(|node| [node.t, hinge(node)[0].hypot(hinge(node)[1])]))
    };
    let layers = vec![
        curve("dla", off(nodes(&pendulum, Dla::midpoint(), start, steps))),
        curve("rk4-reduced", off(nodes(&pendulum, Rk4Reduced, start, steps))),
    ];
    Ok(in_time("A hinge that is given by its rates alone", "distance of the hinge [m]", Linear, layers))
}

pub(crate) fn gauge(_program: &Program) -> Drawn {
    let without = ContactOscillator::default();
    let start = without.start_at(-0.5 * 2f64.sqrt());
    let steps = (2.0 * (PI / 40.0).sin(), 100_000);
    let with = ContactOscillator { s: 1.0, ..without };
    // The mean over fifty periods of `y`, so that what drifts is seen without what swings.
    let drift = |label: &str, nodes: Vec<Node>| {
        let mean = |part: &[Node]| part.iter().map(|node| node.energy - nodes[0].energy).sum::<f64>() / 2000.0;
        curve(label, nodes.chunks_exact(2000).map(|part| [part[0].t, mean(part)]).collect())
    };
    let layers = vec![
        drift("dla", nodes(&with, Dla::midpoint(), start, steps)),
        drift("dla, no gauge term", nodes(&without, Dla::midpoint(), start, steps)),
        drift("energy2", nodes(&with, Energy::new::<1>(), start, steps)),
    ];
    Ok(in_time("A gauge term, which changes no motion", "E - E0, mean of 50 periods", Linear, layers))
}
