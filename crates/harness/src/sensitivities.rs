//! How a run depends on its start and on parameters of its system: tangent vectors that are carried along by the derivatives of the steps.

use crate::analysis::differentiable;
use crate::run::integrate_pieces;
use crate::stepper::{energy, gauss};
use crate::timing::Ticker;
use crate::{Again, METHODS, Method, MethodKind, Progress, Request};
use dla::{
    Differentiable, FullMechanics, Lobatto, Observer, OneStep, RunError, Sensitivity, SensitivityError, State,
    StepReport, Subject, Tangent, TangentRunError, View,
};
use lagrangian::{Gradients, Scalar, Seeded};
use std::ops::ControlFlow;
use thiserror::Error;

/// A system as a function of `P` parameters, on numbers with derivatives; an object, so that what uses it is compiled once for a shape.
pub trait ParametrisedMechanics<const N: usize, const M: usize, const P: usize> {
    /// The system at these parameters, with the basis of that number ([`lagrangian::System::near`]).
    fn at(&self, basis: u64, p: &[Seeded; P]) -> Box<dyn Gradients<N, M> + '_>;
}

/// A state of a run, and how it moves with each number that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Moving<const N: usize, const P: usize> {
    /// When it is (s).
    pub t: f64,
    /// The state.
    pub state: State<N>,
    /// Its tangent vectors.
    pub tangents: Vec<Tangent<N, P>>,
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
        /// Why it has none.
        reason: &'static str,
    },
    /// Forces or constraints jump along the run.
    #[error("forces or constraints jump at t = {time:?} s, and a step across a jump has no derivative")]
    Jump {
        /// When (s).
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

/// The equations of a method's steps, which their derivatives are taken of.
fn equations<const N: usize, const M: usize>(method: &Method) -> Result<Box<dyn Differentiable<N, M>>, &'static str> {
    let info = method.info();
    Ok(match info.kind {
        MethodKind::Gauss(stages) => Box::new(gauss(stages)),
        MethodKind::Lobatto(3) => Box::new(Lobatto::<3>::new()),
        MethodKind::Energy(stages) => Box::new(energy(stages)),
        _ => {
            const ELSEWHERE: &str = "the derivatives are in the library (dla::Sensitivity) and not in this program";
            return differentiable(method).ok_or(info.tangent.err().unwrap_or(ELSEWHERE));
        }
    })
}

/// The names of the methods whose runs have sensitivities.
#[must_use]
pub fn differentiated() -> Vec<&'static str> {
    let has = |name: &&str| Method::named(name, None).is_ok_and(|method| equations::<3, 1>(&method).is_ok());
    METHODS.iter().map(|info| info.name).filter(has).collect()
}

/// Makes a run with tangent vectors, and gives it at the times asked for, or at its end where none are.
///
/// The states are those of the same run without tangent vectors, to the last bit: each step is made first, and then differentiated
/// by the implicit function theorem ([`Sensitivity`]). At a time between nodes the shorter step is differentiated that
/// [`dla::Samples`] makes. Times are in order, and within the run.
///
/// # Errors
/// [`SensitivitiesError`] where the method or the system has no derivatives, where a step fails, and where the caller ends the run.
pub fn sensitivities<const N: usize, const M: usize, const P: usize>(
    (system, subject): (&dyn FullMechanics<N, M>, Subject<'_, N, M>),
    method: &Method,
    request: &Request<N>,
    times: &[f64],
    (family, parameters): (&dyn ParametrisedMechanics<N, M, P>, [f64; P]),
    tangents: Vec<Tangent<N, P>>,
    progress: &mut dyn Progress,
) -> Result<Vec<Moving<N, P>>, SensitivitiesError> {
    let Request { schedule, q, v, .. } = *request;
    let method = &method.undivided();
    let rule = equations(method).map_err(|reason| SensitivitiesError::Method { method: method.info().name, reason })?;
    let jumps = system.jump_times(schedule.t0, schedule.time(schedule.steps));
    if let Some(time) = jumps.into_iter().min_by(f64::total_cmp) {
        return Err(SensitivitiesError::Jump { time });
    }
    let mut carry = Carry {
        rule: &*rule,
        again: Again { method, own: subject.own },
        system,
        family,
        parameters,
        step: schedule.step,
        basis: 0,
        times,
        before: None,
        tangents,
        taken: Vec::new(),
        failure: None,
    };
    let mut state = State::new(q, v, system.angles());
    let mut ticker = Ticker::new(progress, 0);
    let outcome = integrate_pieces(subject, method, &schedule, &mut state, &mut (&mut carry, &mut ticker));
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
struct Carry<'a, const N: usize, const M: usize, const P: usize> {
    rule: &'a dyn Differentiable<N, M>,
    again: Again<'a, N, M>,
    system: &'a dyn FullMechanics<N, M>,
    family: &'a dyn ParametrisedMechanics<N, M, P>,
    parameters: [f64; P],
    /// The length of a step (s).
    step: f64,
    /// The basis in which the last step was made, as [`dla::Rebased`] chooses it.
    basis: u64,
    times: &'a [f64],
    before: Option<(f64, State<N>)>,
    tangents: Vec<Tangent<N, P>>,
    taken: Vec<Moving<N, P>>,
    failure: Option<SensitivitiesError>,
}

impl<const N: usize, const M: usize, const P: usize> Carry<'_, N, M, P> {
    /// The number of the basis near a state, where `known` is the one before.
    fn near(&self, t: f64, state: &State<N>, known: u64) -> u64 {
        let mut number = 0;
        self.system.near(t, state.q(), known, &mut |near, _| number = near);
        number
    }

    /// The tangent vectors after the step from `start` to `end`, made in the basis of that number.
    fn carried(
        &self,
        basis: u64,
        time: (f64, f64),
        (start, end): (&State<N>, &State<N>),
        report: StepReport<M>,
    ) -> Result<Vec<Tangent<N, P>>, SensitivityError> {
        let seeder = |p: &[Seeded]| {
            let p = lagrangian::from_fn(|k| p.get(k).copied().unwrap_or(Seeded::zero()));
            self.family.at(basis, &p)
        };
        let sensitivity = Sensitivity::seeded(self.system, self.parameters, seeder);
        let derivative = sensitivity.between(self.rule, time, start, end, report)?;
        Ok(self.tangents.iter().map(|tangent| derivative.apply(tangent)).collect())
    }

    /// Takes the samples between two nodes, the second of which is not among them.
    fn sample(&mut self, node: &View<'_, N, M>, (t0, start): (f64, &State<N>)) -> Result<(), SensitivityError> {
        while let Some(&t) = self.times.get(self.taken.len())
            && t < node.t
            && t >= t0
        {
            let (mut state, mut tangents) = (*start, self.tangents.clone());
            if t > t0 {
                let report = self.again.step(node.system, t0, t - t0, &mut state)?;
                let basis = self.near(t0, start, 0);
                tangents = self.carried(basis, (t0, t - t0), (start, &state), report)?;
            }
            self.taken.push(Moving { t, state, tangents });
        }
        Ok(())
    }

    fn made(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> Result<(), SensitivityError> {
        let Some((t0, start)) = self.before.replace((node.t, *node.state)) else { return Ok(()) };
        self.sample(node, (t0, &start))?;
        self.basis = self.near(t0, &start, self.basis);
        self.tangents = self.carried(self.basis, (t0, self.step), (&start, node.state), *report)?;
        Ok(())
    }

    /// Takes the samples at a node.
    fn at_node(&mut self, node: &View<'_, N, M>) {
        while self.times.get(self.taken.len()) == Some(&node.t) {
            self.taken.push(Moving { t: node.t, state: *node.state, tangents: self.tangents.clone() });
        }
    }
}

impl<const N: usize, const M: usize, const P: usize> Observer<N, M> for Carry<'_, N, M, P> {
    fn start(&mut self, node: &View<'_, N, M>) {
        self.before = Some((node.t, *node.state));
        self.at_node(node);
    }

    fn step(&mut self, node: &View<'_, N, M>, report: &StepReport<M>) -> ControlFlow<()> {
        let time = self.before.map_or(node.t, |(t, _)| t);
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
