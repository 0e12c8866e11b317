//! Systems as texts.

use crate::special::{sinc, sine_defect};
use crate::{Model, ModelState};
use lagrangian::Scalar;

macros::system! { lagrangian;
    /// The nonholonomic particle: a point in space with `z' = y x'`, free or in a well. (Rosenberg 1977, Analytical Dynamics of
    /// Discrete Systems.)
    pub struct Particle;
    coordinates = { x = "m", y = "m", z = "m" }
    parameters = { m = 1.0, k = 0.0 }
    lagrangian = "m/2*(x'^2 + y'^2 + z'^2) - k/2*(x^2 + y^2)"
    constraints = ["z' - y*x'"]
    basis = [["1", "0", "y"], ["0", "1", "0"]]
}

impl Model<3, 1> for Particle {
    fn name(&self) -> &'static str {
        if self.k > 0.0 { "nonholonomic particle in a well" } else { "nonholonomic particle" }
    }

    fn start(&self) -> ModelState<3> {
        ([0.1, 0.2, 0.3], [0.9, 0.7, 0.2 * 0.9])
    }

    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        let along = (q[1] * q[1] + 1.0) * v[0] * v[0] * (0.5 * self.m) + q[0] * q[0] * (0.5 * self.k);
        vec![("energy along x and z", along)]
    }

    /// Without a well: with `c = x' sqrt(1 + y^2)` and `w = y'` constant,
    /// `x = x0 + c/w (asinh y - asinh y0)`, `z = z0 + c/w (sqrt(1 + y^2) - sqrt(1 + y0^2))`.
    fn exact_from(&self, (q, v): &ModelState<3>, t: f64) -> Option<ModelState<3>> {
        if self.k > 0.0 {
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

macros::system! { lagrangian;
    /// A knife edge on an incline: a body whose centre of mass stands over its blade, on a slope that falls along `x`. (Neimark and
    /// Fufaev 1972, Dynamics of Nonholonomic Systems.)
    pub struct KnifeEdge;
    coordinates = { x = "m", y = "m", theta = "angle" }
    parameters = { m = 1.0, I = 1.0, g = 1.0 }
    lagrangian = "m/2*(x'^2 + y'^2) + I/2*theta'^2 + m*g*x"
    constraints = ["y'*cos(theta) - x'*sin(theta)"]
    basis = [["cos(theta)", "sin(theta)", "0"], ["0", "0", "1"]]
}

impl Model<3, 1> for KnifeEdge {
    fn name(&self) -> &'static str {
        "knife edge on an incline"
    }

    /// At rest but for a turn at 1 rad/s, the blade across the slope's contours: its path is a cycloid.
    fn start(&self) -> ModelState<3> {
        ([0.0; 3], [0.0, 0.0, 1.0])
    }

    /// The hodograph is `u theta' - g sin(theta)` (m/s^2), with `u` the speed along the blade.
    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        let (sin, cos) = q[2].sin_cos();
        vec![("turn momentum", v[2] * self.I), ("hodograph", (cos * v[0] + sin * v[1]) * v[2] - sin * self.g)]
    }

    /// With `w = theta'`, `c = (sin theta - sin theta0)/w` and `s = -(cos theta - cos theta0)/w`: `u = u0 + g c`,
    /// `x = x0 + u0 c + g c^2/2`, `y = y0 + u0 s + g/w int (sin theta - sin theta0) sin theta dt`, in a form that holds
    /// down to `w = 0`.
    fn exact_from(&self, (q, v): &ModelState<3>, t: f64) -> Option<ModelState<3>> {
        let (sin0, cos0) = q[2].sin_cos();
        let u0 = cos0 * v[0] + sin0 * v[1];
        let z = v[2] * t;
        let theta = q[2] + z;
        let (sin_mean, cos_mean) = (q[2] + 0.5 * z).sin_cos();
        let mean = sinc(0.5 * z);
        let (c, s) = (t * mean * cos_mean, t * mean * sin_mean);
        let u = u0 + self.g * c;
        let drift = t * t * (sine_defect(z) + 0.5 * mean * mean * sin_mean * cos_mean);
        let end = [q[0] + u0 * c + 0.5 * self.g * c * c, q[1] + u0 * s + self.g * drift, theta];
        let (sin, cos) = theta.sin_cos();
        Some((end, [u * cos, u * sin, v[2]]))
    }
}

macros::system! { lagrangian;
    /// A disk that stays upright and rolls without slipping, by its contact point, its spin and its heading. (Bloch 2015, Nonholonomic
    /// Mechanics and Control, section 1.4.)
    pub struct RollingDisk;
    coordinates = { x = "m", y = "m", phi = "angle", theta = "angle" }
    parameters = { m = 1.0, R = 1.0, I = 1.0, J = 1.0 }
    lagrangian = "m/2*(x'^2 + y'^2) + I/2*phi'^2 + J/2*theta'^2"
    constraints = ["x' - R*phi'*cos(theta)", "y' - R*phi'*sin(theta)"]
    basis = [["R*cos(theta)", "R*sin(theta)", "1", "0"], ["0", "0", "0", "1"]]
}

impl Model<4, 2> for RollingDisk {
    fn name(&self) -> &'static str {
        "vertical rolling disk"
    }

    /// Spin at 1 rad/s, turn at 2 rad/s.
    fn start(&self) -> ModelState<4> {
        ([0.0; 4], [self.R, 0.0, 1.0, 2.0])
    }

    fn invariants<S: Scalar>(&self, _q: &[S; 4], v: &[S; 4]) -> Vec<(&'static str, S)> {
        vec![("spin momentum", v[2] * (self.I + self.m * self.R * self.R)), ("heading momentum", v[3] * self.J)]
    }

    /// An arc of the radius `R phi' / theta'`: its chord lies along the mean heading.
    fn exact_from(&self, (q, v): &ModelState<4>, t: f64) -> Option<ModelState<4>> {
        let half = 0.5 * v[3] * t;
        let (sin, cos) = (q[3] + half).sin_cos();
        let chord = self.R * v[2] * t * sinc(half);
        let end = [q[0] + chord * cos, q[1] + chord * sin, q[2] + v[2] * t, q[3] + v[3] * t];
        let (sin, cos) = end[3].sin_cos();
        let speed = self.R * v[2];
        Some((end, [speed * cos, speed * sin, v[2], v[3]]))
    }
}

macros::system! { lagrangian;
    /// The roller racer: two bodies with an axle each, hinged to each other. (Krishnaprasad and Tsakiris 2001, Dynamical Systems 16,
    /// 347-397.)
    pub struct RollerRacer;
    coordinates = { x = "m", y = "m", theta = "angle", phi = "angle" }
    parameters = { m = 1.0, I1 = 0.4, I2 = 0.1, d1 = 0.5, d2 = 0.3 }
    lagrangian = "m/2*(x'^2 + y'^2) + I1/2*theta'^2 + I2/2*(theta' + phi')^2"
    constraints = [
        "y'*cos(theta) - x'*sin(theta)",
        "y'*cos(theta + phi) - x'*sin(theta + phi) + (d1*cos(phi) + d2)*theta' + d2*phi'",
    ]
    basis = [["cos(theta)", "sin(theta)", "0", "sin(phi)/d2"], ["0", "0", "1", "-d1/d2*cos(phi) - 1"]]
}

impl Model<4, 2> for RollerRacer {
    fn name(&self) -> &'static str {
        "roller racer"
    }

    /// Forward at 1 m/s and turning at 0.3 rad/s, the hinge bent by half a radian.
    fn start(&self) -> ModelState<4> {
        let (bend, straight) = 0.5f64.sin_cos();
        let turn_rate = 0.3;
        let hinge = (bend - (self.d1 * straight + self.d2) * turn_rate) / self.d2;
        ([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, turn_rate, hinge])
    }
}

// The constraints are the sum and the difference of those of the two axles, which are the same where `cos(phi) = 0`.
macros::system! { lagrangian;
    /// The snakeboard: a board on two wheel axles that steer by opposite angles, with a rotor at its centre. (Lewis, Ostrowski, Murray
    /// and Burdick 1994, Proc. IEEE Int. Conf. Robotics and Automation, 2391-2397.)
    pub struct Snakeboard;
    coordinates = { x = "m", y = "m", theta = "angle", psi = "angle", phi = "angle" }
    parameters = { m = 6.0, l = 0.2, J = 0.016, Jr = 0.072, Jw = 0.0013 }
    lagrangian = "m/2*(x'^2 + y'^2) + J/2*theta'^2 + Jr/2*(theta' + psi')^2 + Jw/2*((theta' + phi')^2 + (theta' - phi')^2)"
    constraints = ["y'*cos(theta) - x'*sin(theta)", "sin(phi)*(x'*cos(theta) + y'*sin(theta)) + l*cos(phi)*theta'"]
    basis = [
        ["l*cos(phi)*cos(theta)", "l*cos(phi)*sin(theta)", "-sin(phi)", "0", "0"],
        ["0", "0", "0", "1", "0"],
        ["0", "0", "0", "0", "1"],
    ]
}

impl Model<5, 2> for Snakeboard {
    fn name(&self) -> &'static str {
        "snakeboard"
    }

    /// On an arc, steering and with the rotor turning.
    fn start(&self) -> ModelState<5> {
        let (sin, cos) = 0.3f64.sin_cos();
        ([0.0, 0.0, 0.0, 0.0, 0.3], [self.l * cos, 0.0, -sin, 0.5, 0.2])
    }

    fn invariants<S: Scalar>(&self, _q: &[S; 5], v: &[S; 5]) -> Vec<(&'static str, S)> {
        vec![("rotor momentum", (v[2] + v[3]) * self.Jr), ("steering momentum", v[4] * (2.0 * self.Jw))]
    }
}

macros::system! { lagrangian;
    /// The contact oscillator with a quartic term `eps` (McLachlan and Perlmutter 2006, J. Nonlinear Sci. 16, 283-328), and with a gauge
    /// term: `-d/dt (s cos(z))` changes no motion, but shifts the momenta, whose reversal then does not reverse it (Modin and Verdier
    /// 2020, Numer. Math. 145, 405-435).
    pub struct ContactOscillator;
    coordinates = { x = "m", y = "m", z = "m" }
    parameters = { eps = 0.0, s = 0.0 }
    lagrangian = "(x'^2 + y'^2 + z'^2 - x^2 - y^2 - z^2 - eps*x^2*z^2)/2 + s*z'*sin(z)"
    constraints = ["x' + y*z'"]
    basis = [["0", "1", "0"], ["-y", "0", "1"]]
}

impl ContactOscillator {
    /// A start of the energy 3/2, of which 1/2 is along `y = sin(t)`, at `z = z0` and `z' = 0`, with `z0^2` up to 2.
    #[must_use]
    pub fn start_at(&self, z0: f64) -> ModelState<3> {
        let x = ((2.0 - z0 * z0) / (1.0 + self.eps * z0 * z0)).sqrt();
        ([x, 0.0, z0], [0.0, 1.0, 0.0])
    }
}

impl Model<3, 1> for ContactOscillator {
    fn name(&self) -> &'static str {
        if self.s == 0.0 { "contact oscillator" } else { "gauged contact oscillator" }
    }

    fn reversible(&self) -> bool {
        self.s == 0.0
    }

    fn start(&self) -> ModelState<3> {
        self.start_at(0.3 * std::f64::consts::SQRT_2)
    }
}

macros::system! { lagrangian;
    /// The chaotic quartic oscillator: seven oscillators. (McLachlan and Perlmutter 2006, J. Nonlinear Sci. 16, 283-328.)
    pub struct QuarticOscillator;
    coordinates = { x = "m", y1 = "m", y2 = "m", y3 = "m", z1 = "m", z2 = "m", z3 = "m" }
    parameters = { c = 1.0 }
    lagrangian = "(x'^2 + y1'^2 + y2'^2 + y3'^2 + z1'^2 + z2'^2 + z3'^2 - x^2 - y1^2 - y2^2 - y3^2 - z1^2 - z2^2 - z3^2
                   - c*(y1^2*z1^2 + y2^2*z2^2 + y3^2*z3^2 + z1^2*z2^2))/2"
    constraints = ["x' + y1*z1' + y2*z2' + y3*z3'"]
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

    fn start(&self) -> ModelState<7> {
        let (sin, cos) = std::f64::consts::FRAC_PI_3.sin_cos();
        ([cos, 0.6, 0.4, 0.2, 1.0, 1.0, 1.0], [0.0, sin, 0.0, 0.0, 0.0, 0.0, 0.0])
    }
}
