use crate::Method;
use dla::{Checkpoint, CheckpointError, Discretisation, Rules, State, View};
use lagrangian::linear::{larger, largest};

/// The constraint residuals of a run besides those of the velocities at its nodes: of the discrete constraint over each step, and of
/// constraints on positions.
#[derive(Debug)]
pub(crate) struct Slip<const N: usize> {
    rules: Rules,
    h: f64,
    /// The time and the state at the node before.
    before: Option<(f64, State<N>)>,
    step: f64,
    /// The largest of the functions of the positions, where there are any.
    leaf: Option<f64>,
}

impl<const N: usize> Slip<N> {
    pub(crate) fn new(method: &Method, h: f64) -> Self {
        Self { rules: Rules::new(method.rule(), method.rule()), h, before: None, step: 0.0, leaf: None }
    }

    pub(crate) fn step_max(&self) -> f64 {
        self.step
    }

    pub(crate) fn leaf_max(&self) -> Option<f64> {
        self.leaf
    }

    pub(crate) fn start<const M: usize>(&mut self, node: &View<'_, N, M>) {
        self.look(node);
        self.before = Some((node.t, *node.state));
    }

    pub(crate) fn resume<const M: usize>(&mut self, node: &View<'_, N, M>) {
        self.before = Some((node.t, *node.state));
    }

    pub(crate) fn step<const M: usize>(&mut self, node: &View<'_, N, M>) {
        // A piece between jumps may have a step of its own.
        let since = self.before.as_ref().map_or(self.h, |(t, _)| node.t - t);
        let own = (since - self.h).abs() > 1e-6 * self.h.abs();
        self.over(node, if own { since } else { self.h });
    }

    /// A part of a step.
    pub(crate) fn part<const M: usize>(&mut self, node: &View<'_, N, M>) {
        // Sub-steps so short that the time does not change show nothing.
        match self.before.as_ref().map(|(t, _)| node.t - t) {
            Some(h) if h != 0.0 => self.over(node, h),
            _ => self.resume(node),
        }
    }

    fn over<const M: usize>(&mut self, node: &View<'_, N, M>, h: f64) {
        if let Some((t, before)) = &self.before {
            let v = node.state.moved_since(before).map(|moved| moved / h);
            let residual: [f64; M] = self.rules.residual(node.system, (*t, h), before.q(), &v);
            self.step = larger(self.step, largest(&residual));
        }
        self.look(node);
        self.before = Some((node.t, *node.state));
    }

    /// At the functions `g(q, t)` whose rates are constraints.
    fn look<const M: usize>(&mut self, node: &View<'_, N, M>) {
        let functions = node.system.positions(node.t, &node.state.unwrapped());
        for g in functions.into_iter().flatten().flatten() {
            self.leaf = Some(larger(self.leaf.unwrap_or(0.0), g.abs()));
        }
    }

    /// Writes it to a checkpoint; the node before is the state there.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("slip", &[self.step]);
        checkpoint.put("leaf", self.leaf.as_slice());
    }

    /// The same with what [`save`](Self::save) wrote.
    pub(crate) fn load(&self, checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [step] = checkpoint.get("slip")?;
        let leaf = checkpoint.list("leaf")?.first().copied();
        Ok(Self { rules: self.rules, h: self.h, before: None, step, leaf })
    }
}
