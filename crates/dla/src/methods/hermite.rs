use crate::Mechanics;
use crate::State;
use lagrangian::{MotionError, from_fn};

/// The quintic through position, velocity and acceleration at both ends of a step: a cheap motion between two nodes.
///
/// Its position is of order 6, its velocity, which is the derivative of its position, of order 5; or of the order of the method if that is
/// less. So no method up to order 6 loses more than one order. Between nodes the constraint holds to order 5 only;
/// [`Samples`](crate::Samples) hold it as nodes do. Over a run the position is twice continuously differentiable if the nodes have
/// accelerations of one smooth system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hermite<const N: usize> {
    pub(crate) t0: f64,
    pub(crate) h: f64,
    pub(crate) q0: [f64; N],
    pub(crate) v0: [f64; N],
    pub(crate) a0: [f64; N],
    pub(crate) q1: [f64; N],
    pub(crate) v1: [f64; N],
    pub(crate) a1: [f64; N],
}

impl<const N: usize> Hermite<N> {
    /// The polynomial between the nodes at the times `t0` and `t1` (s), of the continuous equations' accelerations there.
    ///
    /// # Errors
    /// [`MotionError`] if the equations of motion determine no accelerations.
    pub fn between<const M: usize>(
        system: &dyn Mechanics<N, M>,
        (t0, from): (f64, &State<N>),
        (t1, to): (f64, &State<N>),
    ) -> Result<Self, MotionError> {
        let acceleration = |t: f64, state: &State<N>| Ok(system.motion(t, state.q(), state.v())?.acceleration);
        Ok(Self {
            t0,
            h: t1 - t0,
            q0: from.unwrapped(),
            v0: *from.v(),
            a0: acceleration(t0, from)?,
            q1: to.unwrapped(),
            v1: *to.v(),
            a1: acceleration(t1, to)?,
        })
    }

    /// The polynomial of a step from the time `t0` of length `h` (s) with these positions, velocities and accelerations at its ends.
    #[must_use]
    pub fn through((t0, h): (f64, f64), [q0, v0, a0]: [[f64; N]; 3], [q1, v1, a1]: [[f64; N]; 3]) -> Self {
        Self { t0, h, q0, v0, a0, q1, v1, a1 }
    }

    /// Configuration, angles with their full turns, and velocity at the time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> ([f64; N], [f64; N]) {
        self.at_part((t - self.t0) / self.h)
    }

    /// Position and velocity at the fraction `c` of the step.
    #[must_use]
    pub fn at_part(&self, c: f64) -> ([f64; N], [f64; N]) {
        let h = self.h;
        let mut v = [0.0; N];
        let q = from_fn(|i| {
            // In s = c: q0 + h v0 s + h^2 a0/2 s^2 + s^3 (x + y s + z s^2).
            let (v0, v1, a0, a1) = (h * self.v0[i], h * self.v1[i], h * h * self.a0[i], h * h * self.a1[i]);
            let d = self.q1[i] - self.q0[i] - v0 - 0.5 * a0;
            let (e, f) = (v1 - v0 - a0, a1 - a0);
            let (x, y, z) = (10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f);
            v[i] = (v0 + c * (a0 + c * (3.0 * x + c * (4.0 * y + c * 5.0 * z)))) / h;
            self.q0[i] + c * (v0 + c * (0.5 * a0 + c * (x + c * (y + c * z))))
        });
        (q, v)
    }
}
