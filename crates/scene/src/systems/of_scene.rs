use super::{Guiding, Rotor, SleighFamily, Started, system};
use crate::{BuildError, BuiltScene, Scene, SceneEffect};
use dla::{Schedule, fitted};
use sleigh::effects::{AnyEffect, MovingMass};
use sleigh::{Exact, Guide, Guided, SleighError};

impl Scene {
    /// The system of the scene, with its start.
    ///
    /// # Errors
    /// [`BuildError`] where a trailer or an effect has impossible parameters, which one read from a file has not.
    pub fn built(&self) -> Result<BuiltScene, BuildError> {
        let started = match self.train()? {
            Some((train, (q, v))) => Started { system: Box::new(train), q, v },
            None => self.system()?,
        };
        Ok(BuiltScene::of_sleigh(started))
    }

    /// The system of a sleigh, with its start.
    ///
    /// # Errors
    /// [`SleighError`] if an effect has impossible parameters, which cannot happen to a scene read from a file; or if the scene is a
    /// train, which [`built`](Self::built) makes.
    pub fn system(&self) -> Result<Started, SleighError> {
        if self.has_trailers() {
            return Err(SleighError::Train);
        }
        self.first_blade()
    }

    /// The sleigh as a function of its parameters; `None` of a scene that imposes velocities, or whose plane turns.
    ///
    /// # Errors
    /// As [`system`](Self::system).
    pub fn family(&self) -> Result<Option<SleighFamily>, SleighError> {
        if self.imposed()?.is_some() || self.table_rate().is_some() {
            return Ok(None);
        }
        let acting = (&self.acting()[..], &self.masses()[..]);
        Ok(Some(SleighFamily::new(self.sleigh, self.rotor(), acting, 0.5 * self.run.duration)))
    }

    /// The system of the first blade alone, without trailers.
    pub(crate) fn first_blade(&self) -> Result<Started, SleighError> {
        system(self.guiding()?, self.rotor(), self.acting(), &self.start)
    }

    /// The steps of the run: equal ones, no longer than `run.step`, where every jump of the scene is then at a node. Else each smooth piece
    /// between jumps has equal steps of its own, so that every jump and the end are nodes, and the step here is the mean
    /// ([`dla::smooth_pieces`]).
    #[must_use]
    pub fn schedule(&self) -> Schedule {
        let whole = Schedule { t0: 0.0, step: self.run.actual_step(), steps: self.run.steps() };
        // A scene whose system cannot be built has no run.
        self.jumps().map_or(whole, |jumps| fitted(&whole, self.run.step, jumps))
    }

    /// The energy at the start (J), of the first blade where others follow it.
    ///
    /// # Errors
    /// As [`system`](Self::system).
    pub(crate) fn energy(&self) -> Result<f64, SleighError> {
        let Started { system, q, v } = self.first_blade()?;
        Ok(system.mechanism().smooth_piece(0.0).energy(0.0, &q, &v))
    }

    /// The jumps of the scene in its run (s).
    ///
    /// # Errors
    /// [`SleighError`] where there is no such sleigh.
    pub fn jumps(&self) -> Result<Vec<f64>, SleighError> {
        Ok(self.first_blade()?.system.mechanism().jump_times(0.0, self.run.duration))
    }

    pub(super) fn rotor(&self) -> Option<Rotor> {
        self.effects.iter().find_map(|effect| match effect {
            SceneEffect::Flywheel(rotor) => Some(rotor.clone()),
            _ => None,
        })
    }

    /// Whether anything in the scene is a function of time.
    #[must_use]
    pub fn depends_on_time(&self) -> bool {
        self.effects.iter().any(SceneEffect::depends_on_time)
    }

    /// The effects that act on the coordinates there are.
    pub(super) fn acting(&self) -> Vec<AnyEffect> {
        let acting = |effect: &SceneEffect| match effect {
            SceneEffect::Acting(effect) => Some(effect.clone()),
            _ => None,
        };
        self.effects.iter().filter_map(acting).collect()
    }

    /// The masses that are moved in the body.
    fn masses(&self) -> Vec<MovingMass> {
        let mass = |effect: &SceneEffect| match effect {
            SceneEffect::MovingMass(mass) => Some(mass.clone()),
            _ => None,
        };
        self.effects.iter().filter_map(mass).collect()
    }

    /// The rate of a turning plane (rad/s); `None` for a fixed plane.
    pub(crate) fn table_rate(&self) -> Option<f64> {
        self.effects.iter().find_map(|effect| match effect {
            SceneEffect::Turntable { rate } => Some(*rate),
            _ => None,
        })
    }

    /// The sleigh with its imposed velocities; `None` if none are imposed.
    pub(crate) fn imposed(&self) -> Result<Option<Guiding>, SleighError> {
        let sleigh = self.sleigh;
        let imposed = self.effects.iter().find_map(|effect| match effect {
            SceneEffect::Servo { speed, turn_rate } => match (speed.clone(), turn_rate.clone()) {
                (Some(speed), Some(rate)) => Some(Guided::<2>::servo(sleigh, speed, rate).map(Guiding::Two)),
                (Some(speed), None) => Some(Guided::<1>::servo(sleigh, Guide::Speed(speed)).map(Guiding::One)),
                (None, Some(rate)) => Some(Guided::<1>::servo(sleigh, Guide::TurnRate(rate)).map(Guiding::One)),
                (None, None) => None,
            },
            SceneEffect::Tracer { path } => Some(Guided::<2>::tracer(sleigh, path.clone()).map(Guiding::Two)),
            _ => None,
        });
        imposed.transpose()
    }

    /// The sleigh, what guides it, and what it carries.
    pub(crate) fn guiding(&self) -> Result<Guiding, SleighError> {
        let (rate, masses) = (self.table_rate(), self.masses());
        let on_plane = rate.unwrap_or(0.0);
        Ok(match self.imposed()? {
            Some(Guiding::One(body)) => Guiding::One(body.on_turntable(on_plane)?.carrying(masses)),
            Some(Guiding::Two(body)) => Guiding::Two(body.on_turntable(on_plane)?.carrying(masses)),
            _ if rate.is_none() && masses.is_empty() => Guiding::None(self.sleigh),
            _ => Guiding::Zero(Guided::turntable(self.sleigh, on_plane)?.carrying(masses)),
        })
    }

    /// The motion of the scene in closed form; `None` if an effect changes the motion of the free sleigh.
    ///
    /// # Errors
    /// [`SleighError`] if a quantity of the motion overflows.
    pub fn exact(&self) -> Result<Option<Exact>, SleighError> {
        let free = |effect: &SceneEffect| matches!(effect, SceneEffect::Flywheel(Rotor { torque: None, .. }));
        self.effects.iter().all(free).then(|| Exact::new(&self.sleigh, &self.start)).transpose()
    }
}
