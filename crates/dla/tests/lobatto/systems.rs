use dla::State;
use lagrangian::{Constraint, Effect, Motion, Scalar, System};
use sleigh::Sleigh;
use std::array::from_fn;

/// `z' = y x'` (Rosenberg 1977).
#[derive(Clone, Copy)]
pub(crate) struct Particle;
impl System<3, 1> for Particle {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
    }
}

impl Particle {
    pub(crate) const START: ([f64; 3], [f64; 3]) = ([0.1, -1.5, 0.3], [0.9, 0.7, -1.5 * 0.9]);

    /// Where [`Particle::START`] is at the time `t`: `y' = v` and `k = x' sqrt(1 + y^2)` are constant.
    pub(crate) fn exact(t: f64) -> ([f64; 3], [f64; 3]) {
        let (q, [vx, v, _]) = Self::START;
        let root = |y: f64| y.mul_add(y, 1.0).sqrt();
        let (y, k) = (q[1] + v * t, vx * root(q[1]));
        let at = [q[0] + k / v * (y.asinh() - q[1].asinh()), y, q[2] + k / v * (root(y) - root(q[1]))];
        (at, [k / root(y), v, y * k / root(y)])
    }
}

/// A sideways force that grows with the turn rate, and friction.
#[derive(Clone, Copy)]
pub(crate) struct Forces;
impl<B> Effect<B, 3> for Forces {
    fn force<S: Scalar>(&self, _body: &B, _t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        let (sin, cos) = q[2].sin_cos();
        Some([cos * v[2] - v[0] * 0.2, sin - v[1] * 0.2, q[0] * 0.3 - v[2] * v[2] * v[2] * 0.1])
    }
}

/// Time everywhere: masses that depend on time and place, a magnetic term, an affine constraint that moves, a force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moving;
impl System<3, 1> for Moving {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let mass = (t * 1.5).sin() * 0.3 + q[0] * q[0] * 0.2 + 1.0;
        let kinetic = (mass * v[0] * v[0] + v[1] * v[1] + v[2] * v[2] * (q[1].cos() * 0.3 + 1.5)) * 0.5;
        kinetic + q[1] * v[0] * 0.4 + (t * t) * v[2] * q[0] * 0.1 - (q[0] + t * 0.5).cos() * 0.6 - q[2] * q[2] * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], (t + q[2]).sin() * 0.5, S::constant(1.0)]], [t.cos() * 0.3 + q[0] * 0.2])
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([(t * 2.0).cos() * 0.4 - v[0] * 0.1, -(v[0] * v[1]) * 0.2, q[1] * v[2] * -0.3])
    }
}

pub(crate) fn sleigh(offset: f64) -> Sleigh {
    Sleigh::new(1.0, 1.0, offset).unwrap()
}

/// The largest difference in place and velocity.
pub(crate) fn distance<const N: usize>(state: &State<N>, (q, v): &([f64; N], [f64; N])) -> f64 {
    let (place, velocity) = (state.unwrapped(), state.v());
    (0..N).map(|i| (place[i] - q[i]).abs().max((velocity[i] - v[i]).abs())).fold(0.0, f64::max)
}

/// The motion by an independent method: Runge and Kutta's on the index-reduced equations, extrapolated to order 5.
pub(crate) fn reference<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    start: &([f64; N], [f64; N]),
    duration: f64,
) -> ([f64; N], [f64; N]) {
    // Of the errors of second order that are measured against it, a millionth.
    let steps = (duration * 200.0) as u64;
    let (coarse, fine) = (runge_kutta(system, start, duration, steps), runge_kutta(system, start, duration, 2 * steps));
    let better = |c: &[f64; N], f: &[f64; N]| from_fn(|i| f[i] + (f[i] - c[i]) / 15.0);
    (better(&coarse.0, &fine.0), better(&coarse.1, &fine.1))
}

fn runge_kutta<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    (q, v): &([f64; N], [f64; N]),
    duration: f64,
    steps: u64,
) -> ([f64; N], [f64; N]) {
    let h = duration / steps as f64;
    let (mut q, mut v) = (*q, *v);
    for k in 0..steps {
        let t = k as f64 * h;
        let (mut dq, mut dv) = ([0.0; N], [0.0; N]);
        let (mut last_q, mut last_v) = ([0.0; N], [0.0; N]);
        for (stage, weight) in [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)] {
            let at_v: [f64; N] = from_fn(|i| v[i] + stage * h * last_v[i]);
            let at_q: [f64; N] = from_fn(|i| q[i] + stage * h * last_q[i]);
            let rate = Motion::of(system, t + stage * h, &at_q, &at_v).unwrap().acceleration;
            (dq, dv) = (from_fn(|i| dq[i] + h * weight * at_v[i]), from_fn(|i| dv[i] + h * weight * rate[i]));
            (last_q, last_v) = (at_v, rate);
        }
        (q, v) = (from_fn(|i| q[i] + dq[i]), from_fn(|i| v[i] + dv[i]));
    }
    (q, v)
}
