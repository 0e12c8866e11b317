use crate::Scalar;

/// A basis `w_1 .. w_(N-M)` of the admissible velocities `ker A(q, t)` at one point.
///
/// The array has `N` places, since `N - M` cannot yet be written as its length; only the first `N - M` are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdmissibleBasis<S, const N: usize, const M: usize> {
    vectors: [[S; N]; N],
}

impl<S: Scalar, const N: usize, const M: usize> AdmissibleBasis<S, N, M> {
    /// How many vectors there are: the dimension of the distribution.
    pub const DIMENSION: usize = {
        assert!(M <= N, "more constraints than coordinates");
        N - M
    };

    /// The basis of the given vectors. `K` must be `N - M`, which is checked when the program is compiled.
    #[must_use]
    #[inline(always)]
    pub fn new<const K: usize>(vectors: [[S; N]; K]) -> Self {
        const {
            assert!(K == Self::DIMENSION, "a basis of the admissible velocities has N - M vectors");
        }
        let mut all = [[S::zero(); N]; N];
        all[..K].copy_from_slice(&vectors);
        Self { vectors: all }
    }

    /// The basis with the vectors `vector(0) .. vector(N - M - 1)`, where their number is not known as a constant.
    #[must_use]
    #[inline(always)]
    pub fn from_fn(vector: impl Fn(usize) -> [S; N]) -> Self {
        let mut basis = Self::empty();
        for (k, w) in basis.vectors_mut().iter_mut().enumerate() {
            *w = vector(k);
        }
        basis
    }

    /// The `N - M` basis vectors.
    #[must_use]
    #[inline(always)]
    pub fn vectors(&self) -> &[[S; N]] {
        &self.vectors[..Self::DIMENSION]
    }

    /// The basis of `N - M` zero vectors, to be filled.
    #[inline(always)]
    pub(crate) fn empty() -> Self {
        Self { vectors: [[S::zero(); N]; N] }
    }

    /// The `N - M` basis vectors, to be changed.
    #[inline(always)]
    pub(crate) fn vectors_mut(&mut self) -> &mut [[S; N]] {
        &mut self.vectors[..Self::DIMENSION]
    }

    /// The products of the basis vectors with `p`; zero in the last `M` places.
    #[must_use]
    #[inline(always)]
    pub fn products(&self, p: &[S; N]) -> [S; N] {
        let mut products = [S::zero(); N];
        for (product, w) in products.iter_mut().zip(self.vectors()) {
            *product = (1..N).fold(w[0] * p[0], |sum, i| sum + w[i] * p[i]);
        }
        products
    }

    /// The velocity `xi_1 w_1 + .. + xi_(N-M) w_(N-M)`; the last `M` places of `xi` are not read.
    #[must_use]
    #[inline(always)]
    pub fn combine(&self, xi: &[S; N]) -> [S; N] {
        let mut v = [S::zero(); N];
        for (k, w) in self.vectors().iter().enumerate() {
            for i in 0..N {
                v[i] += xi[k] * w[i];
            }
        }
        v
    }
}
