use crate::convergence::{most_roundings, tolerances::OF_CORRECTION};
use crate::{History, Mechanics, NewtonError, Stage, State, StepError};
use lagrangian::linear::largest;
use lagrangian::{Dual, Rounded, RowSpace, Saddle, from_fn, mapped};

/// The increment of a step with its end projected onto the constraints on positions, `g(q1) = 0`, in the kinetic metric: Newton's method
/// with the gradients at the iterate. Without such constraints nothing is done.
///
/// If rows are dependent, only independent ones are used.
///
/// # Errors
/// [`StepError::Newton`] if no such place is found.
#[inline(always)]
pub(crate) fn onto_positions<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t1: f64,
    state: &State<N>,
    mut increment: [f64; N],
    v: &[f64; N],
) -> Result<[f64; N], StepError> {
    let fail = |source| StepError::Newton { stage: Stage::Positions, source };
    let (mut before, mut history) = (f64::INFINITY, History::new());
    for iteration in 1..=ITERATIONS {
        let q1 = state.ahead(&increment);
        let Some(misses) = system.position_misses(t1, &q1) else { return Ok(increment) };
        if misses.iter().flatten().all(|g| is_rounding(g, &q1)) {
            return Ok(increment);
        }
        let moved = correction(system, t1, &q1, v, &misses)
            .map_err(|source| fail(NewtonError::Singular { iteration, source, history }))?;
        for i in 0..N {
            increment[i] += moved[i];
        }
        let (step, size) = (largest(&moved), largest(&q1));
        history.push(step / size);
        if !step.is_finite() {
            return Err(fail(NewtonError::NotFinite { iteration, history }));
        }
        // Where corrections stall at round-off, the iteration has converged.
        let slight = step <= 16.0 * N as f64 * f64::EPSILON * size;
        if step <= NEARLY * size && step >= 0.25 * before {
            // A place near zero is known to the rounding of the increment that leads there.
            let rounded = from_fn(|i| Rounded { value: q1[i], size: q1[i].abs() + increment[i].abs() });
            let left = system.positions_rounded(Rounded::exact(t1), &rounded);
            let off = most_roundings(left.into_iter().flatten().flatten()) > OF_CORRECTION;
            // Dependent rows that contradict one another leave a residual that no move removes.
            if !off {
                return Ok(increment);
            }
            if slight {
                return Err(fail(NewtonError::IterationLimit {
                    iterations: iteration,
                    correction: step / size,
                    history,
                }));
            }
        }
        before = step;
    }
    let correction = history.last().unwrap_or(before);
    Err(fail(NewtonError::IterationLimit { iterations: ITERATIONS, correction, history }))
}

/// Relative corrections that stall below this may be rounding, which rows that nearly depend on one another make larger.
const NEARLY: f64 = 1e-9;

const ITERATIONS: u32 = 50;

/// Whether a miss is no more than the last digits of the coordinates make.
#[inline(always)]
fn is_rounding<const N: usize>(g: &Dual<f64, N>, q: &[f64; N]) -> bool {
    let size: f64 = g.eps.iter().zip(q).map(|(slope, q)| (slope * q).abs()).sum();
    g.re.abs() <= f64::EPSILON * size
}

/// The correction `-M^-1 A' (A M^-1 A')^-1 g` for the rows of the positions.
#[cold]
#[inline(never)]
fn correction<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    misses: &[Option<Dual<f64, N>>; M],
) -> Result<[f64; N], lagrangian::linear::Singular> {
    let (_, mass) = system.mass_matrix(t, q, v);
    // Rows of the velocities are zero here, and so left out.
    let rows = mapped(misses, |g| g.map_or([0.0; N], |g| g.eps));
    let some = RowSpace::new(&rows, &mass, RowSpace::<N, M>::ROUNDING).dependence().independent;
    let level = mapped(misses, |g| g.map_or(0.0, |g| -g.re));
    let saddle = Saddle { block: mass, transposed: rows, rows, right: [0.0; N], level };
    // Without a mass in some direction the kinetic metric is none, and another one serves.
    let euclidean = || Saddle { block: from_fn(|i| from_fn(|j| f64::from(i == j))), ..saddle }.solve_some(some);
    saddle.solve_some(some).or_else(|_| euclidean()).map(|(moved, _)| moved)
}

/// Refuses a system with constraints that a method cannot carry.
#[inline(always)]
pub(crate) fn affine_only<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    state: &State<N>,
) -> Result<(), StepError> {
    match system.is_nonlinear(t, state.q(), state.v()) {
        false => Ok(()),
        true => Err(StepError::Unsupported {
            reason: "the method needs constraints that are affine in the velocities, and a constraint of the system \
                is not: take a method of the family `dla`",
        }),
    }
}

/// Refuses a system with constraints on positions.
#[inline(always)]
pub(crate) fn velocities_only<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    state: &State<N>,
    reason: &'static str,
) -> Result<(), StepError> {
    match system.constrains_positions(t, state.q()) {
        false => Ok(()),
        true => Err(StepError::Unsupported { reason }),
    }
}
