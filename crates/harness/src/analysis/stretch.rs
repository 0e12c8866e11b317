use super::lyapunov::Running;
use super::tangent::StepTangent;
use crate::Blocks;
use dla::{Observer, SensitivityError, State, StepReport, TangentRunError, View};
use nalgebra::DMatrix;
use std::ops::ControlFlow;

/// So often at most the estimates so far are noted.
const NOTES: u64 = 256;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The observer that carries an orthonormal frame along a run by the derivatives of its steps, and sums up the logarithms of
/// what it is stretched by: `D Phi Q = Q' R`, with the next frame `Q'` and `ln R_ii` (Benettin et al. 1980, Meccanica 15, 9-20).
pub(super) struct Stretch<'a, const N: usize, const M: usize> {
    tangent: &'a dyn StepTangent<N, M>,
    frame: DMatrix<f64>,
    /// Steps that are not counted, and those that are.
    settle: u64,
    steps: u64,
    /// The last node, with the divergence there.
    before: Option<(f64, State<N>, f64)>,
    /// Of `ln R_ii`, all of the counted steps.
    pub(super) sums: Vec<f64>,
    /// Of `ln R_ii / h`.
    pub(super) blocks: Vec<Blocks>,
    /// The integral of the divergence by the trapezoidal rule, and of the time (s).
    pub(super) divergence: f64,
    pub(super) time: f64,
    pub(super) running: Vec<Running>,
    pub(super) failure: Option<TangentRunError>,
}

impl<'a, const N: usize, const M: usize> Stretch<'a, N, M> {
    /// A frame of `count` vectors, of which `settle` steps are not counted and `steps` are.
    pub(super) fn new(tangent: &'a dyn StepTangent<N, M>, count: usize, settle: u64, steps: u64) -> Self {
        // No direction is special to the system: fractions of multiples of irrational numbers, another for each vector.
        let part = |i: usize, j: usize| ((i + 1) as f64 * GOLDEN * ((j + 2) as f64).sqrt()).fract() - 0.5;
        Self {
            tangent,
            frame: DMatrix::from_fn(2 * N - M, count, part).qr().q(),
            settle,
            steps,
            before: None,
            sums: vec![0.0; count],
            blocks: vec![Blocks::default(); count],
            divergence: 0.0,
            time: 0.0,
            running: Vec::new(),
            failure: None,
        }
    }

    fn begin(&mut self, t: f64, state: &State<N>) {
        match self.tangent.divergence(t, state) {
            Ok(divergence) => self.before = Some((t, *state, divergence)),
            Err(source) => self.failure = Some(TangentRunError { step: 1, time: t, source }),
        }
    }

    fn advance(&mut self, k: u64, t: f64, state: &State<N>, report: &StepReport<M>) -> Result<(), TangentRunError> {
        let Some((t0, start, divergence)) = self.before else { return Ok(()) };
        let failed = |source| TangentRunError { step: k, time: t0, source };
        let h = t - t0;
        let stretched = self.tangent.matrix((t0, h), &start, state, *report).map_err(failed)? * &self.frame;
        let qr = stretched.qr();
        let logs: Vec<f64> = qr.r().diagonal().iter().map(|r| r.abs().ln()).collect();
        if !logs.iter().all(|log| log.is_finite()) {
            return Err(failed(SensitivityError::Unsupported { reason: "the derivative of the step is singular" }));
        }
        self.frame = qr.q();
        let next = self.tangent.divergence(t, state).map_err(failed)?;
        self.before = Some((t, *state, next));
        if k > self.settle {
            self.time += h;
            self.divergence += 0.5 * h * (divergence + next);
            for (i, log) in logs.iter().enumerate() {
                self.sums[i] += log;
                self.blocks[i].add(t, log / h);
            }
            if (k - self.settle).is_multiple_of(self.steps.div_ceil(NOTES).max(1)) {
                let exponents = self.sums.iter().map(|sum| sum / self.time).collect();
                self.running.push(Running { time: self.time, exponents });
            }
        }
        Ok(())
    }
}

impl<Sys, const N: usize, const M: usize> Observer<Sys, N, M> for Stretch<'_, N, M> {
    fn start(&mut self, node: &View<'_, Sys, N>) {
        self.begin(node.t, node.state);
    }

    fn step(&mut self, node: &View<'_, Sys, N>, report: &StepReport<M>) -> ControlFlow<()> {
        if self.failure.is_none() {
            self.failure = self.advance(node.k, node.t, node.state, report).err();
        }
        if self.failure.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
