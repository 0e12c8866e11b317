use crate::{Kind, Method};
use dla::{Checkpoint, CheckpointError, State, View};
use lagrangian::linear::{larger, largest};
use lagrangian::{Alpha, DiscreteConstraint, Midpoint, System, Trapezoid};

/// How far a run is from its constraints besides at the velocities of its nodes: over each step, and in the positions.
#[derive(Debug)]
pub(crate) struct Slip<const N: usize> {
    rule: Rule,
    h: f64,
    /// The time and the state at the node before.
    before: Option<(f64, State<N>)>,
    step: f64,
    /// The functions of the positions at the start, as many as there are, and how far they have gone.
    leaf: Vec<f64>,
    distance: f64,
}

/// The rule of a discrete constraint.
#[derive(Debug, Clone, Copy)]
enum Rule {
    Midpoint,
    Trapezoid,
    Alpha(Alpha),
}

impl<const N: usize> Slip<N> {
    pub(crate) fn new(method: &Method, h: f64) -> Self {
        let rule = match method.info().kind {
            Kind::DlaTrapezoid => Rule::Trapezoid,
            Kind::DlaAlpha => Rule::Alpha(method.alpha()),
            _ => Rule::Midpoint,
        };
        Self { rule, h, before: None, step: 0.0, leaf: Vec::new(), distance: 0.0 }
    }

    pub(crate) fn step_max(&self) -> f64 {
        self.step
    }

    pub(crate) fn leaf_max(&self) -> Option<f64> {
        (!self.leaf.is_empty()).then_some(self.distance)
    }

    pub(crate) fn start<Sys: System<N, M>, const M: usize>(&mut self, node: &View<'_, Sys, N>) {
        self.leaf = functions(node).collect();
        self.before = Some((node.t, *node.state));
    }

    pub(crate) fn resume<Sys>(&mut self, node: &View<'_, Sys, N>) {
        self.before = Some((node.t, *node.state));
    }

    pub(crate) fn step<Sys: System<N, M>, const M: usize>(&mut self, node: &View<'_, Sys, N>) {
        if let Some((t, before)) = &self.before {
            let v = node.state.moved_since(before).map(|moved| moved / self.h);
            let (system, t, h, q) = (node.system, *t, self.h, before.q());
            let residual: [f64; M] = match self.rule {
                Rule::Midpoint => Midpoint.residual(system, t, h, q, &v),
                Rule::Trapezoid => Trapezoid.residual(system, t, h, q, &v),
                Rule::Alpha(alpha) => alpha.residual(system, t, h, q, &v),
            };
            self.step = larger(self.step, largest(&residual));
        }
        for (now, start) in functions(node).zip(&self.leaf) {
            self.distance = larger(self.distance, (now - start).abs());
        }
        self.before = Some((node.t, *node.state));
    }

    /// Writes it to a checkpoint; the node before is the state there.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("slip", &[self.step, self.distance]);
        checkpoint.put("leaf", &self.leaf);
    }

    /// The same with what [`save`](Self::save) wrote.
    pub(crate) fn load(&self, checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [step, distance] = checkpoint.get("slip")?;
        Ok(Self { rule: self.rule, h: self.h, before: None, step, leaf: checkpoint.list("leaf")?, distance })
    }
}

/// The functions of the positions whose rates are constraints.
fn functions<Sys: System<N, M>, const N: usize, const M: usize>(
    node: &View<'_, Sys, N>,
) -> impl Iterator<Item = f64> + use<Sys, N, M> {
    node.system.holonomic(node.t, &node.state.unwrapped()).into_iter().flatten().flatten()
}
