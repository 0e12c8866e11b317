use super::assembly_method;
use crate::Method;
use assembly::{Assembly, AssemblyError, AssemblyMethod, AssemblyRunError, AssemblyState};
use dla::{Piece, RunError, Schedule, StepError, smooth_pieces};

/// The steps of a run of an assembly whose forces or constraints may jump: one smooth piece after the other, each with a method of its
/// own.
pub(super) struct AssemblyPieces<'a> {
    whole: &'a Assembly,
    method: Method,
    pieces: Vec<Piece>,
    /// The piece of the steps now, which an assembly that never jumps need not have.
    piece: Option<Assembly>,
    now: usize,
    stepper: Box<dyn AssemblyMethod>,
}

/// A step that is to be made, with what makes it.
pub(super) struct PieceStep<'p> {
    pub(super) assembly: &'p Assembly,
    pub(super) stepper: &'p mut dyn AssemblyMethod,
    /// When it begins, and its length (s).
    pub(super) time: (f64, f64),
    /// When it ends (s).
    pub(super) end: f64,
}

impl<'a> AssemblyPieces<'a> {
    /// The steps of that schedule.
    ///
    /// # Errors
    /// [`AssemblyRunError`] at the first step: the method does no assemblies, or there are fewer steps than pieces.
    pub(super) fn new(whole: &'a Assembly, method: &Method, schedule: &Schedule) -> Result<Self, AssemblyRunError> {
        let fail = |source| AssemblyRunError { step: 1, time: schedule.t0, source };
        let stepper = assembly_method(whole, method).map_err(fail)?;
        let (begin, end) = (schedule.t0, schedule.time(schedule.steps));
        let jumps = whole.jump_times(begin.min(end), begin.max(end));
        let smooth = jumps.is_empty();
        let pieces = smooth_pieces(schedule, jumps).map_err(|RunError { step, time, source }| {
            let StepError::Jump { time: jump } = source else { return fail(AssemblyError::NotFinite) };
            AssemblyRunError { step, time, source: AssemblyError::Jump { time: jump } }
        })?;
        let now = if smooth { 0 } else { usize::MAX };
        Ok(Self { whole, method: *method, pieces, piece: None, now, stepper })
    }

    /// Whether step `k`, counted from 0, is the first of another piece than the step before: a velocity may jump there.
    pub(super) fn begins(&self, k: u64) -> bool {
        self.place(k) != self.now
    }

    fn place(&self, k: u64) -> usize {
        self.pieces.partition_point(|piece| piece.steps.end <= k).min(self.pieces.len() - 1)
    }

    /// The time of node `k` (s): the end of the step before it.
    pub(super) fn time(&self, k: u64) -> f64 {
        self.pieces[self.place(k.saturating_sub(1))].schedule.time(k)
    }

    /// Step `k`, counted from 0. Where it is the first of a piece, the impulse of the constraints brings `state` onto them.
    ///
    /// # Errors
    /// [`AssemblyRunError`] where the constraints do not determine that velocity, or for want of memory.
    pub(super) fn step(&mut self, k: u64, state: &mut AssemblyState) -> Result<PieceStep<'_>, AssemblyRunError> {
        let at = self.place(k);
        let Piece { steps, schedule } = &self.pieces[at];
        let (t, h) = (schedule.time(k), schedule.step);
        if at != self.now {
            let fail = |source| AssemblyRunError { step: k + 1, time: t, source };
            let piece = self.whole.smooth_piece(schedule.middle(steps));
            // Inside a piece, where a run is resumed, there is no impulse.
            if k == steps.start {
                piece.onto_constraint((t, h), state).map_err(fail)?;
            }
            self.stepper = assembly_method(&piece, &self.method).map_err(fail)?;
            (self.piece, self.now) = (Some(piece), at);
        }
        let assembly = self.piece.as_ref().unwrap_or(self.whole);
        Ok(PieceStep { assembly, stepper: &mut *self.stepper, time: (t, h), end: schedule.time(k + 1) })
    }

    /// The assembly as it is now.
    pub(super) fn assembly(&self) -> &Assembly {
        self.piece.as_ref().unwrap_or(self.whole)
    }
}
