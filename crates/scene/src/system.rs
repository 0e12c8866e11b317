use crate::power::{self, SceneBody, SceneEffects};
use crate::{Acting, EffectPower, Scene, SceneEffect};
use dla::FullMechanics;
use lagrangian::{Piecewise, System, With};
use sleigh::{Exact, Flywheel, Guide, Guided, SleighError, SleighState};

/// A system that came from a scene, and answers in the words of a scene.
pub trait SceneSystem<const N: usize, const M: usize>: FullMechanics<N, M> + Sync {
    /// Place, heading and admissible velocities of the sleigh.
    fn sleigh_state(&self, q: &[f64; N], v: &[f64; N]) -> SleighState;

    /// The centre of mass (m).
    fn centre(&self, q: &[f64; N]) -> [f64; 2];

    /// Angle relative to the body (rad) and relative rate (rad/s) of the rotor, where there is one.
    fn rotor(&self, q: &[f64; N], v: &[f64; N]) -> Option<[f64; 2]> {
        (N == 4).then(|| [q[N - 1], v[N - 1]])
    }

    /// The power of each effect that has any, where the constraints have the multipliers `lambda`.
    fn powers(&self, t: f64, q: &[f64; N], v: &[f64; N], lambda: &[f64; M]) -> Vec<EffectPower>;

    /// The smooth piece that holds at the time `t` (s), continued to all times.
    fn scene_piece(&self, t: f64) -> Box<dyn SceneSystem<N, M> + '_>;
}

impl<B, E, const N: usize, const M: usize> SceneSystem<N, M> for With<B, E>
where
    Self: System<N, M> + Piecewise + Sync,
    B: SceneBody<N, M>,
    E: SceneEffects<B, N>,
{
    fn sleigh_state(&self, q: &[f64; N], v: &[f64; N]) -> SleighState {
        SleighState::from_coordinates(&[q[0], q[1], q[2]], &[v[0], v[1], v[2]])
    }

    fn centre(&self, q: &[f64; N]) -> [f64; 2] {
        self.body.centre(q)
    }

    fn powers(&self, t: f64, q: &[f64; N], v: &[f64; N], lambda: &[f64; M]) -> Vec<EffectPower> {
        power::of(self, t, q, v, lambda)
    }

    fn scene_piece(&self, t: f64) -> Box<dyn SceneSystem<N, M> + '_> {
        Box::new(self.piece(t))
    }
}

/// A system with its start.
pub struct Started<const N: usize, const M: usize> {
    /// The system.
    pub system: Box<dyn SceneSystem<N, M>>,
    /// Configuration at the start.
    pub q: [f64; N],
    /// Velocity at the start.
    pub v: [f64; N],
}

/// The system of a scene, by its shape: three coordinates or four, with a rotor; one constraint, the blade, or more, where a scene imposes
/// velocities.
#[derive(Debug)]
pub enum AnySystem {
    /// A sleigh.
    Sleigh(Started<3, 1>),
    /// A sleigh of which one velocity is imposed.
    One(Started<3, 2>),
    /// A sleigh of which two are.
    Two(Started<3, 3>),
    /// A sleigh with a rotor.
    Rotor(Started<4, 1>),
    /// The same with one velocity imposed.
    RotorOne(Started<4, 2>),
    /// The same with two.
    RotorTwo(Started<4, 3>),
}

impl<const N: usize, const M: usize> std::fmt::Debug for Started<N, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Started").field("q", &self.q).field("v", &self.v).finish_non_exhaustive()
    }
}

/// What is to be done with the system of a scene, whatever its shape.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Receives the system and its start.
    fn visit<const N: usize, const M: usize>(
        self,
        system: &dyn SceneSystem<N, M>,
        q: [f64; N],
        v: [f64; N],
    ) -> Self::Output;
}

/// What imposes velocities on the sleigh of a scene.
enum Guiding {
    None,
    Turntable(Guided<0>),
    One(Guided<1>),
    Two(Guided<2>),
}

impl Scene {
    /// Builds the system of the scene and hands it to the visitor.
    ///
    /// # Errors
    /// As [`system`](Self::system).
    pub fn visit<V: Visitor>(&self, visitor: V) -> Result<V::Output, SleighError> {
        Ok(match self.system()? {
            AnySystem::Sleigh(Started { system, q, v }) => visitor.visit(&*system, q, v),
            AnySystem::One(Started { system, q, v }) => visitor.visit(&*system, q, v),
            AnySystem::Two(Started { system, q, v }) => visitor.visit(&*system, q, v),
            AnySystem::Rotor(Started { system, q, v }) => visitor.visit(&*system, q, v),
            AnySystem::RotorOne(Started { system, q, v }) => visitor.visit(&*system, q, v),
            AnySystem::RotorTwo(Started { system, q, v }) => visitor.visit(&*system, q, v),
        })
    }

    /// The same where the blade is the only constraint; `None` of a scene that imposes velocities.
    ///
    /// # Errors
    /// As [`visit`](Self::visit).
    pub fn visit_free<V: Visitor>(&self, visitor: V) -> Result<Option<V::Output>, SleighError> {
        Ok(match self.system()? {
            AnySystem::Sleigh(Started { system, q, v }) => Some(visitor.visit(&*system, q, v)),
            AnySystem::Rotor(Started { system, q, v }) => Some(visitor.visit(&*system, q, v)),
            _ => None,
        })
    }

    /// The system of the scene: the one place where a scene becomes a type.
    ///
    /// A sleigh on which nothing acts, with a rotor or without, is a type of its own, since its steps are shorter than a look at an empty
    /// list; any other body has a list of what acts on it. A velocity that the scene imposes replaces that of its start.
    ///
    /// # Errors
    /// [`SleighError`] where an effect has impossible parameters, which one read from a file has not; or of a train, which
    /// [`train`](Self::train) makes.
    pub fn system(&self) -> Result<AnySystem, SleighError> {
        if self.has_trailers() {
            return Err(SleighError::Train);
        }
        self.first_blade()
    }

    /// The same of the first blade alone, where others follow it.
    fn first_blade(&self) -> Result<AnySystem, SleighError> {
        match self.guiding()? {
            Guiding::None => {
                let effects = self.acting()?;
                if effects.is_empty() {
                    return self.with_rotor(self.sleigh, (), AnySystem::Sleigh, AnySystem::Rotor);
                }
                self.with_rotor(self.sleigh, effects, AnySystem::Sleigh, AnySystem::Rotor)
            }
            Guiding::Turntable(body) => self.with_rotor(body, self.acting()?, AnySystem::Sleigh, AnySystem::Rotor),
            Guiding::One(body) => self.with_rotor(body, self.acting()?, AnySystem::One, AnySystem::RotorOne),
            Guiding::Two(body) => self.with_rotor(body, self.acting()?, AnySystem::Two, AnySystem::RotorTwo),
        }
    }

    /// The jumps of the scene in its run (s).
    pub(crate) fn jumps(&self) -> Result<Vec<f64>, SleighError> {
        let end = self.run.duration;
        Ok(match self.first_blade()? {
            AnySystem::Sleigh(Started { system, .. }) => system.jump_times(0.0, end),
            AnySystem::One(Started { system, .. }) => system.jump_times(0.0, end),
            AnySystem::Two(Started { system, .. }) => system.jump_times(0.0, end),
            AnySystem::Rotor(Started { system, .. }) => system.jump_times(0.0, end),
            AnySystem::RotorOne(Started { system, .. }) => system.jump_times(0.0, end),
            AnySystem::RotorTwo(Started { system, .. }) => system.jump_times(0.0, end),
        })
    }

    /// The body with its rotor, and the rate of that (rad/s), where there is one.
    fn rotor<B: Clone>(&self, body: &B) -> Result<Option<(Flywheel<B>, f64)>, SleighError> {
        for effect in &self.effects {
            if let SceneEffect::Flywheel { inertia, rotor_rate, torque } = effect {
                let torque = torque.as_ref().map(crate::TimeSpec::build).transpose()?;
                return Ok(Some((Flywheel::new(body.clone(), *inertia, torque)?, *rotor_rate)));
            }
        }
        Ok(None)
    }

    /// Whether anything in the scene is a function of time.
    #[must_use]
    pub fn depends_on_time(&self) -> bool {
        self.effects.iter().any(SceneEffect::depends_on_time)
    }

    /// The effects that act on the coordinates there are.
    pub(crate) fn acting(&self) -> Result<Vec<Acting>, SleighError> {
        self.effects.iter().filter_map(|effect| Acting::of(effect).transpose()).collect()
    }

    fn guiding(&self) -> Result<Guiding, SleighError> {
        let sleigh = self.sleigh;
        let rate = self.effects.iter().find_map(|effect| match effect {
            SceneEffect::Turntable { rate } => Some(*rate),
            _ => None,
        });
        let imposed = self.effects.iter().find_map(|effect| match effect {
            SceneEffect::Servo { speed: Some(speed), turn_rate: Some(turn_rate) } => {
                let both = speed.build().and_then(|u| Guided::<2>::servo(sleigh, u, turn_rate.build()?));
                Some(both.map(Guiding::Two))
            }
            SceneEffect::Servo { speed: Some(speed), .. } => {
                let one = speed.build().and_then(|u| Guided::<1>::servo(sleigh, Guide::Speed(u)));
                Some(one.map(Guiding::One))
            }
            SceneEffect::Servo { turn_rate: Some(turn_rate), .. } => {
                let one = turn_rate.build().and_then(|omega| Guided::<1>::servo(sleigh, Guide::TurnRate(omega)));
                Some(one.map(Guiding::One))
            }
            SceneEffect::Tracer { path } => {
                Some(path.build().and_then(|path| Guided::<2>::tracer(sleigh, path)).map(Guiding::Two))
            }
            _ => None,
        });
        Ok(match (imposed.transpose()?, rate) {
            (None, None) => Guiding::None,
            (None, Some(rate)) => Guiding::Turntable(Guided::turntable(sleigh, rate)?),
            (Some(guiding), None) => guiding,
            (Some(Guiding::One(body)), Some(rate)) => Guiding::One(body.on_turntable(rate)?),
            (Some(Guiding::Two(body)), Some(rate)) => Guiding::Two(body.on_turntable(rate)?),
            (Some(guiding), Some(_)) => guiding,
        })
    }

    /// Adds the rotor, if there is one, and what acts on the body.
    fn with_rotor<B, E, const M: usize>(
        &self,
        body: B,
        effects: E,
        plain: fn(Started<3, M>) -> AnySystem,
        rotor: fn(Started<4, M>) -> AnySystem,
    ) -> Result<AnySystem, SleighError>
    where
        B: SceneBody<3, M> + Piecewise + Clone + Sync + 'static,
        E: SceneEffects<B, 3> + SceneEffects<Flywheel<B>, 4> + Piecewise + Sync + 'static,
    {
        let (q, v) = self.start.to_coordinates();
        Ok(match self.rotor(&body)? {
            Some((body, rate)) => {
                let (q, v) = ([q[0], q[1], q[2], 0.0], [v[0], v[1], v[2], rate]);
                rotor(started(With { body, effects }, q, v))
            }
            None => plain(started(With { body, effects }, q, v)),
        })
    }

    /// The motion of the scene in closed form, where no effect changes that of the free sleigh.
    ///
    /// # Errors
    /// [`SleighError`] where a quantity of it overflows.
    pub fn exact(&self) -> Result<Option<Exact>, SleighError> {
        let free = |effect: &SceneEffect| matches!(effect, SceneEffect::Flywheel { torque: None, .. });
        self.effects.iter().all(free).then(|| Exact::new(&self.sleigh, &self.start)).transpose()
    }
}

/// The system with the admissible velocity that has the quasi-velocities of the given one.
fn started<B, E, const N: usize, const M: usize>(system: With<B, E>, q: [f64; N], v: [f64; N]) -> Started<N, M>
where
    With<B, E>: SceneSystem<N, M> + 'static,
{
    of_start(Box::new(system), q, v)
}

fn of_start<const N: usize, const M: usize>(
    system: Box<dyn SceneSystem<N, M>>,
    q: [f64; N],
    v: [f64; N],
) -> Started<N, M> {
    let first = system.smooth_piece(0.0);
    let admissible = first.quasi_velocities(0.0, &q, &v).and_then(|xi| first.velocity_of(0.0, &q, &xi));
    let free = M == 1 && first.constraint(0.0, &q).1.iter().all(|b| *b == 0.0);
    drop(first);
    Started { system, q, v: if free { v } else { admissible.unwrap_or(v) } }
}
