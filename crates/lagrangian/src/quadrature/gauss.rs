use crate::{Twofold, from_fn, mapped};
use std::ops::{Div, Mul, Sub};

/// The Legendre polynomials `P_0(x) .. P_n(x)` on `[-1, 1]`, by their recurrence; `visit(k, P_k)` receives each.
fn legendre<T: RootNumber>(n: usize, x: T, mut visit: impl FnMut(usize, T)) {
    let (mut before, mut current) = (T::from(0.0), T::from(1.0));
    for k in 0..=n {
        visit(k, current);
        let k = k as f64;
        (before, current) = (current, (x * current * T::from(2.0 * k + 1.0) - before * T::from(k)) / T::from(k + 1.0));
    }
}

/// What the recurrence needs: `f64` has it, and [`Twofold`].
trait RootNumber: Copy + From<f64> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {}
impl RootNumber for f64 {}
impl RootNumber for Twofold {}

/// The values `P_0(2 x - 1) .. P_S(2 x - 1)` of the first `S` Legendre polynomials on `[0, 1]`, and of the next one.
#[must_use]
pub fn shifted_legendre<const S: usize>(x: f64) -> ([f64; S], f64) {
    let (mut values, mut next) = ([0.0; S], 0.0);
    legendre(S, 2.0 * x - 1.0, |k, p| if k < S { values[k] = p } else { next = p });
    (values, next)
}

/// The `j`-th Lagrange polynomial of the nodes: one at that node, zero at the others.
#[must_use]
pub fn lagrange(nodes: &[f64], j: usize, x: f64) -> f64 {
    (0..nodes.len()).filter(|&m| m != j).map(|m| (x - nodes[m]) / (nodes[j] - nodes[m])).product()
}

/// Nodes, in ascending order, and weights of the Gauss-Legendre rule with `S` nodes, exact to degree `2 S - 1`.
#[must_use]
pub fn gauss_legendre<const S: usize>() -> ([f64; S], [f64; S]) {
    let (nodes, weights) = gauss_legendre_twofold();
    (mapped(&nodes, |node| node.hi), mapped(&weights, |weight| weight.hi))
}

/// The rule of [`gauss_legendre`] with twice the digits.
///
/// Newton's method on `P_S` from Tricomi's approximations (Abramowitz and Stegun 1964, 22.16.6); each pair of nodes
/// is computed once, so that the rule is symmetric to the last bit.
#[must_use]
pub fn gauss_legendre_twofold<const S: usize>() -> ([Twofold; S], [Twofold; S]) {
    let one = Twofold::from(1.0);
    let (mut nodes, mut weights) = ([one * 0.5; S], [one; S]);
    for k in 0..S.div_ceil(2) {
        // The k-th largest zero of P_S; the middle one is zero.
        let n = S as f64;
        let mut x = Twofold::from((std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos());
        if 2 * k + 1 == S {
            x = Twofold::from(0.0);
        }
        let mut slope = one;
        for _ in 0..10 {
            let (mut before, mut p) = (Twofold::from(0.0), Twofold::from(0.0));
            legendre(S, x, |k, value| {
                if k + 1 == S {
                    before = value;
                }
                p = value;
            });
            slope = (x * p - before) * n / (x * x - one);
            x = x - p / slope;
        }
        let weight = one / ((one - x * x) * slope * slope);
        nodes[k] = (one - x) * 0.5;
        nodes[S - 1 - k] = one - nodes[k];
        weights[k] = weight;
        weights[S - 1 - k] = weight;
    }
    (nodes, weights)
}

/// The coefficients `a[i][j]` of the Gauss collocation method: the integral of the `j`-th Lagrange polynomial of the Gauss nodes from 0 to
/// the `i`-th node.
///
/// By the expansion of the Lagrange polynomials in Legendre's (Hairer, Norsett and Wanner 1993, section II.7; Hairer and
/// Wanner 1996, section IV.5), which loses no digits. For symmetric nodes and weights `a[i][j] + a[S-1-i][S-1-j] = b[j]`
/// holds exactly: left to rounding, it makes a reversible motion lose or gain energy at a constant rate (compare Antonana,
/// Makazaga and Murua 2017, Numer. Algorithms 76, 861-880).
#[must_use]
pub fn gauss_collocation<const S: usize>(nodes: &[f64; S], weights: &[f64; S]) -> [[f64; S]; S] {
    let values: [([f64; S], f64); S] = from_fn(|i| shifted_legendre(nodes[i]));
    let computed: [[f64; S]; S] = from_fn(|i| {
        from_fn(|j| {
            let mut sum = nodes[i];
            for k in 1..S {
                let above = if k + 1 < S { values[i].0[k + 1] } else { values[i].1 };
                sum += 0.5 * values[j].0[k] * (above - values[i].0[k - 1]);
            }
            weights[j] * sum
        })
    });
    from_fn(|i| {
        from_fn(|j| {
            let (own, mirrored) = (computed[i][j], computed[S - 1 - i][S - 1 - j]);
            if own < mirrored {
                // Between half of the weight and twice it, so that the difference is exact.
                weights[j] - mirrored
            } else if own > mirrored {
                own
            } else {
                0.5 * weights[j]
            }
        })
    })
}
