use dla::{AnyState, Observer, Report, View};
use std::ops::ControlFlow;

/// Watches the momentum along a field on a run, and the momentum equation.
#[derive(Debug, Clone)]
pub struct MomentumMeter<Balance> {
    balance: Balance,
    first: f64,
    last: Option<(f64, f64)>,
    gained: f64,
    drift: f64,
    defect: f64,
}

impl<Balance: Fn(f64, &AnyState) -> Option<[f64; 2]>> MomentumMeter<Balance> {
    /// For a momentum, which `balance` gives with its rate at a time (s) and a state: those of a
    /// [`momentum_balance`](lagrangian::momentum_balance()), and none where the equations of motion are degenerate.
    #[must_use]
    pub fn new(balance: Balance) -> Self {
        Self { balance, first: 0.0, last: None, gained: 0.0, drift: 0.0, defect: 0.0 }
    }

    /// The largest `|p.X - (p.X)(0)|` at the nodes: rounding where the momentum is conserved.
    #[must_use]
    pub fn drift(&self) -> f64 {
        self.drift
    }

    /// The largest `|p.X - (p.X)(0) - integral of its rate|`, the integral by the trapezoidal rule over the steps: of second order
    /// in the step where the momentum equation holds. Not a number where the equations of motion are degenerate at a node.
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.defect
    }

    fn at(&self, node: &View<'_>) -> [f64; 2] {
        (self.balance)(node.t, node.state).unwrap_or([f64::NAN; 2])
    }
}

impl<Balance: Fn(f64, &AnyState) -> Option<[f64; 2]>> Observer for MomentumMeter<Balance> {
    fn start(&mut self, node: &View<'_>) {
        let [momentum, rate] = self.at(node);
        self.first = momentum;
        self.last = Some((node.t, rate));
    }

    fn resume(&mut self, node: &View<'_>) {
        self.last = Some((node.t, self.at(node)[1]));
    }

    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        let [momentum, rate] = self.at(node);
        if let Some((t, before)) = self.last {
            self.gained += 0.5 * (node.t - t) * (before + rate);
        }
        self.last = Some((node.t, rate));
        let change = momentum - self.first;
        self.drift = lagrangian::linear::larger(self.drift, change.abs());
        self.defect = lagrangian::linear::larger(self.defect, (change - self.gained).abs());
        ControlFlow::Continue(())
    }
}
