use lagrangian::quadrature::{gauss_collocation, gauss_legendre, lagrange, shifted_legendre};
use lagrangian::simd::Square;
use std::array::from_fn;
use std::sync::OnceLock;

/// A rule of at most eight nodes for eight places at once; those beyond its nodes stay at the beginning of the step.
#[derive(Debug, PartialEq)]
pub(crate) struct Eight {
    pub(crate) nodes: [f64; 8],
    pub(crate) weights: [f64; 8],
    /// The coefficients `a[i][j]` by columns: column `j` has those of slope `j` in every stage.
    pub(crate) columns: [[f64; 8]; 8],
    /// The same in the order of registers.
    pub(super) square: Square,
    /// The weights of the coefficient of the highest Legendre polynomial in the slopes.
    pub(crate) highest: [f64; 8],
    /// What continues the polynomial of one step to the nodes of the next, for each ratio of their lengths.
    continued: [Square; (SHORTER + LONGER + 1) as usize],
}

/// Lengths of steps are powers of the fourth root of two. As many quarter octaves longer is the next at most: stages of a step
/// that is much longer may not converge, and are lost.
pub(super) const LONGER: i32 = 2;
/// And shorter.
pub(super) const SHORTER: i32 = 8;

impl Eight {
    /// The rule with `S` nodes; none for more than eight.
    pub(crate) fn gauss<const S: usize>() -> Option<&'static Self> {
        static RULES: [OnceLock<Eight>; 9] = [const { OnceLock::new() }; 9];
        RULES.get(S).map(|rule| rule.get_or_init(Self::compute::<S>))
    }

    fn compute<const S: usize>() -> Self {
        let (nodes, weights) = gauss_legendre::<S>();
        let coefficients = gauss_collocation(&nodes, &weights);
        let row = |f: &dyn Fn(usize) -> f64| from_fn(|i| if i < S { f(i) } else { 0.0 });
        let column = |f: &dyn Fn(usize, usize) -> f64| from_fn(|j| row(&|i| if j < S { f(i, j) } else { 0.0 }));
        let highest = |j: usize| {
            let (p, _) = shifted_legendre::<S>(nodes[j]);
            (2.0 * S as f64 - 1.0) * weights[j] * p[S - 1]
        };
        let columns = column(&|i, j| coefficients[i][j]);
        Self {
            nodes: row(&|i| nodes[i]),
            weights: row(&|i| weights[i]),
            square: Square::of_columns(&columns),
            columns,
            highest: row(&highest),
            continued: from_fn(|k| {
                let ratio = quarter_octaves(k as i32 - SHORTER);
                Square::of_columns(&column(&|i, j| lagrange(&nodes, j, 1.0 + ratio * nodes[i])))
            }),
        }
    }

    /// What continues the polynomial of a step to the nodes of one that is `2^(quarters/4)` times as long.
    pub(crate) fn continued(&self, quarters: i32) -> Option<&Square> {
        self.continued.get(usize::try_from(quarters + SHORTER).ok()?)
    }
}

/// `2^(quarters/4)`.
pub(crate) fn quarter_octaves(quarters: i32) -> f64 {
    (0.25 * f64::from(quarters)).exp2()
}
