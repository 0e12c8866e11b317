use crate::{Method, Run};
use dla::{Close, Crossing, Event, Mechanism, RunError, Schedule, Watch};
use nalgebra::DMatrix;
use std::f64::consts::{PI, TAU};

/// The crossings of a surface by one motion.
#[derive(Debug, Clone)]
pub struct Section {
    /// The crossings in the order of time, located to rounding: each is the end of a step that is shortened to end there.
    pub crossings: Vec<Crossing>,
    /// Crossings so close that others may have been missed.
    pub close: Option<Close>,
    /// The step that failed, if one did.
    pub failure: Option<RunError>,
    /// Whether the motion was ended early ([`Stop`](dla::Stop)).
    pub interrupted: bool,
}

/// Number of parts in which a step is searched: two crossings within one are not missed.
const SAMPLES: u32 = 2;

/// The crossings of the surface on which an event's function of time and state is zero, by a motion (Poincare 1881).
pub fn section(
    system: &dyn Mechanism,
    method: &Method,
    schedule: &Schedule,
    (q, v): (&[f64], &[f64]),
    surface: &Event<'_>,
) -> Section {
    let mut watch = Watch::new(method, std::slice::from_ref(surface), ());
    watch.samples = SAMPLES;
    let outcome = Run::of(system, method).observe(&mut watch).moves(schedule, &mut system.state(q, v));
    let (crossings, close) = (watch.crossings().to_vec(), watch.close());
    let interrupted = matches!(outcome, Ok(made) if made < schedule.steps);
    Section { crossings, close, failure: outcome.err(), interrupted }
}

/// The area that a closed curve encloses, given by points of it at equal distances of a parameter in which it is smooth.
///
/// With the Fourier series `x + i y = sum_k c_k e^(i k phi)` the area is `pi sum_k k |c_k|^2`: exact but for what the series
/// leaves out, which falls faster than any power of the number of points. Counterclockwise is positive. In coordinates in which the
/// density of a measure is constant, such as `(u, ln |omega|)` of the sleigh, it is the measure of what lies within.
#[must_use]
pub fn enclosed_area(points: &[[f64; 2]]) -> f64 {
    let count = points.len();
    // About a point of the curve, so that a small curve far from the origin loses no digits.
    let [x0, y0] = points.first().copied().unwrap_or_default();
    let squares = |k: i64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (j, [x, y]) in points.iter().enumerate() {
            // The phase within a turn, exactly.
            let turns = (k * j as i64).rem_euclid(count as i64) as f64 / count as f64;
            let (sin, cos) = (-TAU * turns).sin_cos();
            re += (x - x0) * cos - (y - y0) * sin;
            im += (x - x0) * sin + (y - y0) * cos;
        }
        (re * re + im * im) / (count * count) as f64
    };
    let highest = (count as i64 - 1) / 2;
    PI * (1..=highest).map(|k| k as f64 * (squares(k) - squares(-k))).sum::<f64>()
}

/// How far a step is from preserving a measure: `ln |det D Phi| + ln rho(z1) - ln rho(z0)`, from its derivative in the coordinates `(q, xi)`
/// ([`Mechanism::step_derivative`](dla::Mechanism::step_derivative)) and the logarithms of the density at its two ends.
///
/// It is zero for a step that preserves the measure, and `O(h^(p+1))` for a method of order `p` if the flow preserves it.
#[must_use]
pub fn measure_defect(derivative: &DMatrix<f64>, [before, after]: [f64; 2]) -> f64 {
    derivative.determinant().abs().ln() + after - before
}
