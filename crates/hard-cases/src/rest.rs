//! Motions that are small beside the forces on them: what settles, swings by next to nothing, or is balanced.

use crate::HardCaseError;
use crate::lab::{HEADING, Lab, PLACE, SPEED, SPIN, Setup};
use harness::stability::check::{follows, measured, rounding, stays_below};
use harness::stability::{Case, Claim, claims};
use scene::SceneEffect;
use std::f64::consts::FRAC_PI_2;

pub(crate) const SETTLES: Case = Case {
    name: "settles",
    hard: "A sleigh with drag, in a well off the origin and on the plane, until it is at rest, with velocities below \
           the rounding of forces that balance.",
    shows: "Every run reaches its end: no speed, no spin, and in the well the centre of mass in the middle.",
    bar: "What is left after three quarters of the run of 1 m or 1 m/s that die out as e^(-t/8 s); rounding over the \
          steps; of methods whose blade slips, their order.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn settles(lab: &mut Lab) -> Result<(), HardCaseError> {
    // Half of drag over inertia: 0.25/s along the blade and 0.12/s about it; less, where the two are coupled.
    let drag = SceneEffect::Drag { along: 0.5, turning: 0.3 };
    let (center, offset) = ([0.3, 0.7], 0.5);
    let mut plane = Setup { body: [1.0, 1.0, offset], every: 8, ..Setup::new(1.0, 0.5, 0.05, 400.0) }.with(drag);
    (plane.start.x, plane.start.y) = (-0.2, 0.1);
    let well = plane.clone().with(SceneEffect::Bowl { stiffness: [3.0, 7.0], center });
    let late = 0.75 * plane.duration();
    // What has slipped while there was motion, eight seconds at rates of up to sqrt(7)/s, slips on at rest.
    let slips = claims(lab.method.info().kind, Claim::Constraint).is_err();
    let slip = if slips { lab.accuracy(plane.step * 2.6, 2.6 * 8.0, plane.steps) } else { 0.0 };
    let bar = (-late / 8.0).exp() + rounding(plane.steps as usize, 1.0) + slip;
    let still = |run: &harness::stability::Recorded| [SPEED, SPIN].map(|value| stays_below(run, value, late, bar));
    lab.run("on the plane", &plane, still)?;
    lab.run("in the well", &well, |run| {
        let off = run.nodes.iter().filter(|node| node.t >= late).map(|node| {
            let [x, y, heading, ..] = node.values;
            (x + offset * heading.cos() - center[0]).hypot(y + offset * heading.sin() - center[1])
        });
        let apart = measured("distance from the middle of the well", off.fold(0.0, lagrangian::linear::larger), bar);
        still(run).into_iter().chain([apart]).collect::<Vec<_>>()
    })
}

pub(crate) const TINY_SWING: Case = Case {
    name: "tiny-swing",
    hard: "Through the bottom of a well off the origin at 1e-4, 1e-10 and 1e-13 m/s: the place moves by its last \
           digits, and a force is the difference of two numbers nearly the same.",
    shows: "u = U cos(sqrt(k/m) t), along the line of the blade.",
    bar: "The method's order over the run, relative to U; the rounding of the place in the force, eps k abs(C)/m, all \
          the time.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn tiny_swing(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (stiffness, center) = (3.0f64, [0.3, 0.7]);
    let rate = stiffness.sqrt();
    for speed in [1e-4, 1e-10, 1e-13] {
        let well = SceneEffect::Bowl { stiffness: [stiffness; 2], center };
        let mut setup = Setup { body: [1.0, 1.0, 0.0], ..Setup::new(speed, 0.0, 0.02, 100.0) }.with(well);
        ([setup.start.x, setup.start.y], setup.start.heading) = (center, 0.4);
        let time = setup.duration();
        let forces = 4.0 * f64::EPSILON * stiffness * time;
        let bar = lab.accuracy(setup.step * rate, rate * time, setup.steps) * speed + forces;
        lab.run(format!("{speed:e} m/s"), &setup, |run| [follows(run, [SPEED], |t| [speed * (rate * t).cos()], bar)])?;
    }
    Ok(())
}

pub(crate) const BALANCE: Case = Case {
    name: "balance",
    hard: "A skate at rest across a slope of 9.8 m/s^2, its blade level to 0, 1e-9 and 1e-7 rad: the blade bears all \
           of the weight.",
    shows: "u = -g sin(angle) t, and no spin; a level blade stays where it is.",
    bar: "Rounding of the velocity that the weight alone would give in a step, over the steps.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn balance(lab: &mut Lab) -> Result<(), HardCaseError> {
    let gravity = [5.3, -8.2f64];
    let fall = gravity[0].hypot(gravity[1]);
    for angle in [0.0, 1e-9, 1e-7] {
        let slope = SceneEffect::Slope { gravity };
        let mut setup = Setup { body: [1.0, 1.0, 0.0], ..Setup::new(0.0, 0.0, 0.01, 10.0) }.with(slope);
        setup.start.heading = gravity[1].atan2(gravity[0]) + FRAC_PI_2 + angle;
        let bar = rounding(setup.steps as usize, fall * setup.step);
        lab.run(format!("{angle:e} rad"), &setup, |run| {
            [follows(run, [SPEED, SPIN], |t| [-fall * f64::sin(angle) * t, 0.0], bar)]
        })?;
    }
    Ok(())
}

pub(crate) const CANCELLING_FORCES: Case = Case {
    name: "cancelling-forces",
    hard: "A sleigh between springs of 3 and of 1e6 N/m that balance, at rest there and 1e-9 m beside: forces of up to \
           3e5 N leave 2e-3 N, or nothing.",
    shows: "x = x0 + s cos(sqrt(2 k/m) t), and no spin.",
    bar: "The method's order over the run, relative to s; the rounding of the springs' lengths, as a displacement that \
          grows with the oscillation.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn cancelling_forces(lab: &mut Lab) -> Result<(), HardCaseError> {
    let (ends, part, length) = ([0.1, 0.7], 0.1, 100.0);
    let middle = 0.5 * (ends[0] + ends[1]);
    for stiffness in [3.0, 1e6] {
        let rate = f64::sqrt(2.0 * stiffness);
        for off in [0.0, 1e-9] {
            let mut setup = Setup { body: [1.0, 1.0, 0.0], ..Setup::new(0.0, 0.0, part / rate, length / rate) };
            for end in ends {
                setup = setup.with(SceneEffect::Bowl { stiffness: [stiffness; 2], center: [end, 0.0] });
            }
            setup.start.x = middle + off;
            let bar = lab.accuracy(part, length, setup.steps) * off + 4.0 * f64::EPSILON * (1.0 + length);
            lab.run(format!("{stiffness:e} N/m, {off:e} m"), &setup, |run| {
                [
                    follows(run, [PLACE[0]], |t| [middle + off * (rate * t).cos()], bar),
                    follows(run, [PLACE[1], HEADING], |_| [0.0; 2], bar),
                ]
            })?;
        }
    }
    Ok(())
}
