use crate::error::not_negative;
use crate::{Labels, Model, ModelError, State};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, from_fn};

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
    pub fn start_at(&self, angle: f64) -> State<7> {
        let (sin, cos) = angle.sin_cos();
        ([cos, 0.6, 0.4, 0.2, 1.0, 1.0, 1.0], [0.0, sin, 0.0, 0.0, 0.0, 0.0, 0.0])
    }
}

/// `|x|^2`. Written out: a loop that stays one decides in a run which numbers carry derivatives.
#[inline(always)]
fn square_sum<S: Scalar>([x, y1, y2, y3, z1, z2, z3]: &[S; 7]) -> S {
    let (y, z) = (y1.squared() + y2.squared() + y3.squared(), z1.squared() + z2.squared() + z3.squared());
    x.squared() + (y + z)
}

impl System<7, 1> for QuarticOscillator {
    /// `L = (|q'|^2 - |q|^2 - c (sum yi^2 zi^2 + z1^2 z2^2))/2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 7], v: &[S; 7]) -> S {
        let [_, y1, y2, y3, z1, z2, z3] = *q;
        let harmonic = square_sum(v) - square_sum(q);
        let quartic = (y1 * z1).squared() + (y2 * z2).squared() + (y3 * z3).squared() + (z1 * z2).squared();
        harmonic * 0.5 - quartic * (0.5 * self.coupling)
    }

    /// `x' + sum yi zi' = 0`.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 7]) -> Constraint<S, 7, 1> {
        let zero = S::zero();
        ([[S::constant(1.0), zero, zero, zero, q[1], q[2], q[3]]], [zero])
    }

    /// Each of the `yi`, and each of the `zi` with `x' = -yi`.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 7]) -> Option<AdmissibleBasis<S, 7, 1>> {
        Some(AdmissibleBasis::new(from_fn::<_, 6, _>(|k| {
            let mut w = [S::zero(); 7];
            w[k + 1] = S::constant(1.0);
            if k >= 3 {
                w[0] = -q[k - 2];
            }
            w
        })))
    }
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
    fn start(&self) -> State<7> {
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
