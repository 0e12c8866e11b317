use crate::hermite::Hermite;
use crate::{Checkpoint, CheckpointError, MeanPower, Observer, State, StepReport, View, power};
use lagrangian::quadrature::gauss_legendre;
use lagrangian::{PowerSources, from_fn, two_sum};
use std::ops::ControlFlow;

/// The work done on a system since the start of a run (J), so that `E(t) - E(0) - work` is the error of the energy.
///
/// Where a method reports the work of its step, that counts: a method of high order, or with steps of its own, integrates the
/// [power](crate::power()) at its own stages ([`OneStep::measure_work`](crate::OneStep::measure_work)). Elsewhere, of methods up to order 6, the
/// power is integrated with four Gauss nodes along the polynomial of degree five that has the positions, velocities and
/// accelerations of both ends of the step, which is of order 6; where an end has no accelerations, along that of degree three. A system
/// without any power costs no acceleration, and one that says so of itself ([`PowerSources`]) no evaluation.
/// An impulse, where an imposed velocity jumps, does the work by which it changes the energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Work<const N: usize> {
    total: f64,
    rest: f64,
    /// Time, place and velocity at the node before.
    before: Option<(f64, [f64; N], [f64; N])>,
    /// What was known at the last node, while a step is made in parts.
    at_node: Option<KnownWork<N>>,
    /// What may do work on the piece of the system.
    sources: PowerSources,
    nodes: [f64; 4],
    weights: [f64; 4],
}

/// The sum with its rest; time, place and velocity.
type KnownWork<const N: usize> = ([f64; 2], Option<(f64, [f64; N], [f64; N])>);

impl<const N: usize> Default for Work<N> {
    fn default() -> Self {
        let (nodes, weights) = gauss_legendre();
        Self { total: 0.0, rest: 0.0, before: None, at_node: None, sources: PowerSources::ALL, nodes, weights }
    }
}

impl<const N: usize> Work<N> {
    /// The work so far (J).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Adds with compensation.
    fn add(&mut self, work: f64) {
        (self.total, self.rest) = two_sum(self.total, work + self.rest);
    }

    /// Writes the work to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("work", &[self.total, self.rest]);
    }

    /// The work that [`save`](Self::save) wrote, to go on from the state of the same checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError`] where the checkpoint has none.
    pub fn load(checkpoint: &Checkpoint, t: f64, state: &State<N>) -> Result<Self, CheckpointError> {
        let [total, rest] = checkpoint.get("work")?;
        Ok(Self { total, rest, before: Some((t, state.unwrapped(), *state.v())), ..Self::default() })
    }

    fn remember<const M: usize>(&mut self, node: &View<'_, N, M>) {
        self.before = Some((node.t, node.state.unwrapped(), *node.state.v()));
    }

    /// Adds the work over the step that ends at the node.
    fn over<const M: usize>(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) {
        let work = report.work.unwrap_or_else(|| self.over_step(node));
        if work != 0.0 {
            self.add(work);
        }
        self.remember(node);
    }

    /// The work over the step that ends at the node.
    fn over_step<const M: usize>(&self, node: &View<'_, N, M>) -> f64 {
        let sources = self.sources;
        let Some((t0, q0, v0)) = self.before.filter(|_| sources.any()) else { return 0.0 };
        let (system, q1, v1) = (node.system, node.state.unwrapped(), *node.state.v());
        let h = node.t - t0;
        let time = |c: f64| t0 + c * h;
        let moves = |t: f64, q: &[f64; N]| system.constraint(t, q).1.iter().any(|b| *b != 0.0);
        let mean = |c: f64| from_fn::<f64, N, _>(|i| q0[i] + c * (q1[i] - q0[i]));
        let powered = sources.constraints && (moves(t0, &q0) || moves(node.t, &q1))
            || sources.forces && system.force(t0, &q0, &v0).is_some()
            || sources.time && self.nodes.iter().any(|c| system.lagrangian_power(time(*c), &mean(*c), &v1) != 0.0);
        if !powered {
            return 0.0;
        }
        // Those of the cubic where an end has none.
        let acceleration =
            |t: f64, q: &[f64; N], v: &[f64; N], other: &[f64; N], side: f64| match system.motion(t, q, v) {
                Ok(motion) => motion.acceleration,
                Err(_) => from_fn(|i| side * (6.0 * (q1[i] - q0[i]) / h - 4.0 * v[i] - 2.0 * other[i]) / h),
            };
        let (a0, a1) = (acceleration(t0, &q0, &v0, &v1, 1.0), acceleration(node.t, &q1, &v1, &v0, -1.0));
        let hermite = Hermite { t0, h, q0, v0, a0, q1, v1, a1 };
        let mut mean = MeanPower::default();
        for (&c, &weight) in self.nodes.iter().zip(&self.weights) {
            let (q, v) = hermite.at_part(c);
            mean.add(weight, power(system, sources, time(c), (&q, &v)));
        }
        h * mean.mean()
    }
}

impl<const N: usize, const M: usize> Observer<N, M> for Work<N> {
    fn start(&mut self, node: &View<'_, N, M>) {
        self.sources = node.system.power_sources();
        self.remember(node);
    }

    #[allow(clippy::float_cmp, reason = "a velocity that has not jumped is the same to the bit")]
    fn resume(&mut self, node: &View<'_, N, M>) {
        if let Some((_, _, v)) = self.before
            && v != *node.state.v()
        {
            let jump = node.energy() - node.system.energy(node.t, node.state.q(), &v);
            self.add(jump);
        }
        self.sources = node.system.power_sources();
        self.remember(node);
    }

    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        // The parts of a divided step have led to this very node; but for an event, which ends it between two.
        let led = self.at_node.take().is_some() && self.before.is_some_and(|(t, ..)| t.to_bits() == node.t.to_bits());
        if !led {
            self.over(node, report);
        }
        ControlFlow::Continue(())
    }

    fn measures_work(&self) -> bool {
        true
    }

    fn part(&mut self, end: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        self.at_node = self.at_node.or(Some(([self.total, self.rest], self.before)));
        self.over(end, report);
        ControlFlow::Continue(())
    }

    /// A step that was given up has done nothing.
    fn end(&mut self, _node: &View<'_, N, M>) {
        if let Some(([total, rest], before)) = self.at_node.take() {
            (self.total, self.rest, self.before) = (total, rest, before);
        }
    }
}
