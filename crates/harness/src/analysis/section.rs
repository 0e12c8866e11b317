use crate::run::integrate_pieces;
use crate::{Again, Method};
use dla::{Close, Crossing, Event, RunError, Schedule, State, Subject, Watch};

/// The crossings of a surface by one motion.
#[derive(Debug, Clone)]
pub struct Section<const N: usize> {
    /// The crossings in the order of time, located to rounding: each is the end of a step that is shortened to end there.
    pub crossings: Vec<Crossing<N>>,
    /// Which of them are so close that others may have been missed.
    pub close: Option<Close>,
    /// The step that failed, if one did.
    pub failure: Option<RunError>,
    /// Whether the motion was ended early ([`Stop`](dla::Stop)).
    pub interrupted: bool,
}

/// A step is looked at in so many parts: two crossings within one are not missed.
const SAMPLES: u32 = 2;

/// Where a motion crosses the surface on which an event's function of time and state is zero (Poincare 1881).
#[inline(never)]
pub fn section<const N: usize, const M: usize>(
    subject: Subject<'_, N, M>,
    method: &Method,
    schedule: &Schedule,
    (q, v): ([f64; N], [f64; N]),
    surface: &Event<'_, N>,
) -> Section<N> {
    let mut watch = Watch::new(Again { method, own: subject.own }, std::slice::from_ref(surface), ());
    watch.samples = SAMPLES;
    let outcome =
        integrate_pieces(subject, method, schedule, &mut State::new(q, v, subject.system.angles()), &mut watch);
    let (crossings, close) = (watch.crossings().to_vec(), watch.close());
    let interrupted = matches!(outcome, Ok(made) if made < schedule.steps);
    Section { crossings, close, failure: outcome.err(), interrupted }
}
