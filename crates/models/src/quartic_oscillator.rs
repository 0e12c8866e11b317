use crate::error::not_negative;
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::Scalar;

/// The chaotic quartic oscillator: seven oscillators `q = (x, y1, y2, y3, z1, z2, z3)`, coupled by
/// `c/2 (sum yi^2 zi^2 + z1^2 z2^2)` and by `x' + sum yi zi' = 0`. Without units.
///
/// With `zi` for `yi` in the constraint it would be integrable, and the system holonomic: `x + |z|^2/2` constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuarticOscillator {
    coupling: f64,
}

impl QuarticOscillator {
    /// The oscillators with the strength `c` of their coupling; that of the source has `c = 1`.
    ///
    /// # Errors
    /// [`ModelError`] where it is negative or not finite.
    pub fn new(coupling: f64) -> Result<Self, ModelError> {
        Ok(Self { coupling: not_negative("coupling", coupling)? })
    }

    /// The strength `c` of the coupling.
    #[must_use]
    pub fn coupling(&self) -> f64 {
        self.coupling
    }

    /// One of a family of starts of the same energy: `x = cos(angle)`, `y1' = sin(angle)` (rad), `y = (0.6, 0.4, 0.2)`,
    /// `z = (1, 1, 1)`.
    #[must_use]
    pub fn start_at(&self, angle: f64) -> ModelState<7> {
        let (sin, cos) = angle.sin_cos();
        ([cos, 0.6, 0.4, 0.2, 1.0, 1.0, 1.0], [0.0, sin, 0.0, 0.0, 0.0, 0.0, 0.0])
    }
}

macros::system! { lagrangian;
    impl QuarticOscillator;
    coordinates = { x = "m", y1 = "m", y2 = "m", y3 = "m", z1 = "m", z2 = "m", z3 = "m" }
    parameters = { c = self.coupling }
    lagrangian = "(x'^2 + y1'^2 + y2'^2 + y3'^2 + z1'^2 + z2'^2 + z3'^2 - x^2 - y1^2 - y2^2 - y3^2 - z1^2 - z2^2 - z3^2
                   - c*(y1^2*z1^2 + y2^2*z2^2 + y3^2*z3^2 + z1^2*z2^2))/2"
    constraints = ["x' + y1*z1' + y2*z2' + y3*z3'"]
    // Each of the `yi`, and each of the `zi` with `x' = -yi`.
    basis = [
        ["0", "1", "0", "0", "0", "0", "0"],
        ["0", "0", "1", "0", "0", "0", "0"],
        ["0", "0", "0", "1", "0", "0", "0"],
        ["-y1", "0", "0", "0", "1", "0", "0"],
        ["-y2", "0", "0", "0", "0", "1", "0"],
        ["-y3", "0", "0", "0", "0", "0", "1"],
    ]
}

impl Model<7, 1> for QuarticOscillator {
    fn name(&self) -> &'static str {
        "chaotic quartic oscillator"
    }

    fn source(&self) -> &'static str {
        "McLachlan and Perlmutter 2006, Integrators for nonholonomic mechanical systems, J. Nonlinear Sci. 16, \
         283-328; Celledoni, Farre Puiggali, Hoiseth and Martin de Diego 2019, Energy-preserving integrators applied \
         to nonholonomic systems, J. Nonlinear Sci. 29"
    }

    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: false, invariant_measure: true }
    }

    /// [`QuarticOscillator::start_at`] a third of a half turn.
    fn start(&self) -> ModelState<7> {
        self.start_at(std::f64::consts::FRAC_PI_3)
    }

    /// `q'' = f + lambda (1, 0, y)` with `lambda = -(f_x + y . f_z + y' . z') / (1 + |y|^2)`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 7], v: &[f64; 7]) -> [f64; 7] {
        let c = self.coupling;
        let [x, y1, y2, y3, z1, z2, z3] = *q;
        let on_y = [-y1 * (1.0 + c * z1 * z1), -y2 * (1.0 + c * z2 * z2), -y3 * (1.0 + c * z3 * z3)];
        let on_z =
            [-z1 * (1.0 + c * (y1 * y1 + z2 * z2)), -z2 * (1.0 + c * (y2 * y2 + z1 * z1)), -z3 * (1.0 + c * y3 * y3)];
        let pull = -x + y1 * on_z[0] + y2 * on_z[1] + y3 * on_z[2];
        let turning = v[1] * v[4] + v[2] * v[5] + v[3] * v[6];
        let lambda = -(pull + turning) / (1.0 + y1 * y1 + y2 * y2 + y3 * y3);
        let [a1, a2, a3] = on_y;
        [-x + lambda, a1, a2, a3, on_z[0] + lambda * y1, on_z[1] + lambda * y2, on_z[2] + lambda * y3]
    }

    fn density<S: Scalar>(&self, q: &[S; 7]) -> Option<S> {
        Some((q[1] * q[1] + q[2] * q[2] + q[3] * q[3] + 1.0).sqrt())
    }
}
