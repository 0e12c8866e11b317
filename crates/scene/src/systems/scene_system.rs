use super::power::{self, SceneBody, SceneEffects};
use super::{Column, EffectPower, SleighFamily, columns};
use assembly::parts::Train;
use dla::{CompiledShape, Mechanism, Node, OwnMethods, ParametrisedMechanism, Shapes, Stepper, row};
use lagrangian::{Piecewise, System, With};
use serde::Serialize;
use sleigh::closed::ClosedForm;
use sleigh::effects::{AnyEffect, EffectList};
use sleigh::{ClosedMap, Flywheel, Guided, Sleigh, SleighError, SleighState, TimeFunction};

/// A system that answers in the words of a scene.
///
/// Configurations, velocities and multipliers are lists as long as its mechanism has coordinates and constraints; missing numbers count
/// as NaN.
pub trait SceneSystem: Send + Sync {
    /// The system for runs, with its own integrators: a closed form for a sleigh, free or with forces, or with a rotor on a free bearing; a
    /// series for a sleigh that is free, in a round well, or under a constant thrust or torque.
    fn mechanism(&self) -> Box<dyn Mechanism + '_>;

    /// The system as a member of a family; `None` if the family has another number of coordinates, or velocities are imposed.
    fn member<'a>(&'a self, family: &'a SleighFamily) -> Option<Box<dyn ParametrisedMechanism + 'a>>;

    /// Place, heading and admissible velocities of the sleigh.
    fn sleigh_state(&self, q: &[f64], v: &[f64]) -> SleighState;

    /// The centre of mass (m).
    fn centre(&self, q: &[f64]) -> [f64; 2];

    /// Angle (rad) and rate (rad/s) of the rotor relative to the body, if there is a rotor.
    fn rotor(&self, q: &[f64], v: &[f64]) -> Option<[f64; 2]>;

    /// The power of each effect that has power, if the constraints have the multipliers `lambda`.
    fn powers(&self, t: f64, q: &[f64], v: &[f64], lambda: &[f64]) -> Vec<EffectPower>;

    /// The smooth piece that holds at the time `t` (s), continued to all times.
    fn scene_piece(&self, t: f64) -> Box<dyn SceneSystem + '_>;

    /// The columns of a trajectory that begins at this node.
    fn columns(&self, first: &Node) -> Vec<Column> {
        let rotor = self.rotor(&first.q, &first.v).is_some();
        // Of powers the names are asked for.
        columns::of_sleigh(rotor, &self.powers(first.t, &first.q, &first.v, &[]))
    }

    /// The numbers of a node, one for each of the [`columns`](Self::columns).
    fn row(&self, node: &Node) -> Vec<f64> {
        // They are those of the smooth piece that begins there.
        columns::row_of_sleigh(&*self.scene_piece(node.t), node)
    }

    /// The train, if blades follow the sleigh.
    fn train(&self) -> Option<&Train> {
        None
    }

    /// Whether velocities are imposed, so that the blade is not the only constraint.
    fn imposes_velocities(&self) -> bool {
        self.mechanism().size().m > 1
    }
}

/// A system of a shape: three coordinates or four, with a rotor; one constraint, the blade, or more, where velocities are imposed.
struct Shaped<S, const N: usize, const M: usize>(S);

impl<B, E, const N: usize, const M: usize> SceneSystem for Shaped<With<B, E>, N, M>
where
    With<B, E>: System<N, M> + Piecewise + Send + Sync,
    B: SceneBody<N, M>,
    E: SceneEffects<B, N>,
    Shapes: CompiledShape<N, M>,
{
    fn mechanism(&self) -> Box<dyn Mechanism + '_> {
        Shapes::mechanism(&self.0, self)
    }

    fn member<'a>(&'a self, family: &'a SleighFamily) -> Option<Box<dyn ParametrisedMechanism + 'a>> {
        // Other shapes cost no code.
        if const { M > 1 } {
            return None;
        }
        (family.coordinates() == N).then(|| Shapes::member(&self.0, self, family, family.values()))
    }

    fn sleigh_state(&self, q: &[f64], v: &[f64]) -> SleighState {
        SleighState::from_coordinates(&row(q), &row(v))
    }

    fn centre(&self, q: &[f64]) -> [f64; 2] {
        self.0.body.centre(&row::<N>(q))
    }

    fn rotor(&self, q: &[f64], v: &[f64]) -> Option<[f64; 2]> {
        (N == 4).then(|| [row::<N>(q)[N - 1], row::<N>(v)[N - 1]])
    }

    fn powers(&self, t: f64, q: &[f64], v: &[f64], lambda: &[f64]) -> Vec<EffectPower> {
        power::of::<_, _, N, M>(&self.0, t, &row(q), &row(v), &row(lambda))
    }

    fn scene_piece(&self, t: f64) -> Box<dyn SceneSystem + '_> {
        Box::new(Shaped::<_, N, M>(self.0.piece(t)))
    }
}

impl<B, E, const N: usize, const M: usize> OwnMethods<N, M> for Shaped<With<B, E>, N, M>
where
    With<B, E>: System<N, M> + Piecewise,
    B: SceneBody<N, M>,
    E: SceneEffects<B, N>,
{
    fn closed_map<'a>(&'a self, t: f64, general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        if self.0.has_closed_form() { Box::new(ClosedMap::backed_by(self.0.piece(t), general)) } else { general }
    }

    fn series(&self, t: f64, tolerance: f64) -> Option<Stepper<'_, N, M>> {
        let With { body, effects } = self.0.piece(t);
        body.series(effects.in_own_axes(body.sleigh())?, tolerance)
    }
}

/// A system with its start.
pub struct Started {
    /// The system.
    pub system: Box<dyn SceneSystem>,
    /// Configuration at the start.
    pub q: Vec<f64>,
    /// Velocity at the start.
    pub v: Vec<f64>,
}

impl std::fmt::Debug for Started {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Started").field("q", &self.q).field("v", &self.v).finish_non_exhaustive()
    }
}

/// A sleigh, with the velocities imposed on it.
#[derive(Debug, Clone)]
pub(crate) enum Guiding {
    /// No velocity is imposed, and the sleigh carries nothing.
    None(Sleigh),
    /// No velocity is imposed; its plane turns, or it carries masses that are moved.
    Zero(Guided<0>),
    /// One velocity is imposed.
    One(Guided<1>),
    /// Two velocities are imposed.
    Two(Guided<2>),
}

/// A rotor on a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rotor {
    /// Its inertia (kg m^2).
    pub inertia: f64,
    /// Its rate relative to the body at the start (rad/s).
    #[serde(rename = "rotor_rate")]
    pub rate: f64,
    /// The torque of its motor (N m), if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<TimeFunction>,
}

/// The system of a body, a rotor and effects, with its start. This function alone chooses the type.
///
/// A sleigh without effects, with a rotor or without, has a type of its own, since its steps are shorter than a look at an empty list. Any
/// other body has a list of effects. Imposed velocities replace the velocities of `start`.
///
/// # Errors
/// [`SleighError`] if the rotor has impossible parameters.
pub(crate) fn system(
    body: Guiding,
    rotor: Option<Rotor>,
    effects: Vec<AnyEffect>,
    start: &SleighState,
) -> Result<Started, SleighError> {
    let list = EffectList::from;
    match body {
        Guiding::None(sleigh) if effects.is_empty() => with_rotor(sleigh, rotor, (), start),
        Guiding::None(sleigh) => with_rotor(sleigh, rotor, list(effects), start),
        Guiding::Zero(body) => with_rotor(body, rotor, list(effects), start),
        Guiding::One(body) => with_rotor(body, rotor, list(effects), start),
        Guiding::Two(body) => with_rotor(body, rotor, list(effects), start),
    }
}

/// Adds the rotor, if there is one, and what acts on the body.
fn with_rotor<B, E, const M: usize>(
    body: B,
    rotor: Option<Rotor>,
    effects: E,
    start: &SleighState,
) -> Result<Started, SleighError>
where
    B: SceneBody<3, M> + Piecewise + Clone + Send + Sync + 'static,
    E: SceneEffects<B, 3> + SceneEffects<Flywheel<B>, 4> + Piecewise + Send + Sync + 'static,
    Shapes: CompiledShape<3, M> + CompiledShape<4, M>,
{
    let (q, v) = start.to_coordinates();
    Ok(match rotor {
        Some(Rotor { inertia, rate, torque }) => {
            let body = Flywheel::new(body, inertia, torque)?;
            let (q, v) = (vec![q[0], q[1], q[2], 0.0], vec![v[0], v[1], v[2], rate]);
            started(Box::new(Shaped::<_, 4, M>(With { body, effects })), q, v)
        }
        None => started(Box::new(Shaped::<_, 3, M>(With { body, effects })), q.to_vec(), v.to_vec()),
    })
}

/// The system with the admissible velocity that has the quasi-velocities of the given one.
fn started(system: Box<dyn SceneSystem>, q: Vec<f64>, v: Vec<f64>) -> Started {
    let admissible = {
        let whole = system.mechanism();
        let first = whole.smooth_piece(0.0);
        let free = whole.size().m == 1 && !first.is_driven(0.0, &q);
        let quasi = || first.velocity_of(0.0, &q, &first.quasi_velocities(0.0, &q, &v)?);
        if free { None } else { quasi().ok() }
    };
    Started { system, v: admissible.unwrap_or(v), q }
}
