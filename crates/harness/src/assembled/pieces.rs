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
    /// The piece of the steps now, by its place in the list, and whether a step of it has been asked for.
    piece: Assembly,
    now: usize,
    begun: bool,
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
        let (begin, end) = (schedule.t0, schedule.time(schedule.steps));
        let jumps = whole.jump_times(begin.min(end), begin.max(end));
        let pieces = smooth_pieces(schedule, jumps).map_err(|RunError { step, time, source, .. }| {
            let StepError::Jump { time: jump } = source else { return fail(AssemblyError::NotFinite) };
            AssemblyRunError { step, time, source: AssemblyError::Jump { time: jump } }
        })?;
        let Piece { steps, schedule } = &pieces[0];
        let piece = whole.smooth_piece(schedule.middle(steps));
        let stepper = assembly_method(&piece, method).map_err(fail)?;
        Ok(Self { whole, method: *method, pieces, piece, now: 0, begun: false, stepper })
    }

    /// Whether step `k`, counted from 0, is the first that is asked for of its piece: a velocity may jump there.
    pub(super) fn begins(&self, k: u64) -> bool {
        !self.begun || self.place(k) != self.now
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
        let (fail, begins) = (|source| AssemblyRunError { step: k + 1, time: t, source }, self.begins(k));
        if at != self.now {
            self.piece = self.whole.smooth_piece(schedule.middle(steps));
            self.stepper = assembly_method(&self.piece, &self.method).map_err(fail)?;
        }
        // Inside a piece, where a run is resumed, there is no impulse.
        if begins && k == steps.start {
            self.piece.onto_constraint((t, h), state).map_err(fail)?;
        }
        (self.now, self.begun) = (at, true);
        Ok(PieceStep { assembly: &self.piece, stepper: &mut *self.stepper, time: (t, h), end: schedule.time(k + 1) })
    }

    /// The assembly as it is now.
    pub(super) fn assembly(&self) -> &Assembly {
        &self.piece
    }
}
