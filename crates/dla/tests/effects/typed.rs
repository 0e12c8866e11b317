//! Runs of the systems of scenes in their types, as a method of a given form needs them.

use crate::effects::tools::{Laden, laden, run};
use dla::{Composition, Dla, Schedule};
use lagrangian::{Piecewise, System};
use scene::{AnyEffect, Interpolation, Scene, SceneEffect, TimeSpec};
use sleigh::effects::{Bowl, Drag, EggCrate, Friction, Hills, MovingMass, QuadraticDrag, Slope, Thrust, Torque};
use sleigh::{Flywheel, Formula, Guide, Guided, Ramp, Table, TimeFunction};

fn function(spec: &TimeSpec) -> TimeFunction {
    match spec {
        TimeSpec::Constant(value) => TimeFunction::Constant(*value),
        TimeSpec::Sine { amplitude, frequency, phase } => {
            TimeFunction::Sine { amplitude: *amplitude, frequency: *frequency, phase: *phase }
        }
        TimeSpec::Table { times, values, interpolation: Interpolation::Steps } => {
            TimeFunction::Table(Table::new(times.clone(), values.clone()).unwrap())
        }
        TimeSpec::Table { times, values, interpolation: Interpolation::Linear } => {
            TimeFunction::Ramp(Ramp::new(times.clone(), values.clone()).unwrap())
        }
        TimeSpec::Formula(text) => TimeFunction::Formula(Formula::new(text).unwrap()),
    }
}

/// An effect that acts by a potential or a force.
fn acting(effect: &SceneEffect) -> Option<AnyEffect> {
    Some(match effect {
        SceneEffect::Slope { gravity } => AnyEffect::Slope(Slope::new(*gravity).unwrap()),
        SceneEffect::Bowl { stiffness, center } => AnyEffect::Bowl(Bowl::new(*stiffness, *center).unwrap()),
        SceneEffect::EggCrate { height, wave_number } => {
            AnyEffect::EggCrate(EggCrate::new(*height, *wave_number).unwrap())
        }
        SceneEffect::Hills { hills } => {
            AnyEffect::Hills(Hills::new(hills.iter().copied().map(Into::into).collect()).unwrap())
        }
        SceneEffect::Drag { along, turning } => AnyEffect::Drag(Drag::new(*along, *turning).unwrap()),
        SceneEffect::QuadraticDrag { along, turning } => {
            AnyEffect::QuadraticDrag(QuadraticDrag::new(*along, *turning).unwrap())
        }
        SceneEffect::Friction { along, smoothing, turning, turning_smoothing } => {
            AnyEffect::Friction(Friction::new(*along, *smoothing, *turning, *turning_smoothing).unwrap())
        }
        SceneEffect::Thrust { force } => AnyEffect::Thrust(Thrust::new(function(force)).unwrap()),
        SceneEffect::Torque { torque } => AnyEffect::Torque(Torque::new(function(torque)).unwrap()),
        _ => return None,
    })
}

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
            SceneEffect::MovingMass { mass, x, y } => Some(MovingMass::new(*mass, function(x), function(y)).unwrap()),
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
                let body = Guided::<2>::servo(sleigh, function(speed), function(turn_rate)).unwrap();
                self.of(body.on_turntable(on_plane).unwrap().carrying(masses))
            }
            Some(SceneEffect::Servo { speed: Some(speed), .. }) => {
                self.of(one(Guide::Speed(function(speed))).on_turntable(on_plane).unwrap().carrying(masses))
            }
            Some(SceneEffect::Servo { turn_rate: Some(rate), .. }) => {
                self.of(one(Guide::TurnRate(function(rate))).on_turntable(on_plane).unwrap().carrying(masses))
            }
            Some(SceneEffect::Tracer { path }) => {
                let body = Guided::<2>::tracer(sleigh, path.build().unwrap()).unwrap();
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
        let effects = self.scene.effects.iter().filter_map(acting).collect();
        let rotor = self.scene.effects.iter().find_map(|effect| match effect {
            SceneEffect::Flywheel { inertia, torque, .. } => Some((*inertia, torque.as_ref().map(function))),
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
