use crate::error::not_negative;
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::{Scalar, energy};

/// The contact oscillator, `L = |q'|^2/2 - |q|^2/2 - eps/2 x^2 z^2` with `x' + y z' = 0`.
///
/// `q = (x, y, z)`, without units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactOscillator {
    eps: f64,
}

impl ContactOscillator {
    /// The oscillator with the strength `eps` of its quartic term.
    ///
    /// # Errors
    /// [`ModelError`] where it is negative or not finite.
    pub fn new(eps: f64) -> Result<Self, ModelError> {
        Ok(Self { eps: not_negative("eps", eps)? })
    }

    /// The strength `eps` of the quartic term.
    #[must_use]
    pub fn eps(&self) -> f64 {
        self.eps
    }

    /// The energy along `y` alone, `(y'^2 + y^2)/2`: `y` oscillates by itself.
    pub fn energy_in_y<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> S {
        (v[1] * v[1] + q[1] * q[1]) * 0.5
    }

    /// A start of the energy 3/2, of which 1/2 is along `y = sin(t)`, at `z = z0` and `z' = 0`.
    ///
    /// # Errors
    /// [`ModelError`] where `z0^2 > 2`, which is more than the energy allows.
    pub fn start_at(&self, z0: f64) -> Result<ModelState<3>, ModelError> {
        let left = not_negative("2 - z0^2", 2.0 - z0 * z0)?;
        let x = (left / (1.0 + self.eps * z0 * z0)).sqrt();
        Ok(([x, 0.0, z0], [0.0, 1.0, 0.0]))
    }
}

macros::system! { lagrangian;
    impl ContactOscillator;
    coordinates = { x = "m", y = "m", z = "m" }
    parameters = { eps = self.eps }
    lagrangian = "(x'^2 + y'^2 + z'^2 - x^2 - y^2 - z^2 - eps*x^2*z^2)/2"
    constraints = ["x' + y*z'"]
    basis = [["0", "1", "0"], ["-y", "0", "1"]]
}

impl Model<3, 1> for ContactOscillator {
    fn name(&self) -> &'static str {
        "contact oscillator"
    }

    fn source(&self) -> &'static str {
        "McLachlan and Perlmutter 2006, Integrators for nonholonomic mechanical systems, J. Nonlinear Sci. 16, \
         283-328, section 5.2"
    }

    /// Without the quartic term `(x, z, z')` is linear in itself, driven by `y`, and keeps a quadratic form: it turns.
    /// (Modin and Verdier 2014, Integrability of nonholonomically coupled oscillators.)
    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: self.eps == 0.0, invariant_measure: true }
    }

    /// [`ContactOscillator::start_at`] with `z0 = 0.3 sqrt(2)`.
    fn start(&self) -> ModelState<3> {
        let z0 = 0.3 * std::f64::consts::SQRT_2;
        let x = ((2.0 - z0 * z0) / (1.0 + self.eps * z0 * z0)).sqrt();
        ([x, 0.0, z0], [0.0, 1.0, 0.0])
    }

    /// `y'' = -y`; with `f` the force and `w = z'`, `(1 + y^2) w' = f_z - y f_x - y y' w`, and `x'' = -y' w - y w'`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let [x, y, z] = *q;
        let (along_x, along_z) = (-x - self.eps * x * z * z, -z - self.eps * x * x * z);
        let z2 = (along_z - y * along_x - y * v[1] * v[2]) / (1.0 + y * y);
        [-v[1] * v[2] - y * z2, -y, z2]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        vec![("energy", energy(self, S::zero(), q, v)), ("energy along y", self.energy_in_y(q, v))]
    }

    fn density<S: Scalar>(&self, q: &[S; 3]) -> Option<S> {
        Some((q[1] * q[1] + 1.0).sqrt())
    }
}
