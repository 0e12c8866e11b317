//! What an error at the end costs on the cases of `benches/peers`: Gauss collocation of 16th order by equal steps and by steps
//! of its own, and Taylor series. Microseconds, the least of rounds on one core.
//!
//! With `--all` every run is shown, not only the quickest to an error.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use dla::{Gauss, GaussAdaptive, OneStep, Schedule, State, drive};
use lagrangian::{Effect, EffectSlope, Scalar, System, With};
use sleigh::effects::Bowl;
use sleigh::series::{InOwnAxes, OwnPush, PushInOwnAxes};
use sleigh::{Sleigh, SleighBody, SleighState, Taylor};
use std::hint::black_box;
use std::time::Instant;

const DURATION: f64 = 100.0;
const START: SleighState = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: -1.0, turn_rate: 0.1 };
const ERRORS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
const STEPS: [u64; 33] = [
    8, 10, 12, 15, 18, 20, 22, 25, 27, 29, 30, 31, 32, 33, 35, 37, 40, 42, 45, 47, 50, 52, 54, 56, 58, 60, 65, 70, 75,
    80, 85, 90, 100,
];
const ROUNDS: usize = 40;
const PASSES: usize = 6;

/// The well of the case L, at the blade: `V = k/2 |P|^2`.
struct AtBlade(f64);

impl<B: SleighBody, const N: usize> Effect<B, N> for AtBlade {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _body: &B, _t: S, q: &[S; N], _v: &[S; N]) -> Option<S> {
        Some((q[0] * q[0] + q[1] * q[1]) * (-0.5 * self.0))
    }
    #[inline(always)]
    fn slope<S: Scalar>(&self, _body: &B, _t: S, q: &[S; N]) -> EffectSlope<S, N> {
        let mut slope = [S::zero(); N];
        (slope[0], slope[1]) = (q[0] * -self.0, q[1] * -self.0);
        EffectSlope::Known(slope)
    }
}

impl PushInOwnAxes for AtBlade {
    fn in_own_axes(&self, _sleigh: &Sleigh) -> Option<OwnPush> {
        Some(OwnPush { center: Some([0.0; 2]), along: [0.0, -self.0], ..OwnPush::NOTHING })
    }
}

/// The coordinates at the end; none of a run that fails.
fn end<Sys: System<3, 1>>(
    system: &Sys,
    (q, v): ([f64; 3], [f64; 3]),
    mut method: impl OneStep<3, 1>,
    steps: u64,
) -> Option<[f64; 3]> {
    let mut state = State::new(q, v, system.angles());
    let schedule = Schedule { t0: 0.0, step: DURATION / steps as f64, steps };
    drive(system, &mut method, &schedule, &mut state, ()).ok().map(|_| state.unwrapped())
}

/// Microseconds of a run.
fn time(mut run: impl FnMut() -> Option<[f64; 3]>) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let begin = Instant::now();
        for _ in 0..4 {
            black_box(run());
        }
        least = least.min(begin.elapsed().as_secs_f64() / 4.0);
    }
    least * 1e6
}

/// Error and least time of a run at each of these values; without those that fail.
fn runs(of: &[f64], error: impl Fn(f64) -> Option<f64>, run: impl Fn(f64) -> Option<[f64; 3]>) -> Vec<(f64, f64, f64)> {
    let mut runs: Vec<_> = of.iter().filter_map(|&of| Some((of, error(of)?, f64::INFINITY))).collect();
    // Neighbours on a shared core come and go: each run is measured at several times.
    for _ in 0..PASSES {
        for (of, _, least) in &mut runs {
            *least = least.min(time(|| run(*of)));
        }
    }
    runs
}

/// Errors and times of all runs of a case, then the least times to the errors.
fn case<Sys: System<3, 1> + InOwnAxes>(name: &str, system: &Sys, start: ([f64; 3], [f64; 3])) {
    let system = black_box(system);
    let equal = |steps: f64| end(system, start, Gauss::new::<8>(), steps as u64);
    let own = |tolerance: f64| end(system, start, GaussAdaptive::new::<8>(tolerance), 1);
    let series = |tolerance: f64| end(system, start, Taylor::of(system, tolerance)?, 1);
    let exact = equal(400.0).unwrap();
    let distance = |q: [f64; 3]| (0..3).map(|k| (q[k] - exact[k]).abs()).fold(0.0, f64::max);
    let tolerances: Vec<f64> = (8..73).map(|quarter| 10f64.powf(-0.25 * f64::from(quarter))).collect();
    let equal = runs(&STEPS.map(|steps| steps as f64), |steps| equal(steps).map(distance), equal);
    let own = runs(&tolerances, |tolerance| own(tolerance).map(distance), own);
    let series = runs(&tolerances, |tolerance| series(tolerance).map(distance), series);
    for (method, runs) in [("equal steps", &equal), ("steps of its own", &own), ("series", &series)] {
        if std::env::args().any(|argument| argument == "--all") {
            for (of, error, us) in runs {
                println!("{name}, {method}, {of:.3e}: {error:.1e} {us:.2} us");
            }
        }
        let least = |error: f64| {
            let least = runs.iter().filter(|run| run.1 <= error).map(|run| run.2).fold(f64::INFINITY, f64::min);
            if least.is_finite() { format!("{least:.1}") } else { "-".into() }
        };
        println!("{name}, {method}: {} us", ERRORS.map(least).join(" / "));
    }
}

fn main() {
    let sleigh = |offset| Sleigh::new(1.0, 1.0, offset).unwrap();
    let (body, start) = (sleigh(0.5), START.to_coordinates());
    println!("errors {ERRORS:?}");
    case("S1", &body, start);
    case("S2", &sleigh(0.1), start);
    case("L", &With { body, effects: AtBlade(0.05) }, start);
    case("bowl", &With { body, effects: Bowl::new([0.1, 0.1], [0.0; 2]).unwrap() }, start);
}
