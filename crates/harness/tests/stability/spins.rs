//! Spins, long steps and long runs.

use crate::stability::checks::{constraint, ends_at, energy, follows, sign_kept, stays_below};
use crate::stability::sleigh::{BODY, Broken, run, straight, value};
use crate::stability::{control, energetic, recorded, schedule};
use dla::Schedule;
use harness::stability::check::{rounding, truncation};
use harness::stability::{Recorded, Trial};
use std::f64::consts::TAU;

const SPEED: usize = 3;
const SPIN: usize = 4;
/// `kappa` and `U/k` of the sleigh at 1 m/s.
const KAPPA: f64 = 0.4;
const ALL: f64 = 0.894_427_190_999_915_9;

/// An absolute tolerance takes a small spin for none: the sleigh never turns around.
#[test]
fn a_small_spin() {
    for (name, spin, step, tolerance) in [("small-spin", 1e-8, 0.05, 1e-9), ("tiny-spin", -1e-300, 0.2, 1e-13)] {
        let duration = (2.0 * ALL / f64::abs(spin)).ln() / KAPPA + 60.0;
        let found = |broken| {
            let run = straight(broken, -1.0, spin, step, duration);
            ends_at(&run, [SPEED], [1.0], truncation(2, step * ALL, 7.0) + rounding(run.nodes.len(), 1.0))
        };
        control(name, found(Broken::Nothing), found(Broken::AbsoluteTolerance(tolerance)));
    }
    let sign = |broken| sign_kept(&straight(broken, -1.0, -5e-324, 0.05, 100.0), SPIN);
    control("subnormal-spin", sign(Broken::Nothing), sign(Broken::Coordinates));
}

/// The recurrence of the reflected momenta, `omega_+ = omega_- - 2 h c u omega`.
#[test]
fn what_dies_out() {
    let (h, duration) = (0.05, 400.0);
    let bar = rounding(1, ALL) / (KAPPA * h);
    let sound = stays_below(&straight(Broken::Nothing, 1.0, 0.3, h, duration), SPIN, 100.0, bar);
    let mut before = 0.3;
    let reflected = recorded([0.0, 0.0, 0.0, 1.0, 0.3, 0.0], schedule(h, duration), |_, values| {
        let next = before - 2.0 * h * KAPPA * values[SPIN];
        before = values[SPIN];
        values[SPIN] = next.clamp(-1.0, 1.0);
    });
    control("stable-line", sound, stays_below(&reflected, SPIN, 100.0, bar));
}

#[test]
fn home_again() {
    let (h, duration) = (0.05, 80.0);
    let bar = rounding(3200, KAPPA * duration) * duration;
    let found = |broken| {
        let there = straight(broken, 1.0, 0.3, h, duration);
        let end = there.nodes.last().unwrap().values;
        let back = run(broken, BODY, [end[0], end[1], end[2], -end[3], -end[4]], schedule(h, duration));
        ends_at(&back, [0, 1, 2, 3, 4], [0.0, 0.0, 0.0, -1.0, -0.3], bar)
    };
    control("there-and-back", found(Broken::Nothing), found(Broken::OneSided));
}

/// The kinetic energy, which a wrong solution misses.
fn kinetic(run: &Recorded) -> Recorded {
    let energy = |values: &[f64; 6]| 0.5 * values[3] * values[3] + 0.625 * values[4] * values[4];
    let mut run = run.clone();
    let first = energy(&run.nodes[0].values);
    for node in &mut run.nodes {
        node.energy_error = (energy(&node.values) - first).abs();
    }
    run
}

/// Another solution of a long step is garbage.
#[test]
fn another_root() {
    let found = |broken| energy(&kinetic(&straight(broken, 0.1, 1.2, 1.0, 20.0)), 0.5 * 0.01 + 0.625 * 1.44);
    control("long-step", found(Broken::Nothing), found(Broken::AnyRoot));
    // Against the line, a step back within a step that has no solution on the branch: its sign is lost.
    let sign = |broken| {
        let steps = if broken == Broken::Nothing { 0.5 } else { 7.0 };
        sign_kept(&straight(broken, -1.0, 1e-8, steps, 70.0), SPIN)
    };
    control("negative-substeps", sign(Broken::Nothing), sign(Broken::AnyRoot));
}

/// A thousand steps of 1e-12 s from x = 1 m.
#[test]
fn the_way_of_a_short_step() {
    let found = |broken| {
        let run = run(broken, BODY, [1.0, 0.0, 0.3, -1.0, 0.3], schedule(1e-12, 1e-9));
        ends_at(&run, [0], [1.0 - 1e-9 * 0.3f64.cos()], f64::EPSILON + rounding(1000, 1e-9))
    };
    control("step-lengths", found(Broken::Nothing), found(Broken::PlainSums));
}

/// The velocity of a circle, turned step by step and not projected.
#[test]
fn a_velocity_that_is_carried_along() {
    let found = |broken| {
        let run =
            run(broken, [1.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0, 1.0], Schedule { t0: 0.0, step: 0.5, steps: 100_000 });
        constraint(&run, 1.0)
    };
    control("round-off", found(Broken::Nothing), found(Broken::Unprojected));
}

/// Closed forms: the balanced sleigh, and the cusp of the path.
#[test]
fn closed_forms() {
    let circle = |broken| {
        let run = run(broken, [1.0, 1.0, 1e-12], [0.0, 0.0, 0.0, -1.0, 0.3], schedule(0.05, 20.0));
        let bar = truncation(2, 0.05 * 0.3, 6.0) + rounding(400, 1.0);
        follows(&run, [0, 1], |t| [-(0.3 * t).sin() / 0.3, ((0.3 * t).cos() - 1.0) / 0.3], 20.0 * bar)
    };
    control("offsets", circle(Broken::Nothing), circle(Broken::OneSided));

    // u = U tanh s, x' = u cos theta: the path from the closed form of the heading, by its own finer steps.
    let path = |broken, h| run(broken, BODY, [0.0, 0.0, 0.0, -0.5, 0.6], schedule(h, 10.0));
    let fine = path(Broken::Nothing, 0.05 / 16.0);
    let through = |broken| {
        let at = |t: f64| {
            let node = fine.nodes[(t / (0.05 / 16.0)).round() as usize];
            [node.values[0], node.values[1]]
        };
        follows(&path(broken, 0.05), [0, 1], at, truncation(2, 0.05 * 1.2, 12.0) * 6.0)
    };
    control("cusp", through(Broken::Nothing), through(Broken::ByVelocity));
}

/// Squares of 1e160 are no numbers, and no error tells of it.
#[test]
fn a_silent_overflow() {
    let unit = 1e160;
    let broken = |broken| {
        Trial::new("", &run(broken, BODY, [0.0, 0.0, 0.0, -unit, 0.3 * unit], schedule(0.05 / unit, 10.0 / unit)))
    };
    assert!(broken(Broken::Nothing).broken.is_none());
    assert!(broken(Broken::Squares).broken.unwrap().contains("not a finite number"));
}

#[test]
fn a_summed_time() {
    check_summed_time(100_000);
}

#[test]
#[ignore = "slow"]
fn a_summed_time_in_full() {
    check_summed_time(2_000_000);
}

/// A force in time, after a time that was summed over so many of its periods.
fn check_summed_time(periods: u64) {
    let (h, before) = (0.03, 64 * periods);
    let frequency = TAU / (64.0 * h);
    let summed = (0..before).fold(0.0, |t, _| t + h);
    let speed = |t0: f64| {
        energetic(
            [0.2; 6],
            Schedule { t0, step: h, steps: 600 },
            |_| 0.0,
            |t, values| values[SPEED] += h * (frequency * t).sin(),
        )
    };
    let early = value(&speed(0.0), SPEED);
    let bar = 4.0 * f64::EPSILON * frequency * before as f64 * h * 18.0 + rounding(600, 18.0);
    let found = |t0| ends_at(&speed(t0), [SPEED], [early], bar);
    control("late", found(before as f64 * h), found(summed));
}
