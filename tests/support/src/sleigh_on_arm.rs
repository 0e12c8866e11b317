use crate::{Model, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// A sleigh on a pendulum arm: a massless arm, free to turn about the origin, holds a hitch on the sleigh, ahead of its blade.
/// A constraint on positions beside one on velocities; on a slope that falls along `x`.
///
/// `q = (x, y, theta)`: the blade's contact point (m) and the heading (rad). The path is the curve of the hatchet planimeter whose
/// tracer runs on a circle: with `psi` the heading relative to the arm's angle `phi`, `dpsi/dphi = (l/d) cos(psi) - 1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SleighOnArm {
    mass: f64,
    inertia: f64,
    offset: f64,
    hitch: f64,
    arm: f64,
    pull: f64,
}

impl SleighOnArm {
    /// A sleigh of mass `m` (kg) and moment of inertia `I` about its centre of mass (kg m^2).
    ///
    /// The centre of mass is `offset` (m) ahead of the blade, of either sign, the hitch `hitch` (m), and the arm `arm` (m)
    /// longer than that; gravity's part down the slope is `pull` (m/s^2), of either sign.
    pub fn new(mass: f64, inertia: f64, offset: f64, hitch: f64, arm: f64, pull: f64) -> Self {
        Self { mass, inertia, offset, hitch, arm, pull }
    }

    /// The hitch (m), along the blade and across it as seen from the origin, and in space.
    #[inline(always)]
    fn hitched<S: Scalar>(&self, q: &[S; 3]) -> ([S; 2], [S; 2]) {
        let (sin, cos) = q[2].sin_cos();
        let at = [q[0] + cos * self.hitch, q[1] + sin * self.hitch];
        ([at[0] * cos + at[1] * sin, at[1] * cos - at[0] * sin], at)
    }

    /// Moment of inertia about the blade (kg m^2).
    fn about_blade(&self) -> f64 {
        self.inertia + self.mass * self.offset * self.offset
    }
}

impl System<3, 2> for SleighOnArm {
    /// `L = m/2 (x'^2 + y'^2) + m a theta' (n . P') + J/2 theta'^2 + m g (x + a cos(theta))`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass)
            + v[2] * (cos * v[1] - sin * v[0]) * (self.mass * self.offset)
            + v[2] * v[2] * (0.5 * self.about_blade())
            + (q[0] + cos * self.offset) * (self.mass * self.pull)
    }

    /// The blade, `n . P' = 0`, and the arm, `H . H' / l = 0`, with `H = P + d e`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let (sin, cos) = q[2].sin_cos();
        let ([_, across], at) = self.hitched(q);
        let l = self.arm;
        let arm = [at[0] / l, at[1] / l, across * (self.hitch / l)];
        ([[-sin, cos, S::zero()], arm], [S::zero(); 2])
    }

    /// The arm, `(|H|^2 - l^2)/(2 l) = 0`.
    #[inline(always)]
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<[Option<S>; 2]> {
        let (_, at) = self.hitched(q);
        Some([None, Some((at[0] * at[0] + at[1] * at[1] - self.arm * self.arm) / (2.0 * self.arm))])
    }

    /// `(d sin(psi) e, cos(psi))`, the motion that takes the hitch around the origin at the speed `d`.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 2>> {
        let (sin, cos) = q[2].sin_cos();
        let ([along, across], _) = self.hitched(q);
        let drive = -across * (self.hitch / self.arm);
        Some(AdmissibleBasis::new([[drive * cos, drive * sin, along / self.arm]]))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

impl Model<3, 2> for SleighOnArm {
    fn name(&self) -> &'static str {
        "sleigh on a pendulum arm"
    }

    /// The blade inside of the arm's circle, at 1 rad/s of the hitch about it.
    fn start(&self) -> ModelState<3> {
        self.admissible([0.3, 0.0, 1.1], [self.arm / self.hitch, 0.0, 0.0])
    }

    /// At the angle `q[0]` of the arm and the heading `q[2]`.
    fn admissible(&self, [angle, _, heading]: [f64; 3], xi: [f64; 3]) -> ModelState<3> {
        let ((sin, cos), (s, c)) = (angle.sin_cos(), heading.sin_cos());
        let q = [self.arm * cos - self.hitch * c, self.arm * sin - self.hitch * s, heading];
        let drive = self.hitch * (heading - angle).sin() * xi[0];
        (q, [drive * c, drive * s, (heading - angle).cos() * xi[0]])
    }
}
