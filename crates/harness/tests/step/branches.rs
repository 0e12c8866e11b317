//! Methods that find their step by fixed-point iteration need no safeguard: what the iteration converges to is the solution
//! that continues the motion, which is followed here from a step of length zero on, independently.

use crate::common::{sleigh, state_of};
use dla::{Energy, Gauss, Gni, ImplicitMidpoint, OneStep, State};
use lagrangian::linear::Lu;
use lagrangian::quadrature::{gauss_collocation, gauss_legendre};
use lagrangian::{Dual, Scalar};
use sleigh::{Sleigh, SleighState};
use std::array::from_fn;

/// The parts in which a solution is followed; within one it changes by less than a twentieth, or it has ended.
const PARTS: u32 = 500;

/// A solution `x` of some equations at the end of the branch that begins at `x0`, by Newton's method in small parts.
fn followed<const U: usize>(x0: [f64; U], correction: impl Fn(f64, &[f64; U]) -> Option<[f64; U]>) -> Option<[f64; U]> {
    let mut x = x0;
    for part in 1..=PARTS {
        let before = x;
        let size = |x: &[f64; U]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for _ in 0..6 {
            let d = correction(f64::from(part) / f64::from(PARTS), &x)?;
            x = from_fn(|i| x[i] + d[i]);
            // The next correction is of the order of its square.
            if size(&d) <= 1e-10 * size(&x) {
                break;
            }
        }
        let moved = size(&from_fn(|i| x[i] - before[i]));
        // What is not a number is not near.
        if !moved.is_finite() || moved > 0.05 * size(&before) {
            return None;
        }
    }
    Some(x)
}

/// Speed and spin after a step of Gauss collocation for `u' = a omega^2`, `omega' = -c u omega`.
fn collocated<const S: usize, const U: usize>(sleigh: &Sleigh, start: [f64; 2], h: f64) -> Option<[f64; 2]> {
    let (a, c) = (sleigh.offset(), sleigh.spin_gain());
    let (nodes, weights) = gauss_legendre::<S>();
    let table = gauss_collocation(&nodes, &weights);
    let slope = |[u, omega]: [f64; 2]| [a * omega * omega, -c * u * omega];
    let stage = |h: f64, k: &[f64; U], i: usize| -> [f64; 2] {
        from_fn(|x| start[x] + h * (0..S).map(|j| table[i][j] * k[2 * j + x]).sum::<f64>())
    };
    let k = followed::<U>(from_fn(|i| slope(start)[i % 2]), |part, k| {
        let h = part * h;
        let (mut matrix, mut right) = ([[0.0; U]; U], [0.0; U]);
        for i in 0..S {
            let [u, omega] = stage(h, k, i);
            let jacobian = [[0.0, 2.0 * a * omega], [-c * omega, -c * u]];
            for x in 0..2 {
                right[2 * i + x] = slope([u, omega])[x] - k[2 * i + x];
                for j in 0..S {
                    for y in 0..2 {
                        let same = f64::from(u8::from(i == j && x == y));
                        matrix[2 * i + x][2 * j + y] = same - h * table[i][j] * jacobian[x][y];
                    }
                }
            }
        }
        Lu::new(matrix).ok().map(|lu| lu.solve(right))
    })?;
    Some(from_fn(|x| start[x] + h * (0..S).map(|j| weights[j] * k[2 * j + x]).sum::<f64>()))
}

/// The solution of one equation `f(h, w) = 0`, from `w0` on.
fn root(w0: f64, h: f64, f: impl Fn(f64, Dual<f64, 1>) -> Dual<f64, 1>) -> Option<f64> {
    let [w] = followed([w0], |part, w| {
        let [w] = Dual::variables(w);
        let at = f(part * h, w);
        Some([-at.re / at.eps[0]])
    })?;
    Some(w)
}

/// The spin at the end of a step of the implicit midpoint rule in full coordinates, whose mean spin `w` is that of
///
/// ```text
/// w = omega - (h/2) c w (u cos(h w/2) + (h/2) a w^2).
/// ```
fn by_midpoint(sleigh: &Sleigh, [u, omega]: [f64; 2], h: f64) -> Option<f64> {
    let (a, c) = (sleigh.offset(), sleigh.spin_gain());
    let w = root(omega, h, |h, w| w - omega + w * ((w * (0.5 * h)).cos() * u + w * w * (0.5 * h * a)) * (0.5 * h * c))?;
    Some(2.0 * w - omega)
}

/// The mean spin of a first step of the reflected momenta by the trapezoidal rule, from heading 0: with
/// `v_x = u + a w sin(h w)/2` and `v_y = a omega - a w (1 + cos(h w))/2`,
///
/// ```text
/// J omega = J w + m a/2 (v_y - sin(h w) v_x + cos(h w) v_y) + (h/2) m a w v_x.
/// ```
fn by_reflection(sleigh: &Sleigh, [u, omega]: [f64; 2], h: f64) -> Option<f64> {
    let (m, a, inertia) = (sleigh.mass(), sleigh.offset(), sleigh.pivot_inertia());
    root(omega, h, |h, w| {
        let (sin, cos) = (w * h).sin_cos();
        let vx = w * sin * (0.5 * a) + u;
        let vy = -w * (cos + 1.0) * (0.5 * a) + a * omega;
        let across = vy - sin * vx + cos * vy;
        (w - omega) * inertia + across * (0.5 * m * a) + w * vx * (0.5 * h * m * a)
    })
}

/// How many steps were right, refused though there is a solution, refused where there is none, and wrong.
#[derive(Debug, Default)]
struct Count {
    right: u32,
    refused: u32,
    none: u32,
    wrong: u32,
}

/// Steps of every length from every `every`-th start. After each step `seen` of the state is compared with `expected`.
fn count<M: OneStep<3, 1>>(
    every: usize,
    method: impl Fn() -> M,
    expected: impl Fn(&Sleigh, [f64; 2], f64) -> Option<f64>,
    seen: impl Fn(&State<3>, f64) -> f64,
) -> Count {
    let (sleigh, mut count) = (sleigh(), Count::default());
    for i in (0..14).step_by(every) {
        for j in (0..14).step_by(every) {
            for h in [0.3, 1.0, 2.0, 3.0] {
                let (speed, turn_rate) = (-3.0 + 0.443 * f64::from(i), 0.01 + 0.32 * f64::from(j));
                let start = SleighState { speed, turn_rate, ..SleighState::default() };
                let mut state = state_of(&sleigh, &start);
                let outcome = method().step(&sleigh, 0.0, h, &mut state);
                match (expected(&sleigh, [speed, turn_rate], h), outcome) {
                    (Some(value), Ok(_)) => {
                        // Near the end of a branch a rounding moves the solution by its root.
                        let near = (seen(&state, h) - value).abs() <= 1e-6 * value.abs().max(1.0);
                        count.right += u32::from(near);
                        count.wrong += u32::from(!near);
                    }
                    (None, Ok(_)) => count.wrong += 1,
                    (Some(_), Err(error)) => {
                        assert!(error.hint().is_some(), "{error}");
                        count.refused += 1;
                    }
                    (None, Err(_)) => count.none += 1,
                }
            }
        }
    }
    count
}

fn spin(state: &State<3>, _h: f64) -> f64 {
    state.v()[2]
}

fn gauss4(every: usize) -> Count {
    count(every, Gauss::new::<2>, |s, y, h| collocated::<2, 4>(s, y, h).map(|y| y[1]), spin)
}

fn gauss8(every: usize) -> Count {
    count(every, Gauss::new::<4>, |s, y, h| collocated::<4, 8>(s, y, h).map(|y| y[1]), spin)
}

fn energy2(every: usize) -> Count {
    count(every, Energy::new::<1>, |s, y, h| collocated::<1, 2>(s, y, h).map(|y| y[1]), spin)
}

fn midpoint(every: usize) -> Count {
    count(every, ImplicitMidpoint::default, by_midpoint, spin)
}

/// The control: Newton's method without a look at the branch, as the counter-example has it.
fn gni(every: usize) -> Count {
    count(every, Gni::<3>::default, by_reflection, |state, h| state.unwrapped()[2] / h)
}

/// No step is wrong; more than `right` are right, and more than `refused` have no solution or are refused.
fn on_the_branch(name: &str, count: &Count, [right, refused]: [u32; 2]) {
    println!("{name:<18} {count:?}");
    assert_eq!(count.wrong, 0, "{name} accepts solutions of another motion: {count:?}");
    assert!(count.right > right && count.none + count.refused > refused, "{name}: {count:?}");
}

/// More than `wrong` steps are wrong, and more than `right` are right.
fn off_the_branch(count: &Count, [wrong, right]: [u32; 2]) {
    println!("{:<18} {count:?}", "gni");
    assert!(count.wrong > wrong && count.right > right, "the same measure sees other solutions with gni: {count:?}");
}

/// From every ninth start and every fifth; the control from every fourth.
#[test]
fn fixed_points_are_on_the_branch() {
    on_the_branch("gauss4", &gauss4(9), [6, 2]);
    on_the_branch("energy2", &energy2(9), [6, 2]);
    on_the_branch("implicit-midpoint", &midpoint(5), [14, 5]);
    off_the_branch(&gni(4), [0, 24]);
}

#[test]
#[ignore = "slow"]
fn fixed_points_are_on_the_branch_at_length() {
    for (name, count) in
        [("gauss4", gauss4(1)), ("gauss8", gauss8(1)), ("energy2", energy2(1)), ("implicit-midpoint", midpoint(1))]
    {
        on_the_branch(name, &count, [300, 100]);
    }
    off_the_branch(&gni(1), [4, 300]);
}
