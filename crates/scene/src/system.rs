use crate::power::{self, SceneBody, SceneEffects};
use crate::{Acting, EffectPower, RunSettings, Scene, SceneEffect};
use lagrangian::{Piecewise, System, With, quasi_velocities, velocity_of, whole_steps};
use sleigh::{Exact, Flywheel, Guide, Guided, SleighError, SleighState};

/// A system that came from a scene, and answers in the words of a scene.
pub trait SceneSystem<const N: usize, const M: usize>: System<N, M> + Piecewise + Sync {
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
}

/// What is to be done with the system of a scene, whatever its type.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Receives the system and its start.
    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, q: [f64; N], v: [f64; N]) -> Self::Output
    where
        Sys: SceneSystem<N, M>;
}

/// What imposes velocities on the sleigh of a scene.
enum Guiding {
    None,
    Turntable(Guided<0>),
    One(Guided<1>),
    Two(Guided<2>),
}

impl Scene {
    /// Builds the system of the scene and hands it to the visitor: the one place where a scene becomes a type.
    ///
    /// A body on which nothing acts becomes `With<Body, ()>`, any other a body with a list of what acts on it: an empty list
    /// would be looked at in every evaluation. A velocity that the scene imposes replaces that of its start.
    ///
    /// # Errors
    /// [`SleighError`] where an effect has impossible parameters, which one read from a file has not; or of a train, which
    /// [`train`](Self::train) makes.
    pub fn visit<V: Visitor>(&self, visitor: V) -> Result<V::Output, SleighError> {
        if self.has_trailers() {
            return Err(SleighError::Train);
        }
        self.visit_first(visitor)
    }

    /// The same of the first blade alone, where others follow it.
    pub(crate) fn visit_first<V: Visitor>(&self, visitor: V) -> Result<V::Output, SleighError> {
        Ok(match self.guiding()? {
            Guiding::None => self.with_rotor(self.sleigh, visitor)?,
            Guiding::Turntable(body) => self.with_rotor(body, visitor)?,
            Guiding::One(body) => self.with_rotor(body, visitor)?,
            Guiding::Two(body) => self.with_rotor(body, visitor)?,
        })
    }

    /// The same, of half as many types: a list of effects that is empty makes none of its own, and is looked at in every evaluation.
    ///
    /// # Errors
    /// As [`visit`](Self::visit).
    pub fn visit_listed<V: Visitor>(&self, visitor: V) -> Result<V::Output, SleighError> {
        if self.has_trailers() {
            return Err(SleighError::Train);
        }
        match self.guiding()? {
            Guiding::None => self.listed(self.sleigh, visitor),
            Guiding::Turntable(body) => self.listed(body, visitor),
            Guiding::One(body) => self.listed(body, visitor),
            Guiding::Two(body) => self.listed(body, visitor),
        }
    }

    /// The same where the blade is the only constraint; `None` of a scene that imposes velocities.
    ///
    /// For what needs much code for each system: a list of effects that is empty makes no type of its own here.
    ///
    /// # Errors
    /// As [`visit`](Self::visit).
    pub fn visit_free<V: Visitor>(&self, visitor: V) -> Result<Option<V::Output>, SleighError> {
        if self.has_trailers() {
            return Err(SleighError::Train);
        }
        match self.guiding()? {
            Guiding::None => self.listed(self.sleigh, visitor).map(Some),
            Guiding::Turntable(body) => self.listed(body, visitor).map(Some),
            Guiding::One(_) | Guiding::Two(_) => Ok(None),
        }
    }

    /// Adds the rotor, if there is one, and the list of what acts on the body.
    fn listed<B, V, const M: usize>(&self, body: B, visitor: V) -> Result<V::Output, SleighError>
    where
        B: SceneBody<3, M> + Piecewise + Clone + Sync,
        V: Visitor,
    {
        let (effects, (q, v)) = (self.acting()?, self.start.to_coordinates());
        Ok(match self.rotor(&body)? {
            Some((body, rate)) => {
                let (q, v) = ([q[0], q[1], q[2], 0.0], [v[0], v[1], v[2], rate]);
                start(visitor, &With { body, effects }, q, v)
            }
            None => start(visitor, &With { body, effects }, q, v),
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
    fn with_rotor<B, V, const M: usize>(&self, body: B, visitor: V) -> Result<V::Output, SleighError>
    where
        B: SceneBody<3, M> + Piecewise + Clone + Sync,
        V: Visitor,
    {
        let (q, v) = self.start.to_coordinates();
        match self.rotor(&body)? {
            Some((body, rate)) => {
                let (q, v) = ([q[0], q[1], q[2], 0.0], [v[0], v[1], v[2], rate]);
                self.with_effects(body, visitor, q, v)
            }
            None => self.with_effects(body, visitor, q, v),
        }
    }

    /// Adds what acts on the body, if anything does.
    fn with_effects<B, V, const N: usize, const M: usize>(
        &self,
        body: B,
        visitor: V,
        q: [f64; N],
        v: [f64; N],
    ) -> Result<V::Output, SleighError>
    where
        B: SceneBody<N, M> + Piecewise + Sync,
        V: Visitor,
    {
        let effects = self.acting()?;
        Ok(if effects.is_empty() {
            start(visitor, &With { body, effects: () }, q, v)
        } else {
            start(visitor, &With { body, effects }, q, v)
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

/// Hands the system over with the admissible velocity that has the quasi-velocities of the given one.
fn start<Sys, V, const N: usize, const M: usize>(visitor: V, system: &Sys, q: [f64; N], v: [f64; N]) -> V::Output
where
    Sys: SceneSystem<N, M>,
    V: Visitor,
{
    let first = system.piece(0.0);
    let admissible = quasi_velocities(&first, 0.0, &q, &v).and_then(|xi| velocity_of(&first, 0.0, &q, &xi));
    let free = M == 1 && first.constraint(0.0, &q).1.iter().all(|b| *b == 0.0);
    visitor.visit(system, q, if free { v } else { admissible.unwrap_or(v) })
}

/// The first jump that no step ends at.
pub(crate) struct FirstMisaligned<'a>(pub(crate) &'a RunSettings);

impl Visitor for FirstMisaligned<'_> {
    type Output = Option<f64>;

    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, _q: [f64; N], _v: [f64; N]) -> Option<f64>
    where
        Sys: SceneSystem<N, M>,
    {
        let step = self.0.actual_step();
        let inside = |t: &f64| whole_steps(t / step).is_none();
        system.jumps(0.0, self.0.duration).into_iter().filter(inside).min_by(f64::total_cmp)
    }
}
