use crate::power::{self, SceneBody, SceneEffects};
use crate::{AnyEffect, Column, EffectList, EffectPower, columns};
use dla::{FullMechanics, Node, Stepper};
use lagrangian::{Piecewise, System, With};
use sleigh::closed::ClosedForm;
use sleigh::{ClosedMap, Flywheel, Guided, Sleigh, SleighError, SleighState, TimeFunction};

/// A system that answers in the words of a scene.
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

    /// The columns of a trajectory that begins at this node.
    fn columns(&self, first: &Node<N, M>) -> Vec<Column> {
        columns::of_sleigh(self, first)
    }

    /// The numbers of a node, one for each of the [`columns`](Self::columns).
    fn row(&self, node: &Node<N, M>) -> Vec<f64> {
        columns::row_of_sleigh(self, node)
    }

    /// As [`closed_map`](dla::OwnMethods::closed_map): where the system is a sleigh, free or with forces, or has a rotor on a free bearing.
    fn closed_map<'a>(&'a self, _t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        general
    }

    /// As [`series`](dla::OwnMethods::series): where the system is a sleigh that is free, in a round well, or under a constant thrust or torque.
    fn series(&self, _t: f64, _tolerance: f64) -> Option<Stepper<'_, N, M>> {
        None
    }
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

    fn closed_map<'a>(&'a self, t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        if self.has_closed_form() { Box::new(ClosedMap::backed_by(self.piece(t), general)) } else { general }
    }

    fn series(&self, t: f64, tolerance: f64) -> Option<Stepper<'_, N, M>> {
        let With { body, effects } = self.piece(t);
        body.series(effects.in_own_axes(&body)?, tolerance)
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

/// A sleigh with what imposes velocities on it.
#[derive(Debug, Clone)]
pub enum Guiding {
    /// Nothing does, and it carries nothing.
    None(Sleigh),
    /// No velocity is imposed; its plane turns, or it carries masses that are moved.
    Zero(Guided<0>),
    /// One velocity is imposed.
    One(Guided<1>),
    /// Two are.
    Two(Guided<2>),
}

/// A rotor on a body.
#[derive(Debug, Clone)]
pub struct Rotor {
    /// Its inertia (kg m^2).
    pub inertia: f64,
    /// Its rate relative to the body at the start (rad/s).
    pub rate: f64,
    /// The torque of its motor (N m), if it has one.
    pub torque: Option<TimeFunction>,
}

/// The system of a body, a rotor and effects, and its start: the one place where a type is chosen.
///
/// A sleigh on which nothing acts, with a rotor or without, is a type of its own, since its steps are shorter than a look at an empty
/// list; any other body has a list of what acts on it. A velocity that is imposed replaces that of the start.
///
/// # Errors
/// [`SleighError`] where the rotor has impossible parameters.
pub fn system(
    body: Guiding,
    rotor: Option<Rotor>,
    effects: Vec<AnyEffect>,
    start: &SleighState,
) -> Result<AnySystem, SleighError> {
    let list = EffectList::from;
    match body {
        Guiding::None(sleigh) if effects.is_empty() => {
            with_rotor(sleigh, rotor, (), start, AnySystem::Sleigh, AnySystem::Rotor)
        }
        Guiding::None(sleigh) => with_rotor(sleigh, rotor, list(effects), start, AnySystem::Sleigh, AnySystem::Rotor),
        Guiding::Zero(body) => with_rotor(body, rotor, list(effects), start, AnySystem::Sleigh, AnySystem::Rotor),
        Guiding::One(body) => with_rotor(body, rotor, list(effects), start, AnySystem::One, AnySystem::RotorOne),
        Guiding::Two(body) => with_rotor(body, rotor, list(effects), start, AnySystem::Two, AnySystem::RotorTwo),
    }
}

/// Adds the rotor, if there is one, and what acts on the body.
fn with_rotor<B, E, const M: usize>(
    body: B,
    rotor: Option<Rotor>,
    effects: E,
    start: &SleighState,
    plain: fn(Started<3, M>) -> AnySystem,
    turning: fn(Started<4, M>) -> AnySystem,
) -> Result<AnySystem, SleighError>
where
    B: SceneBody<3, M> + Piecewise + Clone + Sync + 'static,
    E: SceneEffects<B, 3> + SceneEffects<Flywheel<B>, 4> + Piecewise + Sync + 'static,
{
    let (q, v) = start.to_coordinates();
    Ok(match rotor {
        Some(Rotor { inertia, rate, torque }) => {
            let body = Flywheel::new(body, inertia, torque)?;
            let (q, v) = ([q[0], q[1], q[2], 0.0], [v[0], v[1], v[2], rate]);
            turning(started(Box::new(With { body, effects }), q, v))
        }
        None => plain(started(Box::new(With { body, effects }), q, v)),
    })
}

/// The system with the admissible velocity that has the quasi-velocities of the given one.
fn started<const N: usize, const M: usize>(
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
