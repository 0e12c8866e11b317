use crate::record::Meter;
use crate::substeps::substepped_part;
use crate::timing::{Stopper, Ticker, median_seconds};
use crate::{Method, Progress, Record};
use dla::{Mechanics, Observer, Piece, RunError, Schedule, State, Subject, drive, piece_by_piece_from};

/// A run to be made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request<const N: usize> {
    /// When the steps are.
    pub schedule: Schedule,
    /// Configuration at the start.
    pub q: [f64; N],
    /// Velocity at the start.
    pub v: [f64; N],
    /// About how many nodes to keep for plots.
    pub samples: u64,
}

/// Integrates with the method of that name, in whole steps; returns how many were made. What integrators the system may have of its own
/// is not asked: [`integrate_pieces`] does.
///
/// # Errors
/// [`RunError`] with the step that failed; `state` is then the last good node.
pub fn integrate<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<N, M>,
) -> Result<u64, RunError> {
    drive(system, &mut *method.stepper(), schedule, state, observer)
}

/// Integrates a system whose forces or constraints may jump, one smooth piece after the other, and shows every node to the
/// observer.
///
/// # Errors
/// As [`integrate`]; a run with fewer steps than pieces is refused before the first step is made.
pub fn integrate_pieces<'a, const N: usize, const M: usize>(
    subject: impl Into<Subject<'a, N, M>>,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<N, M>,
) -> Result<u64, RunError> {
    integrate_from(0, subject.into(), method, schedule, state, observer)
}

/// The same for a run that has made so many steps already, whose observer then sees the first node by
/// [`Observer::resume`].
///
/// # Errors
/// As [`integrate_pieces`].
#[inline(never)]
pub fn integrate_from<const N: usize, const M: usize>(
    from: u64,
    Subject { system, own }: Subject<'_, N, M>,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<N, M>,
) -> Result<u64, RunError> {
    piece_by_piece_from(from, system, schedule, state, |piece, Piece { steps, schedule }, state| {
        // A method for each piece: nothing that it remembers holds across a jump.
        let mut stepper = method.stepper_of(own, schedule.middle(&steps));
        substepped_part(piece, &mut *stepper, method.substeps(), &schedule, steps, state, &mut *observer)
    })
}

/// Makes a run that shows its progress, with an observer besides, which may be `()`.
///
/// # Errors
/// As [`integrate_pieces`].
pub fn integrate_on<'a, const N: usize, const M: usize>(
    subject: impl Into<Subject<'a, N, M>>,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<N, M>,
    progress: &mut dyn Progress,
) -> Result<u64, RunError> {
    integrate_pieces(subject, method, schedule, state, &mut (observer, Ticker::new(progress, 0)))
}

/// Makes a run twice, once observed and once timed with nothing looking on, and measures it.
///
/// A run that fails gives the record of its valid part, with [`Record::failure`] set.
pub fn run<'a, const N: usize, const M: usize>(
    subject: impl Into<Subject<'a, N, M>>,
    method: &Method,
    request: &Request<N>,
    progress: &mut dyn Progress,
) -> Record<N> {
    observed_and_timed(subject.into(), method, request, progress)
}

#[inline(never)]
pub(crate) fn observed_and_timed<const N: usize, const M: usize>(
    subject: Subject<'_, N, M>,
    method: &Method,
    request: &Request<N>,
    progress: &mut dyn Progress,
) -> Record<N> {
    let Request { schedule, q, v, .. } = *request;
    let start = State::new(q, v, subject.system.angles());

    let mut meter = Meter::new(request, method);
    let mut ticker = Ticker::new(progress, 0);
    let outcome = integrate_pieces(subject, method, &schedule, &mut start.clone(), &mut (&mut meter, &mut ticker));

    let interrupted = ticker.stopped || outcome.is_ok_and(|made| made < schedule.steps);
    let steps = outcome.unwrap_or_else(|failure| failure.valid_steps());
    let wall_seconds = timed(subject, method, request, steps, progress);
    Record { interrupted, ..meter.record(method.info(), wall_seconds, outcome.err()) }
}

/// Of a longer run than this the first so many steps are timed.
const TIMED: u64 = 1 << 22;

/// The time of steps that have been made before, nothing looking on (s): the processor's, for this thread.
///
/// Of more than 2^22 steps it is that of the first so many, times the ratio: a long run costs hardly more for being timed.
#[inline(never)]
pub fn timed<const N: usize, const M: usize>(
    subject: Subject<'_, N, M>,
    method: &Method,
    request: &Request<N>,
    steps: u64,
    progress: &dyn Progress,
) -> f64 {
    let first = Schedule { steps: steps.min(TIMED), ..request.schedule };
    let start = State::new(request.q, request.v, subject.system.angles());
    let mut made = 0;
    let seconds = median_seconds(|| {
        let mut state = std::hint::black_box(start);
        // The observed run has just shown that these steps succeed.
        made = integrate_pieces(subject, method, &first, &mut state, &mut Stopper(progress)).unwrap_or(first.steps);
        std::hint::black_box(state);
    });
    if made == steps { seconds } else { seconds * steps as f64 / made.max(1) as f64 }
}
