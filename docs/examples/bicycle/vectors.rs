//! Vectors and rotations of space, on any scalar.

use noslip::Scalar;

pub(crate) type V3<S> = [S; 3];
/// By rows.
pub(crate) type M3<S> = [[S; 3]; 3];

pub(crate) fn constant<S: Scalar>(a: [f64; 3]) -> V3<S> {
    a.map(S::constant)
}

pub(crate) fn add<S: Scalar>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub<S: Scalar>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale<S: Scalar>(a: V3<S>, k: S) -> V3<S> {
    a.map(|a| a * k)
}

pub(crate) fn dot<S: Scalar>(a: V3<S>, b: V3<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross<S: Scalar>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn mul<S: Scalar>(m: M3<S>, a: V3<S>) -> V3<S> {
    m.map(|row| dot(row, a))
}

pub(crate) fn transpose<S: Scalar>(m: M3<S>) -> M3<S> {
    [[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]]
}

pub(crate) fn product<S: Scalar>(a: M3<S>, b: M3<S>) -> M3<S> {
    transpose(transpose(b).map(|column| mul(a, column)))
}

pub(crate) fn about_x<S: Scalar>(angle: S) -> M3<S> {
    let ((s, c), z, one) = (angle.sin_cos(), S::zero(), S::constant(1.0));
    [[one, z, z], [z, c, -s], [z, s, c]]
}

pub(crate) fn about_y<S: Scalar>(angle: S) -> M3<S> {
    let ((s, c), z, one) = (angle.sin_cos(), S::zero(), S::constant(1.0));
    [[c, z, s], [z, one, z], [-s, z, c]]
}

pub(crate) fn about_z<S: Scalar>(angle: S) -> M3<S> {
    let ((s, c), z, one) = (angle.sin_cos(), S::zero(), S::constant(1.0));
    [[c, -s, z], [s, c, z], [z, z, one]]
}
