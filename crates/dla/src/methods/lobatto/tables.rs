use lagrangian::quadrature::shifted_legendre;
use lagrangian::{from_fn, mapped};

/// The Lobatto nodes and weights on `[0, 1]` with the coefficients of the pair IIIA and IIIB, for any `S >= 2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LobattoTables<const S: usize> {
    /// Nodes `c`, ascending, the two ends among them.
    pub c: [f64; S],
    /// Weights `b`, exact to degree `2 S - 3`.
    pub b: [f64; S],
    /// IIIA: `a[i][j]` is the integral of the `j`-th Lagrange polynomial from 0 to `c[i]`. The first row is zero, the last
    /// is `b`.
    pub a: [[f64; S]; S],
    /// IIIB: `b[i] a_hat[i][j] + b[j] a[j][i] = b[i] b[j]`. The first column is `b[0]`, the last is zero.
    pub a_hat: [[f64; S]; S],
    /// The values at the nodes of the polynomial of degree `S - 1` that IIIA does not see, `sum_j a[i][j] blind[j] = 0`:
    /// Legendre's, scaled to 1 at the first node.
    pub blind: [f64; S],
}

impl<const S: usize> LobattoTables<S> {
    /// Computes them to rounding.
    ///
    /// The Lagrange polynomials are expanded in Legendre's, which loses no digits (Hairer and Wanner 1996, section IV.5).
    #[must_use]
    #[allow(clippy::new_without_default, reason = "a rule has no default number of stages")]
    pub fn new() -> Self {
        const { assert!(S >= 2, "a Lobatto rule has at least the two ends") }
        let c = nodes();
        let values: [([f64; S], f64); S] = mapped(&c, shifted_legendre);
        let last = mapped(&values, |(p, _)| p[S - 1]);
        let n = S as f64;
        let b = mapped(&last, |p| 1.0 / (n * (n - 1.0) * p * p));
        let a = from_fn(|i| {
            from_fn(|j| {
                let mut sum = c[i];
                for k in 1..S {
                    let (above, norm) = if k + 1 < S {
                        (values[i].0[k + 1], 0.5)
                    } else {
                        // The rule is not exact for the square of this last one.
                        (values[i].1, 0.5 * (n - 1.0) / (2.0 * n - 1.0))
                    };
                    sum += norm * values[j].0[k] * (above - values[i].0[k - 1]);
                }
                b[j] * sum
            })
        });
        let a: [[f64; S]; S] = a;
        let a_hat = from_fn(|i| from_fn(|j| b[j] - b[j] * (a[j][i] / b[i])));
        Self { c, b, a, a_hat, blind: mapped(&last, |p| p / last[0]) }
    }
}

/// The ends and the zeros of `P_(S-1)'`, by Newton's method from the extrema of Chebyshev's polynomial.
///
/// Each pair is computed once, so that the rule is symmetric.
fn nodes<const S: usize>() -> [f64; S] {
    let mut nodes = [0.5; S];
    (nodes[0], nodes[S - 1]) = (0.0, 1.0);
    let n = S as f64 - 1.0;
    for k in 1..S / 2 {
        let mut c = 0.5 * (1.0 - (std::f64::consts::PI * k as f64 / n).cos());
        for _ in 0..10 {
            let (p, _) = shifted_legendre::<S>(c);
            let x = 2.0 * c - 1.0;
            // (1 - x^2) P_n' and its derivative, -n (n + 1) P_n.
            let slope = n * (p[S - 2] - x * p[S - 1]);
            c += 0.5 * slope / (n * (n + 1.0) * p[S - 1]);
        }
        (nodes[k], nodes[S - 1 - k]) = (c, 1.0 - c);
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(computed: &[f64], published: &[f64], what: &str) {
        assert_eq!(computed.len(), published.len());
        for (x, y) in computed.iter().zip(published) {
            assert!((x - y).abs() <= 2.0 * f64::EPSILON, "{what}: {computed:?}, published {published:?}");
        }
    }

    /// Hairer and Wanner 1996, tables IV.5.7 to IV.5.10.
    #[test]
    fn the_published_tables() {
        let two = LobattoTables::<2>::new();
        close(&two.c, &[0.0, 1.0], "c");
        close(&two.b, &[0.5, 0.5], "b");
        close(two.a.as_flattened(), &[0.0, 0.0, 0.5, 0.5], "IIIA");
        close(two.a_hat.as_flattened(), &[0.5, 0.0, 0.5, 0.0], "IIIB");

        let three = LobattoTables::<3>::new();
        close(&three.c, &[0.0, 0.5, 1.0], "c");
        let [x, y] = [1.0 / 6.0, 2.0 / 3.0];
        close(&three.b, &[x, y, x], "b");
        close(three.a.as_flattened(), &[0.0, 0.0, 0.0, 5.0 / 24.0, 1.0 / 3.0, -1.0 / 24.0, x, y, x], "IIIA");
        close(three.a_hat.as_flattened(), &[x, -x, 0.0, x, 2.0 * x, 0.0, x, 5.0 * x, 0.0], "IIIB");

        let four = LobattoTables::<4>::new();
        let r = 5f64.sqrt();
        close(&four.c, &[0.0, (5.0 - r) / 10.0, (5.0 + r) / 10.0, 1.0], "c");
        let [x, y] = [1.0 / 12.0, 5.0 / 12.0];
        close(&four.b, &[x, y, y, x], "b");
        let third_a = [
            [0.0; 4],
            [(11.0 + r) / 120.0, (25.0 - r) / 120.0, (25.0 - 13.0 * r) / 120.0, (-1.0 + r) / 120.0],
            [(11.0 - r) / 120.0, (25.0 + 13.0 * r) / 120.0, (25.0 + r) / 120.0, (-1.0 - r) / 120.0],
            [x, y, y, x],
        ];
        close(four.a.as_flattened(), third_a.as_flattened(), "IIIA");
        let third_b = [
            [x, (-1.0 - r) / 24.0, (-1.0 + r) / 24.0, 0.0],
            [x, (25.0 + r) / 120.0, (25.0 - 13.0 * r) / 120.0, 0.0],
            [x, (25.0 + 13.0 * r) / 120.0, (25.0 - r) / 120.0, 0.0],
            [x, (11.0 - r) / 24.0, (11.0 + r) / 24.0, 0.0],
        ];
        close(four.a_hat.as_flattened(), third_b.as_flattened(), "IIIB");
    }

    fn power(c: f64, k: usize) -> f64 {
        c.powi(k as i32)
    }

    /// `B(2 S - 2)`, `C(S)` of IIIA, `C(S - 2)` and `D(S)` of IIIB, `D(S - 2)` of IIIA.
    fn simplifying<const S: usize>() {
        let LobattoTables { c, b, a, a_hat, blind } = LobattoTables::<S>::new();
        let tolerance = 4.0 * f64::EPSILON;
        let holds = |left: f64, right: f64, what: &str| {
            assert!((left - right).abs() <= tolerance, "S = {S}, {what}: {left} and {right}");
        };
        let sum = |term: &dyn Fn(usize) -> f64| (0..S).map(term).sum::<f64>();
        for k in 1..=2 * S - 2 {
            holds(sum(&|j| b[j] * power(c[j], k - 1)), 1.0 / k as f64, "B");
        }
        let short = sum(&|j| b[j] * power(c[j], 2 * S - 2)) - 1.0 / (2 * S - 1) as f64;
        assert!(short.abs() > 1e-10, "S = {S}: exact beyond its degree");
        for i in 0..S {
            holds(a[0][i], 0.0, "first row");
            holds(a[S - 1][i], b[i], "last row");
            holds(a_hat[i][0], b[0], "first column");
            assert_eq!(a_hat[i][S - 1].to_bits(), 0, "last column");
            holds(sum(&|j| a[i][j] * blind[j]), 0.0, "blind");
            for j in 0..S {
                holds(b[i] * a_hat[i][j] + b[j] * a[j][i], b[i] * b[j], "symplectic");
                holds(a[i][j] + a[S - 1 - i][S - 1 - j], b[j], "symmetric IIIA");
                holds(a_hat[i][j] + a_hat[S - 1 - i][S - 1 - j], b[j], "symmetric IIIB");
            }
            for k in 1..=S {
                holds(sum(&|j| a[i][j] * power(c[j], k - 1)), power(c[i], k) / k as f64, "C of IIIA");
                let d = |m: &[[f64; S]; S]| sum(&|j| b[j] * power(c[j], k - 1) * m[j][i]);
                let expected = b[i] * (1.0 - power(c[i], k)) / k as f64;
                holds(d(&a_hat), expected, "D of IIIB");
                if k + 2 <= S {
                    holds(sum(&|j| a_hat[i][j] * power(c[j], k - 1)), power(c[i], k) / k as f64, "C of IIIB");
                    holds(d(&a), expected, "D of IIIA");
                }
            }
        }
    }

    #[test]
    fn the_simplifying_assumptions() {
        simplifying::<2>();
        simplifying::<3>();
        simplifying::<4>();
        simplifying::<5>();
        simplifying::<6>();
        simplifying::<7>();
        simplifying::<8>();
    }
}
