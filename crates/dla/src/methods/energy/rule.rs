use lagrangian::quadrature::gauss_legendre_twofold;
use lagrangian::{Lanes, Twofold, from_fn, mapped};

/// The coefficients of collocation with up to four Gauss nodes `c_i` and of the integrals over the step.
///
/// The derivative of the polynomial is `u'(tau) = sum_i l_i(tau) K_i`, `l_i` the Lagrange polynomials of the `c_i`. The
/// averages of the gradient are integrals against the `l_i`, by the Gauss rule with eight nodes, one in each of the
/// [`Lanes`]. It integrates polynomials of degree 15 exactly, so a gradient along the path of degree `16 - S`: an energy
/// of fourth degree at `S = 4`. An oscillation by the angle `d` over a step is integrated with the relative error
/// `d^16 (8!)^4 / (17 (16!)^3)`, which is `7e-16` at `d = 3` and far below rounding at the steps of an accurate run.
///
/// The energy is kept by identities between the coefficients. Their rounding would break these by the same little in every step, and the
/// energy would drift if the motion has an attractor; so they have twice the digits.
///
/// The number of nodes is a value and no type, so that a step is compiled once for all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EnergyRule {
    /// How many collocation nodes there are; `S` above.
    pub(super) stages: usize,
    /// `b_i`, the integral of `l_i`.
    b: [Twofold; MOST],
    /// Where along the step the nodes of the quadrature are.
    pub(super) nodes: Lanes,
    /// Where the [points](Rule::ends) are.
    pub(super) points: Lanes,
    /// `w_k l_i(sigma_k) / b_i` at the nodes of the quadrature.
    averages: [Weights; MOST],
    /// `int_0^sigma l_i` at the nodes of the quadrature.
    to_nodes: [Weights; MOST],
    /// The weights at the points.
    to_points: [Weights; MOST],
}

/// With more nodes too few of the quadrature's digits are left.
pub(super) const MOST: usize = 4;

/// One coefficient for each of the lanes, with twice the digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights {
    hi: Lanes,
    lo: Lanes,
}

impl Weights {
    const NONE: Self = Self { hi: Lanes([0.0; Lanes::COUNT]), lo: Lanes([0.0; Lanes::COUNT]) };

    fn new(weights: [Twofold; Lanes::COUNT]) -> Self {
        Self { hi: Lanes(mapped(&weights, |w| w.hi)), lo: Lanes(mapped(&weights, |w| w.lo)) }
    }

    /// Adds the products with `x` to a sum and to what it leaves out.
    #[inline(always)]
    pub(super) fn add<X: Copy>(&self, x: X, sum: &mut Lanes, rest: &mut Lanes)
    where
        Lanes: std::ops::Mul<X, Output = Lanes>,
    {
        *sum += self.hi * x;
        *rest += self.lo * x;
    }
}

impl EnergyRule {
    /// The indices of the end and the start of the step among the points, after the collocation nodes.
    #[inline(always)]
    pub(super) fn ends(&self) -> (usize, usize) {
        (self.stages, self.stages + 1)
    }

    pub(super) fn new<const S: usize>() -> Self {
        const { assert!(1 <= S && S <= MOST, "one to four nodes: more leave too few of the quadrature's digits") };
        let (c, _) = gauss_legendre_twofold::<S>();
        let (nodes, weights) = gauss_legendre_twofold::<{ Lanes::COUNT }>();
        let one = Twofold::from(1.0);
        let basis = |i: usize, tau: Twofold| -> Twofold {
            (0..S).filter(|j| *j != i).fold(one, |product, j| product * ((tau - c[j]) / (c[i] - c[j])))
        };
        let integral = |i: usize, tau: Twofold| -> Twofold {
            let at = |k: usize| weights[k] * basis(i, tau * nodes[k]);
            tau * (1..Lanes::COUNT).fold(at(0), |sum, k| sum + at(k))
        };
        let points: [Twofold; Lanes::COUNT] = from_fn(|k| match k {
            k if k < S => c[k],
            k if k == S + 1 => Twofold::from(0.0),
            _ => one,
        });
        let b: [Twofold; S] = from_fn(|i| integral(i, one));
        let filled = |weights: &dyn Fn(usize) -> Weights| from_fn(|i| if i < S { weights(i) } else { Weights::NONE });
        Self {
            stages: S,
            b: from_fn(|i| if i < S { b[i] } else { Twofold::from(0.0) }),
            nodes: Lanes(mapped(&nodes, |node| node.hi)),
            points: Lanes(mapped(&points, |point| point.hi)),
            averages: filled(&|i| Weights::new(from_fn(|k| weights[k] * basis(i, nodes[k]) / b[i]))),
            to_nodes: filled(&|i| Weights::new(mapped(&nodes, |tau| integral(i, tau)))),
            to_points: filled(&|i| Weights::new(mapped(&points, |tau| integral(i, tau)))),
        }
    }

    #[inline(always)]
    pub(super) fn b(&self) -> &[Twofold] {
        &self.b[..self.stages]
    }

    #[inline(always)]
    pub(super) fn averages(&self) -> &[Weights] {
        &self.averages[..self.stages]
    }

    #[inline(always)]
    pub(super) fn integrals_to_nodes(&self) -> &[Weights] {
        &self.to_nodes[..self.stages]
    }

    #[inline(always)]
    pub(super) fn integrals_to_points(&self) -> &[Weights] {
        &self.to_points[..self.stages]
    }

    /// `sum_i b_i x_i`.
    #[inline(always)]
    pub(super) fn weighted(&self, x: &Lanes) -> f64 {
        let (hi, lo) = self.b().iter().zip(x.0).fold((0.0, 0.0), |(hi, lo), (b, x)| (hi + b.hi * x, lo + b.lo * x));
        hi + lo
    }
}

#[cfg(test)]
mod tests {
    use super::EnergyRule;

    /// Weights and matrix of the Gauss methods (Hairer, Lubich and Wanner 2006, table II.1.1).
    #[test]
    fn gauss_coefficients() {
        let rule = EnergyRule::new::<2>();
        let root = 3.0_f64.sqrt() / 6.0;
        let expected = [[0.25, 0.25 - root], [0.25 + root, 0.25]];
        for i in 0..2 {
            assert!((rule.b[i].hi - 0.5).abs() < 2e-16);
            for j in 0..2 {
                assert!((rule.to_points[j].hi.0[i] - expected[i][j]).abs() < 2e-16);
            }
        }
        check::<1>();
        check::<3>();
        check::<4>();
    }

    /// Collocation integrates powers below `2 S` exactly over the step, and below `S` up to every point.
    fn check<const S: usize>() {
        let rule = EnergyRule::new::<S>();
        for power in 0..2 * S as i32 {
            let sum: f64 = (0..S).map(|i| rule.b[i].hi * rule.points.0[i].powi(power)).sum();
            assert!((sum - f64::from(power + 1).recip()).abs() < 4e-16, "S = {S}, power {power}: {sum}");
        }
        for power in 0..S as i32 {
            for k in 0..8 {
                let tau = rule.nodes.0[k];
                let sum: f64 = (0..S).map(|j| rule.to_nodes[j].hi.0[k] * rule.points.0[j].powi(power)).sum();
                let exact = tau.powi(power + 1) / f64::from(power + 1);
                assert!((sum - exact).abs() < 4e-16, "S = {S}, power {power}, node {k}");
            }
        }
        for i in 0..S {
            assert!((rule.averages[i].hi.0.iter().sum::<f64>() - 1.0).abs() < 4e-16);
        }
    }
}
