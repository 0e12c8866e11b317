//! Places, turns and masses.

use crate::sleigh::{BODY, Broken, run};
use crate::{control, schedule};
use harness::stability::check::{agrees, follows, rounding, truncation};
use std::f64::consts::TAU;

#[test]
fn far_from_the_origin() {
    const FAR: f64 = 1e8;
    let found = |broken| {
        let at = |x: f64| run(broken, BODY, [x, -x, 0.0, -1.0, 0.3], schedule(0.05, 50.0));
        let image = |node: &harness::stability::Seen| [node.values[0] + FAR, node.values[1] - FAR];
        agrees(&at(FAR), &at(0.0), [0, 1], image, f64::EPSILON * FAR + rounding(1000, 50.0))
    };
    control("far-away", found(Broken::Nothing), found(Broken::PlainSums));
}

#[test]
fn a_million_turns() {
    let turned = 1e6 * TAU + 0.3;
    let plain = (-1e6f64).mul_add(TAU, turned) - 1e6 * 2.449_293_598_294_706_4e-16;
    let found = |broken| {
        let at = |heading: f64| run(broken, BODY, [0.0, 0.0, heading, -1.0, 0.3], schedule(0.05, 50.0));
        let same = |node: &harness::stability::Seen| [node.values[0], node.values[1]];
        agrees(&at(turned), &at(plain), [0, 1], same, rounding(1000, 50.0))
    };
    control("many-turns", found(Broken::Nothing), found(Broken::Unwrapped));
}

/// `I` and `m` ten orders below one: the motion is that of their ratio.
#[test]
fn a_light_body() {
    let found = |broken| {
        let light = run(broken, [1e-10, 1e-10, 0.5], [0.0, 0.0, 0.0, -1.0, 0.3], schedule(0.05, 10.0));
        let spin = |t: f64| {
            let (speed, kappa): (f64, f64) = (1.1125f64.sqrt(), 0.4 * 1.1125f64.sqrt());
            let begin = (-1.0 / (1.25f64.sqrt() * 0.3)).asinh();
            [speed / 1.25f64.sqrt() / (begin + kappa * t).cosh()]
        };
        follows(&light, [4], spin, truncation(2, 0.05 * 1.4, 14.0) + rounding(200, 1.0))
    };
    control("masses", found(Broken::Nothing), found(Broken::UnitMass));
}
