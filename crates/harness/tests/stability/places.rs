//! Places, turns and masses.

use crate::stability::checks::{agrees, follows};
use crate::stability::sleigh::{BODY, Body, Broken, run};
use crate::stability::{control, schedule};
use harness::stability::Finding;
use harness::stability::check::{rounding, truncation};
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

/// The spin of a body from -1 m/s and 0.3 rad/s, against its closed form `(U/k) sech(s0 + kappa t)`.
fn spin(broken: Broken, body @ [m, inertia, a]: Body, step: f64, duration: f64) -> Finding {
    let (u, omega) = (-1.0, 0.3);
    let pivot = inertia + m * a * a;
    let gyration = (pivot / m).sqrt();
    let speed = f64::hypot(u, gyration * omega);
    let (kappa, all, begin) = (speed * m * a / pivot, speed / gyration, (u / (gyration * omega)).asinh());
    let rate = kappa + all;
    let schedule = schedule(step, duration);
    let relative = truncation(2, step * rate, duration * rate) + rounding(schedule.steps as usize, 1.0);
    let run = run(broken, body, [0.0, 0.0, 0.0, u, omega], schedule);
    follows(&run, [4], |t| [all / (begin + kappa * t).cosh()], all * relative)
}

/// `I` and `m` ten orders below one: the motion is that of their ratio.
#[test]
fn a_light_body() {
    let found = |broken| spin(broken, [1e-10, 1e-10, 0.5], 0.05, 10.0);
    control("masses", found(Broken::Nothing), found(Broken::UnitMass));
}

/// Nearly all of the mass in one point: what inverts the whole mass matrix divides by an inertia of zero, and what divides
/// by the inertia makes a spin of rounding. Neither is seen in a body with an inertia of its own.
#[test]
fn a_mass_without_inertia() {
    let found = |broken, inertia| spin(broken, [1.0, inertia, 1.0], 0.005, 5.0);
    for broken in [Broken::MassMatrix, Broken::Across] {
        control("light-inertia", found(Broken::Nothing, 1e-16), found(broken, 1e-16));
        assert!(found(broken, 1.0).holds(), "{broken:?} is seen in any body");
    }
    // Half the digits of the inertia are left: the one is right then, the other still wrong.
    assert!(found(Broken::MassMatrix, 1e-8).holds() && !found(Broken::Across, 1e-15).holds());
}
