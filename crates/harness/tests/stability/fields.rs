//! Fields, forces, constraints: what is broken is a rule for one oscillator, one force or one row.

use crate::stability::checks::{agrees, constant, constraint, ends_at, energy, follows, sign_kept};
use crate::stability::{control, energetic, recorded, schedule};
use harness::stability::check::{measured, rounding, truncation};
use harness::stability::{Recorded, Seen};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// An oscillator `x'' = -k x` in `values[0]`, `values[3]`, by a rule for a step.
fn oscillator(k: f64, start: [f64; 2], step: f64, duration: f64, rule: impl Fn(&mut [f64; 6])) -> Recorded {
    let energy = move |q: &[f64; 6]| 0.5 * q[3] * q[3] + 0.5 * k * q[0] * q[0];
    energetic([start[0], 0.0, 0.0, start[1], 0.0, 0.0], schedule(step, duration), energy, |_, q| rule(q))
}

/// The midpoint rule: the mean velocity first.
fn midpoint(k: f64, h: f64) -> impl Fn(&mut [f64; 6]) {
    move |q| {
        let mean = (q[3] - 0.5 * h * k * q[0]) / (1.0 + 0.25 * h * h * k);
        (q[0], q[3]) = (q[0] + h * mean, 2.0 * mean - q[3]);
    }
}

/// The leapfrog, explicit.
fn leapfrog(k: f64, h: f64) -> impl Fn(&mut [f64; 6]) {
    move |q| {
        let mean = q[3] - 0.5 * h * k * q[0];
        q[0] += h * mean;
        q[3] = mean - 0.5 * h * k * q[0];
    }
}

#[test]
fn a_stiff_bowl() {
    let (h, k) = (0.05, 4e4);
    let found = |run: &Recorded| energy(run, 0.5 * k);
    let sound = found(&oscillator(k, [1.0, 0.0], h, 10.0, midpoint(k, h)));
    control("stiff-bowl", sound, found(&oscillator(k, [1.0, 0.0], h, 10.0, leapfrog(k, h))));
}

/// A rule that looks at its nodes only, on a hill of 1 cm, in steps of 5 mm and of 5 cm; and one that keeps the energy.
#[test]
fn a_steep_hill() {
    let hill = |x: f64| 0.2 * (-0.5 * (x / 0.01) * (x / 0.01)).exp();
    let height = |q: &[f64; 6]| 0.5 * q[3] * q[3] + hill(q[0]);
    let start = [-0.49, 0.0, 0.0, 1.0, 0.0, 0.0];
    let bar = rounding(20, 0.7);
    let kept = energetic(start, schedule(0.05, 1.0), height, |_, q| {
        let all = height(q);
        q[0] += 0.05 * q[3];
        q[3] = (2.0 * (all - hill(q[0]))).sqrt();
    });
    let blind = energetic(start, schedule(0.05, 1.0), height, |_, q| {
        let middle = q[0] + 0.025 * q[3];
        q[0] += 0.05 * q[3];
        q[3] += 0.05 * hill(middle) * middle * 1e4;
    });
    control("steep-hill", energy(&kept, bar), energy(&blind, bar));
}

/// A discrete gradient `(V(x1) - V(x0))/(x1 - x0)` at rest.
#[test]
fn a_turning_point() {
    let gradient = |guarded: bool| {
        oscillator(1.0, [0.0, 0.0], 0.05, 5.0, move |q| {
            let (x0, v0) = (q[0], q[3]);
            let (mut x1, mut v1) = (x0, v0);
            for _ in 0..30 {
                let way = x1 - x0;
                let slope = if guarded && way.abs() < 1e-8 { 0.5 * (x0 + x1) } else { 0.5 * (x1 * x1 - x0 * x0) / way };
                v1 = v0 - 0.05 * slope;
                x1 = x0 + 0.025 * (v0 + v1);
            }
            (q[0], q[3]) = (x1, v1);
        })
    };
    control("turning-points", energy(&gradient(true), 1e-15), energy(&gradient(false), 1e-15));
}

/// `u' = a w^2 + F/m`, `w' = -c u w`: the integral `u^2/2 + J w^2/2 + (F/c) ln w` by the split rule and by Euler's.
#[test]
fn a_well_in_the_logarithm() {
    let (a, c, inertia, force, h) = (0.5, 0.4, 1.25, -0.5, 0.05);
    let value = |u: f64, w: f64| 0.5 * u * u + 0.5 * inertia * w * w + force / c * w.abs().ln();
    let start = [0.0, 0.0, 0.0, 0.0, 0.1, 0.0];
    let split = recorded(start, schedule(h, 200.0), |_, q| {
        q[3] += 0.5 * h * (a * q[4] * q[4] + force);
        q[4] *= (-h * c * q[3]).exp();
        q[3] += 0.5 * h * (a * q[4] * q[4] + force);
    });
    let euler = recorded(start, schedule(h, 200.0), |_, q| {
        (q[3], q[4]) = (q[3] + h * (a * q[4] * q[4] + force), q[4] - h * c * q[3] * q[4]);
    });
    let bar = value(0.0, 0.1) * truncation(2, h * 3.5, TAU);
    let found = |run: &Recorded| constant(run, |node| value(node.values[3], node.values[4]), bar);
    control("log-well", found(&split), found(&euler));
}

/// A rule of order 2 that pretends to be of order 4.
#[test]
fn an_order_that_is_none() {
    let worst = |h: f64| energy(&oscillator(1.0, [1.0, 0.0], h, 20.0, leapfrog(1.0, h)), 0.0).measured;
    let (coarse, fine) = (worst(0.1), worst(0.05));
    let found = |order| measured("energy error at half the step", fine, 2.0 * coarse * truncation(order, 0.5, 1.0));
    control("attractor", found(2), found(4));
}

/// A bowl, from a start and from the same rotated: a rule that treats `y` after `x` is not the same for both.
#[test]
fn a_round_bowl() {
    let h = 0.02;
    let run = |start: [f64; 4], one_after_the_other: bool| {
        let [x, y, vx, vy] = start;
        recorded([x, y, 0.0, vx, vy, 0.0], schedule(h, 10.0), |_, q| {
            // A magnetic force turns the velocity.
            let turn = 0.5 * h;
            if one_after_the_other {
                q[3] += turn * q[4];
                q[4] -= turn * q[3];
            } else {
                let (sin, cos) = turn.sin_cos();
                (q[3], q[4]) = (q[3] * cos + q[4] * sin, q[4] * cos - q[3] * sin);
            }
            (q[0], q[1]) = (q[0] + h * q[3], q[1] + h * q[4]);
            (q[3], q[4]) = (q[3] - h * q[0], q[4] - h * q[1]);
        })
    };
    let found = |broken| {
        let (plain, rotated) = (run([0.8, 0.1, 3.0, 0.5], broken), run([-0.1, 0.8, -0.5, 3.0], broken));
        agrees(&plain, &rotated, [0, 1], |node| [node.values[1], -node.values[0]], rounding(500, 10.0))
    };
    control("round-bowl", found(false), found(true));
}

/// The midpoint rule for a drag that stops within a step, and the exponential.
#[test]
fn a_heavy_drag() {
    let part: f64 = 1e3;
    let run = |factor: f64| recorded([0.0, 0.0, 0.0, 1.0, 0.0, 0.0], schedule(0.05, 1.0), move |_, q| q[3] *= factor);
    let alive = |run: Recorded| Recorded {
        nodes: run.nodes.into_iter().take_while(|node| node.values[3] != 0.0).collect(),
        ..Recorded::default()
    };
    let sign = |factor| sign_kept(&alive(run(factor)), 3);
    control("heavy-drag", sign((-part).exp()), sign((1.0 - 0.5 * part) / (1.0 + 0.5 * part)));
}

/// A rotor drives the sleigh through its spin; one that takes small spins for none does not speed up.
#[test]
fn a_driven_rotor() {
    let (h, a, c, inertia, frequency) = (0.05, 0.5, 0.4, 1.25, 0.25);
    let run = |least: f64| {
        recorded([0.0, 0.0, 0.0, 1.0, 0.0, 0.0], schedule(h, 8.0 * TAU / frequency), |t, q| {
            let torque = (frequency * (t + 0.5 * h)).sin();
            // The spin relaxes to the torque, exactly at the speed of the step.
            let rest = -torque / (inertia * c * q[3]);
            let spin = rest + (q[4] - rest) * (-h * c * q[3]).exp();
            q[4] = if spin.abs() < least { 0.0 } else { spin };
            q[3] += h * a * q[4] * q[4];
        })
    };
    let found = |run: &Recorded| {
        let (middle, end) = (run.nodes[run.nodes.len() / 2], run.nodes[run.nodes.len() - 1]);
        let slope = (end.values[3].powi(3) - middle.values[3].powi(3)) / (end.t - middle.t);
        measured("relative error of the slope of u^3", (slope / 3.0 - 1.0).abs(), 0.1)
    };
    control("rotor-drive", found(&run(0.0)), found(&run(2.0)));
}

/// The spin as a difference of two momenta of the rotor's size, in half the digits.
#[test]
fn a_fast_rotor() {
    let carried = 200_000.123;
    let run = |single: bool| {
        recorded([0.0, 0.0, 0.0, 1.0, 0.31, 0.0], schedule(0.05, 10.0), move |_, q| {
            let all = 1.25 * q[4] + carried;
            q[4] = if single { f64::from(all as f32 - carried as f32) } else { all - carried } / 1.25;
        })
    };
    let bar = rounding(200, carried);
    let found = |run: &Recorded| follows(run, [4], |_| [0.31], bar);
    control("fast-rotor", found(&run(false)), found(&run(true)));
}

/// A step of the classical rule for `x' = rate(x)`.
fn runge_kutta(x: f64, h: f64, rate: &dyn Fn(f64) -> f64) -> f64 {
    let a = rate(x);
    let b = rate(x + 0.5 * h * a);
    let c = rate(x + 0.5 * h * b);
    x + h / 6.0 * (a + 2.0 * b + 2.0 * c + rate(x + h * c))
}

/// A step by the slope in its middle.
fn middle(x: f64, h: f64, rate: &dyn Fn(f64) -> f64) -> f64 {
    x + h * rate(x + 0.5 * h * rate(x))
}

/// `beta' = r cos beta - 1` per radian of the tracer, by a rule of order 4 and by one of order 2 in its place, against the Moebius map.
#[test]
fn a_planimeter() {
    let (ratio, steps) = (0.5, 200);
    let h = TAU / f64::from(steps);
    let rate = |beta: f64| ratio * beta.cos() - 1.0;
    let turn =
        |rule: fn(f64, f64, &dyn Fn(f64) -> f64) -> f64| (0..steps).fold(FRAC_PI_2, |beta, _| rule(beta, h, &rate));
    let s = PI * (1.0 - ratio * ratio).sqrt();
    let (c, d) = (s.cos(), s.sin() / s * PI);
    let exact = 2.0 * f64::atan2(c + d * (ratio - 1.0), d * (ratio + 1.0) + c);
    let bar = truncation(4, h * (1.0 + ratio), TAU * (1.0 + ratio));
    let found = |beta: f64| measured("heading after a round", 2.0 * (0.5 * (beta - exact)).sin().abs(), bar);
    control("planimeter", found(turn(runge_kutta)), found(turn(middle)));
}

/// A tracer around a corner, with a node in it and with the mean velocity of the step across it.
#[test]
fn a_corner() {
    let sides = [[1.0, 0.0], [0.0, 1.0]];
    let run = |steps: u32| {
        let h = 2.0 / f64::from(steps);
        (0..steps).fold(1.0f64, |heading, k| {
            // The velocity at the beginning of a step: that of the first side where the step begins on it.
            let [vx, vy] = sides[usize::from(f64::from(k) * h >= 1.0)];
            let rate = |angle: f64| 2.0 * (vy * angle.cos() - vx * angle.sin());
            runge_kutta(heading, h, &rate)
        })
    };
    let exact = [0.0, FRAC_PI_2].iter().fold(1.0f64, |heading, side| {
        side + 2.0 * f64::atan2((0.5 * (heading - side)).sin() * (-2f64).exp(), (0.5 * (heading - side)).cos())
    });
    let found = |steps: u32| {
        let bar = truncation(4, 2.0 * 2.0 / f64::from(steps), 4.0);
        measured("heading after two sides", (run(steps) - exact).abs(), bar)
    };
    control("corners", found(200), found(201));
}

/// A force that jumps at t = 1 s, inside a step.
#[test]
fn a_jump_inside_a_step() {
    let run = |step: f64| {
        recorded([0.0, 0.0, 0.0, 0.5, 0.0, 0.0], schedule(step, 4.0), move |t, q| {
            let force = if t < 1.0 { 2.0 } else { -3.0 };
            q[0] += step * q[3] + 0.5 * step * step * force;
            q[3] += step * force;
        })
    };
    let found = |run: &Recorded| {
        let exact = |t: f64| [0.5 + 2.0 * t.min(1.0) - 3.0 * (t - 1.0).max(0.0)];
        follows(run, [3], exact, rounding(run.nodes.len(), 10.0))
    };
    control("jumps", found(&run(0.0625)), found(&run(0.3)));
}

/// A row `n . v = rate r`, met and with its right-hand side forgotten.
#[test]
fn a_turning_plane() {
    let residual = |level: f64| {
        let mut run = recorded([0.4, 0.0, 0.0, 0.5, 0.3, 0.0], schedule(0.05, 10.0), |_, _| {});
        for node in &mut run.nodes {
            node.constraint = (level - 0.3 * node.values[0]).abs();
        }
        constraint(&run, 1.0)
    };
    control("turntable", residual(0.3 * 0.4), residual(0.0));
}

/// Two equal rows: one of the two forces, or both, each as large as one alone.
#[test]
fn two_rows_that_are_one() {
    // Blade speed and turn: the force across turns the motion at the rate omega once, or twice.
    let run = |times: f64| recorded([0.0; 6], schedule(0.05, 10.0), move |_, q| q[2] += times * 0.05 * 0.3);
    let found = |run: &Recorded| follows(run, [2], |t| [0.3 * t], rounding(200, 3.0));
    control("parallel-blades", found(&run(1.0)), found(&run(2.0)));
}

/// A row `(x - 1) w = 0` that lets go: the run must end there.
#[test]
fn a_row_that_vanishes() {
    let run = |ends: bool| {
        let steps = if ends { 1.0 } else { 2.0 };
        recorded([0.0; 6], schedule(0.0625, steps), |_, q| q[0] += 0.0625)
    };
    let found = |run: &Recorded| {
        let reached = run.nodes[run.nodes.len() - 1].values[0];
        measured("distance from where the row vanishes", (reached - 1.0).abs(), 0.0625)
    };
    control("dropping-row", found(&run(true)), found(&run(false)));
}

/// A point on a circle whose radius is given by its rate alone, by the chord and along the tangent.
#[test]
fn a_constraint_on_rates() {
    let h: f64 = 0.02;
    let run = |chord: bool| {
        recorded([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], schedule(h, 200.0), move |_, q| {
            let [x, y] = [q[0], q[1]];
            let (mut nx, mut ny) = (x, y);
            for _ in 0..if chord { 20 } else { 1 } {
                let (mx, my) = (0.5 * (x + nx), 0.5 * (y + ny));
                (nx, ny) = (x - h * my, y + h * mx);
            }
            (q[0], q[1]) = (nx, ny);
        })
    };
    let off = |node: &Seen| node.values[0].hypot(node.values[1]);
    let found = |run: &Recorded| constant(run, off, truncation(2, h, TAU) + rounding(10_000, 1.0));
    control("pseudo-holonomic", found(&run(true)), found(&run(false)));
}

/// The energy of an oscillator, kept, and by a rule of order 2.
#[test]
fn a_gauge() {
    let found = |run: &Recorded| energy(run, rounding(4000, 1.0));
    let sound = found(&oscillator(1.0, [1.0, 0.0], 0.1, 400.0, midpoint(1.0, 0.1)));
    control("gauge", sound, found(&oscillator(1.0, [1.0, 0.0], 0.1, 400.0, leapfrog(1.0, 0.1))));
    assert!(ends_at(&Recorded::default(), [0], [0.0], 1.0).is_none());
}
