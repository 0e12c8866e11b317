use crate::record::Meter;
use crate::substeps::substepped_part;
use crate::timing::{Stopper, Ticker, median_seconds};
use crate::{Dop853, ImplicitMidpoint, Kind, Method, Progress, Record, Rk4, Rk4Projected, Rk4Reduced};
use dla::{
    Composition, Dla, Energy, Gauss, Gni, Lobatto, Observer, OneStep, Part, RunError, Schedule, State, drive_part,
    piece_by_piece_from,
};
use lagrangian::{Piecewise, System};
use std::ops::Range;

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

/// Integrates with the method of that name, in whole steps; returns how many were made.
///
/// # Errors
/// [`RunError`] with the step that failed; `state` is then the last good node.
pub fn integrate<Sys, Obs, const N: usize, const M: usize>(
    system: &Sys,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: Obs,
) -> Result<u64, RunError>
where
    Sys: System<N, M>,
    Obs: Observer<Sys, N, M>,
{
    integrate_part(system, method, schedule, 0..schedule.steps, state, observer, None).map(|part| part.made)
}

/// Integrates a system whose forces or constraints may jump, one smooth piece after the other, and shows every node to the
/// observer.
///
/// One code for every observer, `()` among them: it is called through a pointer, so that the steps are compiled once.
///
/// # Errors
/// As [`integrate`]; a jump inside a step is refused before the first step is made.
pub fn integrate_pieces<Sys, const N: usize, const M: usize>(
    system: &Sys,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<Sys, N, M>,
) -> Result<u64, RunError>
where
    Sys: System<N, M> + Piecewise,
{
    integrate_from(0, system, method, schedule, state, observer)
}

/// The same for a run that has made so many steps already, whose observer then sees the first node by
/// [`Observer::resume`].
///
/// # Errors
/// As [`integrate_pieces`].
pub fn integrate_from<Sys, const N: usize, const M: usize>(
    from: u64,
    system: &Sys,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<Sys, N, M>,
) -> Result<u64, RunError>
where
    Sys: System<N, M> + Piecewise,
{
    piece_by_piece_from(from, system, schedule, state, |piece, steps, state| {
        substepped_part(piece, method, schedule, steps, state, &mut *observer, None)
    })
}

/// A part of a run with the method of that name: the one place where a name becomes a type. Where there is a memory, it is
/// what the method remembers from the part before, and then from this one. All steps are whole; `substepped_part` divides some.
pub(crate) fn integrate_part<Sys, Obs, const N: usize, const M: usize>(
    system: &Sys,
    method: &Method,
    schedule: &Schedule,
    steps: Range<u64>,
    state: &mut State<N>,
    observer: Obs,
    memory: Option<&mut Vec<f64>>,
) -> Result<Part, RunError>
where
    Sys: System<N, M>,
    Obs: Observer<Sys, N, M>,
{
    macro_rules! run_with {
        ($method:expr) => {{
            let mut method = $method;
            if let Some(memory) = &memory {
                OneStep::<Sys, N, M>::recall(&mut method, memory, state);
            }
            let part = drive_part(system, &mut method, schedule, steps, state, observer);
            if let Some(memory) = memory {
                *memory = OneStep::<Sys, N, M>::memory(&method);
            }
            part
        }};
    }
    match method.info().kind {
        Kind::Dla => run_with!(Dla::midpoint()),
        // One type for both: every type is compiled for every system.
        Kind::DlaTrapezoid | Kind::DlaAlpha => run_with!(Dla::new(method.rule(), method.rule())),
        Kind::Dla4 => run_with!(Composition::suzuki4(Dla::midpoint())),
        Kind::Dla6 => run_with!(Composition::kahan_li6(Dla::midpoint())),
        Kind::Dla8 => run_with!(Composition::fifteen8(Dla::midpoint())),
        Kind::Lobatto3 => run_with!(Lobatto::<3>::new()),
        Kind::Lobatto4 => run_with!(Lobatto::<4>::new()),
        Kind::Lobatto5 => run_with!(Lobatto::<5>::new()),
        Kind::Gauss4 => run_with!(Gauss::new::<2>()),
        Kind::Gauss6 => run_with!(Gauss::new::<3>()),
        Kind::Gauss8 => run_with!(Gauss::new::<4>()),
        Kind::Gauss10 => run_with!(Gauss::new::<5>()),
        Kind::Gauss12 => run_with!(Gauss::new::<6>()),
        Kind::Gauss14 => run_with!(Gauss::new::<7>()),
        Kind::Gauss16 => run_with!(Gauss::new::<8>()),
        Kind::Energy2 => run_with!(Energy::new::<1>()),
        Kind::Energy4 => run_with!(Energy::new::<2>()),
        Kind::Energy6 => run_with!(Energy::new::<3>()),
        Kind::Energy8 => run_with!(Energy::new::<4>()),
        Kind::Gni => run_with!(Gni::<N>::default()),
        Kind::Rk4 => run_with!(Rk4),
        Kind::Rk4Projected => run_with!(Rk4Projected),
        Kind::Rk4Reduced => run_with!(Rk4Reduced),
        Kind::ImplicitMidpoint => run_with!(ImplicitMidpoint::default()),
        Kind::Dop853 => run_with!(Dop853::<N, M>::new(method.tolerance())),
    }
}

/// Makes a run that shows its progress, with an observer besides, which may be `()`.
///
/// # Errors
/// As [`integrate_pieces`].
pub fn integrate_on<Sys: System<N, M> + Piecewise, const N: usize, const M: usize>(
    system: &Sys,
    method: &Method,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer<Sys, N, M>,
    progress: &mut dyn Progress,
) -> Result<u64, RunError> {
    integrate_pieces(system, method, schedule, state, &mut (observer, Ticker::new(progress, 0)))
}

/// Makes a run twice, once observed and once timed with nothing looking on, and measures it.
///
/// A run that fails gives the record of its valid part, with [`Record::failure`] set.
pub fn run<Sys: System<N, M> + Piecewise, const N: usize, const M: usize>(
    system: &Sys,
    method: &Method,
    request: &Request<N>,
    progress: &mut dyn Progress,
) -> Record<N> {
    let Request { schedule, q, v, .. } = *request;
    let start = State::new(q, v, system.angles());

    let mut meter = Meter::new(request, method);
    let mut ticker = Ticker::new(progress, 0);
    let outcome = integrate_pieces(system, method, &schedule, &mut start.clone(), &mut (&mut meter, &mut ticker));

    let interrupted = ticker.stopped;
    let steps = outcome.unwrap_or_else(|failure| failure.valid_steps());
    let wall_seconds = timed(system, method, request, steps, progress);
    Record { interrupted, ..meter.record(method.info(), wall_seconds, outcome.err()) }
}

/// Of a longer run than this the first so many steps are timed.
const TIMED: u64 = 1 << 22;

/// The time of steps that have been made before, nothing looking on (s).
///
/// Of more than 2^22 steps it is that of the first so many, times the ratio: a long run costs hardly more for being timed.
pub fn timed<Sys: System<N, M> + Piecewise, const N: usize, const M: usize>(
    system: &Sys,
    method: &Method,
    request: &Request<N>,
    steps: u64,
    progress: &dyn Progress,
) -> f64 {
    let first = Schedule { steps: steps.min(TIMED), ..request.schedule };
    let start = State::new(request.q, request.v, system.angles());
    let mut made = 0;
    let seconds = median_seconds(|| {
        let mut state = std::hint::black_box(start);
        // The observed run has just shown that these steps succeed.
        made = integrate_pieces(system, method, &first, &mut state, &mut Stopper(progress)).unwrap_or(first.steps);
        std::hint::black_box(state);
    });
    if made == steps { seconds } else { seconds * steps as f64 / made.max(1) as f64 }
}
