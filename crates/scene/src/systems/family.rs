use super::Rotor;
use dla::{PARAMETERS as ROOM, ParametrisedMechanics};
use lagrangian::{
    AdmissibleBasis, Constraint, Effect, Gradients, Parametrised, Piecewise, Scalar, Seeded, SeededMember,
};
use sleigh::effects::{AnyEffect, MovingMass};
use sleigh::{Sleigh, TimeFunction};

/// The parameters of a [`SleighFamily`] in their order, with their names in scenes.
pub const PARAMETERS: [&str; 3] = ["sleigh.mass", "sleigh.inertia", "sleigh.offset"];

/// A sleigh on which no velocity is imposed, with its effects, as a function of [`PARAMETERS`]: three coordinates, or four with a rotor, and
/// one constraint. [`SceneSystem::member`](crate::SceneSystem::member) asks for no other shape.
#[derive(Debug, Clone)]
pub struct SleighFamily {
    /// The sleigh with its own mass and offset.
    sleigh: Sleigh,
    /// Inertia (kg m^2) and torque of the motor.
    rotor: Option<(f64, Option<TimeFunction>)>,
    effects: Vec<AnyEffect>,
    /// The masses that move in the sleigh.
    masses: Vec<MovingMass>,
}

impl SleighFamily {
    /// The family of a sleigh that carries masses, under the smooth piece of its effects at the time `t` (s).
    #[must_use]
    pub fn new(sleigh: Sleigh, rotor: Option<Rotor>, (effects, masses): (&[AnyEffect], &[MovingMass]), t: f64) -> Self {
        let rotor = rotor.map(|rotor| (rotor.inertia, rotor.torque.map(|torque| torque.piece(t))));
        let effects = effects.iter().map(|effect| effect.piece(t)).collect();
        let masses = masses.iter().map(|mass| mass.piece(t)).collect();
        Self { sleigh, rotor, effects, masses }
    }

    /// Number of coordinates.
    pub(crate) fn coordinates(&self) -> usize {
        if self.rotor.is_some() { 4 } else { 3 }
    }

    /// The values of the parameters, followed by zeros.
    pub(crate) fn values(&self) -> [f64; ROOM] {
        let own = [self.sleigh.mass(), self.sleigh.inertia(), self.sleigh.offset()];
        std::array::from_fn(|k| own.get(k).copied().unwrap_or(0.0))
    }

    /// What an effect adds to the Lagrangian.
    ///
    /// The ground acts at the centre of mass alone: another offset is another place. A slope draws the mass.
    fn added<S: Scalar, const N: usize>(
        &self,
        effect: &AnyEffect,
        p: &[S; ROOM],
        t: S,
        q: &[S; N],
        v: &[S; N],
    ) -> Option<S> {
        if !effect.is_ground() {
            return effect.lagrangian(&self.sleigh, t, q, v);
        }
        let (sin, cos) = q[2].sin_cos();
        let further = p[2] - self.sleigh.offset();
        let mut place = *q;
        place[0] += cos * further;
        place[1] += sin * further;
        let term = effect.lagrangian(&self.sleigh, t, &place, v)?;
        Some(if matches!(effect, AnyEffect::Slope(_)) { term * (p[0] / self.sleigh.mass()) } else { term })
    }
}

/// Its basis holds everywhere.
impl<const N: usize, const M: usize> ParametrisedMechanics<N, M, ROOM> for SleighFamily {
    fn at(&self, _basis: u64, p: &[Seeded; ROOM]) -> Box<dyn Gradients<N, M> + '_> {
        Box::new(SeededMember { family: self, parameters: *p })
    }
}

impl<const N: usize, const M: usize> Parametrised<N, M, ROOM> for SleighFamily {
    /// The Lagrangian of the sleigh, its rotor and its effects (J).
    fn lagrangian<S: Scalar>(&self, p: &[S; ROOM], t: S, q: &[S; N], v: &[S; N]) -> S {
        let (sin, cos) = q[2].sin_cos();
        let &[mass, inertia, offset, ..] = p;
        let across = cos * v[1] - sin * v[0];
        let pivot = inertia + mass * offset * offset;
        let mut sum =
            (v[0] * v[0] + v[1] * v[1]) * mass * 0.5 + v[2] * across * mass * offset + v[2] * v[2] * pivot * 0.5;
        if let Some((inertia, _)) = &self.rotor {
            let spin = v[2] + v[N - 1];
            sum += spin * spin * (0.5 * inertia);
        }
        for effect in &self.effects {
            if let Some(term) = self.added(effect, p, t, q, v) {
                sum += term;
            }
        }
        for mass in &self.masses {
            sum += mass.kinetic_energy(t, q, v);
        }
        sum
    }

    fn constraint<S: Scalar>(&self, _p: &[S; ROOM], _t: S, q: &[S; N]) -> Constraint<S, N, M> {
        let (sin, cos) = q[2].sin_cos();
        let mut row = [S::zero(); N];
        (row[0], row[1]) = (-sin, cos);
        ([row; M], [S::zero(); M])
    }

    fn force<S: Scalar>(&self, _p: &[S; ROOM], t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        let mut force = [S::zero(); N];
        for effect in &self.effects {
            if let Some(own) = effect.force(&self.sleigh, t, q, v) {
                force.iter_mut().zip(own).for_each(|(sum, term)| *sum += term);
            }
        }
        if let Some((_, Some(torque))) = &self.rotor {
            force[N - 1] += torque.value(t);
        }
        Some(force)
    }

    /// Drive along the blade, pivot about it with the rotor at rest in space, and the spin of the rotor.
    fn admissible_basis<S: Scalar>(&self, _p: &[S; ROOM], _t: S, q: &[S; N]) -> Option<AdmissibleBasis<S, N, M>> {
        let (sin, cos) = q[2].sin_cos();
        Some(AdmissibleBasis::from_fn(|k| {
            let mut vector = [S::zero(); N];
            match k {
                0 => (vector[0], vector[1]) = (cos, sin),
                1 => {
                    vector[2] = S::constant(1.0);
                    if N > 3 {
                        vector[N - 1] = S::constant(-1.0);
                    }
                }
                _ => vector[N - 1] = S::constant(1.0),
            }
            vector
        }))
    }

    fn angles(&self) -> [bool; N] {
        std::array::from_fn(|i| i > 1)
    }
}
