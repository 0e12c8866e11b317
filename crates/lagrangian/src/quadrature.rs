//! Quadrature rules on `[0, 1]`, computed to rounding.

use std::array::from_fn;

/// The Legendre polynomials `P_0(x) .. P_n(x)` on `[-1, 1]`, by their recurrence; `visit(k, P_k)` receives each.
fn legendre(n: usize, x: f64, mut visit: impl FnMut(usize, f64)) {
    let (mut before, mut current) = (0.0, 1.0);
    for k in 0..=n {
        visit(k, current);
        let k = k as f64;
        (before, current) = (current, ((2.0 * k + 1.0) * x * current - k * before) / (k + 1.0));
    }
}

/// The values `P_0(2 x - 1) .. P_S(2 x - 1)` of the first `S` Legendre polynomials on `[0, 1]`, and of the next one.
#[must_use]
pub fn shifted_legendre<const S: usize>(x: f64) -> ([f64; S], f64) {
    let (mut values, mut next) = ([0.0; S], 0.0);
    legendre(S, 2.0 * x - 1.0, |k, p| if k < S { values[k] = p } else { next = p });
    (values, next)
}

/// Nodes, in ascending order, and weights of the Gauss-Legendre rule with `S` nodes, exact to degree `2 S - 1`.
///
/// Newton's method on `P_S` from Tricomi's approximations (Abramowitz and Stegun 1964, 22.16.6); each pair of nodes
/// is computed once, so that the rule is symmetric to the last bit.
#[must_use]
pub fn gauss_legendre<const S: usize>() -> ([f64; S], [f64; S]) {
    let (mut nodes, mut weights) = ([0.5; S], [1.0; S]);
    for k in 0..S.div_ceil(2) {
        // The k-th largest zero of P_S; the middle one is zero.
        let n = S as f64;
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        if 2 * k + 1 == S {
            x = 0.0;
        }
        let mut slope = 1.0;
        for _ in 0..10 {
            let (mut before, mut p) = (0.0, 0.0);
            legendre(S, x, |k, value| {
                if k + 1 == S {
                    before = value;
                }
                p = value;
            });
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        nodes[k] = 0.5 * (1.0 - x);
        nodes[S - 1 - k] = 1.0 - nodes[k];
        weights[k] = weight;
        weights[S - 1 - k] = weight;
    }
    (nodes, weights)
}

/// The coefficients `a[i][j]`, the integral of the `j`-th Lagrange polynomial of the Gauss nodes from 0 to the `i`-th:
/// those of the Gauss collocation method.
///
/// By the expansion of the Lagrange polynomials in Legendre's (Hairer, Norsett and Wanner 1993, section II.7; Hairer and
/// Wanner 1996, section IV.5), which loses no digits.
#[must_use]
pub fn gauss_collocation<const S: usize>(nodes: &[f64; S], weights: &[f64; S]) -> [[f64; S]; S] {
    let values: [([f64; S], f64); S] = from_fn(|i| shifted_legendre(nodes[i]));
    from_fn(|i| {
        from_fn(|j| {
            let mut sum = nodes[i];
            for k in 1..S {
                let above = if k + 1 < S { values[i].0[k + 1] } else { values[i].1 };
                sum += 0.5 * values[j].0[k] * (above - values[i].0[k - 1]);
            }
            weights[j] * sum
        })
    })
}
