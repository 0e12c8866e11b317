use crate::effects::MovingMass;
use crate::error::finite;
use crate::{ClosedPath, Sleigh, SleighBody, SleighError, TimeFunction};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Reduced, Scalar, System, called};

/// A velocity that is imposed on the sleigh, as an affine constraint.
#[derive(Debug, Clone, PartialEq)]
pub enum Guide {
    /// The speed along the blade: `e . P' = u(t)` (m/s).
    Speed(TimeFunction),
    /// The turn rate: `theta' = omega(t)` (rad/s).
    TurnRate(TimeFunction),
    /// The velocity of the centre of mass along the axis `x`, as on the path.
    TracerX(ClosedPath),
    /// The velocity of the centre of mass along the axis `y`, as on the path.
    TracerY(ClosedPath),
}

/// A sleigh with `K` velocities imposed, perhaps on a turning table, perhaps with masses that are moved in it: `1 + K` constraints.
///
/// The first constraint is the blade's, `n . (P' - Omega (-y, x)) = 0` on a plane that turns at the rate `Omega` about the
/// origin. Then come the imposed velocities: a servo imposes the speed, the turn rate or both; a tracer, the point `C` of
/// the planimeter, both components of `C'`. What imposes them does work.
#[derive(Debug, Clone, PartialEq)]
pub struct Guided<const K: usize> {
    pub(super) sleigh: Sleigh,
    pub(super) table_rate: f64,
    pub(super) masses: Vec<MovingMass>,
    pub(super) guides: [Guide; K],
}

/// On a plane that rests, with nothing imposed.
impl From<Sleigh> for Guided<0> {
    fn from(sleigh: Sleigh) -> Self {
        Self { sleigh, table_rate: 0.0, masses: Vec::new(), guides: [] }
    }
}

impl Guided<0> {
    /// The sleigh on a plane that turns at the rate `Omega` about the origin (rad/s).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn turntable(sleigh: Sleigh, rate: f64) -> Result<Self, SleighError> {
        Self::from(sleigh).on_turntable(rate)
    }
}

impl Guided<1> {
    /// The sleigh with one velocity imposed.
    ///
    /// # Errors
    /// [`SleighError`] names the quantity that is not finite. A tracer is refused, since it needs both velocities.
    pub fn servo(sleigh: Sleigh, guide: Guide) -> Result<Self, SleighError> {
        let guides = [match guide {
            Guide::Speed(speed) => Guide::Speed(speed.finite("speed")?),
            Guide::TurnRate(rate) => Guide::TurnRate(rate.finite("turn_rate")?),
            Guide::TracerX(_) | Guide::TracerY(_) => {
                return Err(SleighError::Path { problem: "a tracer imposes both components of a velocity".to_owned() });
            }
        }];
        Ok(Self { sleigh, table_rate: 0.0, masses: Vec::new(), guides })
    }
}

impl Guided<2> {
    /// The sleigh with both of its velocities imposed: it follows `u(t)`, `omega(t)` whatever acts on it.
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn servo(sleigh: Sleigh, speed: TimeFunction, turn_rate: TimeFunction) -> Result<Self, SleighError> {
        let guides = [Guide::Speed(speed.finite("speed")?), Guide::TurnRate(turn_rate.finite("turn_rate")?)];
        Ok(Self { sleigh, table_rate: 0.0, masses: Vec::new(), guides })
    }

    /// The sleigh whose centre of mass is led along a closed path: Prytz's planimeter, `theta' = (n . C')/a`.
    ///
    /// # Errors
    /// [`SleighError::Path`] where `a = 0`: the blade would have to move sideways.
    pub fn tracer(sleigh: Sleigh, path: ClosedPath) -> Result<Self, SleighError> {
        if sleigh.offset() == 0.0 {
            let problem = "with the centre of mass at the blade (offset 0) a tracer cannot be led sideways".to_owned();
            return Err(SleighError::Path { problem });
        }
        let guides = [Guide::TracerX(path.clone()), Guide::TracerY(path)];
        Ok(Self { sleigh, table_rate: 0.0, masses: Vec::new(), guides })
    }
}

impl<const K: usize> Guided<K> {
    /// The sleigh on a plane that turns at the rate `Omega` about the origin (rad/s).
    ///
    /// # Errors
    /// [`SleighError::NotFinite`].
    pub fn on_turntable(self, rate: f64) -> Result<Self, SleighError> {
        finite("rate", [rate])?;
        Ok(Self { table_rate: rate, ..self })
    }

    /// Another sleigh, guided alike.
    #[must_use]
    pub fn with_sleigh(&self, sleigh: Sleigh) -> Self {
        Self { sleigh, ..self.clone() }
    }

    /// The sleigh with these moving masses added.
    #[must_use]
    pub fn carrying(mut self, masses: Vec<MovingMass>) -> Self {
        self.masses.extend(masses);
        self
    }

    /// The masses that are moved in the body.
    #[must_use]
    pub fn masses(&self) -> &[MovingMass] {
        &self.masses
    }

    /// The rate `Omega` of the plane (rad/s).
    #[must_use]
    pub fn table_rate(&self) -> f64 {
        self.table_rate
    }

    /// What imposes the velocities: `servo` or `tracer`.
    #[must_use]
    pub fn guided_by(&self) -> Option<&'static str> {
        self.guides.first().map(|guide| match guide {
            Guide::Speed(_) | Guide::TurnRate(_) => "servo",
            Guide::TracerX(_) | Guide::TracerY(_) => "tracer",
        })
    }

    /// The row of the blade.
    #[inline(always)]
    fn blade<S: Scalar>(&self, q: &[S; 3]) -> ([S; 3], S) {
        let (sin, cos) = q[2].sin_cos();
        let swept = if self.table_rate == 0.0 { S::zero() } else { -self.swept(q) };
        ([-sin, cos, S::zero()], swept)
    }

    /// The row of an imposed velocity.
    #[inline(always)]
    fn guide<S: Scalar>(&self, guide: &Guide, t: S, q: &[S; 3]) -> ([S; 3], S) {
        let (zero, one) = (S::zero(), S::constant(1.0));
        let (sin, cos) = q[2].sin_cos();
        let a = self.sleigh.offset();
        match guide {
            Guide::Speed(speed) => ([cos, sin, zero], -speed.value(t)),
            Guide::TurnRate(rate) => ([zero, zero, one], -rate.value(t)),
            Guide::TracerX(path) => ([one, zero, sin * -a], -path.velocity(t)[0]),
            Guide::TracerY(path) => ([zero, one, cos * a], -path.velocity(t)[1]),
        }
    }
}

/// The kinetic energy of the masses (J).
#[inline(always)]
fn carried_energy<S: Scalar>(masses: &[MovingMass], t: S, q: &[S; 3], v: &[S; 3]) -> S {
    called(
        #[inline(always)]
        || {
            S::over(
                masses,
                S::zero().carried_as(t),
                #[inline(always)]
                |sum, mass| sum + mass.kinetic_energy(t, q, v),
            )
        },
    )
}

/// One text for each number of imposed velocities.
macro_rules! guided {
    ($k:literal, $m:literal) => {
        impl System<3, $m> for Guided<$k> {
            #[inline(always)]
            fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
                let bare = System::<3, 1>::lagrangian(&self.sleigh, t, q, v);
                if self.masses.is_empty() { bare } else { bare + carried_energy(&self.masses, t, q, v) }
            }

            #[inline(always)]
            fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, $m> {
                let (mut a, mut b) = ([[S::zero(); 3]; $m], [S::zero(); $m]);
                (a[0], b[0]) = self.blade(q);
                for (k, guide) in self.guides.iter().enumerate() {
                    (a[k + 1], b[k + 1]) = self.guide(guide, t, q);
                }
                (a, b)
            }

            /// What is not imposed: drive along the blade, and pivot about it.
            #[inline(always)]
            fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, $m>> {
                let (sin, cos) = q[2].sin_cos();
                let (drive, pivot) = ([cos, sin, S::zero()], [S::zero(), S::zero(), S::constant(1.0)]);
                let driven = matches!(self.guides.first(), Some(Guide::Speed(_)));
                Some(AdmissibleBasis::from_fn(|k| if driven || k == 1 { pivot } else { drive }))
            }

            #[inline(always)]
            fn angles(&self) -> [bool; 3] {
                [false, false, true]
            }

            #[inline(always)]
            fn reduced(&self) -> impl Reduced<3, $m> {
                self
            }
        }
    };
}
guided!(0, 1);
guided!(1, 2);
guided!(2, 3);

impl<const K: usize> SleighBody for Guided<K> {
    #[inline(always)]
    fn sleigh(&self) -> &Sleigh {
        &self.sleigh
    }
}

impl Piecewise for Guide {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        match self {
            Self::Speed(function) | Self::TurnRate(function) => function.jumps(from, to),
            Self::TracerX(path) | Self::TracerY(path) => path.jumps(from, to),
        }
    }
    fn piece(&self, t: f64) -> Self {
        match self {
            Self::Speed(function) => Self::Speed(function.piece(t)),
            Self::TurnRate(function) => Self::TurnRate(function.piece(t)),
            Self::TracerX(path) => Self::TracerX(path.piece(t)),
            Self::TracerY(path) => Self::TracerY(path.piece(t)),
        }
    }
}

impl<const K: usize> Piecewise for Guided<K> {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        [self.guides.jumps(from, to), self.masses.jumps(from, to)].concat()
    }
    fn piece(&self, t: f64) -> Self {
        Self { masses: self.masses.piece(t), guides: self.guides.piece(t), ..*self }
    }
}
