//! Motions that are small beside the forces on them: what is broken is what a search takes for rounding, or how it asks for a force.

use crate::stability::checks::{follows, stays_below};
use crate::stability::{control, recorded, schedule};
use harness::stability::check::{rounding, truncation};
use harness::stability::{Recorded, Trial};

/// A step of the midpoint rule for `x'' = force(x) - drag x'` in `values[0]`, `values[3]`, by iteration of the mean velocity; a
/// correction below `least` (m/s) ends it, and is not made.
fn step(h: f64, least: f64, drag: f64, force: impl Fn(f64) -> f64) -> impl Fn(&mut [f64; 6]) {
    move |q| {
        let (x, v) = (q[0], q[3]);
        let mut mean = v;
        for _ in 0..40 {
            let correction = v + 0.5 * h * (force(x + 0.5 * h * mean) - drag * mean) - mean;
            if correction.abs() < least {
                break;
            }
            mean += correction;
        }
        (q[0], q[3]) = (x + h * mean, 2.0 * mean - v);
    }
}

/// A part of the largest velocity there was, taken for rounding: the motion never comes to rest.
#[test]
fn what_settles() {
    let (h, duration) = (0.05, 400.0f64);
    let late = 0.75 * duration;
    let bar = (-late / 8.0).exp() + rounding(8000, 1.0);
    let found = |least| {
        let rule = step(h, least, 0.5, |x| -3.0 * (x - 0.3));
        let run = recorded([-0.2, 0.0, 0.0, 1.0, 0.0, 0.0], schedule(h, duration), |_, q| rule(q));
        stays_below(&run, 3, late, bar)
    };
    control("settles", found(0.0), found(1e-9));
}

#[test]
fn a_tiny_swing() {
    let (h, duration, stiffness, speed) = (0.02, 100.0, 3.0f64, 1e-10);
    let rate = stiffness.sqrt();
    let bar = truncation(2, h * rate, rate * duration) * speed + 4.0 * f64::EPSILON * stiffness * duration;
    let found = |least| {
        let rule = step(h, least, 0.0, |x| -stiffness * (x - 0.7));
        let run = recorded([0.7, 0.0, 0.0, speed, 0.0, 0.0], schedule(h, duration), |_, q| rule(q));
        follows(&run, [3], |t| [speed * (rate * t).cos()], bar)
    };
    control("tiny-swing", found(0.0), found(1e-11));
}

/// What drives a skate whose blade bears its weight is a part of 1e-9 of that; below 1e-11 of the weight's own speed nothing moves.
#[test]
fn a_balance() {
    let (h, fall, angle) = (0.01, 9.8, 1e-9);
    let bar = rounding(1000, fall * h);
    let found = |least| {
        let rule = step(h, least, 0.0, |_| -fall * f64::sin(angle));
        let run = recorded([0.0; 6], schedule(h, 10.0), |_, q| rule(q));
        follows(&run, [3], |t| [-fall * f64::sin(angle) * t], bar)
    };
    control("balance", found(0.0), found(1e-11 * fall));
}

/// The force of two springs as a sum, and as a difference quotient of their energy along the way of the step.
#[test]
fn forces_that_cancel() {
    let (stiffness, middle, off, part, length) = (1e6, 0.4, 1e-9, 0.1, 100.0);
    let rate = f64::sqrt(2.0 * stiffness);
    let h = part / rate;
    let force = |x: f64| -stiffness * (x - 0.1) - stiffness * (x - 0.7);
    let potential = |x: f64| 0.5 * stiffness * ((x - 0.1) * (x - 0.1) + (x - 0.7) * (x - 0.7));
    let bar = truncation(2, part, length) * off + 4.0 * f64::EPSILON * (1.0 + length);
    let found = |run: &Recorded| follows(run, [0], |t| [middle + off * (rate * t).cos()], bar);
    let start = [middle + off, 0.0, 0.0, 0.0, 0.0, 0.0];
    let rule = step(h, 0.0, 0.0, force);
    let sound = recorded(start, schedule(h, length / rate), |_, q| rule(q));
    let broken = recorded(start, schedule(h, length / rate), |_, q| {
        let (x, v) = (q[0], q[3]);
        let mut mean = v;
        for _ in 0..20 {
            let way = h * mean;
            let slope = if way == 0.0 { -force(x) } else { (potential(x + way) - potential(x)) / way };
            mean = v - 0.5 * h * slope;
        }
        (q[0], q[3]) = (x + h * mean, 2.0 * mean - v);
    });
    control("cancelling-forces", found(&sound), found(&broken));
}

/// `u' = g - c |u| u` from rest, by Newton's method with the derivative of a length: `u/|u|`, which is none at rest.
#[test]
fn a_force_with_a_corner() {
    let (slope, drag, h) = (2.0, 0.5, 0.01);
    let run = |derivative: fn(f64) -> f64| {
        recorded([0.0; 6], schedule(h, 3.0), move |_, q| {
            let mut mean = q[3];
            for _ in 0..5 {
                let size = mean.abs();
                let missing = q[3] + 0.5 * h * (slope - drag * size * mean) - mean;
                mean += missing / (1.0 + 0.5 * h * drag * (size + mean * derivative(mean)));
            }
            q[3] = 2.0 * mean - q[3];
        })
    };
    let bar = truncation(2, h, 3.0) * 2.0 + rounding(300, 2.0);
    let sound = run(|u| if u == 0.0 { 0.0 } else { u / u.abs() });
    let found = follows(&sound, [3], |t| [2.0 * f64::tanh(t)], bar);
    assert!(found.holds(), "{found:?}");
    assert!(Trial::new("", &sound).broken.is_none());
    assert!(Trial::new("", &run(|u| u / u.abs())).broken.unwrap().contains("not a finite number"));
}
