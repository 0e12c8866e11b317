//! At rest where forces cancel.

use super::systems::{Cart, Run, SLOPE, Skate, in_basis, methods};
use crate::support::{Three, Two};
use dla::{Schedule, State};
use lagrangian::System;

/// Ends and stiffnesses of two springs.
type Springs = ([f64; 2], [f64; 2]);

#[test]
fn a_cart_stays_where_its_springs_balance() {
    balances(&[([0.1, 0.7], [3.0, 7.0]), ([0.1, 0.7], [1e6, 1e6])], 20);
}

#[test]
#[ignore = "slow"]
fn a_cart_stays_where_its_springs_balance_at_length() {
    let springs = [
        ([0.1, 0.7], [3.0, 7.0]),
        ([0.1, 0.7], [1.0, 1.0]),
        ([-1.3, 0.7], [3e4, 7e3]),
        ([0.1, 0.7], [1e6, 1e6]),
        ([-1e-3, 2e3], [1e-3, 1.0]),
    ];
    balances(&springs, 2000);
}

/// Started at the balance of two springs a cart moves by the rounding of their forces only; off it, as an oscillator does.
fn balances(springs: &[Springs], steps: u64) {
    for &(ends, stiffness) in springs {
        let plain = Cart::<false> { ends, stiffness, drag: 0.0 };
        let based = Cart::<true> { ends, stiffness, drag: 0.0 };
        let [without, within] = [Two::from(plain), Two::from(based)];
        // The explicit limit of the leapfrog is two; fixed points contract up to one.
        let step = 0.4 / plain.frequency();
        let schedule = Schedule { t0: 0.0, step, steps };
        let x = plain.balance();
        // The rounding of the two forces, and of the place where they are taken, as a displacement: added up over all steps.
        let spring = |i: usize| stiffness[i] * ((x - ends[i]).abs() + x.abs());
        let rounding = f64::EPSILON * (spring(0) + spring(1)) / plain.frequency().powi(2);
        for off in [0.0, 1e-9 * x.abs(), 0.1] {
            let end = |result: Result<State<2>, dla::RunError>, name: &str| {
                let state = result.unwrap_or_else(|error| panic!("{name}, {stiffness:?}, off {off:e}: {error}"));
                let bound = 1.01 * off + steps as f64 * rounding;
                assert!((state.q()[0] - x).abs() <= bound, "{name}, {stiffness:?}: {:e}", state.q()[0] - x);
            };
            let start = State::new([x + off, 0.0], [0.0; 2], [false; 2]);
            for (name, run) in methods() {
                end(run(&without, &schedule, start), name);
            }
            for (name, run) in methods().into_iter().chain(in_basis()) {
                end(run(&within, &schedule, start), name);
            }
        }
    }
}

#[test]
fn a_skate_across_its_slope_hardly_moves() {
    across_its_slope(&[(1e-5, 0.0), (0.0, 1e-6)], 40);
}

#[test]
#[ignore = "slow"]
fn a_skate_across_its_slope_hardly_moves_at_length() {
    let starts = [(1e-3, 0.0), (1e-5, 0.0), (1e-7, 0.0), (1e-9, 0.0), (0.0, 1e-6), (0.0, 1e-9), (0.0, 0.0)];
    across_its_slope(&starts, 1000);
}

/// A skate at rest, nearly across its slope: `u = -g sin(e) t` off the level by `e`; and with a slow spin `w`,
/// `u = g/w (cos(e + w t) - cos e)`. For each `e` and `w`.
fn across_its_slope(starts: &[(f64, f64)], steps: u64) {
    let all = |skate: Three, basis: bool, runs: &[(&'static str, Run<Three, 3>)]| {
        let g = SLOPE[0].hypot(SLOPE[1]);
        let level = SLOPE[1].atan2(SLOPE[0]) + std::f64::consts::FRAC_PI_2;
        for &(off, spin) in starts {
            let heading = level + off;
            let start = State::new([0.3, 0.7, heading], [0.0, 0.0, spin], skate.angles());
            for (name, run) in runs {
                let state = run(&skate, &Schedule { t0: 0.0, step: 0.01, steps }, start)
                    .unwrap_or_else(|error| panic!("{name}, basis {basis}, {off:e}, {spin:e}: {error}"));
                let (q, v, t) = (state.unwrapped(), state.v(), 0.01 * steps as f64);
                let u = v[0] * q[2].cos() + v[1] * q[2].sin();
                // By a product, since the difference of the cosines cancels.
                let exact = if spin == 0.0 {
                    -g * off.sin() * t
                } else {
                    -2.0 * g / spin * (off + 0.5 * spin * t).sin() * (0.5 * spin * t).sin()
                };
                // The method's error, the rounding of the heading, and that of the weight in every step.
                let bound = 1e-6 * exact.abs() + 2.0 * f64::EPSILON * g * t * heading.abs().max(1.0);
                assert!((u - exact).abs() <= bound, "{name}, basis {basis}, {off:e}, {spin:e}: {u:e} for {exact:e}");
            }
        }
    };
    all(Skate::<false>.into(), false, &methods());
    let based: Vec<_> = methods().into_iter().chain(in_basis()).collect();
    all(Skate::<true>.into(), true, &based);
}
