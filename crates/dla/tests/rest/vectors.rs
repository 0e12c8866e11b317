//! Vectors and rotations of space on any scalar; a matrix is an array of rows.

use lagrangian::Scalar;

pub type V3<S> = [S; 3];
pub type M3<S> = [[S; 3]; 3];

pub fn fixed<S: Scalar>(a: [f64; 3]) -> V3<S> {
    a.map(S::constant)
}
pub fn add<S: Scalar>(a: V3<S>, b: V3<S>) -> V3<S> {
    lagrangian::from_fn(|i| a[i] + b[i])
}
pub fn sub<S: Scalar>(a: V3<S>, b: V3<S>) -> V3<S> {
    lagrangian::from_fn(|i| a[i] - b[i])
}
pub fn dot<S: Scalar>(a: V3<S>, b: V3<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
pub fn cross<S: Scalar>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
pub fn turned<S: Scalar>(m: M3<S>, a: V3<S>) -> V3<S> {
    m.map(|row| dot(row, a))
}
pub fn transposed<S: Scalar>(m: M3<S>) -> M3<S> {
    lagrangian::from_fn(|i| lagrangian::from_fn(|j| m[j][i]))
}
pub fn product<S: Scalar>(a: M3<S>, b: M3<S>) -> M3<S> {
    let columns = transposed(b);
    transposed(columns.map(|column| turned(a, column)))
}
/// `w . I w` of a wheel: across its axle, along the axle.
pub fn wheel<S: Scalar>(axle: V3<S>, w: V3<S>, across: f64, along: f64) -> S {
    let spin = dot(w, axle);
    (dot(w, w) - spin * spin) * across + spin * spin * along
}
/// The rotation about an axis of coordinates: 0, 1, 2.
pub fn about<S: Scalar>(axis: usize, angle: S) -> M3<S> {
    let ((sin, cos), zero, one) = (angle.sin_cos(), S::zero(), S::constant(1.0));
    match axis {
        0 => [[one, zero, zero], [zero, cos, -sin], [zero, sin, cos]],
        1 => [[cos, zero, sin], [zero, one, zero], [-sin, zero, cos]],
        _ => [[cos, -sin, zero], [sin, cos, zero], [zero, zero, one]],
    }
}
