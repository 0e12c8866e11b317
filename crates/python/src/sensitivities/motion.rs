use super::{Asked, BLOCK, SensitivityRows, chosen, failed};
use cli::{Refusal, ShownToCaller};
use dla::{Node, Tangent, Variation, View};
use harness::{Moving, ParametrisedMechanics, Request, sensitivities};
use lagrangian::{Gradients, Scalar, Seeded};
use scene::Built;

/// A state with its derivatives in the directions of a block, the parameters with theirs.
pub(super) struct Carried<const N: usize> {
    pub(super) t: f64,
    pub(super) q: [Seeded; N],
    pub(super) v: [Seeded; N],
    pub(super) p: [Seeded; BLOCK],
}

impl<const N: usize> Carried<N> {
    fn new(at: &Moving<N, BLOCK>, parameters: &[f64; BLOCK]) -> Self {
        let seeded = |x: f64, along: &dyn Fn(&Tangent<N, BLOCK>) -> f64| {
            let mut number = Seeded::constant(x);
            number.eps.iter_mut().zip(&at.tangents).for_each(|(eps, tangent)| *eps = along(tangent));
            number
        };
        let (q, v) = (at.state.unwrapped(), *at.state.v());
        Self {
            t: at.t,
            q: std::array::from_fn(|i| seeded(q[i], &|tangent| tangent.state.q[i])),
            v: std::array::from_fn(|i| seeded(v[i], &|tangent| tangent.state.v[i])),
            p: std::array::from_fn(|k| seeded(parameters[k], &|tangent| tangent.parameters[k])),
        }
    }

    /// The energy `v . L_v - L`.
    pub(super) fn energy<const M: usize>(&self, model: &dyn Gradients<N, M>) -> Seeded {
        let t = Seeded::constant(self.t);
        let momentum = model.momentum(t, &self.q, &self.v);
        let twice = self.v.iter().zip(momentum).fold(Seeded::zero(), |sum, (v, p)| sum + *v * p);
        twice - model.lagrangian(t, &self.q, &self.v)
    }
}

/// The motion of one scene, in a block of keys.
pub(super) struct DifferentiatedMotion<'a, const N: usize, const M: usize> {
    pub(super) system: Built<'a, N, M>,
    pub(super) family: &'a dyn ParametrisedMechanics<N, M, BLOCK>,
    pub(super) parameters: [f64; BLOCK],
    pub(super) q: [f64; N],
    pub(super) v: [f64; N],
}

impl<const N: usize, const M: usize> DifferentiatedMotion<'_, N, M> {
    /// The rows of a run: `start` is how it begins in each of the keys, `told` gives all numbers of a state that have derivatives, by the
    /// names `known`, the first `usual` of which are told where no columns are asked for.
    pub(super) fn rows(
        &self,
        &Asked { method, schedule, request, caller }: &Asked<'_>,
        start: Vec<Tangent<N, BLOCK>>,
        (known, usual): (&[String], usize),
        told: impl Fn(&Carried<N>) -> Vec<Seeded>,
    ) -> Result<SensitivityRows, Refusal> {
        let chosen = chosen(&request.columns, known, usual)?;
        let run = Request { schedule, q: self.q, v: self.v, samples: 1 };
        let mut shown = ShownToCaller::new(caller, method.info().name, schedule.steps);
        let (family, system) = ((self.family, self.parameters), (&*self.system, (&self.system).into()));
        let made = sensitivities(system, method, &run, &request.times, family, start, &mut shown);
        let made = made.map_err(|error| failed(&error))?;
        let numbers = made.iter().flat_map(|at| {
            let told = told(&Carried::new(at, &self.parameters));
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
    fn node(&self, at: &Moving<N, BLOCK>) -> Node<N, M> {
        let piece = self.system.smooth_piece(at.t);
        let view = View { system: &*piece, k: 0, t: at.t, state: &at.state };
        let (q, v, energy, constraint) = (at.state.unwrapped(), *at.state.v(), view.energy(), view.constraint());
        Node { k: 0, t: at.t, q, v, energy, work: f64::NAN, constraint, multipliers: None }
    }
}

/// The start does not move, and one parameter does.
pub(super) fn of_parameter<const N: usize>(place: usize) -> Tangent<N, BLOCK> {
    Tangent { state: Variation::ZERO, parameters: std::array::from_fn(|k| f64::from(u8::from(k == place))) }
}

/// The parameters stay, and the start moves.
pub(super) fn of_start<const N: usize>(q: [f64; N], v: [f64; N]) -> Tangent<N, BLOCK> {
    Tangent { state: Variation { q, v }, parameters: [0.0; BLOCK] }
}
