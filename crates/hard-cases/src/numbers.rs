//! Numbers far from one: places, turns, times, masses, speeds.

use crate::HardCaseError;
use crate::free::follows_exactly;
use crate::lab::{HEADING, Lab, PLACE, SPEED, SPIN, Setup};
use harness::stability::check::{agrees, rounding};
use harness::stability::{Case, Claim};
use scene::{SceneEffect, TimeSpec};
use std::f64::consts::TAU;

pub(crate) const FAR_AWAY: Case = Case {
    name: "far-away",
    hard: "A place of 1e8 m has digits down to 1.5e-8 m only, and an equation for the place has none left for the \
           velocity.",
    shows: "The motion is that at the origin, moved.",
    bar: "The rounding of one place, 1.5e-8 m, for any number of steps; the velocities to rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn far_away(lab: &mut Lab) -> Result<(), HardCaseError> {
    const FAR: f64 = 1e8;
    let here = Setup::new(-1.0, 0.3, 0.05, 50.0);
    let mut there = here.clone();
    (there.start.x, there.start.y) = (FAR, -FAR);
    let ulp = f64::EPSILON * FAR;
    let (run, image) = (lab.record(&there)?, lab.record(&here)?);
    // As the way, so its rounding grows with the turn.
    let bar = rounding(here.steps as usize, 50.0);
    let found = [
        agrees(&run, &image, PLACE, |node| [node.values[0] + FAR, node.values[1] - FAR], ulp + bar),
        agrees(&run, &image, [HEADING, SPEED, SPIN], |node| [HEADING, SPEED, SPIN].map(|i| node.values[i]), bar),
    ];
    lab.judge("free", &run, found);

    // A balanced sleigh: no exponent makes more of the rounding of the place, which acts as a force all the time.
    let bowl = |center| SceneEffect::Bowl { stiffness: [0.1; 2], center };
    let mut here = Setup { body: [1.0, 1.0, 0.0], ..Setup::new(1.0, 0.3, 0.05, 20.0) }.with(bowl([0.0, 0.0]));
    here.start.x = 1.0;
    let mut there = Setup { effects: vec![bowl([FAR, -FAR])], ..here.clone() };
    (there.start.x, there.start.y) = (FAR + 1.0, -FAR);
    let (run, image) = (lab.record(&there)?, lab.record(&here)?);
    let time = here.duration();
    let moved = agrees(
        &run,
        &image,
        PLACE,
        |node| [node.values[0] + FAR, node.values[1] - FAR],
        ulp * (1.0 + 0.1 * time * time),
    );
    lab.judge("in a bowl there", &run, [moved]);
    Ok(())
}

pub(crate) const MANY_TURNS: Case = Case {
    name: "many-turns",
    hard: "A heading of a million turns has digits down to 1e-9 rad only.",
    shows: "The motion from the same heading without the turns.",
    bar: "Rounding over the steps; the heading itself to the rounding of 6e6 rad.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn many_turns(lab: &mut Lab) -> Result<(), HardCaseError> {
    const TURNS: f64 = 1e6;
    /// `2 pi` minus its nearest number.
    const TAU_REST: f64 = 2.449_293_598_294_706_4e-16;
    let mut turned = Setup::new(-1.0, 0.3, 0.05, 50.0);
    turned.start.heading = TURNS * TAU + 0.3;
    let mut plain = turned.clone();
    plain.start.heading = (-TURNS).mul_add(TAU, turned.start.heading) - TURNS * TAU_REST;
    let (run, image) = (lab.record(&turned)?, lab.record(&plain)?);
    let bar = rounding(turned.steps as usize, 50.0);
    let found = [
        agrees(&run, &image, PLACE, |node| [node.values[0], node.values[1]], bar),
        agrees(&run, &image, [SPEED, SPIN], |node| [node.values[SPEED], node.values[SPIN]], bar),
        agrees(&run, &image, [HEADING], |node| [node.values[HEADING] + TURNS * TAU], bar + TURNS * TAU * f64::EPSILON),
    ];
    lab.judge("", &run, found);
    Ok(())
}

pub(crate) const LATE: Case = Case {
    name: "late",
    hard: "A force that depends on time, after 1e9 steps: a time summed step by step is wrong by then.",
    shows: "After whole periods the motion is that from time zero.",
    bar: "The rounding of the phase, 4 eps omega t, in the force, and rounding over the steps.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn late(lab: &mut Lab) -> Result<(), HardCaseError> {
    // 64 steps a period, of a length that no sum of them is a multiple of.
    const BEFORE: u64 = 1_000_000_000;
    let (step, frequency) = (0.03, TAU / (64.0 * 0.03));
    let force = TimeSpec::Sine { amplitude: 1.0, frequency, phase: 0.3 };
    let early = Setup::new(0.2, 0.5, step, 20.0).with(SceneEffect::Thrust { force });
    let later = Setup { from: BEFORE, ..early.clone() };
    let (run, image) = (lab.record(&later)?, lab.record(&early)?);
    let phase = 4.0 * f64::EPSILON * frequency * BEFORE as f64 * step;
    let time = early.duration();
    let bar = phase * time * (1.0 + time) + rounding(early.steps as usize, time * time);
    lab.judge("", &run, [agrees(&run, &image, [0, 1, 2, 3, 4], |node| [0, 1, 2, 3, 4].map(|i| node.values[i]), bar)]);
    Ok(())
}

pub(crate) const MASSES: Case = Case {
    name: "masses",
    hard: "Masses and inertias over twenty orders of magnitude, together and against one another: an absolute \
           tolerance loses one of them.",
    shows: "The closed form, which depends on I/m and a only.",
    bar: "The method's order over the run, and rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn masses(lab: &mut Lab) -> Result<(), HardCaseError> {
    let bodies = [[1e-10, 1e-10, 0.5], [1e10, 1e10, 0.5], [1e-10, 1e10, 0.5], [1.0, 1.0, 1e-8]];
    for body @ [mass, inertia, offset] in bodies {
        let spin = if inertia / mass > 1e10 { 1e-11 } else { 0.3 };
        let setup = Setup { body, ..Setup::new(-1.0, spin, 0.05, 10.0) };
        follows_exactly(lab, &format!("m = {mass:e}, I = {inertia:e}, a = {offset:e}"), &setup)?;
    }
    Ok(())
}

pub(crate) const LIGHT_INERTIA: Case = Case {
    name: "light-inertia",
    hard: "The inertia I -> 0, m a^2/I up to 2e19: the mass matrix is singular to rounding, though not on the \
           constraint.",
    shows: "The closed form; or an error, of a method whose stages leave the constraint.",
    bar: "The method's order over the run, and rounding.",
    claim: Claim::LightInertia,
    refusable: true,
};

pub(crate) fn light_inertia(lab: &mut Lab) -> Result<(), HardCaseError> {
    for body @ [mass, inertia, offset] in [[1.0, 1e-12, 0.5], [1e10, 1e-10, 0.5], [1.0, 1e-16, 1.0]] {
        // Its rates are U/a: with shorter steps than elsewhere the bar is 1 % for order 2, and tells a wrong motion.
        let setup = Setup { body, ..Setup::new(-1.0, 0.3, 0.005, 5.0) };
        follows_exactly(lab, &format!("m = {mass:e}, I = {inertia:e}, a = {offset:e}"), &setup)?;
    }
    Ok(())
}

pub(crate) const FAST: Case = Case {
    name: "fast",
    hard: "Speeds of 1e150 m/s, whose squares just fit into a number, and of 1e160 and 1e300 m/s, whose energy does \
           not.",
    shows: "The motion is that at 1 m/s, in another unit of time; or an error that names the overflow.",
    bar: "The closed form, by the method's order and rounding, all relative.",
    claim: Claim::Order,
    refusable: true,
};

pub(crate) fn fast(lab: &mut Lab) -> Result<(), HardCaseError> {
    for unit in [1e150, 1e160, 1e300] {
        let setup = Setup::new(-unit, 0.3 * unit, 0.05 / unit, 10.0 / unit);
        let exact = setup.exact()?;
        let slow = Setup::new(-1.0, 0.3, 0.05, 10.0);
        let [kappa, all] = slow.rates()?;
        let bar = lab.accuracy(0.05 * (kappa + all), 10.0 * (kappa + all), setup.steps);
        lab.run(format!("{unit:e} m/s"), &setup, |run| {
            let scaled = |t| {
                let now = exact.at(t);
                [now.speed, now.turn_rate]
            };
            [
                harness::stability::check::follows(run, [SPEED, SPIN], scaled, bar * 2.0 * unit),
                harness::stability::check::follows(run, [HEADING], |t| [exact.at(t).heading], bar * 10.0 * all),
            ]
        })?;
    }
    Ok(())
}
