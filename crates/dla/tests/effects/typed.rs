//! Runs of the systems of scenes in their types, as a method of a given form needs them.

use crate::effects::tools::{Laden, laden, run};
use dla::{Composition, Dla, Schedule};
use lagrangian::{Piecewise, System};
use scene::{Rotor, Scene, SceneEffect};
use sleigh::effects::MovingMass;
use sleigh::{Flywheel, Guide, Guided};

/// The run of a scene from its start, and the configuration and velocity at its end.
pub struct Run<'a> {
    pub scene: &'a Scene,
    pub method: Composition<Dla>,
    pub schedule: Schedule,
    pub start: (Vec<f64>, Vec<f64>),
}

impl Run<'_> {
    pub fn end(self) -> [Vec<f64>; 2] {
        let sleigh = self.scene.sleigh;
        let effects = || self.scene.effects.iter();
        let mass = |effect: &_| match effect {
            SceneEffect::MovingMass(mass) => Some(MovingMass::clone(mass)),
            _ => None,
        };
        let masses: Vec<MovingMass> = effects().filter_map(mass).collect();
        let rate = effects().find_map(|effect| match effect {
            SceneEffect::Turntable { rate } => Some(*rate),
            _ => None,
        });
        let on_plane = rate.unwrap_or(0.0);
        let one = |guide| Guided::<1>::servo(sleigh, guide).unwrap();
        let guided = effects().find(|effect| matches!(effect, SceneEffect::Servo { .. } | SceneEffect::Tracer { .. }));
        match guided {
            Some(SceneEffect::Servo { speed: Some(speed), turn_rate: Some(turn_rate) }) => {
                let body = Guided::<2>::servo(sleigh, speed.clone(), turn_rate.clone()).unwrap();
                self.of(body.on_turntable(on_plane).unwrap().carrying(masses))
            }
            Some(SceneEffect::Servo { speed: Some(speed), .. }) => {
                self.of(one(Guide::Speed(speed.clone())).on_turntable(on_plane).unwrap().carrying(masses))
            }
            Some(SceneEffect::Servo { turn_rate: Some(rate), .. }) => {
                self.of(one(Guide::TurnRate(rate.clone())).on_turntable(on_plane).unwrap().carrying(masses))
            }
            Some(SceneEffect::Tracer { path }) => {
                let body = Guided::<2>::tracer(sleigh, path.clone()).unwrap();
                self.of(body.on_turntable(on_plane).unwrap().carrying(masses))
            }
            _ if rate.is_none() && masses.is_empty() => self.of(sleigh),
            _ => self.of(Guided::turntable(sleigh, on_plane).unwrap().carrying(masses)),
        }
    }

    /// The body with its rotor, if it has one.
    fn of<B, const M: usize>(self, body: B) -> [Vec<f64>; 2]
    where
        Laden<B>: System<3, M> + Piecewise,
        Laden<Flywheel<B>>: System<4, M> + Piecewise,
    {
        let acting = |effect: &_| if let SceneEffect::Acting(effect) = effect { Some(effect.clone()) } else { None };
        let effects = self.scene.effects.iter().filter_map(acting).collect();
        let rotor = self.scene.effects.iter().find_map(|effect| match effect {
            SceneEffect::Flywheel(Rotor { inertia, torque, .. }) => Some((*inertia, torque.clone())),
            _ => None,
        });
        match rotor {
            Some((inertia, torque)) => {
                self.with::<_, 4, M>(&laden(Flywheel::new(body, inertia, torque).unwrap(), effects))
            }
            None => self.with::<_, 3, M>(&laden(body, effects)),
        }
    }

    fn with<Sys, const N: usize, const M: usize>(mut self, system: &Sys) -> [Vec<f64>; 2]
    where
        Sys: System<N, M> + Piecewise,
    {
        let start = (self.start.0.try_into().unwrap(), self.start.1.try_into().unwrap());
        let state = run::<_, N, M>(system, &mut self.method, &self.schedule, start, ());
        [state.unwrapped().to_vec(), state.v().to_vec()]
    }
}
