use crate::{Sleigh, SleighError};
use lagrangian::{Twofold, power_of_two_below};

/// Below this phase the motion is written as its change from the start, which keeps the digits of a small change and
/// is exact at phase zero; above it, by exponentials.
const NEAR: f64 = 0.5;

/// The velocities and the heading of the turning free sleigh, `omega0 != 0`, as functions of time.
///
/// With the gyration radius `k = sqrt(J/m)` about the blade, the speed `U = hypot(u0, k omega0)` and
/// `kappa = a U / k^2`, the motion `u' = a omega^2`, `omega' = -(a / k^2) u omega` is
///
/// ```text
/// u = U tanh s,   k |omega| = U sech s,   s = s0 + kappa t,   sinh s0 = u0 / (k |omega0|).
/// ```
///
/// The difference `U - |u0|` and the sum `s0 + kappa t` are never formed where they would cancel:
/// `e^-|s0| = k |omega0| / (U + |u0|)` carries all its digits however small the spin, and multiplies or divides
/// `e^(kappa t)`. An error of `kappa t` is a relative error of the spin, so `kappa t` has twice the digits.
#[derive(Debug, Clone)]
pub(super) struct ReducedSleigh {
    start: Moment,
    /// `k = sqrt(J/m)` (m).
    pub(super) gyration: f64,
    /// `U` (m/s).
    pub(super) speed: f64,
    /// `k/a`, infinite for a balanced sleigh.
    pub(super) gyration_per_offset: f64,
    kappa: Twofold,
    /// `tanh s0` and `sech s0`.
    tanh0: f64,
    sech0: f64,
    /// `e^-|s0| = decay 2^-shift`, `decay` near one: nothing underflows before `omega` itself does.
    decay: f64,
    shift: i32,
}

/// The reduced state at one time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    /// `kappa t`, the distance in `s` from the start.
    pub(super) tau: f64,
    /// `u` (m/s).
    pub(super) speed: f64,
    /// `omega` (rad/s).
    pub(super) turn_rate: f64,
    /// `theta - theta0` (rad).
    pub(super) turn: f64,
}

impl ReducedSleigh {
    /// # Errors
    /// [`SleighError::NotFinite`] where the energy's speed `U` or the rate `kappa` leaves the range of numbers.
    pub(super) fn new(sleigh: &Sleigh, u0: f64, omega0: f64) -> Result<Self, SleighError> {
        let a = sleigh.offset();
        let gyration = (sleigh.inertia() / sleigh.mass()).sqrt().hypot(a);
        let spin = gyration * omega0.abs();
        let speed = u0.hypot(spin);
        if !speed.is_finite() {
            return Err(SleighError::NotFinite { quantity: "the speed sqrt(2 E / m) of all the energy", value: speed });
        }
        let kappa = rate(sleigh, u0, omega0, (a / gyration) * (speed / gyration));
        if !kappa.hi.is_finite() {
            return Err(SleighError::NotFinite { quantity: "the rate a sqrt(2 E m) / J", value: kappa.hi });
        }
        let total = speed + u0.abs();
        let shift = (total.log2() - gyration.log2() - omega0.abs().log2()).round() as i32;
        let (part, rest) = (2.0_f64.powi(shift / 2), 2.0_f64.powi(shift - shift / 2));
        Ok(Self {
            start: Moment { tau: 0.0, speed: u0, turn_rate: omega0, turn: 0.0 },
            gyration,
            speed,
            gyration_per_offset: gyration / a,
            kappa,
            tanh0: u0 / speed,
            sech0: spin / speed,
            decay: gyration * (omega0.abs() * part) / total * rest,
            shift,
        })
    }

    pub(super) fn start(&self) -> Moment {
        self.start
    }

    /// `s0`, to rounding of its size.
    pub(super) fn s0(&self) -> f64 {
        (f64::from(self.shift) * std::f64::consts::LN_2 - self.decay.ln()).copysign(self.tanh0)
    }

    pub(super) fn at(&self, t: f64) -> Moment {
        let tau = self.kappa * t;
        if tau.hi.abs() <= NEAR { self.near(tau.hi, t) } else { self.far(tau) }
    }

    /// The change from the start: with `cosh s / cosh s0 = cosh tau + tanh s0 sinh tau` and the difference formula of
    /// the Gudermannian, `tan((gd s - gd s0)/2) = sinh(tau/2) / cosh(s0 + tau/2)`, in which `a -> 0` is regular.
    fn near(&self, tau: f64, t: f64) -> Moment {
        let half = 0.5 * tau;
        let sinh = half.sinh();
        let cosh = sinh.mul_add(sinh, 1.0).sqrt();
        let (u0, omega0) = (self.start.speed, self.start.turn_rate);
        let growth = 1.0 + 2.0 * sinh * (sinh + self.tanh0 * cosh);
        let middle = cosh + self.tanh0 * sinh;
        let tan = sinh * self.sech0 / middle;
        Moment {
            tau,
            speed: u0 + self.gyration * omega0.abs() * self.sech0 * (2.0 * sinh * cosh / growth),
            turn_rate: omega0 / growth,
            turn: omega0 * t * (ratio(sinh, half) * ratio(tan.atan(), tan) / middle),
        }
    }

    /// By `f = e^-s` of the direction in which the phase runs: the difference formula of the Gudermannian is
    /// `tan((gd s - gd s0)/2) = (1 - e^-tau) / (e^s0 + e^-s)`, without cancellation for `tau > 0`.
    fn far(&self, tau: Twofold) -> Moment {
        let direction = 1.0_f64.copysign(tau.hi);
        let outward = direction * self.tanh0 >= 0.0;
        let distance = tau.abs();
        let shift = Twofold::ln_2() * f64::from(self.shift);
        let backward = -distance;
        let two_to_shift = 2.0_f64.powi(self.shift);
        let (e_start, f) = if outward {
            (two_to_shift / self.decay, self.decay * (backward - shift).exp())
        } else {
            (self.decay / two_to_shift, (backward + shift).exp() / self.decay)
        };
        let (g, side) = if f > 1.0 { (f.recip(), -direction) } else { (f, direction) };
        let one_plus = g.mul_add(g, 1.0);
        let angle = 2.0 * (-(-distance.hi).exp_m1() / (e_start + f)).atan();
        let spin_sign = self.start.turn_rate.signum();
        Moment {
            tau: tau.hi,
            speed: side * self.speed * ((1.0 - g) * (1.0 + g) / one_plus),
            turn_rate: spin_sign * (self.speed / self.gyration) * (2.0 * g / one_plus),
            turn: spin_sign * direction * self.gyration_per_offset * angle,
        }
    }
}

/// `kappa = a U m / J` with twice the digits, or `plain` where the squares leave the range of numbers.
fn rate(sleigh: &Sleigh, u0: f64, omega0: f64, plain: f64) -> Twofold {
    let a = sleigh.offset();
    let square = Twofold::from(sleigh.inertia()) / Twofold::from(sleigh.mass()) + Twofold::product(a, a);
    // Powers of two, so that the scaled velocities are exact.
    let scale = power_of_two_below(u0.abs().max(omega0.abs()));
    let (u, omega) = (u0 / scale, omega0 / scale);
    let spin = square * omega * omega;
    let speed = (Twofold::product(u, u) + spin).sqrt();
    let kappa = (speed * a / square) * scale;
    if (kappa.hi - plain).abs() <= 8.0 * f64::EPSILON * plain.abs() { kappa } else { Twofold::from(plain) }
}

/// `f/x` of functions with the tangent of the identity at zero.
fn ratio(f: f64, x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { f / x }
}
