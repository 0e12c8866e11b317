//! The sleigh driven: rotors, tables of forces, a turning plane, the planimeter.

use crate::HardCaseError;
use crate::lab::{HEADING, Lab, PLACE, ROTOR, SPEED, SPIN, Setup};
use harness::stability::check::{energy, follows, measured, rounding};
use harness::stability::{Case, Claim};
use scene::{Interpolation, PathShape, PathSpec, SceneEffect, TimeSpec};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub(crate) const ROTOR_DRIVE: Case = Case {
    name: "rotor-drive",
    hard: "A rotor that is driven to and fro speeds the sleigh up, u^3 ~ 3 <tau^2> t/(m^2 a): the spin relaxes faster \
           and faster than the drive.",
    shows: "The slope of u^3 over the second half of the run.",
    bar: "The spin follows the drive up to (Omega/(c u))^2, relative, and the drive ends within a quarter of its \
          period; the method's order over the run.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn rotor_drive(lab: &mut Lab) -> Result<(), HardCaseError> {
    let frequency = 0.25;
    let torque = Some(TimeSpec::Sine { amplitude: 1.0, frequency, phase: 0.0 });
    let periods = 8.0;
    let setup = Setup::new(1.0, 0.0, 0.1, periods * TAU / frequency).with(SceneEffect::Flywheel {
        inertia: 0.2,
        rotor_rate: 0.0,
        torque,
    });
    // <tau^2> = 1/2, m = 1, a = 1/2.
    let slope = 3.0;
    let gain = 0.4;
    let middle = (slope * 0.5 * setup.duration()).cbrt();
    let end = (slope * setup.duration()).cbrt();
    let lag = (frequency / (gain * middle)).powi(2) + 0.25 / (0.5 * periods);
    let own = lab.accuracy(setup.step * gain * end, gain * end * setup.duration(), setup.steps);
    lab.run("", &setup, |run| {
        let half = run.nodes.len() / 2;
        let pair = run.nodes.get(half).zip(run.end());
        pair.map(|(a, b)| {
            let found = (b.values[SPEED].powi(3) - a.values[SPEED].powi(3)) / (b.t - a.t);
            measured("relative error of the slope of u^3", (found / slope - 1.0).abs(), lag + own)
        })
    })
}

pub(crate) const FAST_ROTOR: Case = Case {
    name: "fast-rotor",
    hard: "A rotor at 1e6 rad/s carries nearly all of the momentum and of the energy.",
    shows: "The sleigh moves as without it, and the rotor's momentum is constant.",
    bar: "The method's order over the run, and the rounding of the rotor's momentum in each step.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn fast_rotor(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (inertia, rate) = (0.2, 1e6);
    let setup =
        Setup::new(-1.0, 0.3, 0.05, 10.0).with(SceneEffect::Flywheel { inertia, rotor_rate: rate, torque: None });
    let ([kappa, all], exact) = (setup.rates()?, setup.exact()?);
    let (time, sum) = (setup.duration(), kappa + all);
    let noise = rounding(setup.steps as usize, inertia * rate);
    let bar = lab.accuracy(setup.step * sum, sum * time, setup.steps) + noise * (1.0 + sum * time);
    lab.run("", &setup, |run| {
        let at = |t| {
            let now = exact.at(t);
            [now.speed, now.turn_rate]
        };
        let momentum = |node: &harness::stability::Seen| inertia * (node.values[SPIN] + node.values[ROTOR]);
        [follows(run, [SPEED, SPIN], at, bar), harness::stability::check::constant(run, momentum, noise)]
    })
}

pub(crate) const PLANIMETER: Case = Case {
    name: "planimeter",
    hard: "The tracer runs a circle of radius R below, at and above a: the map of the heading is elliptic, parabolic \
           or hyperbolic, and changes its kind within 1e-6.",
    shows: "The heading after a round is that of the exact (Moebius) map of tan((theta - psi)/2).",
    bar: "The method's order over the round, and rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn planimeter(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (offset, period) = (0.5, 10.0);
    for ratio in [0.5, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 2.0] {
        let radius = ratio * offset;
        let path = PathSpec { shape: PathShape::Circle { radius, center: [0.0; 2] }, period };
        let mut setup = Setup::new(0.0, 0.0, 0.05, period).with(SceneEffect::Tracer { path });
        // Along the circle, the tracer in its rightmost point.
        (setup.start.x, setup.start.y, setup.start.heading) = (radius, -offset, FRAC_PI_2);
        // W' = (r - 1)/2 - (r + 1)/2 W^2 for W = tan(beta/2), beta = theta - psi, over one round of psi.
        let s = PI * (ratio * ratio - 1.0).abs().sqrt();
        let (c, d) = match ratio {
            r if r > 1.0 => (s.cosh(), s.sinh() / s * PI),
            r if r < 1.0 => (s.cos(), s.sin() / s * PI),
            _ => (1.0, PI),
        };
        let start = (0.5 * FRAC_PI_2).tan();
        let expected = 2.0 * f64::atan2(c * start + d * (ratio - 1.0), d * (ratio + 1.0) * start + c);
        let rate = (1.0 + ratio) * TAU / period;
        let bar = lab.accuracy(setup.step * rate, rate * period, setup.steps);
        lab.run(format!("R/a = {ratio}"), &setup, |run| {
            let off = run.end().map(|end| 2.0 * (0.5 * (end.values[HEADING] - expected)).sin().abs());
            off.map(|off| measured("heading after a round, modulo 2 pi", off, bar))
        })?;
    }
    Ok(())
}

pub(crate) const CORNERS: Case = Case {
    name: "corners",
    hard: "The tracer runs a square: its velocity jumps in the corners, and with it that of the blade.",
    shows: "On each side the heading follows the tractrix, tan(delta/2) falls by e^(-d/a).",
    bar: "The method's order over the round, and rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn corners(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (offset, period, first) = (0.5, 8.0, 1.0f64);
    let vertices = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let path = PathSpec { shape: PathShape::Polygon(vertices), period };
    let mut setup = Setup::new(0.0, 0.0, 0.05, period).with(SceneEffect::Tracer { path });
    (setup.start.x, setup.start.y) = (-offset * first.cos(), -offset * first.sin());
    setup.start.heading = first;
    let expected = (0..4).fold(first, |heading, side| {
        let direction = FRAC_PI_2 * f64::from(side);
        let turned = 0.5 * (heading - direction);
        direction + 2.0 * f64::atan2(turned.sin() * (-1.0 / offset).exp(), turned.cos())
    });
    let rate = 4.0 / period / offset;
    let bar = lab.accuracy(setup.step * rate, rate * period, setup.steps);
    lab.run("", &setup, |run| {
        let off = run.end().map(|end| 2.0 * (0.5 * (end.values[HEADING] - expected)).sin().abs());
        off.map(|off| measured("heading after a round, modulo 2 pi", off, bar))
    })
}

pub(crate) const JUMPS: Case = Case {
    name: "jumps",
    hard: "A thrust from a table jumps, and a step across a jump has no order.",
    shows: "With a node at every jump a straight run is exact. Where equal steps have no node at a jump, each piece between jumps has steps of its own.",
    bar: "Rounding over the steps, and nodes at the jumps to round-off.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn jumps(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (times, values) = (vec![0.0, 1.0, 2.5], vec![2.0, -3.0, 1.0]);
    let force = TimeSpec::Table { times, values, interpolation: Interpolation::Steps };
    let setup = Setup::new(0.5, 0.0, 0.0625, 4.0).with(SceneEffect::Thrust { force });
    let exact = |t: f64| {
        let parts = [(2.0, t.min(1.0)), (-3.0, (t - 1.0).clamp(0.0, 1.5)), (1.0, (t - 2.5).max(0.0))];
        parts
            .iter()
            .fold([0.0, 0.5], |[x, u], (force, time)| [x + u * time + 0.5 * force * time * time, u + force * time])
    };
    let bar = rounding(setup.steps as usize, 4.0) + if lab.is_adaptive() { 1e-12 * setup.steps as f64 } else { 0.0 };
    lab.run("a node at every jump", &setup, |run| [follows(run, [PLACE[0], SPEED], exact, bar)])?;

    let across = Setup { step: 0.3, steps: 13, ..setup };
    lab.run("jumps between the nodes of equal steps", &across, |run| {
        let misses =
            [1.0, 2.5].map(|jump| run.nodes.iter().map(|node| (node.t - jump).abs()).fold(f64::INFINITY, f64::min));
        let late = measured("a jump from the nearest node (s)", misses[0].max(misses[1]), 8.0 * f64::EPSILON * 2.5);
        // A run that was refused has no nodes at all.
        let late = run.failure.is_none().then_some(late);
        [follows(run, [PLACE[0], SPEED], exact, bar)].into_iter().chain(late)
    })
}

pub(crate) const TURNTABLE: Case = Case {
    name: "turntable",
    hard: "On a plane that turns the constraint is affine: it does work, and has no basis of admissible velocities \
           through zero.",
    shows: "The constraint to rounding, and the energy less the work of the plane.",
    bar: "Rounding of the velocities; the method's order over the run, or that of the work's quadrature (6).",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn turntable(lab: &mut Lab) -> Result<(), HardCaseError> {
    let mut setup = Setup::new(0.5, 0.3, 0.05, 10.0).with(SceneEffect::Turntable { rate: 0.3 });
    (setup.start.x, setup.start.y) = (0.4, 0.2);
    // Far out the plane is fast.
    let run = lab.record(&setup)?;
    let far = |node: &harness::stability::Seen| node.values[0].hypot(node.values[1]);
    let reach = run.nodes.iter().map(far).fold(0.0, f64::max);
    let fastest = run.nodes.iter().map(|node| node.values[SPEED].abs()).fold(0.3 * reach, f64::max);
    let [kappa, all] = setup.rates()?;
    let rate = (kappa + all + 0.3) * fastest.max(1.0);
    let own = lab.accuracy(setup.step * rate, rate * setup.duration(), setup.steps);
    let work = harness::stability::check::truncation(6, setup.step * rate, rate * setup.duration());
    let size = fastest * fastest;
    let held = lab.constraint(&run, fastest);
    lab.judge("", &run, held.into_iter().chain([energy(&run, size * (own + work))]));
    Ok(())
}
