use super::{Asked, BLOCK, SensitivityRows, chosen, failed};
use cli::{Refusal, ShownToCaller};
use dla::{AnyTangent, Node, ParametrisedMechanism, View};
use harness::{Moving, Request, sensitivities};
use lagrangian::{Scalar, Seeded};
use scene::Built;

/// A state with its derivatives in the directions of a block, the parameters with theirs.
pub(super) struct Carried<'a> {
    family: &'a dyn ParametrisedMechanism,
    pub(super) t: f64,
    pub(super) q: Vec<Seeded>,
    pub(super) v: Vec<Seeded>,
    pub(super) p: [Seeded; BLOCK],
}

impl<'a> Carried<'a> {
    fn new(family: &'a dyn ParametrisedMechanism, at: &Moving) -> Self {
        let seeded = |x: f64, i: usize, of: fn(&AnyTangent) -> &[f64]| {
            let along = |tangent: &AnyTangent| of(tangent).get(i).copied().unwrap_or(0.0);
            let mut number = Seeded::constant(x);
            number.eps.iter_mut().zip(&at.tangents).for_each(|(eps, tangent)| *eps = along(tangent));
            number
        };
        let all = |x: &[f64], of| x.iter().enumerate().map(|(i, x)| seeded(*x, i, of)).collect();
        let parameters = family.parameters();
        let value = |k: usize| parameters.get(k).copied().unwrap_or(0.0);
        Self {
            family,
            t: at.t,
            q: all(&at.state.unwrapped(), |tangent| &tangent.q),
            v: all(at.state.v(), |tangent| &tangent.v),
            p: std::array::from_fn(|k| seeded(value(k), k, |tangent| &tangent.parameters)),
        }
    }

    /// The energy `v . L_v - L`.
    pub(super) fn energy(&self) -> Seeded {
        self.family.energy(self.t, &self.q, &self.v, &self.p)
    }
}

/// The motion of one scene, in a block of keys.
pub(super) struct DifferentiatedMotion<'a> {
    pub(super) system: Built<'a>,
    pub(super) family: &'a dyn ParametrisedMechanism,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
}

impl DifferentiatedMotion<'_> {
    /// The rows of a run: `start` is how it begins in each of the keys, `told` gives all numbers of a state that have derivatives, by the
    /// names `known`, the first `usual` of which are told where no columns are asked for.
    pub(super) fn rows(
        &self,
        &Asked { method, schedule, request, caller }: &Asked<'_>,
        start: Vec<AnyTangent>,
        (known, usual): (&[String], usize),
        told: impl Fn(&Carried<'_>) -> Vec<Seeded>,
    ) -> Result<SensitivityRows, Refusal> {
        let chosen = chosen(&request.columns, known, usual)?;
        let run = Request { schedule, q: self.q.clone(), v: self.v.clone(), samples: 1 };
        let mut shown = ShownToCaller::new(caller, method.info().name, schedule.steps);
        let made = sensitivities(self.family, method, &run, &request.times, start, &mut shown);
        let made = made.map_err(|error| failed(&error))?;
        let numbers = made.iter().flat_map(|at| {
            let told = told(&Carried::new(self.family, at));
            let node = self.node(at);
            let (names, row) = (self.system.columns(&node), self.system.row(&node));
            // The number is that of the run, to the last bit.
            let number = |place: &usize| {
                let own = names.iter().position(|column| column.name == known[*place]);
                (own.map_or(told[*place].re, |own| row[own]), told[*place].eps)
            };
            chosen.iter().map(number).collect::<Vec<_>>()
        });
        Ok(SensitivityRows {
            columns: chosen.iter().map(|place| known[*place].clone()).collect(),
            times: made.iter().map(|at| at.t).collect(),
            numbers: numbers.collect(),
        })
    }

    /// A state as a node of a run.
    fn node(&self, at: &Moving) -> Node {
        let mechanism = self.system.mechanism();
        let piece = mechanism.smooth_piece(at.t);
        Node::of(&View { system: &*piece, k: 0, t: at.t, state: &at.state }, f64::NAN, None)
    }
}

/// The start does not move, and one parameter does.
pub(super) fn of_parameter(place: usize) -> AnyTangent {
    let parameters = (0..BLOCK).map(|k| f64::from(u8::from(k == place))).collect();
    AnyTangent { parameters, ..AnyTangent::default() }
}

/// The parameters stay, and the start moves.
pub(super) fn of_start(q: Vec<f64>, v: Vec<f64>) -> AnyTangent {
    AnyTangent { q, v, parameters: vec![0.0; BLOCK] }
}
