//! Finds the place in a step at which rows of the constraint become dependent.

use crate::dependent::{Dependency, Dependent};
use crate::{Mechanics, State, StepError};
use lagrangian::linear::{larger, largest};
use lagrangian::{RowSpace, Rows, from_fn};

/// The predicted motion from a node, by the number of steps.
struct Way<'a, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    t0: f64,
    h: f64,
    start: &'a State<N>,
    acceleration: [f64; N],
    /// The sizes of the rows at the node, in the kinetic metric.
    sizes: [f64; M],
}

/// Finds the place at which the rank of the rows drops within `steps` steps from the node `start`, along the predicted motion.
///
/// The rows must come ten times nearer to a dependence there than at the node; otherwise `None`.
#[cold]
#[inline(never)]
pub(crate) fn rank_drop<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    start: &State<N>,
    steps: f64,
) -> Option<Dependent> {
    /// Largest distance from a dependence, relative to the distance at the node.
    const NEARER: f64 = 0.1;
    const SAMPLES: i32 = 16;
    if M == 0 {
        return None;
    }
    let (q0, v0) = (start.q(), start.v());
    let acceleration = system.motion(t0, q0, v0).map_or([0.0; N], |motion| motion.acceleration);
    let sizes = row_sizes(system, t0, q0, v0, RowSpace::<N, M>::ROUNDING).1;
    let way = Way { system, t0, h, start, acceleration, sizes };
    let mut nearest = (f64::INFINITY, 0.0, 0.0);
    // Not farther than angles can be followed along a line.
    let angles = system.angles();
    let turn = (0..N).filter(|&i| angles[i]).fold(0.0, |most, i| larger(most, h * v0[i]));
    let part = f64::min(steps, 2.0 / turn) / f64::from(SAMPLES);
    // Ever shorter ways too: a node that is near to the drop passes it soon.
    let evenly = (0..=SAMPLES).map(|k| (part * f64::from(k), part));
    let shorter = (1..SAMPLES).map(|k| part * 0.5_f64.powi(k)).map(|s| (s, s));
    for (s, width) in evenly.chain(shorter) {
        let distance = way.distance(s);
        if distance < nearest.0 {
            nearest = (distance, s, width);
        }
    }
    // The distance falls and rises again like the size of a number that changes its sign.
    let (mut least, mut place, mut width) = nearest;
    while width > 1e-12 && least > 0.0 {
        width *= 0.5;
        for s in [place - width, place + width].map(|s| f64::max(s, 0.0)) {
            let distance = way.distance(s);
            if distance < least {
                (least, place) = (distance, s);
            }
        }
    }
    if !(least <= NEARER * way.distance(0.0) && way.is_admissible(place)) {
        return None;
    }
    let (space, sizes) = way.at(place, larger(2.0 * least, RowSpace::<N, M>::ROUNDING));
    Some(dropped(&space, (&sizes, &way.sizes), t0 + place * h, least))
}

impl<const N: usize, const M: usize> Way<'_, N, M> {
    /// The span of the rows and their sizes, `s` steps from the node.
    fn at(&self, s: f64, tolerance: f64) -> (RowSpace<N, M>, [f64; M]) {
        row_sizes(self.system, self.t0 + s * self.h, &self.place(s), self.start.v(), tolerance)
    }

    fn place(&self, s: f64) -> [f64; N] {
        let Self { h, start, acceleration, .. } = self;
        start.ahead(&from_fn(|i| s * h * (start.v()[i] + 0.5 * s * h * acceleration[i])))
    }

    /// Whether the constraints on positions hold `s` steps from the node, so that the way shows the motion: a way across a circle comes to
    /// the middle, where its row vanishes, but the motion does not.
    fn is_admissible(&self, s: f64) -> bool {
        /// Largest miss, relative to the change of the constraint along the way.
        const MISSES: f64 = 0.05;
        let Self { system, t0, h, start, .. } = self;
        let (t, q) = (t0 + s * h, self.place(s));
        let Some(misses) = system.position_misses(t, &q) else { return true };
        let rows = system.reaction_rows(*t0, start.q(), start.v());
        (0..M).all(|k| {
            let along: f64 = (0..N).map(|i| (rows[k][i] * h * start.v()[i]).abs()).sum();
            misses[k].is_none_or(|g| g.re.abs() <= MISSES * along)
        })
    }

    fn distance(&self, s: f64) -> f64 {
        distance(&self.at(s, RowSpace::<N, M>::ROUNDING), &self.sizes)
    }
}

/// The span of the rows at a place, and their sizes in the kinetic metric.
fn row_sizes<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    tolerance: f64,
) -> (RowSpace<N, M>, [f64; M]) {
    let space = system.row_space(t, q, v, tolerance);
    let rows = system.reaction_rows(t, q, v);
    (space, from_fn(|k| space.outside(&rows[k]).1))
}

/// How far the nearest row is from the span of the remaining rows, relative to its size, or from zero, relative to its size elsewhere.
fn distance<const N: usize, const M: usize>((space, sizes): &(RowSpace<N, M>, [f64; M]), elsewhere: &[f64; M]) -> f64 {
    (0..M).fold(space.dependence().distance, |least, k| least.min(sizes[k] / elsewhere[k]))
}

/// A change of the velocity above this fraction of it within a step asks for an explanation.
const MUCH: f64 = 0.3;

/// The place between two nodes at which the motion has left its branch: the velocity changes by more than its acceleration explains, and
/// the rank of the rows drops.
#[inline(always)]
pub(crate) fn left_branch<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    start: &State<N>,
    end: &State<N>,
) -> Option<Dependent> {
    if M == 0 || !turns(MUCH, start.v(), end.v()) { None } else { unexplained(system, (t0, h), start, end) }
}

/// Moves a state to the velocity `v1` by `advance`, unless the motion would leave its branch at a drop of the rank of the constraint.
///
/// # Errors
/// [`StepError::Dependent`] if it would leave its branch, with the state as it was; and the errors of `advance`.
#[inline(always)]
pub fn on_branch<R, const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: &mut State<N>,
    v1: &[f64; N],
    advance: impl Fn(&mut State<N>) -> Result<R, StepError>,
) -> Result<R, StepError> {
    if M == 0 || !turns(MUCH, state.v(), v1) {
        return advance(state);
    }
    let before = *state;
    let made = advance(state)?;
    match unexplained(system, (t0, h), &before, state) {
        Some(dropped) => {
            *state = before;
            Err(dropped.into())
        }
        None => Ok(made),
    }
}

/// Fails if the accelerations of the stages of an explicit step differ by more than half of their size because the rank of the rows drops
/// within it. Near there small misses of the constraint are large accelerations, which lead to another branch little by little.
///
/// # Errors
/// [`StepError::Dependent`] with the place.
#[inline(always)]
pub(crate) fn even_accelerations<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    step: (f64, f64),
    start: &State<N>,
    accelerations: &[[f64; N]; 4],
) -> Result<(), StepError> {
    let [first, others @ ..] = accelerations;
    // A single row depends on no other row. A step in which the row vanishes changes the velocity, and [`on_branch`] finds that change.
    if M < 2 || !others.iter().any(|other| turns(UNEVEN, first, other)) {
        return Ok(());
    }
    rank_drop(system, step, start, 1.0).map_or(Ok(()), |dropped| Err(dropped.into()))
}

/// Accelerations that differ by more than this part of their size within a step are not explained by a smooth motion.
const UNEVEN: f64 = 0.5;

/// Whether a vector changes by more than `part` of its size.
#[inline(always)]
fn turns<const N: usize>(part: f64, v0: &[f64; N], v1: &[f64; N]) -> bool {
    let change: [f64; N] = from_fn(|i| v1[i] - v0[i]);
    largest(&change) > part * larger(largest(v0), largest(v1))
}

#[cold]
#[inline(never)]
fn unexplained<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    start: &State<N>,
    end: &State<N>,
) -> Option<Dependent> {
    let (v0, v1) = (start.v(), end.v());
    let acceleration = |t: f64, at: &State<N>| system.motion(t, at.q(), at.v()).map(|motion| motion.acceleration);
    let explained = match (acceleration(t0, start), acceleration(t0 + h, end)) {
        // Where rows are nearly dependent, accelerations are large and say nothing.
        (Ok(a0), Ok(a1)) => {
            let expected = from_fn(|i| v0[i] + 0.5 * h * (a0[i] + a1[i]));
            !turns(UNEVEN, &a0, &a1) && !turns(MUCH, &expected, v1)
        }
        _ => false,
    };
    if explained { None } else { rank_drop(system, (t0, h), start, 1.0) }
}

/// The place at which a method with short steps of its own is turned from its branch: the velocity turns between two of them, and the rows
/// are nearly dependent there compared with the node `far`. An adaptive method resolves that turn, although its errors cause it.
#[inline(always)]
pub(crate) fn turned_off<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    far: &(f64, State<N>),
    last: &State<N>,
    (t, node): (f64, &State<N>),
) -> Option<Dependent> {
    /// A turn relative to the velocity, in one of the method's own steps.
    const TURN: f64 = 0.02;
    if M == 0 || !turns(TURN, last.v(), node.v()) { None } else { nearly_dependent(system, far, (t, node)) }
}

#[cold]
#[inline(never)]
fn nearly_dependent<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    (t0, far): &(f64, State<N>),
    (t, node): (f64, &State<N>),
) -> Option<Dependent> {
    /// Distance from a dependence, relative to the distance at `far`.
    const NEARLY: f64 = 1e-3;
    let tolerance = RowSpace::<N, M>::ROUNDING;
    let elsewhere = row_sizes(system, *t0, far.q(), far.v(), tolerance);
    let here = row_sizes(system, t, node.q(), node.v(), tolerance);
    let least = distance(&here, &elsewhere.1);
    (least <= NEARLY * distance(&elsewhere, &elsewhere.1)).then(|| {
        let space = system.row_space(t, node.q(), node.v(), larger(2.0 * least, tolerance));
        dropped(&space, (&here.1, &elsewhere.1), t, least)
    })
}

/// The error that names the rows that depend on one another at a place; the nearest row is `least` from a dependence.
fn dropped<const N: usize, const M: usize>(
    space: &RowSpace<N, M>,
    (sizes, elsewhere): (&[f64; M], &[f64; M]),
    time: f64,
    least: f64,
) -> Dependent {
    let vanishing: Rows = (0..M).filter(|&k| sizes[k] <= 2.0 * least * elsewhere[k]).collect();
    let rows = if vanishing.is_empty() { space.dependence().involved } else { vanishing };
    Dependent { rows, time, distance: least, dependency: Dependency::RankDrops }
}
