use super::pace::Pace;
use super::tangent::{Local, Stepped, Steps};
use super::volume::Volume;
use crate::Blocks;
use dla::{AnyState, Observer, Report, RunError, SensitivityError, TangentRunError, View};
use nalgebra::DMatrix;
use std::ops::ControlFlow;
use thiserror::Error;

/// The exponents over a first part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Running {
    /// How long it is (s).
    pub time: f64,
    /// The exponents (1/s).
    pub exponents: Vec<f64>,
}

/// Why a run with a frame ended early.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LyapunovFailure {
    /// A step failed.
    #[error(transparent)]
    Step(#[from] RunError),
    /// A step has no derivative.
    #[error("the derivative of {0}")]
    Derivative(#[from] TangentRunError),
    /// The sum of all exponents by the derivatives of the steps is not the mean divergence of the equations, which it is by Liouville's
    /// theorem. The results end at the last agreement.
    #[error(
        "until t = {time:.6} s the sum of the exponents is {:+.6e} 1/s by the steps and {:+.6e} 1/s by the \
            divergence of the equations, and the two may differ by at most {allowed:.1e}: the steps are too long, or \
            the motion is so quick that round-off takes the digits of its derivatives; the exponents up to that time \
            are shown; take shorter steps or a shorter run",
        sums[0],
        sums[1]
    )]
    Volumes {
        /// The time at which it was seen (s).
        time: f64,
        /// The sum of all exponents from the start of the run, by the steps and by the divergence (1/s).
        sums: [f64; 2],
        /// The allowed difference of the two (1/s).
        allowed: f64,
    },
}

/// Maximum number of running estimates that are stored.
const NOTES: u64 = 256;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Sums over the counted steps.
#[derive(Debug, Clone)]
pub(super) struct Sums {
    /// The sums of `ln R_ii`.
    pub(super) logs: Vec<f64>,
    /// The integral of the divergence by the trapezoidal rule, and of the time (s).
    pub(super) divergence: f64,
    pub(super) time: f64,
}

/// The observer that propagates orthonormal tangent vectors by the tangent maps of the steps, and sums up the logarithms of their growth:
/// `D Phi Q = Q' R`, with the next vectors `Q'` and `ln R_ii` (Benettin et al. 1980, Meccanica 15, 9-20).
pub(super) struct Stretch<'a> {
    tangent: &'a Steps<'a>,
    frame: DMatrix<f64>,
    /// Steps that are not counted, and those that are.
    settle: u64,
    steps: u64,
    /// The last node, with the equations there.
    before: Option<(f64, AnyState, Local)>,
    pub(super) sums: Sums,
    /// The sums at the last agreement of the volumes.
    agreed: Sums,
    volume: Volume,
    /// Blocks of `ln R_ii / h`.
    pub(super) blocks: Vec<Blocks>,
    pub(super) running: Vec<Running>,
    pub(super) pace: Option<Pace>,
    pub(super) failure: Option<LyapunovFailure>,
}

impl<'a> Stretch<'a> {
    /// An observer with `count` tangent vectors, for `settle` steps that are not counted and `steps` that are, of a method of that order.
    pub(super) fn new(tangent: &'a Steps<'a>, order: u32, count: usize, (settle, steps): (u64, u64)) -> Self {
        // No direction is special to the system: fractions of multiples of irrational numbers, another for each vector.
        let part = |i: usize, j: usize| ((i + 1) as f64 * GOLDEN * ((j + 2) as f64).sqrt()).fract() - 0.5;
        let sums = Sums { logs: vec![0.0; count], divergence: 0.0, time: 0.0 };
        Self {
            tangent,
            frame: DMatrix::from_fn(tangent.count(), count, part).qr().q(),
            settle,
            steps,
            before: None,
            agreed: sums.clone(),
            sums,
            volume: Volume::new(order),
            blocks: vec![Blocks::default(); count],
            running: Vec::new(),
            pace: None,
            failure: None,
        }
    }

    fn begin(&mut self, t: f64, state: &AnyState) -> Result<(), TangentRunError> {
        let local = self.tangent.begin(t, state).map_err(|source| TangentRunError { step: 1, time: t, source })?;
        let mut pace = Pace::new(self.tangent.weights(t, state), self.settle, self.steps);
        pace.add(0, t, &local.xi, &local.rate);
        self.pace = Some(pace);
        self.before = Some((t, state.clone(), local));
        Ok(())
    }

    fn advance(&mut self, k: u64, t: f64, state: &AnyState, report: &Report) -> Result<(), LyapunovFailure> {
        let Some((t0, start, local)) = self.before.take() else { return Ok(()) };
        let failed = |source| TangentRunError { step: k, time: t0, source };
        let h = t - t0;
        let Stepped { matrix, change, divergence, next } =
            self.tangent.step((t0, h), [&start, state], report).map_err(failed)?;
        let qr = (&matrix * &self.frame).qr();
        let logs: Vec<f64> = qr.r().diagonal().iter().map(|r| r.abs().ln()).collect();
        if !logs.iter().all(|log| log.is_finite()) {
            let reason = "the derivative of the step is singular";
            return Err(failed(SensitivityError::Unsupported { reason }).into());
        }
        self.frame = qr.q();
        if let Some(pace) = &mut self.pace {
            pace.add(k, t, &next.xi, &next.rate);
        }
        self.before = Some((t, state.clone(), next));
        let ends = [local.divergence, divergence];
        if k > self.settle {
            self.sums.time += h;
            self.sums.divergence += 0.5 * h * (ends[0] + ends[1]) + change;
            for (i, log) in logs.iter().enumerate() {
                self.sums.logs[i] += log;
                self.blocks[i].add(t, log / h);
            }
        }
        // A whole frame spans all volumes.
        let whole = logs.len() == matrix.nrows();
        let determinant = if whole { logs.iter().sum() } else { matrix.determinant().abs().ln() };
        // A change of the basis is none of the motion.
        match self.volume.add(h, &logs, determinant - change, ends) {
            Some(Ok(())) => self.agreed.clone_from(&self.sums),
            Some(Err(apart)) => {
                // Steps after the last agreement are left out.
                self.sums.clone_from(&self.agreed);
                return Err(LyapunovFailure::Volumes { time: t, sums: apart.sums, allowed: apart.allowed });
            }
            None => {}
        }
        if k > self.settle && (k - self.settle).is_multiple_of(self.steps.div_ceil(NOTES).max(1)) {
            let exponents = self.sums.logs.iter().map(|sum| sum / self.sums.time).collect();
            self.running.push(Running { time: self.sums.time, exponents });
        }
        Ok(())
    }
}

impl Observer for Stretch<'_> {
    fn start(&mut self, node: &View<'_>) {
        self.failure = self.begin(node.t, node.state).err().map(Into::into);
    }

    fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
        if self.failure.is_none() {
            self.failure = self.advance(node.k, node.t, node.state, report).err();
        }
        if self.failure.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
