//! Runs of assemblies, measured as those of static systems are.

mod events;
mod making;
mod meter;
mod parts;
mod pieces;
mod recommend;
mod samples;
mod saved;
mod step;

pub use events::{AssemblyCrossing, AssemblyEvent};
pub use recommend::recommend_assembly;
pub use samples::sample_assembly;
pub use saved::run_assembly_saved;

use crate::{METHODS, Method, MethodKind, Progress, Record};
use assembly::{
    Assembly, AssemblyError, AssemblyMethod, AssemblyRunError, AssemblyState, Solver, SparseComposition, SparseDla,
};
use dla::{Close, Schedule};
use events::ended;
use making::{AssemblyTicker, Making};
use pieces::{AssemblyPieces, PieceStep};
use std::ops::ControlFlow;
use std::sync::LazyLock;

/// A node of an assembly that was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyNode {
    /// Time (s).
    pub t: f64,
    /// Configuration, angles with their full turns.
    pub q: Vec<f64>,
    /// Velocity.
    pub v: Vec<f64>,
    /// Energy (J).
    pub energy: f64,
    /// Work done since the start (J).
    pub work: f64,
    /// The largest `|A v + b|` here.
    pub constraint: f64,
    /// The largest `|g|` of a joint here.
    pub joint: f64,
}

impl AssemblyNode {
    /// The node of a state, after so much work (J).
    pub(crate) fn of(assembly: &Assembly, (t, state): (f64, &AssemblyState), work: f64) -> Self {
        let (q, v) = (0..state.len()).map(|i| (state.unwrapped(i), state.v(i))).unzip();
        let [constraint, joint] = assembly.misses(t, state);
        Self { t, q, v, energy: assembly.energy(t, state), work, constraint, joint }
    }
}

/// What becomes of the nodes of a run of an assembly.
pub enum AssemblyNodes<'a> {
    /// Every so manieth and the last are kept in memory.
    Kept(u64),
    /// They are handed on with their numbers, every so manieth and the last, as they are made; none is kept. A run that is resumed hands on
    /// those after the checkpoint.
    Shown(u64, &'a mut dyn FnMut(u64, &AssemblyNode)),
}

impl std::fmt::Debug for AssemblyNodes<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Kept(every) => f.debug_tuple("Kept").field(every).finish(),
            Self::Shown(every, _) => f.debug_tuple("Shown").field(every).finish_non_exhaustive(),
        }
    }
}

/// A run of an assembly, measured.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// The record, whose coordinates are the first three of the assembly; [`Record::leaf_max`] is that of its joints.
    pub record: Record,
    /// The nodes that were kept.
    pub nodes: Vec<AssemblyNode>,
    /// The state at the end.
    pub end: AssemblyState,
    /// Why the run ended early, where it did, with the constraints that are the cause.
    pub failure: Option<AssemblyRunError>,
}

/// Why a method is refused.
static OTHERS: LazyLock<String> = LazyLock::new(|| {
    let able: Vec<&str> = METHODS.iter().filter(|info| info.assemblies).map(|info| info.name).collect();
    let (last, others) = able.split_last().map_or(("none", &[][..]), |(last, others)| (*last, others));
    let others = others.join(", ");
    format!("the method is for systems of a few coordinates; for trains and other assemblies take {others} or {last}")
});

/// The method of that name for an assembly.
///
/// # Errors
/// [`AssemblyError::Unsupported`] for one that does none.
pub fn assembly_method(assembly: &Assembly, method: &Method) -> Result<Box<dyn AssemblyMethod>, AssemblyError> {
    let best = Solver::Best;
    match method.info().kind {
        MethodKind::Dla => SparseDla::new(assembly, best).map(|method| Box::new(method) as _),
        MethodKind::Composed(order) => {
            SparseComposition::new(assembly, best, order).map(|method| Box::new(method) as _)
        }
        _ => Err(AssemblyError::Unsupported { reason: OTHERS.as_str() }),
    }
}

/// The state at the end of a run, nothing looking on but the progress; none where that stops it.
///
/// # Errors
/// [`AssemblyRunError`] with the step that failed.
pub fn assembly_end(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    start: &AssemblyState,
    progress: &mut dyn Progress,
) -> Result<Option<AssemblyState>, AssemblyRunError> {
    let mut state = start.clone();
    let mut pieces = AssemblyPieces::new(assembly, method, schedule)?;
    let mut ticker = AssemblyTicker::new(progress, 0);
    for k in 0..schedule.steps {
        let PieceStep { assembly, stepper, time: (t, h), .. } = pieces.step(k, &mut state)?;
        let fail = |source| AssemblyRunError { step: k + 1, time: t, source };
        stepper.step(assembly, t, h, &mut state).map_err(fail)?;
        if ticker.stops(k + 1) {
            return Ok(None);
        }
    }
    ticker.finish(schedule.steps);
    Ok(Some(state))
}

/// Makes a run of an assembly and measures it, keeping every `every`-th node and the last.
///
/// The time is that of the steps alone. Work is integrated along the polynomial of degree five of each step, which is of order 6 ([`assembly::AssemblyWork`]). A run that fails gives the record of its valid part.
pub fn run_assembly(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    start: &AssemblyState,
    every: u64,
    progress: &mut dyn Progress,
) -> Assembled {
    run_assembly_watched(assembly, method, schedule, (start, AssemblyNodes::Kept(every)), (&[], 1), progress).0
}

/// The same, with an eye on events in so many parts of each step; one that is terminal ends the run at its first crossing. Returns
/// the crossings in the order in which they happened, and why some may have been missed.
///
/// Inside a step the state is that of a shorter step of the same method from the same node, as in [`dla::Watch`].
pub fn run_assembly_watched(
    assembly: &Assembly,
    method: &Method,
    schedule: &Schedule,
    (start, nodes): (&AssemblyState, AssemblyNodes<'_>),
    events: (&[AssemblyEvent<'_>], u32),
    progress: &mut dyn Progress,
) -> (Assembled, Vec<AssemblyCrossing>, Option<Close>) {
    let mut making = Making::new(assembly, method, schedule, start, nodes);
    let (mut ticker, mut crossings, mut unseen) = (AssemblyTicker::new(progress, 0), Vec::new(), 0);
    making.go(schedule.steps, &mut ticker, |method, step| {
        let last = ended(assembly, method, &step, events, (&mut crossings, &mut unseen));
        last.map_or(ControlFlow::Continue(()), ControlFlow::Break)
    });
    ticker.finish(making.made);
    let close = Close::with_unseen(AssemblyCrossing::close(&crossings), unseen);
    (making.assembled(ticker.stopped), crossings, close)
}
