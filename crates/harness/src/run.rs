use crate::record::Meter;
use crate::timing::{Stopper, Ticker, median_seconds};
use crate::{Method, Progress, Record};
use dla::{AnyState, Mechanism, Observer, Piece, RunError, Schedule, piece_by_piece, substepped_part};

/// A run to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The schedule of the steps.
    pub schedule: Schedule,
    /// Configuration at the start.
    pub q: Vec<f64>,
    /// Velocity at the start.
    pub v: Vec<f64>,
    /// Approximate number of nodes to keep for plots.
    pub samples: u64,
}

/// Integrates a system whose forces or constraints may jump, one smooth piece after the other, and shows every node to the
/// observer.
///
/// # Errors
/// [`RunError`] with the step that failed; `state` is then the last good node. A run with fewer steps than pieces is refused before the first
/// step is made.
pub fn integrate_pieces(
    system: &dyn Mechanism,
    method: &Method,
    schedule: &Schedule,
    state: &mut AnyState,
    observer: &mut dyn Observer,
) -> Result<u64, RunError> {
    integrate_from(0, system, method, schedule, state, observer)
}

/// As [`integrate_pieces`], for a run that has made `from` steps already; the observer then sees the first node by [`Observer::resume`].
///
/// # Errors
/// As [`integrate_pieces`].
pub fn integrate_from(
    from: u64,
    system: &dyn Mechanism,
    method: &Method,
    schedule: &Schedule,
    state: &mut AnyState,
    observer: &mut dyn Observer,
) -> Result<u64, RunError> {
    piece_by_piece(from, system, schedule, state, |piece, Piece { steps, schedule }, state| {
        // A method for each piece: its memory does not hold across a jump.
        let mut integrator = piece.integrator(method);
        substepped_part(piece, &mut *integrator, method.substeps(), &schedule, steps, state, observer)
    })
}

/// Makes a run that shows its progress, with an observer besides, which may be `()`.
///
/// # Errors
/// As [`integrate_pieces`].
pub fn integrate_on(
    system: &dyn Mechanism,
    method: &Method,
    schedule: &Schedule,
    state: &mut AnyState,
    observer: &mut dyn Observer,
    progress: &mut dyn Progress,
) -> Result<u64, RunError> {
    integrate_pieces(system, method, schedule, state, &mut (observer, Ticker::new(progress, 0)))
}

/// Makes a run twice, once observed and once timed without observers, and measures it.
///
/// A run that fails gives the record of its valid part, with [`Record::failure`] set.
pub fn run(system: &dyn Mechanism, method: &Method, request: &Request, progress: &mut dyn Progress) -> Record {
    let Request { schedule, q, v, .. } = request;
    let mut meter = Meter::new(request, method);
    let mut ticker = Ticker::new(progress, 0);
    let mut state = system.state(q, v);
    let outcome = integrate_pieces(system, method, schedule, &mut state, &mut (&mut meter, &mut ticker));

    let interrupted = ticker.stopped || outcome.is_ok_and(|made| made < schedule.steps);
    let steps = outcome.unwrap_or_else(|failure| failure.valid_steps());
    let wall_seconds = timed(system, method, request, steps, progress);
    Record { interrupted, ..meter.record(method.info(), wall_seconds, outcome.err()) }
}

/// Number of first steps that are timed in a longer run.
const TIMED: u64 = 1 << 22;

/// The time of steps that have been made before, without observers (s): the processor's, for this thread.
///
/// For more than 2^22 steps, the time of the first 2^22 is scaled by the ratio: a long run costs hardly more for being timed.
pub fn timed(system: &dyn Mechanism, method: &Method, request: &Request, steps: u64, progress: &dyn Progress) -> f64 {
    let first = Schedule { steps: steps.min(TIMED), ..request.schedule };
    let start = system.state(&request.q, &request.v);
    let mut made = 0;
    let seconds = median_seconds(|| {
        let mut state = std::hint::black_box(&start).clone();
        // The observed run has just shown that these steps succeed.
        made = integrate_pieces(system, method, &first, &mut state, &mut Stopper(progress)).unwrap_or(first.steps);
        std::hint::black_box(state);
    });
    if made == steps { seconds } else { seconds * steps as f64 / made.max(1) as f64 }
}
