use dla::{Observer, StepReport, View};
use lagrangian::{MomentumBalance, System, VectorField, momentum_balance};
use std::ops::ControlFlow;

/// Watches the momentum along a field on a run, and the momentum equation.
#[derive(Debug, Clone)]
pub struct MomentumMeter<'a, Sys, X> {
    system: &'a Sys,
    field: X,
    first: f64,
    last: Option<(f64, f64)>,
    gained: f64,
    drift: f64,
    defect: f64,
}

impl<'a, Sys, X> MomentumMeter<'a, Sys, X> {
    /// For the momentum of this system along this field.
    #[must_use]
    pub fn new(system: &'a Sys, field: X) -> Self {
        Self { system, field, first: 0.0, last: None, gained: 0.0, drift: 0.0, defect: 0.0 }
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

    fn balance<const N: usize, const M: usize>(&self, node: &View<'_, N, M>) -> (f64, f64)
    where
        Sys: System<N, M>,
        X: VectorField<N>,
    {
        let balance = momentum_balance(self.system, node.t, node.state.q(), node.state.v(), &self.field);
        balance.map_or((f64::NAN, f64::NAN), |balance: MomentumBalance<M>| (balance.momentum, balance.rate()))
    }
}

impl<Sys, X, const N: usize, const M: usize> Observer<N, M> for MomentumMeter<'_, Sys, X>
where
    Sys: System<N, M>,
    X: VectorField<N>,
{
    fn start(&mut self, node: &View<'_, N, M>) {
        let (momentum, rate) = self.balance(node);
        self.first = momentum;
        self.last = Some((node.t, rate));
    }

    fn resume(&mut self, node: &View<'_, N, M>) {
        self.last = Some((node.t, self.balance(node).1));
    }

    fn step(&mut self, node: &View<'_, N, M>, _report: &StepReport<M>) -> ControlFlow<()> {
        let (momentum, rate) = self.balance(node);
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
