use crate::Sleigh;
use lagrangian::Scalar;

/// A body that is a sleigh, perhaps with more coordinates or constraints: its first three coordinates are `(x, y, theta)`.
pub trait SleighBody {
    /// Whether it is the sleigh and nothing more.
    const ALONE: bool = false;

    /// The sleigh.
    fn sleigh(&self) -> &Sleigh;

    /// The centre of mass `C = P + a e` (m).
    #[inline(always)]
    fn centre<S: Scalar, const N: usize>(&self, q: &[S; N]) -> [S; 2] {
        let (sin, cos) = q[2].sin_cos();
        let a = self.sleigh().offset();
        [q[0] + cos * a, q[1] + sin * a]
    }

    /// The generalised force of a force at the centre of mass (N).
    #[inline(always)]
    fn at_centre<S: Scalar, const N: usize>(&self, q: &[S; N], [fx, fy]: [S; 2]) -> [S; N] {
        let (sin, cos) = q[2].sin_cos();
        let torque = (cos * fy - sin * fx) * self.sleigh().offset();
        let mut force = [S::zero(); N];
        force[..3].copy_from_slice(&[fx, fy, torque]);
        force
    }
}

impl SleighBody for Sleigh {
    const ALONE: bool = true;

    #[inline(always)]
    fn sleigh(&self) -> &Sleigh {
        self
    }
}
