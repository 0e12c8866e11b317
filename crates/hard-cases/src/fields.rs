//! The sleigh in fields: wells, landscapes, hills, and thrust that makes one.

use crate::HardCaseError;
use crate::lab::{Lab, MOTION, SPEED, SPIN, Setup};
use harness::stability::check::{agrees, constant, energy, measured, rounding, sign_kept, truncation};
use harness::stability::{Case, Claim, Seen, claims};
use scene::{HillSpec, SceneEffect, TimeSpec};
use std::f64::consts::{FRAC_PI_2, TAU};

impl Lab {
    /// What the energy may be wrong by, of a size `all` (J): rounding where a method keeps it, else as any relative error.
    fn energy_bar(&self, all: f64, part: f64, length: f64, steps: u64) -> f64 {
        let kept = claims(self.method.info().kind, Claim::Energy).is_ok();
        all * if kept { rounding(steps as usize, 1.0) } else { self.accuracy(part, length, steps) }
    }
}

pub(crate) const STIFF_BOWL: Case = Case {
    name: "stiff-bowl",
    hard: "A bowl whose oscillation takes from 600 steps to a sixteenth of a step: sqrt(k/m) h from 0.01 to 100.",
    shows: "Implicit rules that are stable for every step stay in the bowl; all others say that the step is too long.",
    bar: "The energy within its own size: an unstable step multiplies it. At 0.01 the method's order over the run.",
    claim: Claim::Stiffness,
    refusable: true,
};

pub(crate) fn stiff_bowl(lab: &mut Lab) -> Result<(), HardCaseError> {
    let step = 0.05;
    // A balanced sleigh: else its heading is unstable on the way out, and has no solution for long steps.
    let body = [1.0, 1.0, 0.0];
    for part in [0.01, 1.0, 10.0, 100.0] {
        let stiffness = (part / step) * (part / step);
        let bowl = SceneEffect::Bowl { stiffness: [stiffness; 2], center: [0.0; 2] };
        let mut setup = Setup { body, ..Setup::new(0.0, 0.0, step, 10.0) }.with(bowl);
        // A metre out, the blade along the way to the middle.
        setup.start.x = 1.0;
        let all = 0.5 * stiffness;
        let bar = if part < 0.1 { lab.energy_bar(all, part, part * setup.steps as f64, setup.steps) } else { all };
        lab.run(format!("sqrt(k/m) h = {part}"), &setup, |run| [energy(run, bar)])?;
    }
    Ok(())
}

pub(crate) const STEEP_HILL: Case = Case {
    name: "steep-hill",
    hard: "Hills of 1 cm width in the way of a sleigh that goes 5 cm a step: a step may miss a hill, or feel its flank \
           all along.",
    shows: "Methods that promise the energy keep it or refuse the step. The others cannot know what lies between \
            nodes, and go on with finite numbers.",
    bar: "Rounding of the energy.",
    claim: Claim::Energy,
    refusable: true,
};

pub(crate) fn steep_hill(lab: &mut Lab) -> Result<(), HardCaseError> {
    for (y, height) in [(0.0, 0.2), (0.004, 5.0), (0.0, -3.0)] {
        let hills = [0.3, 0.82, 1.01].map(|x| HillSpec { height, x, y, width: 0.01 });
        let mut setup = Setup::new(1.0, 0.2, 0.05, 5.0).with(SceneEffect::Hills { hills: hills.to_vec() });
        setup.start.x = -0.5;
        let bar = rounding(setup.steps as usize, setup.exact()?.energy() + 3.0 * f64::abs(height));
        lab.run(format!("hills of {height} J"), &setup, |run| [energy(run, bar)])?;
    }
    Ok(())
}

pub(crate) const TURNING_POINTS: Case = Case {
    name: "turning-points",
    hard: "To and fro in a bowl, standing still twice in a period. A discrete gradient divides by the way of a step, \
           and a direction by the speed.",
    shows: "The energy, through every turning point; at rest in the middle nothing moves.",
    bar: "Rounding for the methods that keep the energy, for others their order over the run.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn turning_points(lab: &mut Lab) -> Result<(), HardCaseError> {
    let bowl = SceneEffect::Bowl { stiffness: [1.0; 2], center: [0.0; 2] };
    let mut setup = Setup::new(0.0, 0.0, 0.05, 50.0).with(bowl.clone());
    setup.start.x = 0.5;
    let bar = lab.energy_bar(0.5, setup.step, setup.duration(), setup.steps);
    lab.run("from rest", &setup, |run| [energy(run, bar)])?;
    let mut still = setup.clone();
    // The centre of mass in the middle.
    still.start.x = -0.5;
    lab.run("at rest", &still, |run| {
        let way = |node: &Seen| MOTION.iter().map(|i| (node.values[*i] - still_at(*i)).abs()).sum();
        [constant(run, way, 0.0)]
    })
}

fn still_at(value: usize) -> f64 {
    if value == 0 { -0.5 } else { 0.0 }
}

pub(crate) const LOG_WELL: Case = Case {
    name: "log-well",
    hard: "A constant backward thrust: the spin goes up and down over decades for ever, and K = E + (F/c) \
           ln(abs(omega)) is constant.",
    shows: "K stays near its value, without a trend for a symmetric method.",
    bar: "The method's order over one oscillation where it is symmetric, over the run where it is not.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn log_well(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (force, gain, inertia) = (-0.5, 0.4, 1.25);
    let setup = Setup::new(0.0, 0.1, 0.05, 200.0).with(SceneEffect::Thrust { force: TimeSpec::Constant(force) });
    let value =
        |speed: f64, spin: f64| 0.5 * speed * speed + 0.5 * inertia * spin * spin + force / gain * spin.abs().ln();
    let all = value(0.0, 0.1);
    // The largest spin is where K holds with no speed, the largest speed where the spin is |F|/(m a) = 1.
    let rate = gain * (2.0 * (all - value(0.0, 1.0))).sqrt() + 2.6;
    let symmetric = claims(lab.method.info().kind, Claim::Symmetry).is_ok();
    let length = if symmetric { TAU } else { rate * setup.duration() };
    let bar = all * lab.accuracy(setup.step * rate, length, setup.steps);
    lab.run("", &setup, |run| {
        [constant(run, |node| value(node.values[SPEED], node.values[SPIN]), bar), sign_kept(run, SPIN)]
    })
}

pub(crate) const ATTRACTOR: Case = Case {
    name: "attractor",
    hard: "In the egg-crate a sleigh with a > 0 is drawn to an attractor. Its mirror image is a repeller, so every \
           symmetric method gains or loses energy at a rate ~ h^p.",
    shows: "The energy error of a method of order p falls as h^p; methods that keep the energy keep it.",
    bar: "Half the step: 2^-p of the error, or twice that before the order is reached; rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn attractor(lab: &mut Lab) -> Result<(), HardCaseError> {
    for offset in [0.5, 0.1] {
        let mut setup = Setup { body: [1.0, 1.0, offset], ..Setup::new(0.4, 0.7, 0.1, 20.0) };
        setup.start.x = 0.5 - offset * f64::cos(0.3);
        setup.start.y = 1.0 - offset * f64::sin(0.3);
        setup.start.heading = 0.3;
        setup.effects.push(SceneEffect::EggCrate { height: 0.5, wave_number: [1.0; 2] });
        let half = Setup { step: 0.5 * setup.step, steps: 2 * setup.steps, ..setup.clone() };
        let largest = |setup: &Setup| -> Result<_, HardCaseError> {
            let run = lab.record(setup)?;
            let error = energy(&run, 0.0).measured;
            Ok((run, error))
        };
        let ((_, coarse), (run, fine)) = (largest(&setup)?, largest(&half)?);
        let floor =
            rounding(half.steps as usize, 1.2) + if lab.is_adaptive() { 1e-12 * half.steps as f64 } else { 0.0 };
        let bar = floor.max(2.0 * coarse * truncation(lab.order(), 0.5, 1.0));
        lab.judge(format!("a = {offset}"), &run, [measured("energy error at half the step", fine, bar)]);
    }
    Ok(())
}

pub(crate) const ROUND_BOWL: Case = Case {
    name: "round-bowl",
    hard: "A periodic attractor in a round bowl (8 J, a = 0.5). A scheme that is not symmetric under rotations, or \
           that mistakes the turns of an angle, breaks it.",
    shows: "The same motion from a start that is rotated, and from one with a thousand turns more.",
    bar: "Rounding over the steps, times e^(kappa T), by which no disturbance grows faster.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn round_bowl(lab: &mut Lab) -> Result<(), HardCaseError> {
    let bowl = SceneEffect::Bowl { stiffness: [1.0; 2], center: [0.0; 2] };
    let mut plain = Setup::new(3.0, 2.0, 0.02, 10.0).with(bowl);
    let mut rotated = plain.clone();
    (plain.start.x, plain.start.y) = (0.8, 0.0);
    (rotated.start.x, rotated.start.y, rotated.start.heading) = (0.0, 0.8, FRAC_PI_2);
    let mut turned = plain.clone();
    turned.start.heading = 1000.0 * TAU;
    let [kappa, all] = plain.rates()?;
    let grown = |size: f64| size * (kappa * plain.duration()).exp() * (1.0 + all * plain.duration());
    let bar = rounding(plain.steps as usize, grown(1.0));
    let run = lab.record(&plain)?;
    let image = lab.record(&rotated)?;
    let back = |node: &Seen| {
        let [x, y, heading, speed, spin, _] = node.values;
        [y, -x, heading - FRAC_PI_2, speed, spin]
    };
    lab.judge("rotated", &run, [agrees(&run, &image, MOTION, back, bar)]);
    let image = lab.record(&turned)?;
    let same = |node: &Seen| {
        let [x, y, heading, speed, spin, _] = node.values;
        [x, y, heading - 1000.0 * TAU, speed, spin]
    };
    // The heading is given with the rounding of so many turns.
    let given = f64::EPSILON * 1000.0 * TAU;
    lab.judge("turned", &run, [agrees(&run, &image, MOTION, same, bar + grown(given))]);
    Ok(())
}

pub(crate) const HEAVY_DRAG: Case = Case {
    name: "heavy-drag",
    hard: "Drag that stops the sleigh within a step, c h/m up to 1e6. Beyond c h/m = 2 rules for the mean velocity \
           change the sign of the speed in every step.",
    shows: "The speed never changes its sign, or the step is refused.",
    bar: "No node with the wrong sign.",
    claim: Claim::Stiffness,
    refusable: true,
};

pub(crate) fn heavy_drag(lab: &mut Lab) -> Result<(), HardCaseError> {
    let least = if lab.is_adaptive() { harness::Method::TOLERANCE } else { 0.0 };
    for part in [0.1, 1.0, 3.0, 1e3, 1e6] {
        let along = part / 0.05;
        let setup = Setup::new(1.0, 0.0, 0.05, 1.0).with(SceneEffect::Drag { along, turning: 0.0 });
        lab.run(format!("c h/m = {part:e}"), &setup, |run| {
            // What has died out has no sign: to nothing, or to the absolute tolerance of an adaptive method.
            let alive = run.nodes.iter().take_while(|node| node.values[SPEED].abs() > least).copied().collect();
            [sign_kept(&harness::stability::Recorded { nodes: alive, ..run.clone() }, SPEED)]
        })?;
    }
    Ok(())
}
