use super::state::{Row, lanes};
use lagrangian::quadrature::{gauss_collocation, gauss_legendre, lagrange};
use std::array::from_fn;

/// The coefficients of Gauss collocation with an even number `S` of stages, for a step of length `h`, in the form that needs
/// the fewest operations.
///
/// Nodes lie symmetrically, so that `A = 1 b'/2 + B` where `B` changes its sign when rows and columns are reversed: it takes
/// the even part `e_k = f_k + f_(S-1-k)` of the slopes to the odd part of their sums, and the odd part to the even one. Two
/// matrices of `S/2` rows are left of one of `S`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Collocation<const S: usize> {
    pub(crate) nodes: [f64; S],
    /// `h b/2`, and `h/2 (B_ik -+ B_i(S-1-k))`; the first `S/2` places count.
    half_weights: [f64; S],
    of_even: [[f64; S]; S],
    of_odd: [[f64; S]; S],
    /// The collocation polynomial of the slopes, at the nodes of the next step.
    next: [[f64; S]; S],
}

impl<const S: usize> Collocation<S> {
    pub(crate) fn new(h: f64) -> Self {
        const { assert!(S.is_multiple_of(2), "stages go in pairs") };
        let (nodes, weights) = gauss_legendre::<S>();
        let a = gauss_collocation(&nodes, &weights);
        let odd = |i: usize, k: usize| a[i][k] - 0.5 * weights[k];
        let part = |sign: f64| from_fn(|i| from_fn(|k| 0.5 * h * (odd(i, k) + sign * odd(i, S - 1 - k))));
        Self {
            nodes,
            half_weights: weights.map(|b| 0.5 * h * b),
            of_even: part(1.0),
            of_odd: part(-1.0),
            next: from_fn(|i| from_fn(|j| lagrange(&nodes, j, 1.0 + nodes[i]))),
        }
    }

    /// `start + h A slopes`, in every lane.
    #[inline(always)]
    pub(crate) fn integrate<const W: usize>(&self, start: &Row<W>, slopes: &[Row<W>; S], stages: &mut [Row<W>; S]) {
        for lane in 0..lanes::<W>() {
            let (even, odd) = Self::parts(lane, slopes);
            let mut whole = 0.0;
            for k in 0..S / 2 {
                whole += self.half_weights[k] * even[k];
            }
            for i in 0..S / 2 {
                let (mut along, mut across) = (whole, 0.0);
                for k in 0..S / 2 {
                    along += self.of_odd[i][k] * odd[k];
                    across += self.of_even[i][k] * even[k];
                }
                stages[i].0[lane] = start.0[lane] + (along + across);
                stages[S - 1 - i].0[lane] = start.0[lane] + (along - across);
            }
        }
    }

    /// `h b . slopes`, in every lane.
    #[inline(always)]
    pub(crate) fn increment<const W: usize>(&self, slopes: &[Row<W>; S]) -> Row<W> {
        let mut sum = Row::ZERO;
        for lane in 0..lanes::<W>() {
            let (even, _) = Self::parts(lane, slopes);
            let mut half = 0.0;
            for k in 0..S / 2 {
                half += self.half_weights[k] * even[k];
            }
            sum.0[lane] = 2.0 * half;
        }
        sum
    }

    /// The slopes as their polynomial goes on over the next step.
    #[inline(always)]
    pub(crate) fn extrapolate<const W: usize>(&self, slopes: &mut [Row<W>; S]) {
        let before = *slopes;
        for i in 0..S {
            for lane in 0..lanes::<W>() {
                let mut sum = 0.0;
                for j in 0..S {
                    sum += self.next[i][j] * before[j].0[lane];
                }
                slopes[i].0[lane] = sum;
            }
        }
    }

    #[inline(always)]
    fn parts<const W: usize>(lane: usize, slopes: &[Row<W>; S]) -> ([f64; S], [f64; S]) {
        let f = |k: usize| slopes[k].0[lane];
        (from_fn(|k| f(k) + f(S - 1 - k)), from_fn(|k| f(k) - f(S - 1 - k)))
    }
}
