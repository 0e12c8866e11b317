//! A stepper of the free sleigh, with what can be broken in one.

use dla::Schedule;
use harness::stability::{Recorded, Seen};

pub(crate) fn schedule(step: f64, duration: f64) -> Schedule {
    Schedule { t0: 0.0, step, steps: (duration / step).round() as u64 }
}

/// What is broken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Broken {
    /// Newton's method stops at this correction of the spin (rad/s), whatever its size.
    AbsoluteTolerance(f64),
    /// The velocity at the start of the step, for all of it.
    OneSided,
    /// Places are sums without compensation.
    PlainSums,
    /// The heading is not kept within a turn.
    Unwrapped,
    /// A mass that is none but one.
    UnitMass,
    /// What rounding leaves of a velocity across the blade is stopped as if all mass were there, and the torque of that
    /// divided by the inertia.
    Across,
}

/// Mass, inertia, offset.
pub(crate) type Body = [f64; 3];
pub(crate) const BODY: Body = [1.0, 1.0, 0.5];

/// Place, heading, speed and spin of the midpoint map of the free sleigh, in quasi-velocities:
///
/// ```text
/// U cos d - a w sin d = u0,   w (1 + k U) = omega0,   d = h w/2,   k = h m a/(2 J),
/// U cos d + a w sin d = u1,   w (1 - k U) = omega1.
/// ```
pub(crate) fn run(broken: Broken, body: Body, start: [f64; 5], schedule: Schedule) -> Recorded {
    use Broken as B;
    let [m, inertia, a] = body;
    let (h, gain) = (schedule.step, m * a / (inertia + m * a * a));
    let [mut x, mut y, mut heading, mut u, mut omega] = start;
    let (mut rest, mut turns) = ([0.0; 3], 0.0);
    let mut wrap = |heading: &mut f64, rest: &mut f64| {
        if broken != B::Unwrapped && heading.abs() > std::f64::consts::PI {
            let whole = (*heading / std::f64::consts::TAU).round();
            *heading = (-whole).mul_add(std::f64::consts::TAU, *heading);
            *rest -= whole * 2.449_293_598_294_706_4e-16;
            turns += whole;
        }
        turns * std::f64::consts::TAU
    };
    let mut nodes = Vec::new();
    for k in 0..=schedule.steps {
        let full = wrap(&mut heading, &mut rest[2]);
        let (sin, cos) = heading.sin_cos();
        let v = [u * cos, u * sin];
        let across = -sin * v[0] + cos * v[1];
        nodes.push(Seen {
            t: schedule.time(k),
            values: [x, y, heading + full, u, omega, 0.0],
            energy_error: 0.0,
            constraint: across.abs(),
        });
        if broken == B::Across {
            omega += m * a * across / inertia;
        }
        let (w, mean) = mean_velocities(broken, h, gain, a, [u, omega]);
        let d = 0.5 * h * w;
        let (direction, speed) = match broken {
            B::OneSided => (heading, u),
            _ => (heading + d, mean),
        };
        let end = match broken {
            B::OneSided => [u + h * a * omega * omega, omega - h * gain * u * omega],
            B::UnitMass => [mean * d.cos() + a * w * d.sin(), w * (1.0 - 0.5 * h * a / (inertia + a * a) * mean)],
            _ => [mean * d.cos() + a * w * d.sin(), 2.0 * w - omega],
        };
        let moved = [h * speed * direction.cos(), h * speed * direction.sin(), h * w];
        for ((sum, rest), d) in [&mut x, &mut y, &mut heading].into_iter().zip(&mut rest).zip(moved) {
            let add = if broken == B::PlainSums { d } else { d + *rest };
            let new = *sum + add;
            *rest = add - (new - *sum);
            *sum = new;
        }
        [u, omega] = end;
    }
    Recorded { nodes, ..Recorded::default() }
}

/// The mean spin and the mean speed of a step, by Newton's method for the spin.
fn mean_velocities(broken: Broken, h: f64, gain: f64, a: f64, [u, omega]: [f64; 2]) -> (f64, f64) {
    let k = 0.5 * h * gain;
    let speed = |w: f64| (u + a * w * (0.5 * h * w).sin()) / (0.5 * h * w).cos();
    if broken == Broken::OneSided {
        return (omega, u);
    }
    let mut w = omega;
    for _ in 0..50 {
        let residual = |w: f64| w * (1.0 + k * speed(w)) - omega;
        // A slope by a complex step would be finer than is needed here: only the residual decides.
        let e = 1e-7 * w.abs();
        let slope = if e > 0.0 { (residual(w + e) - residual(w - e)) / (2.0 * e) } else { 1.0 + k * u };
        let correction = -residual(w) / slope;
        if let Broken::AbsoluteTolerance(tolerance) = broken
            && correction.abs() <= tolerance
        {
            break;
        }
        w += correction;
        if correction.abs() <= 2.0 * f64::EPSILON * w.abs() {
            break;
        }
    }
    (w, speed(w))
}

/// The sleigh of the cases on a straight line, nearly.
pub(crate) fn straight(broken: Broken, speed: f64, spin: f64, step: f64, duration: f64) -> Recorded {
    run(broken, BODY, [0.0, 0.0, 0.0, speed, spin], schedule(step, duration))
}
