use crate::{Dual, Scalar, from_fn, mapped};

/// A vector field on the configurations, one function generic in its scalar: an infinitesimal motion `q' = X(q)`.
pub trait VectorField<const N: usize> {
    /// `X(q)`.
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N];
}

impl<X: VectorField<N>, const N: usize> VectorField<N> for &X {
    #[inline(always)]
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        X::at(self, q)
    }
}

/// The Lie bracket `[X, Y] = (dY/dq) X - (dX/dq) Y`.
///
/// The derivatives are dual numbers over whatever carries `q`, so that a bracket is a field again, and may stand in another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LieBracket<X, Y>(pub X, pub Y);

impl<X: VectorField<N>, Y: VectorField<N>, const N: usize> VectorField<N> for LieBracket<X, Y> {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        let (x, y) = (self.0.at(q), self.1.at(q));
        let (of_y, of_x) = (rate_along(&self.1, q, &x), rate_along(&self.0, q, &y));
        from_fn(|i| of_y[i] - of_x[i])
    }
}

/// How a field changes along a velocity: `(dX/dq) v`.
pub(crate) fn rate_along<X: VectorField<N>, S: Scalar, const N: usize>(field: &X, q: &[S; N], v: &[S; N]) -> [S; N] {
    let along: [Dual<S, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [v[i]] });
    mapped(&field.at(&along), |x| x.eps[0])
}
