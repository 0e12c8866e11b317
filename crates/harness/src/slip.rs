use dla::{AnyState, Checkpoint, CheckpointError, Method, Rules, View};
use lagrangian::linear::larger;

/// The constraint residuals of a run besides the residuals of the velocities at its nodes: of the discrete constraint over each step, and
/// of constraints on positions.
#[derive(Debug)]
pub(crate) struct Slip {
    rules: Rules,
    h: f64,
    /// The time and the state at the node before.
    before: Option<(f64, AnyState)>,
    /// The mean velocity of a step.
    mean: Vec<f64>,
    step: f64,
    /// The largest of the functions of the positions; `None` if there are none.
    leaf: Option<f64>,
}

impl Slip {
    pub(crate) fn new(method: &Method, h: f64) -> Self {
        Self {
            rules: Rules::new(method.rule(), method.rule()),
            h,
            before: None,
            mean: Vec::new(),
            step: 0.0,
            leaf: None,
        }
    }

    pub(crate) fn step_max(&self) -> f64 {
        self.step
    }

    pub(crate) fn leaf_max(&self) -> Option<f64> {
        self.leaf
    }

    pub(crate) fn start(&mut self, node: &View<'_>) {
        // At the functions `g(q, t)` whose rates are constraints.
        if let Some(g) = node.position() {
            self.leaf = Some(larger(self.leaf.unwrap_or(0.0), g));
        }
        self.resume(node);
    }

    /// Sees a node again at the beginning of a smooth piece.
    pub(crate) fn resume(&mut self, node: &View<'_>) {
        // An unknown residual stays unknown.
        if self.step.is_nan() {
            return;
        }
        node.keep_in(&mut self.before);
    }

    pub(crate) fn step(&mut self, node: &View<'_>) {
        // A piece between jumps may have a step of its own.
        let since = self.before.as_ref().map_or(self.h, |(t, _)| node.t - t);
        let own = (since - self.h).abs() > 1e-6 * self.h.abs();
        self.over(node, if own { since } else { self.h });
    }

    /// A part of a step.
    pub(crate) fn part(&mut self, node: &View<'_>) {
        // Sub-steps so short that the time does not change show nothing.
        match self.before.as_ref().map(|(t, _)| node.t - t) {
            Some(h) if h != 0.0 => self.over(node, h),
            Some(_) => self.resume(node),
            // After a resumption with an unknown residual there is no node before.
            None => self.start(node),
        }
    }

    fn over(&mut self, node: &View<'_>, h: f64) {
        if let Some((t, before)) = self.before.as_ref().filter(|_| !self.step.is_nan()) {
            self.mean.resize(node.state.v().len(), 0.0);
            node.state.move_into(before, &mut self.mean);
            self.mean.iter_mut().for_each(|moved| *moved /= h);
            let residual = node.system.largest_step_residual(&self.rules, (*t, h), before.q(), &self.mean);
            self.step = larger(self.step, residual);
        }
        self.start(node);
    }

    /// Writes it to a checkpoint; the node before is the state there.
    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("slip", &[self.step]);
        checkpoint.put("leaf", self.leaf.as_slice());
    }

    /// A copy with the numbers that [`save`](Self::save) wrote.
    pub(crate) fn load(&self, checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [step] = checkpoint.get("slip")?;
        let leaf = checkpoint.list("leaf")?.first().copied();
        Ok(Self { rules: self.rules, h: self.h, before: None, mean: Vec::new(), step, leaf })
    }
}
