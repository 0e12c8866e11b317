use crate::error::positive;
use crate::{Sleigh, SleighBody, SleighError, TimeFunction};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Reduced, ReducedError, Scalar, System, velocity_of};

/// A sleigh with a rotor on a bearing: the coordinate `psi`, its angle relative to the body, and the energy
/// `I_r/2 (omega + psi')^2`.
///
/// The mass of the sleigh includes the rotor's, its inertia excludes the rotor's spin. On a free bearing the rotor's
/// absolute angular momentum `I_r (omega + psi')` is conserved, and the sleigh moves as if there were no rotor. A motor
/// torque `tau(t)` acts on `psi`.
#[derive(Debug, Clone, PartialEq)]
pub struct Flywheel<B> {
    body: B,
    inertia: f64,
    torque: Option<TimeFunction>,
}

impl<B> Flywheel<B> {
    /// The body with a rotor of spin inertia `I_r` (kg m^2) and, unless the bearing is free, a motor torque (N m).
    ///
    /// # Errors
    /// [`SleighError`] names an inertia that is not positive or a torque that is not finite.
    pub fn new(body: B, inertia: f64, torque: Option<TimeFunction>) -> Result<Self, SleighError> {
        positive("inertia of the rotor", inertia)?;
        let torque = torque.map(|torque| torque.finite("torque")).transpose()?;
        Ok(Self { body, inertia, torque })
    }

    /// The sleigh that carries the rotor.
    #[must_use]
    pub fn body(&self) -> &B {
        &self.body
    }

    /// The torque of the motor (N m); none on a free bearing.
    #[must_use]
    pub fn torque(&self) -> Option<&TimeFunction> {
        self.torque.as_ref()
    }

    /// The rotor's spin inertia `I_r` (kg m^2).
    #[must_use]
    pub fn inertia(&self) -> f64 {
        self.inertia
    }
}

/// The coordinates of the sleigh, without the rotor.
#[inline(always)]
fn of_body<S: Scalar>(all: &[S; 4]) -> [S; 3] {
    [all[0], all[1], all[2]]
}

#[inline(always)]
fn with_rotor<S: Scalar>(body: &[S; 3], rotor: S) -> [S; 4] {
    [body[0], body[1], body[2], rotor]
}

impl<B: System<3, M>, const M: usize> System<4, M> for Flywheel<B> {
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 4], v: &[S; 4]) -> S {
        let spin = v[2] + v[3];
        self.body.lagrangian(t, &of_body(q), &of_body(v)) + spin * spin * (0.5 * self.inertia)
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 4]) -> Constraint<S, 4, M> {
        let (a, b) = self.body.constraint(t, &of_body(q));
        (a.map(|row| with_rotor(&row, S::zero())), b)
    }

    #[inline(always)]
    fn force<S: Scalar>(&self, t: S, q: &[S; 4], v: &[S; 4]) -> Option<[S; 4]> {
        let motor = self.torque.as_ref().map(|torque| torque.value(t));
        match (self.body.force(t, &of_body(q), &of_body(v)), motor) {
            (None, None) => None,
            (force, motor) => Some(with_rotor(&force.unwrap_or([S::zero(); 3]), motor.unwrap_or(S::zero()))),
        }
    }

    /// The body's own, with the rotor at rest in space as it pivots, and then the spin of the rotor: the last
    /// quasi-velocity is the rotor's absolute rate `omega + psi'`.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 4]) -> Option<AdmissibleBasis<S, 4, M>> {
        let body = self.body.admissible_basis(t, &of_body(q))?;
        let vectors = body.vectors();
        Some(AdmissibleBasis::from_fn(|k| match vectors.get(k) {
            Some(w) => with_rotor(w, -w[2]),
            None => [S::zero(), S::zero(), S::zero(), S::constant(1.0)],
        }))
    }

    #[inline(always)]
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; 4]) -> Option<[Option<S>; M]> {
        self.body.holonomic(t, &of_body(q))
    }

    #[inline(always)]
    fn nonlinear<S: Scalar>(&self, t: S, q: &[S; 4], v: &[S; 4]) -> Option<[Option<S>; M]> {
        self.body.nonlinear(t, &of_body(q), &of_body(v))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 4] {
        let [x, y, theta] = self.body.angles();
        [x, y, theta, true]
    }

    #[inline(always)]
    fn reduced(&self) -> impl Reduced<4, M> {
        self
    }
}

impl<B: System<3, M>, const M: usize> Reduced<4, M> for Flywheel<B> {
    const ANY: bool = M == 1;

    /// The body's own, and `I_r (omega + psi')' = tau`, where the constraints leave the body two freedoms.
    #[inline(always)]
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; 4], xi: &[S; 4]) -> Option<[S; 4]> {
        if M != 1 {
            return None;
        }
        let zero = S::zero();
        if self.torque.is_some() {
            return self.pushed_motion(t, q, xi, &[zero; 4]);
        }
        let [u, omega, _] = self.body.reduced().reduced_motion(t, &of_body(q), &of_body(xi))?;
        Some([u, omega, zero, zero])
    }

    /// The body's own; the rotor turns with what the last quasi-velocity is more than the turn rate of the others. (It is the rotor's
    /// absolute rate where the turn rate is not imposed.)
    #[inline(always)]
    fn velocity<S: Scalar>(
        &self,
        t: S,
        q: &[S; 4],
        xi: &[S; 4],
        _derived: impl FnOnce() -> Result<[S; 4], ReducedError>,
    ) -> Result<[S; 4], ReducedError> {
        let (place, rates) = (of_body(q), of_body(xi));
        let turning = self.body.admissible_basis(t, &place).ok_or(ReducedError::NoBasis)?.combine(&rates)[2];
        Ok(with_rotor(&velocity_of(&self.body, t, &place, &rates)?, xi[3 - M] - turning))
    }

    #[inline(always)]
    fn reconstruction(&self) -> Option<u32> {
        if M == 1 { self.body.reduced().reconstruction() } else { None }
    }

    #[inline(always)]
    fn stands_alone(&self) -> bool {
        self.torque.is_none() && M == 1 && self.body.reduced().stands_alone()
    }

    /// A torque on the rotor acts on the body the other way.
    #[inline(always)]
    fn pushed_motion<S: Scalar>(
        &self,
        t: S,
        q: &[S; 4],
        xi: &[S; 4],
        &[fx, fy, tau, motor]: &[S; 4],
    ) -> Option<[S; 4]> {
        if M != 1 {
            return None;
        }
        let motor = match &self.torque {
            Some(torque) => motor + torque.value(t),
            None => motor,
        };
        let [u, omega, _] = self.body.reduced().pushed_motion(t, &of_body(q), &of_body(xi), &[fx, fy, tau - motor])?;
        Some([u, omega, motor / self.inertia, S::zero()])
    }
}

impl<B: SleighBody> SleighBody for Flywheel<B> {
    #[inline(always)]
    fn sleigh(&self) -> &Sleigh {
        self.body.sleigh()
    }
}

impl<B: Piecewise> Piecewise for Flywheel<B> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        [self.body.jumps(from, to), self.torque.jumps(from, to)].concat()
    }
    fn piece(&self, t: f64) -> Self {
        Self { body: self.body.piece(t), inertia: self.inertia, torque: self.torque.piece(t) }
    }
}
