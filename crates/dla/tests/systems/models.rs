//! The systems, each with its closed form.

use crate::systems::tools::Place;
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// What a particle's velocity costs. Each conserves the speed, so that all have the same motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kinetic {
    /// `v^2 / 2`.
    Quadratic,
    /// `-sqrt(1 - v^2)`.
    Relativistic,
    /// `v^2 / 2 + v^4 / 4`.
    Quartic,
}

/// A particle in space with `z' = y x'` (Rosenberg 1977), with a drag of `-damping v`.
#[derive(Debug, Clone, Copy)]
pub struct Particle {
    pub kinetic: Kinetic,
    pub damping: f64,
}

impl Particle {
    pub const FREE: Self = Self { kinetic: Kinetic::Quadratic, damping: 0.0 };

    /// The particle that starts at `(0.1, 0.2, 0.3)` with `x' = 0.45`, `y' = 0.35`.
    pub fn exact(&self, t: f64) -> Place<3> {
        let (x0, y0, z0, x1, y1) = (0.1, 0.2f64, 0.3, 0.45, 0.35);
        // Drag slows the motion along one and the same path.
        let (s, slowed) = match self.damping {
            0.0 => (t, 1.0),
            nu => (-(-nu * t).exp_m1() / nu, (-nu * t).exp()),
        };
        let (y, k) = (y0 + y1 * s, x1 * y0.hypot(1.0));
        let q = [x0 + k / y1 * (y.asinh() - y0.asinh()), y, z0 + k / y1 * (y.hypot(1.0) - y0.hypot(1.0))];
        let along = k / y.hypot(1.0);
        (q, [along, y1, y * along].map(|v| slowed * v))
    }
}

impl System<3, 1> for Particle {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        match self.kinetic {
            Kinetic::Quadratic => square * 0.5,
            Kinetic::Relativistic => -(-square + 1.0).sqrt(),
            Kinetic::Quartic => square * 0.5 + square * square * 0.25,
        }
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        (self.damping != 0.0).then(|| v.map(|v| -v * self.damping))
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, q[1]], [zero, one, zero]]))
    }
}

/// The particle in the potential `-y^2 / 2`, in the coordinates `(x, u, z)` with `y = sinh u`: mass, potential and
/// constraint all depend on the configuration, so that no two rules agree. With `u' = 1` at the start it stays so.
#[derive(Debug, Clone, Copy)]
pub struct Hyperbolic;

fn sinh_cosh<S: Scalar>(u: S) -> (S, S) {
    let (up, down) = (u.exp(), (-u).exp());
    ((up - down) * 0.5, (up + down) * 0.5)
}

impl Hyperbolic {
    pub fn exact(t: f64) -> Place<3> {
        let (u, k) = (t - 0.6, 0.8);
        ([2.0 * k * (0.5 * u).tanh().atan(), u, k * u.cosh().ln()], [k / u.cosh(), 1.0, k * u.tanh()])
    }
}

impl System<3, 1> for Hyperbolic {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let (sinh, cosh) = sinh_cosh(q[1]);
        (v[0] * v[0] + (cosh * v[1]).squared() + v[2] * v[2] + sinh * sinh) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-sinh_cosh(q[1]).0, S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, sinh_cosh(q[1]).0], [zero, one, zero]]))
    }
}

/// A disk that rolls upright: `(x, y, phi, theta)` with `x' = R phi' cos theta`, `y' = R phi' sin theta`.
#[derive(Debug, Clone, Copy)]
pub struct Disk;

impl Disk {
    const RADIUS: f64 = 0.7;

    /// The disk with the rolling rate 2 and the turning rate 0.8.
    pub fn exact(t: f64) -> Place<4> {
        let (roll, turn) = (2.0, 0.8);
        let (theta, speed) = (0.4 + turn * t, Self::RADIUS * roll);
        let (sin, cos) = theta.sin_cos();
        let q = [speed / turn * sin, -speed / turn * cos, 0.3 + roll * t, theta];
        (q, [speed * cos, speed * sin, roll, turn])
    }
}

impl System<4, 2> for Disk {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 4], v: &[S; 4]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.65 + v[2] * v[2] * 0.25 + v[3] * v[3] * 0.45
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Constraint<S, 4, 2> {
        let ((sin, cos), zero, one) = (q[3].sin_cos(), S::zero(), S::constant(1.0));
        ([[one, zero, cos * -Self::RADIUS, zero], [zero, one, sin * -Self::RADIUS, zero]], [zero; 2])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Option<AdmissibleBasis<S, 4, 2>> {
        let ((sin, cos), zero, one) = (q[3].sin_cos(), S::zero(), S::constant(1.0));
        let roll = [cos * Self::RADIUS, sin * Self::RADIUS, one, zero];
        Some(AdmissibleBasis::new([roll, [zero, zero, zero, one]]))
    }
    fn angles(&self) -> [bool; 4] {
        [false, false, true, true]
    }
}

/// `x'' + 2 damping x' + x = drive cos(2 t)`: no constraint.
#[derive(Debug, Clone, Copy)]
pub struct Oscillator {
    pub damping: f64,
    pub drive: f64,
}

impl Oscillator {
    /// The motion from `x = 1`, `x' = 0.5`.
    pub fn exact(&self, t: f64) -> Place<1> {
        let (beta, rate) = (self.damping, (1.0 - self.damping * self.damping).sqrt());
        // The forced part is a cos 2t + b sin 2t, with -3 a + 4 beta b = drive and -3 b - 4 beta a = 0.
        let a = -self.drive * 3.0 / (9.0 + 16.0 * beta * beta);
        let b = -4.0 / 3.0 * beta * a;
        let (c, d) = (1.0 - a, (0.5 - 2.0 * b + beta * (1.0 - a)) / rate);
        let ((s2, c2), (s, co), decay) = ((2.0 * t).sin_cos(), (rate * t).sin_cos(), (-beta * t).exp());
        let x = decay * (c * co + d * s);
        let v = -beta * x + decay * rate * (d * co - c * s);
        ([x + a * c2 + b * s2], [v - 2.0 * a * s2 + 2.0 * b * c2])
    }
}

impl System<1, 0> for Oscillator {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 1], v: &[S; 1]) -> S {
        (v[0] * v[0] - q[0] * q[0]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 0> {
        ([], [])
    }
    fn force<S: Scalar>(&self, t: S, _q: &[S; 1], v: &[S; 1]) -> Option<[S; 1]> {
        let none = self.damping == 0.0 && self.drive == 0.0;
        (!none).then(|| [(t * 2.0).cos() * self.drive - v[0] * (2.0 * self.damping)])
    }
}

/// A particle with `z' = y x' + cos t`.
#[derive(Debug, Clone, Copy)]
pub struct Pushed;

impl Pushed {
    /// The motion from `(0, 0.3, 0)` with `x' = 0.5`, `y' = 0.4`, by the integral that the constraint leaves,
    /// `(sqrt(1 + y^2) x')' = y sin t / sqrt(1 + y^2)`.
    pub fn exact(t: f64) -> Place<3> {
        let y = |t: f64| 0.3 + 0.4 * t;
        // Rates of (sqrt(1 + y^2) x', x, z), by the classical Runge-Kutta rule: its error is below 1e-11 for t < 10.
        let rate = |t: f64, p: f64| {
            let root = y(t).hypot(1.0);
            let along = p / root;
            [y(t) * t.sin() / root, along, y(t) * along + t.cos()]
        };
        let steps = 1000;
        let h = t / f64::from(steps);
        let mut state = [0.5 * y(0.0).hypot(1.0), 0.0, 0.0];
        for k in 0..steps {
            let t = f64::from(k) * h;
            let k1 = rate(t, state[0]);
            let k2 = rate(t + 0.5 * h, state[0] + 0.5 * h * k1[0]);
            let k3 = rate(t + 0.5 * h, state[0] + 0.5 * h * k2[0]);
            let k4 = rate(t + h, state[0] + h * k3[0]);
            for i in 0..3 {
                state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        let [_, x1, z1] = rate(t, state[0]);
        ([state[1], y(t), state[2]], [x1, 0.4, z1])
    }
}

impl System<3, 1> for Pushed {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], S::zero(), S::constant(1.0)]], [-t.cos()])
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        Particle::FREE.admissible_basis(t, q)
    }
}
