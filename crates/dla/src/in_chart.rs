use crate::{Mechanics, OneStep, State, StepError, StepReport};
use lagrangian::linear::larger;
use lagrangian::{PowerSources, from_fn};

/// A method for a system whose coordinates end somewhere, as angles of an attitude do that are singular at some of them: its steps
/// are refused near there, where the method alone would go on with any error.
///
/// It is told how far a configuration is from the end, one far from it and zero there. A step is refused with
/// [`StepError::Chart`] where that is too little at its start, its end or half way between them, or is less there than what it
/// changes by in the step: the next one might pass the end without a node near it. So is one that the method gives up on a way that
/// leads there. The state is then that of the last good node.
/// Systems whose coordinates do not end do without it, and pay nothing.
///
/// ```
/// use dla::{Dla, Hint, InChart, Schedule, State, StepError, drive};
/// use lagrangian::{Constraint, Scalar, System};
///
/// /// A free particle in polar coordinates `(r, phi)`, which end at `r = 0`.
/// struct Polar;
/// impl System<2, 0> for Polar {
///     fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
///         (v[0] * v[0] + (q[0] * v[1]).squared()) * 0.5
///     }
///     fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 0> {
///         ([], [])
///     }
/// }
///
/// let mut method = InChart::new(Dla::midpoint(), "polar coordinates, which end at r = 0", |q: &[f64; 2]| q[0]);
/// // It passes the origin at a distance of 1e-3 after a second.
/// let mut state = State::new([1.0, 0.0], [-1.0, 1e-3], [false, true]);
/// let error = drive(&Polar, &mut method, &Schedule { t0: 0.0, step: 0.01, steps: 200 }, &mut state, ()).unwrap_err();
/// assert!(matches!(error.source, StepError::Chart { .. }) && error.to_string().contains("r = 0"));
/// assert!((0.9..0.96).contains(&error.time) && error.hint() == Some(Hint::OtherCoordinates));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InChart<Method, Regularity> {
    /// The method.
    pub method: Method,
    /// The least regularity that is accepted: [`LEAST`](Self::LEAST) unless set.
    pub least: f64,
    chart: &'static str,
    regularity: Regularity,
}

impl<Method, Regularity> InChart<Method, Regularity> {
    /// The least regularity that is accepted unless set: coordinates that have rates of `1/regularity` there turn at most twenty
    /// times as quickly as the body.
    pub const LEAST: f64 = 0.05;

    /// The method on the coordinates that `chart` names for people, with where they end, and of which `regularity` says for
    /// a configuration how far from the end that is: of a model, `Model::regularity`.
    pub fn new(method: Method, chart: &'static str, regularity: Regularity) -> Self {
        Self { method, least: Self::LEAST, chart, regularity }
    }

    /// Refuses a step on which the regularity is too little, or changes by as much as is left.
    fn check(&self, seen: &[f64]) -> Result<(), StepError> {
        let regularity = seen.iter().fold(f64::INFINITY, |m, r| if *r < m || r.is_nan() { *r } else { m });
        let change = seen.iter().fold(0.0, |m, r| larger(m, (r - seen[0]).abs()));
        // NaN counts as too little.
        if regularity >= self.least && regularity >= change {
            return Ok(());
        }
        Err(StepError::Chart { chart: self.chart, regularity, least: self.least, change })
    }
}

impl<Method, Regularity, const N: usize, const M: usize> OneStep<N, M> for InChart<Method, Regularity>
where
    Method: OneStep<N, M>,
    Regularity: Fn(&[f64; N]) -> f64,
{
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let before = *state;
        let at = |q: &[f64; N]| (self.regularity)(q);
        let start = at(before.q());
        self.check(&[start])?;
        let report = self.method.step(system, t, h, state).map_err(|error| {
            // Where the step approaches the end of the coordinates, this error says more than the method's own.
            let towards = |part: f64| at(&from_fn(|i| part.mul_add(h * before.v()[i], before.q()[i])));
            self.check(&[start, towards(0.5), towards(1.0)]).err().unwrap_or(error)
        })?;
        // With full turns, so that half way is between the two.
        let (q0, q1) = (before.unwrapped(), state.unwrapped());
        let middle = from_fn(|i| 0.5 * (q0[i] + q1[i]));
        self.check(&[start, at(&middle), at(state.q())]).inspect_err(|_| *state = before)?;
        Ok(report)
    }

    fn memory(&self) -> Vec<f64> {
        self.method.memory()
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        self.method.recall(memory, state);
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.method.measure_work(sources);
    }
}
