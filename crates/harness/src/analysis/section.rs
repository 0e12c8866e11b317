use crate::Method;
use crate::run::integrate_pieces;
use dla::{Close, Crossing, Event, Mechanism, RunError, Schedule, Watch};

/// The crossings of a surface by one motion.
#[derive(Debug, Clone)]
pub struct Section {
    /// The crossings in the order of time, located to rounding: each is the end of a step that is shortened to end there.
    pub crossings: Vec<Crossing>,
    /// Crossings so close that others may have been missed.
    pub close: Option<Close>,
    /// The step that failed, if one did.
    pub failure: Option<RunError>,
    /// Whether the motion was ended early ([`Stop`](dla::Stop)).
    pub interrupted: bool,
}

/// Number of parts in which a step is searched: two crossings within one are not missed.
const SAMPLES: u32 = 2;

/// The crossings of the surface on which an event's function of time and state is zero, by a motion (Poincare 1881).
pub fn section(
    system: &dyn Mechanism,
    method: &Method,
    schedule: &Schedule,
    (q, v): (&[f64], &[f64]),
    surface: &Event<'_>,
) -> Section {
    let mut watch = Watch::new(method, std::slice::from_ref(surface), ());
    watch.samples = SAMPLES;
    let outcome = integrate_pieces(system, method, schedule, &mut system.state(q, v), &mut watch);
    let (crossings, close) = (watch.crossings().to_vec(), watch.close());
    let interrupted = matches!(outcome, Ok(made) if made < schedule.steps);
    Section { crossings, close, failure: outcome.err(), interrupted }
}
