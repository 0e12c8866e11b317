use crate::error::{not_negative, positive};
use crate::{Labels, Model, ModelError, ModelState};
use lagrangian::{Scalar, energy};

/// The nonholonomic particle: a point in space with `z' = y x'`, free or in a well `U = k/2 (x^2 + y^2)`.
///
/// `q = (x, y, z)`; `y` and the constraint take the unit of length as given (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    mass: f64,
    stiffness: f64,
}

impl Particle {
    /// A particle of mass `m` (kg) without forces.
    ///
    /// # Errors
    /// [`ModelError`] where the mass is not positive.
    pub fn flat(mass: f64) -> Result<Self, ModelError> {
        Self::in_well(mass, 0.0)
    }

    /// A particle of mass `m` (kg) in the well `U = k/2 (x^2 + y^2)` of stiffness `k` (N/m).
    ///
    /// # Errors
    /// [`ModelError`] where the mass is not positive, or the stiffness negative.
    pub fn in_well(mass: f64, stiffness: f64) -> Result<Self, ModelError> {
        Ok(Self { mass: positive("mass", mass)?, stiffness: not_negative("stiffness", stiffness)? })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Stiffness `k` of the well (N/m).
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// The energy along `y` alone, `m/2 y'^2 + k/2 y^2` (J).
    pub fn energy_in_y<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> S {
        v[1] * v[1] * (0.5 * self.mass) + q[1] * q[1] * (0.5 * self.stiffness)
    }

    /// The energy along `x` and `z`, `m/2 (1 + y^2) x'^2 + k/2 x^2` (J).
    ///
    /// Without a well `x' sqrt(1 + y^2)` is constant.
    pub fn energy_in_x<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> S {
        (q[1] * q[1] + 1.0) * v[0] * v[0] * (0.5 * self.mass) + q[0] * q[0] * (0.5 * self.stiffness)
    }
}

macros::system! { lagrangian;
    impl Particle;
    coordinates = { x = "m", y = "m", z = "m" }
    parameters = { m = self.mass, k = self.stiffness }
    lagrangian = "m/2*(x'^2 + y'^2 + z'^2) - k/2*(x^2 + y^2)"
    constraints = ["z' - y*x'"]
    basis = [["1", "0", "y"], ["0", "1", "0"]]
}

impl Model<3, 1> for Particle {
    fn name(&self) -> &'static str {
        if self.stiffness > 0.0 { "nonholonomic particle in a well" } else { "nonholonomic particle" }
    }

    fn source(&self) -> &'static str {
        "Rosenberg 1977, Analytical Dynamics of Discrete Systems"
    }

    /// `y` is an oscillator by itself; with `A` the amplitude of the energy along `x`, `x = A sin(s)` with
    /// `s' = sqrt(k / (m (1 + y^2)))`: a quadrature.
    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: true, invariant_measure: true }
    }

    fn start(&self) -> ModelState<3> {
        ([0.1, 0.2, 0.3], [0.9, 0.7, 0.2 * 0.9])
    }

    /// `(1 + y^2) x'' + y y' x' = -k/m x`, `y'' = -k/m y`, `z'' = y' x' + y x''`.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let rate = self.stiffness / self.mass;
        let x2 = -(rate * q[0] + q[1] * v[1] * v[0]) / (1.0 + q[1] * q[1]);
        [x2, -rate * q[1], v[1] * v[0] + q[1] * x2]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        vec![
            ("energy", energy(self, S::zero(), q, v)),
            ("energy along x and z", self.energy_in_x(q, v)),
            ("energy along y", self.energy_in_y(q, v)),
        ]
    }

    fn density<S: Scalar>(&self, q: &[S; 3]) -> Option<S> {
        Some((q[1] * q[1] + 1.0).sqrt())
    }

    /// Without a well: with `c = x' sqrt(1 + y^2)` and `w = y'` constant,
    /// `x = x0 + c/w (asinh y - asinh y0)`, `z = z0 + c/w (sqrt(1 + y^2) - sqrt(1 + y0^2))`.
    fn exact_from(&self, (q, v): &ModelState<3>, t: f64) -> Option<ModelState<3>> {
        if self.stiffness > 0.0 {
            return None;
        }
        let (y0, w) = (q[1], v[1]);
        let y = y0 + w * t;
        let (s0, s) = (1f64.hypot(y0), 1f64.hypot(y));
        let c = v[0] * s0;
        // s - s0 = (y - y0) slope, and asinh y - asinh y0 = asinh(y s0 - y0 s) = asinh(w stretch).
        let slope = (y + y0) / (s + s0);
        let stretch = t * (s0 - y0 * slope);
        let time = if w == 0.0 { stretch } else { (w * stretch).asinh() / w };
        let x1 = c / s;
        Some(([q[0] + c * time, y, q[2] + c * t * slope], [x1, w, y * x1]))
    }
}
