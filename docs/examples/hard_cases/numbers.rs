//! Numbers far from one.

use crate::broken::{self, BODY, Body, Broken};
use crate::curves::Upright::{Decades, Linear};
use crate::curves::{SPEED, SPIN, X, Y, chart, curve, in_time, level, markers, peaks, upper_edge};
use crate::free::exact;
use crate::program::{Program, Setup};
use harness::stability::Seen;
use report::Chart;
use std::error::Error;
use std::f64::consts::TAU;

type Drawn = Result<Chart, Box<dyn Error>>;

/// How far a run is from another, moved by so much, node by node (m).
fn apart(mut nodes: Vec<Seen>, image: &[Seen], [dx, dy]: [f64; 2]) -> Vec<Seen> {
    for (node, other) in nodes.iter_mut().zip(image) {
        node.values[X] -= other.values[X] + dx;
        node.values[Y] -= other.values[Y] + dy;
    }
    nodes
}

fn distance(node: &Seen) -> f64 {
    node.values[X].hypot(node.values[Y])
}

fn made(broken: Broken, body: Body, start: [f64; 5], step: f64, duration: f64) -> Vec<Seen> {
    broken::run(broken, body, start, broken::schedule(step, duration)).nodes
}

pub(crate) fn far_away(program: &Program) -> Drawn {
    const FAR: [f64; 2] = [1e8, -1e8];
    let here = Setup::free(-1.0, 0.3, 0.05, 50.0);
    let there = Setup { start: [FAR[0], FAR[1], 0.0, -1.0, 0.3], ..here };
    let dla = apart(program.run("dla", &there)?, &program.run("dla", &here)?, FAR);
    let plain = [there, here].map(|setup| made(Broken::PlainSums, BODY, setup.start, setup.step, setup.duration));
    let [plain, image] = plain;
    let layers = vec![
        peaks("dla", &dla, distance),
        peaks("sums as they are", &apart(plain, &image, FAR), distance),
        level("rounding of 1e8 m", f64::EPSILON * FAR[0], here.duration),
    ];
    Ok(in_time("From 1e8 m: how far from the same motion at the origin", "distance [m]", Linear, layers))
}

pub(crate) fn many_turns(program: &Program) -> Drawn {
    let turned = 1e6 * TAU + 0.3;
    // 2 pi is no number: the turns of its nearest one are another heading.
    let plain = (-1e6f64).mul_add(TAU, turned) - 1e6 * 2.449_293_598_294_706_4e-16;
    let setup = |heading| Setup { start: [0.0, 0.0, heading, -1.0, 0.3], ..Setup::free(0.0, 0.0, 0.05, 50.0) };
    let dla = apart(program.run("dla", &setup(turned))?, &program.run("dla", &setup(plain))?, [0.0; 2]);
    let unwrapped = [turned, plain].map(|heading| made(Broken::Unwrapped, BODY, setup(heading).start, 0.05, 50.0));
    let [unwrapped, image] = unwrapped;
    let layers =
        vec![peaks("dla", &dla, distance), peaks("turns not taken off", &apart(unwrapped, &image, [0.0; 2]), distance)];
    Ok(in_time("From a million turns: how far from the same motion without", "distance [m]", Linear, layers))
}

/// A time that is summed, and one that is a product.
pub(crate) fn late(_program: &Program) -> Drawn {
    const STEP: f64 = 0.03;
    let frequency = TAU / (64.0 * STEP);
    let (mut sum, mut summed, mut product) = (0.0, Vec::new(), Vec::new());
    let mut next = 100u64;
    for k in 1..=1_000_000_000u64 {
        sum += STEP;
        if k == next {
            let time = k as f64 * STEP;
            summed.push([k as f64, (frequency * (sum - time)).abs()]);
            // What the product was rounded by.
            product.push([k as f64, (frequency * (k as f64).mul_add(STEP, -time)).abs()]);
            next = (k as f64 * 1.3) as u64;
        }
    }
    let layers = vec![curve("t = k h", product), curve("t = t + h", summed)];
    Ok(chart("The phase of a force after many steps", ["steps", "error of the phase [rad]"], [true; 2], layers))
}

/// How far the spin is from its closed form, as a part of the largest.
fn spin_off(setup: &Setup<'_>) -> Result<impl Fn(&Seen) -> f64 + use<>, Box<dyn Error>> {
    let (exact, [m, inertia, a]) = (exact(setup)?, setup.body);
    let all = (2.0 * exact.energy() / (inertia + m * a * a)).sqrt();
    Ok(move |node: &Seen| (node.values[SPIN] - exact.at(node.t).turn_rate).abs() / all)
}

pub(crate) fn masses(program: &Program) -> Drawn {
    let setup = |body| Setup { body, ..Setup::free(-1.0, 0.3, 0.05, 10.0) };
    let mut layers = Vec::new();
    for (label, body) in [
        ("1 kg, a = 0.5 m", [1.0, 1.0, 0.5]),
        ("1e-10 kg, a = 0.5 m", [1e-10, 1e-10, 0.5]),
        ("1e10 kg, a = 0.5 m", [1e10, 1e10, 0.5]),
        ("1 kg, a = 1e-8 m", [1.0, 1.0, 1e-8]),
    ] {
        let setup = setup(body);
        layers.push(peaks(label, &program.run("dla", &setup)?, spin_off(&setup)?));
    }
    let light = setup([1e-10, 1e-10, 0.5]);
    let unit = made(Broken::UnitMass, light.body, light.start, light.step, light.duration);
    layers.push(peaks("1e-10 kg, taken for 1 kg", &unit, spin_off(&light)?));
    Ok(in_time("Masses over twenty orders of magnitude", "relative error of the spin", Decades, layers))
}

pub(crate) fn light_inertia(program: &Program) -> Drawn {
    let setup = |inertia| Setup { body: [1.0, inertia, 1.0], ..Setup::free(-1.0, 0.3, 0.005, 5.0) };
    let across = |inertia| made(Broken::Across, setup(inertia).body, setup(inertia).start, 0.005, 5.0);
    let mut layers = Vec::new();
    for inertia in [1.0, 1e-16] {
        layers.push(peaks(
            &format!("dla, I = {inertia:?}"),
            &program.run("dla", &setup(inertia))?,
            spin_off(&setup(inertia))?,
        ));
    }
    for inertia in [1.0, 1e-8, 1e-12, 1e-16] {
        layers.push(peaks(&format!("divides by I = {inertia:?}"), &across(inertia), spin_off(&setup(inertia))?));
    }
    Ok(in_time("Nearly all of the mass in one point", "relative error of the spin", Decades, layers))
}

/// Speeds and times in units of the motion at 1 m/s: the same motion, if its numbers are numbers.
pub(crate) fn fast(program: &Program) -> Drawn {
    let (mut layers, mut refused) = (Vec::new(), Vec::new());
    for (label, method, unit) in [
        ("dla, 1 m/s", "dla", 1.0),
        ("dla, 1e160 m/s", "dla", 1e160),
        ("dla, 1e300 m/s", "dla", 1e300),
        ("gauss8, 1e150 m/s", "gauss8", 1e150),
        ("gauss8, 1e160 m/s", "gauss8", 1e160),
    ] {
        let setup = Setup::free(-unit, 0.3 * unit, 0.05 / unit, 10.0 / unit);
        let (exact, nodes) = (exact(&setup)?, program.run(method, &setup)?);
        if nodes.len() == 1 {
            refused.push([0.0, 1e-6]);
            continue;
        }
        // The same motion, in another unit of time.
        let off = |node: &Seen| [node.t * unit, (node.values[SPEED] - exact.at(node.t).speed).abs() / unit];
        layers.push(curve(label, upper_edge(nodes.iter().map(off))));
    }
    layers.push(markers("gauss8, 1e160 m/s: refused", refused));
    let (title, across) = ("Speeds whose squares are no numbers", "t, times the first speed [m]");
    Ok(chart(title, [across, "error of u, as a part of the first speed"], [false, true], layers))
}
