//! Balls with `q = (x, y, e_0, e_1, e_2, e_3)`.

use crate::Attitude;
use lagrangian::Scalar;

/// What of coordinates, or of velocities, is the quaternion.
#[inline(always)]
pub(crate) fn attitude_part<S: Scalar>(q: &[S; 6]) -> [S; 4] {
    [q[2], q[3], q[4], q[5]]
}

/// The attitude at given coordinates.
#[inline(always)]
pub(crate) fn attitude<S: Scalar>(q: &[S; 6]) -> Attitude<S> {
    Attitude::new(attitude_part(q))
}
