use lagrangian::{AdmissibleBasis, Constraint, Member, Parametrised, Scalar};

/// The Chaplygin sleigh of mass `m` (kg), inertia `I` about the centre of mass (kg m^2) and offset `a` (m), in an egg-crate
/// potential of height `V` (J), with a thrust `F` along the blade (N) and a torque (N m) as controls, which swing with time.
#[derive(Debug, Clone, Copy)]
pub struct Controlled;

pub type ControlledSleigh = Member<Controlled, 6>;

impl Controlled {
    pub const PARAMETERS: [f64; 6] = [1.3, 0.8, 0.4, 0.7, 0.5, -0.3];

    pub fn at(parameters: &[f64; 6]) -> ControlledSleigh {
        Member { family: Self, parameters: *parameters }
    }
}

impl Parametrised<3, 1, 6> for Controlled {
    fn lagrangian<S: Scalar>(&self, &[m, i, a, height, ..]: &[S; 6], _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        let (vx, vy) = (v[0] - a * sin * v[2], v[1] + a * cos * v[2]);
        let (x, y) = (q[0] + a * cos, q[1] + a * sin);
        (m * (vx * vx + vy * vy) + i * v[2] * v[2]) * 0.5 - height * (x.cos() + y.cos())
    }
    fn constraint<S: Scalar>(&self, _p: &[S; 6], _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = q[2].sin_cos();
        ([[-sin, cos, S::zero()]], [S::zero()])
    }
    fn force<S: Scalar>(&self, p: &[S; 6], t: S, q: &[S; 3], _v: &[S; 3]) -> Option<[S; 3]> {
        let (sin, cos) = q[2].sin_cos();
        let thrust = p[4] * ((t * 2.0).sin() * 0.5 + 1.0);
        Some([thrust * cos, thrust * sin, p[5] * (t * 1.5).cos()])
    }
    fn admissible_basis<S: Scalar>(&self, _p: &[S; 6], _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (sin, cos) = q[2].sin_cos();
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[cos, sin, zero], [zero, zero, one]]))
    }
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

/// The Chaplygin sleigh with a blade that turns in its body at the rate `p` (rad/s) and is carried across itself at `s cos t`
/// (m/s): constraint, basis and what is imposed on the velocity depend on the time and on the parameters `(p, s)`.
#[derive(Debug, Clone, Copy)]
pub struct Swivelling;

impl Swivelling {
    pub const PARAMETERS: [f64; 2] = [0.9, 0.4];

    pub fn at(parameters: &[f64; 2]) -> Member<Self, 2> {
        Member { family: Self, parameters: *parameters }
    }

    /// Sine and cosine of the blade's direction in space.
    fn blade<S: Scalar>(&[rate, _]: &[S; 2], t: S, q: &[S; 3]) -> (S, S) {
        (q[2] + rate * t).sin_cos()
    }
}

impl Parametrised<3, 1, 2> for Swivelling {
    fn lagrangian<S: Scalar>(&self, _p: &[S; 2], _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let (sin, cos) = q[2].sin_cos();
        let (vx, vy) = (v[0] - sin * v[2] * 0.4, v[1] + cos * v[2] * 0.4);
        (vx * vx + vy * vy) * 0.65 + v[2] * v[2] * 0.4 - q[0].cos() * 0.7
    }
    fn constraint<S: Scalar>(&self, p: &[S; 2], t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (sin, cos) = Self::blade(p, t, q);
        ([[-sin, cos, S::zero()]], [-(p[1] * t.cos())])
    }
    fn admissible_basis<S: Scalar>(&self, p: &[S; 2], t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (sin, cos) = Self::blade(p, t, q);
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[cos, sin, zero], [zero, zero, one]]))
    }
    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}
