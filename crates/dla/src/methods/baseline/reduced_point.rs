use differential_equations::traits::State;

/// A point of the reduced equations: the increment since the start of an interval, and the quasi-velocities.
///
/// Only the first `N - M` quasi-velocities count, so that there are `2 N - M` components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ReducedPoint<const N: usize, const M: usize> {
    pub(super) d: [f64; N],
    pub(super) xi: [f64; N],
}

impl<const N: usize, const M: usize> ReducedPoint<N, M> {
    /// Calls `f` for every component, with the matching component of `other`.
    #[inline(always)]
    fn each(&mut self, other: &Self, mut f: impl FnMut(&mut f64, f64)) {
        for i in 0..N {
            f(&mut self.d[i], other.d[i]);
        }
        for i in 0..N - M {
            f(&mut self.xi[i], other.xi[i]);
        }
    }
}

impl<const N: usize, const M: usize> State<f64> for ReducedPoint<N, M> {
    #[inline(always)]
    fn len(&self) -> usize {
        2 * N - M
    }

    #[inline(always)]
    fn get_component(&self, index: usize) -> f64 {
        if index < N { self.d[index] } else { self.xi[index - N] }
    }

    #[inline(always)]
    fn set_component(&mut self, index: usize, value: f64) {
        if index < N {
            self.d[index] = value;
        } else {
            self.xi[index - N] = value;
        }
    }

    #[inline(always)]
    fn map_components_mut<F: FnMut(usize, &mut f64)>(&mut self, mut f: F) {
        for (i, x) in self.d.iter_mut().chain(&mut self.xi[..N - M]).enumerate() {
            f(i, x);
        }
    }

    #[inline(always)]
    fn zeros_like(&self) -> Self {
        Self::zeros()
    }

    #[inline(always)]
    fn zeros() -> Self {
        Self { d: [0.0; N], xi: [0.0; N] }
    }

    #[inline(always)]
    fn mul_add_assign(&mut self, alpha: f64, other: &Self) {
        self.each(other, |x, y| *x += alpha * y);
    }

    #[inline(always)]
    fn add_scaled(&mut self, alpha: f64, other: &Self) -> &mut Self {
        self.each(other, |x, y| *x += alpha * y);
        self
    }

    #[inline(always)]
    fn scale_mut(&mut self, alpha: f64) {
        self.each(&Self::zeros(), |x, _| *x *= alpha);
    }
}
