use lagrangian::from_fn;
use lagrangian::quadrature::{gauss_collocation, gauss_legendre, lagrange};
use lagrangian::simd::{Pack, Simd};

/// The coefficients of Gauss collocation with an even number `S` of stages, for a step of length `h`, in the form that needs
/// the fewest operations.
///
/// Nodes lie symmetrically, so that `A = 1 b'/2 + B` where `B` changes its sign when rows and columns are reversed: it takes
/// the even part `e_k = f_k + f_(S-1-k)` of the slopes to the odd part of their sums, and the odd part to the even one. Two
/// matrices of `S/2` rows are left of one of `S`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaneCollocation<const S: usize> {
    pub(crate) nodes: [f64; S],
    /// `h b/2`, and `h/2 (B_ik -+ B_i(S-1-k))`; the first `S/2` places count.
    half_weights: [f64; S],
    of_even: [[f64; S]; S],
    of_odd: [[f64; S]; S],
    /// The collocation polynomial of the slopes, at the nodes of the next step.
    next: [[f64; S]; S],
}

impl<const S: usize> LaneCollocation<S> {
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
    pub(crate) fn integrate<Si: Simd, const R: usize>(
        &self,
        start: Pack<Si, R>,
        slopes: &[Pack<Si, R>; S],
        stages: &mut [Pack<Si, R>; S],
    ) {
        let simd = start.simd();
        let (even, odd) = Self::parts(slopes);
        let mut whole = start;
        for k in 0..S / 2 {
            whole = even[k].mul_add(Pack::splat(simd, self.half_weights[k]), whole);
        }
        for i in 0..S / 2 {
            let (mut along, mut across) = (whole, even[0] * Pack::splat(simd, self.of_even[i][0]));
            for k in 0..S / 2 {
                along = odd[k].mul_add(Pack::splat(simd, self.of_odd[i][k]), along);
                if k > 0 {
                    across = even[k].mul_add(Pack::splat(simd, self.of_even[i][k]), across);
                }
            }
            stages[i] = along + across;
            stages[S - 1 - i] = along - across;
        }
    }

    /// `h b . slopes`, in every lane.
    #[inline(always)]
    pub(crate) fn increment<Si: Simd, const R: usize>(&self, slopes: &[Pack<Si, R>; S]) -> Pack<Si, R> {
        let simd = slopes[0].simd();
        let (even, _) = Self::parts(slopes);
        let mut half = even[0] * Pack::splat(simd, self.half_weights[0]);
        for k in 1..S / 2 {
            half = even[k].mul_add(Pack::splat(simd, self.half_weights[k]), half);
        }
        half + half
    }

    /// The slopes of the next step, by the polynomial of these.
    #[inline(always)]
    pub(crate) fn extrapolate<Si: Simd, const R: usize>(&self, slopes: &mut [Pack<Si, R>; S]) {
        let before = *slopes;
        let simd = before[0].simd();
        for i in 0..S {
            let mut sum = before[0] * Pack::splat(simd, self.next[i][0]);
            for j in 1..S {
                sum = before[j].mul_add(Pack::splat(simd, self.next[i][j]), sum);
            }
            slopes[i] = sum;
        }
    }

    #[inline(always)]
    fn parts<Si: Simd, const R: usize>(slopes: &[Pack<Si, R>; S]) -> ([Pack<Si, R>; S], [Pack<Si, R>; S]) {
        let (mut even, mut odd) = (*slopes, *slopes);
        for k in 0..S / 2 {
            even[k] = slopes[k] + slopes[S - 1 - k];
            odd[k] = slopes[k] - slopes[S - 1 - k];
        }
        (even, odd)
    }
}
