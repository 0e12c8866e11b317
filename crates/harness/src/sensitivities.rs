//! How a run depends on its start and on parameters of its system: tangent vectors that are carried along by the derivatives of the steps.

use crate::Run;
use crate::timing::Ticker;
use crate::{METHODS, Method, Progress, Request};
use dla::{
    AnyState, AnyTangent, Observer, ParametrisedMechanism, Report, RunError, SensitivityError, TangentRunError, View,
    again, has_derivatives,
};
use std::ops::ControlFlow;
use thiserror::Error;

/// A state of a run, and its derivatives in each number that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Moving {
    /// The time (s).
    pub t: f64,
    /// The state.
    pub state: AnyState,
    /// Its tangent vectors.
    pub tangents: Vec<AnyTangent>,
}

/// Why a run has no sensitivities.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SensitivitiesError {
    /// The steps of the method have no derivative.
    #[error("{method} has no derivatives of its steps: {reason}; the methods that have derivatives are \
        {}", differentiated().join(", "))]
    Method {
        /// The method.
        method: &'static str,
        /// The reason.
        reason: &'static str,
    },
    /// Forces or constraints jump along the run.
    #[error("forces or constraints jump at t = {time:?} s, and a step across a jump has no derivative")]
    Jump {
        /// The time of the jump (s).
        time: f64,
    },
    /// A step failed.
    #[error(transparent)]
    Step(#[from] RunError),
    /// A step has no derivative.
    #[error("the derivative of {0}")]
    Derivative(#[from] TangentRunError),
    /// The caller ended the run.
    #[error("the run was ended")]
    Ended,
}

/// The names of the methods whose runs have sensitivities.
#[must_use]
pub fn differentiated() -> Vec<&'static str> {
    let has = |name: &&str| Method::named(name, None).is_ok_and(|method| has_derivatives(&method).is_ok());
    METHODS.iter().map(|info| info.name).filter(has).collect()
}

/// Makes a run with tangent vectors, and gives it at the times asked for, or at its end if there are none.
///
/// The states are the same as in a run without tangent vectors, to the last bit: each step is made first, and then differentiated by the
/// implicit function theorem ([`dla::Sensitivity`]). At a time between nodes, the shorter step that [`dla::Samples`] makes is
/// differentiated. Times are in order, and within the run.
///
/// # Errors
/// [`SensitivitiesError`] if the method or the system has no derivatives, if a step fails, or if the caller ends the run.
pub fn sensitivities(
    family: &dyn ParametrisedMechanism,
    method: &Method,
    request: &Request,
    times: &[f64],
    tangents: Vec<AnyTangent>,
    progress: &mut dyn Progress,
) -> Result<Vec<Moving>, SensitivitiesError> {
    let Request { schedule, q, v, .. } = request;
    let (method, system) = (&method.undivided(), family.mechanism());
    if let Err(SensitivityError::Unsupported { reason }) = has_derivatives(method) {
        return Err(SensitivitiesError::Method { method: method.info().name, reason });
    }
    let jumps = system.jump_times(schedule.t0, schedule.time(schedule.steps));
    if let Some(time) = jumps.into_iter().min_by(f64::total_cmp) {
        return Err(SensitivitiesError::Jump { time });
    }
    let mut carry = Carry {
        method,
        family,
        step: schedule.step,
        basis: 0,
        times,
        before: None,
        tangents,
        taken: Vec::new(),
        failure: None,
    };
    let mut state = system.state(q, v);
    let mut ticker = Ticker::new(progress, 0);
    let outcome = Run::of(system, method).observe(&mut (&mut carry, &mut ticker)).moves(schedule, &mut state);
    if let Some(failure) = carry.failure {
        return Err(failure);
    }
    outcome?;
    if ticker.stopped {
        return Err(SensitivitiesError::Ended);
    }
    if times.is_empty() {
        let t = schedule.time(schedule.steps);
        carry.taken.push(Moving { t, state, tangents: carry.tangents });
    }
    Ok(carry.taken)
}

/// The observer that carries tangent vectors along.
struct Carry<'a> {
    method: &'a Method,
    family: &'a dyn ParametrisedMechanism,
    /// The length of a step (s).
    step: f64,
    /// The basis in which the last step was made, as [`dla::Rebased`] chooses it.
    basis: u64,
    times: &'a [f64],
    before: Option<(f64, AnyState)>,
    tangents: Vec<AnyTangent>,
    taken: Vec<Moving>,
    failure: Option<SensitivitiesError>,
}

impl Carry<'_> {
    /// The number of the basis near a state; `known` is the number before.
    fn near(&self, t: f64, state: &AnyState, known: u64) -> u64 {
        let mut number = 0;
        self.family.mechanism().near(t, state.q(), known, &mut |near, _| number = near);
        number
    }

    /// The tangent vectors after the step between two states, made in the basis number `basis`.
    fn carried(
        &self,
        basis: u64,
        time: (f64, f64),
        ends: [&AnyState; 2],
        report: &Report,
    ) -> Result<Vec<AnyTangent>, SensitivityError> {
        self.family.carried(self.method, basis, time, ends, report, &self.tangents)
    }

    /// Takes the samples between two nodes, without the second.
    fn sample(&mut self, node: &View<'_>, (t0, start): (f64, &AnyState)) -> Result<(), SensitivityError> {
        while let Some(&t) = self.times.get(self.taken.len())
            && t < node.t
            && t >= t0
        {
            let (mut state, mut tangents) = (start.clone(), self.tangents.clone());
            if t > t0 {
                let report = again(node.system, self.method, (t0, t - t0), &mut state, false)?;
                let basis = self.near(t0, start, 0);
                tangents = self.carried(basis, (t0, t - t0), [start, &state], &report)?;
            }
            self.taken.push(Moving { t, state, tangents });
        }
        Ok(())
    }

    fn made(&mut self, node: &View<'_>, report: &Report) -> Result<(), SensitivityError> {
        let Some((t0, start)) = self.before.replace((node.t, node.state.clone())) else { return Ok(()) };
        self.sample(node, (t0, &start))?;
        self.basis = self.near(t0, &start, self.basis);
        self.tangents = self.carried(self.basis, (t0, self.step), [&start, node.state], report)?;
        Ok(())
    }

    /// Takes the samples at a node.
    fn at_node(&mut self, node: &View<'_>) {
        while self.times.get(self.taken.len()) == Some(&node.t) {
            self.taken.push(Moving { t: node.t, state: node.state.clone(), tangents: self.tangents.clone() });
        }
    }
}

impl Observer for Carry<'_> {
    fn start(&mut self, node: &View<'_>) {
        self.before = Some((node.t, node.state.clone()));
        self.at_node(node);
    }

    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        let time = self.before.as_ref().map_or(node.t, |(t, _)| *t);
        match self.made(node, report) {
            Ok(()) => {
                self.at_node(node);
                ControlFlow::Continue(())
            }
            Err(source) => {
                self.failure = Some(TangentRunError { step: node.k, time, source }.into());
                ControlFlow::Break(())
            }
        }
    }
}
