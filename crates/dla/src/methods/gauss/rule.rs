use super::doubt::Between;
use lagrangian::from_fn;
use lagrangian::quadrature::{gauss_collocation, gauss_legendre, lagrange, shifted_legendre};
use lagrangian::simd::Square;
use std::sync::OnceLock;

/// A rule of at most eight nodes for eight lanes; lanes beyond its nodes stay at the beginning of the step.
#[derive(Debug, PartialEq)]
pub(crate) struct GaussRule {
    pub(crate) nodes: [f64; 8],
    pub(crate) weights: [f64; 8],
    /// The coefficients `a[i][j]` by columns: column `j` has the coefficients of slope `j` in every stage.
    pub(crate) columns: [[f64; 8]; 8],
    /// The same coefficients in the order of registers.
    pub(super) square: Square,
    /// The weights of the coefficient of the highest Legendre polynomial in the slopes.
    pub(crate) highest: [f64; 8],
    /// The weights for the five highest Legendre coefficients, the highest first; zeros if there are fewer.
    pub(super) tail: [[f64; 8]; 5],
    /// The number of nodes.
    pub(crate) stages: usize,
    between: OnceLock<Between>,
    /// The matrices that continue the slopes of one step to the nodes of the next, by the degree of the polynomial and the ratio of the
    /// lengths.
    continued: [OnceLock<[Square; (SHORTER + LONGER + 1) as usize]>; 8],
}

/// Lengths of steps are powers of the fourth root of two. The next step is longer by at most this number of quarter octaves: the iteration
/// of a much longer step may not converge, and is lost.
pub(super) const LONGER: i32 = 2;
/// The next step is shorter by at most this number of quarter octaves.
pub(super) const SHORTER: i32 = 8;

impl GaussRule {
    /// The rule with `S` nodes.
    pub(crate) fn gauss<const S: usize>() -> &'static Self {
        static RULES: [OnceLock<GaussRule>; 9] = [const { OnceLock::new() }; 9];
        const { assert!(1 <= S && S <= 8, "one to eight stages") };
        RULES[S].get_or_init(Self::compute::<S>)
    }

    fn compute<const S: usize>() -> Self {
        let (nodes, weights) = gauss_legendre::<S>();
        let coefficients = gauss_collocation(&nodes, &weights);
        let row = |f: &dyn Fn(usize) -> f64| from_fn(|i| if i < S { f(i) } else { 0.0 });
        let column = |f: &dyn Fn(usize, usize) -> f64| from_fn(|j| row(&|i| if j < S { f(i, j) } else { 0.0 }));
        let coefficient = |m: usize, j: usize| {
            let (p, _) = shifted_legendre::<S>(nodes[j]);
            (S - 1).checked_sub(m).map_or(0.0, |k| (2.0 * k as f64 + 1.0) * weights[j] * p[k])
        };
        let tail: [[f64; 8]; 5] = from_fn(|m| row(&|j| coefficient(m, j)));
        let columns = column(&|i, j| coefficients[i][j]);
        Self {
            nodes: row(&|i| nodes[i]),
            weights: row(&|i| weights[i]),
            square: Square::of_columns(&columns),
            columns,
            highest: tail[0],
            tail,
            between: OnceLock::new(),
            stages: S,
            continued: [const { OnceLock::new() }; 8],
        }
    }

    /// The points between the stages, at which the error of a step shows.
    pub(super) fn between(&self) -> &Between {
        self.between.get_or_init(|| Between::of(&self.nodes[..self.stages]))
    }

    /// The matrix that continues the slopes of a step to the nodes of one that is `2^(quarters/4)` times as long, by the polynomial through
    /// the last `degree + 1` of them.
    #[inline(always)]
    pub(crate) fn continued(&self, degree: usize, quarters: i32) -> Option<&Square> {
        let all =
            self.continued.get(degree)?.get_or_init(|| from_fn(|k| self.continuation(degree, k as i32 - SHORTER)));
        all.get(usize::try_from(quarters.saturating_add(SHORTER)).ok()?)
    }

    #[cold]
    fn continuation(&self, degree: usize, quarters: i32) -> Square {
        let first = self.stages.saturating_sub(degree + 1);
        let (last, ratio) = (&self.nodes[first..self.stages], quarter_octaves(quarters));
        let term = |i: usize, j: usize| match i < self.stages && (first..self.stages).contains(&j) {
            true => lagrange(last, j - first, 1.0 + ratio * self.nodes[i]),
            false => 0.0,
        };
        Square::of_columns(&from_fn(|j| from_fn(|i| term(i, j))))
    }
}

/// `2^(quarters/4)`.
pub(crate) fn quarter_octaves(quarters: i32) -> f64 {
    (0.25 * f64::from(quarters)).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The product of a square with a vector.
    fn product(square: &Square, x: &[f64; 8]) -> [f64; 8] {
        from_fn(|i| (0..8).map(|term| square.terms[term][i] * x[i ^ term]).sum())
    }

    fn check<const S: usize>() {
        let rule = GaussRule::gauss::<S>();
        for degree in 0..S {
            for quarters in -SHORTER..=LONGER {
                let square = rule.continued(degree, quarters).expect("a ratio that steps have");
                let off = |power: i32| {
                    let before = from_fn(|i| if i < S { rule.nodes[i].powi(power) } else { 0.0 });
                    let after = product(square, &before);
                    let ahead = |i: usize| (1.0 + quarter_octaves(quarters) * rule.nodes[i]).powi(power);
                    (0..S).map(|i| (after[i] - ahead(i)).abs()).fold(0.0, f64::max)
                };
                // Lagrange polynomials reach 1e6 at the end of a step that is longer by half an octave.
                assert!((0..=degree as i32).all(|power| off(power) < 1e6 * 16.0 * f64::EPSILON));
                assert!(off(degree as i32 + 1) > 1e-4, "one degree more: {:e}", off(degree as i32 + 1));
            }
        }
        assert!(rule.continued(S - 1, LONGER + 1).is_none() && rule.continued(S - 1, -SHORTER - 1).is_none());
        assert!(rule.continued(8, 0).is_none());
    }

    /// Slopes that are a polynomial of the degree are continued exactly, whatever the ratio of the steps, and no others.
    #[test]
    fn polynomials_go_on() {
        check::<1>();
        check::<2>();
        check::<5>();
        check::<8>();
    }
}
