use dla::{Schedule, Subject};
use harness::precision::{
    Bench, Cheapest, Curve, LEVELS, LadderLimits, Reference, ReferenceError, ReferenceMotion, cheapest, mark_pareto,
    seconds_to, work_precision,
};
use harness::{Method, MethodError, Record, Request, Run};
use lagrangian::linear::larger;
use std::fmt;
use thiserror::Error;

/// Runs of a system by several methods. Displayed, they are a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The run of each method, in the order of the request.
    pub runs: Vec<Record>,
}

/// Makes the same run by each of these methods, named as in the table of methods, and measures constraint, energy and time.
///
/// # Errors
/// [`MethodError`] names an unknown method. A run that fails gives a [`Record`] of the part before the failure.
///
/// ```
/// use noslip::Schedule;
///
/// noslip::system! {
///     struct Skate;
///     coordinates = { x = "m", y = "m", theta = "angle" }
///     parameters = { m = 1.0, J = 0.5, g = 1.0 }
///     lagrangian = "m/2*(x'^2 + y'^2) + J/2*theta'^2 + m*g*x"
///     constraints = ["y'*cos(theta) - x'*sin(theta)"]
/// }
///
/// let schedule = Schedule { t0: 0.0, step: 0.05, steps: 400 };
/// let start = ([0.0; 3], [0.0, 0.0, 1.0]);
/// let compared = noslip::compare(&Skate::default(), &["dla", "rk4"], &schedule, start)?;
/// let [dla, rk4] = &compared.runs[..] else { unreachable!() };
/// assert!(dla.constraint_max < 1e-15 && rk4.constraint_max > 1e-9);
/// println!("{compared}");
/// # Ok::<(), noslip::harness::MethodError>(())
/// ```
///
/// A system of two functions, whose forces never jump, goes as [`Subject::smooth`]:
///
/// ```
/// use noslip::{Constraint, Scalar, Schedule, Subject, System};
///
/// struct Particle;
///
/// impl System<3, 1> for Particle {
///     fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
///         (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
///     }
///     fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
///         ([[-q[1], S::zero(), S::constant(1.0)]], [S::zero()])
///     }
/// }
///
/// let schedule = Schedule { t0: 0.0, step: 0.01, steps: 300 };
/// let start = ([0.1, 0.2, 0.3], [0.9, 0.7, 0.2 * 0.9]);
/// let compared = noslip::compare(Subject::smooth(&Particle), &["dla", "rk4"], &schedule, start)?;
/// assert!(compared.runs.iter().all(|run| run.failure.is_none() && run.energy.max_error < 1e-4));
/// # Ok::<(), noslip::harness::MethodError>(())
/// ```
pub fn compare<'a, const N: usize, const M: usize>(
    system: impl Into<Subject<'a, N, M>>,
    methods: &[&str],
    schedule: &Schedule,
    (q, v): ([f64; N], [f64; N]),
) -> Result<Comparison, MethodError> {
    /// Nodes that a record keeps for plots.
    const SAMPLES: u64 = 200;
    let subject = system.into();
    let request = Request { schedule: *schedule, q: q.to_vec(), v: v.to_vec(), samples: SAMPLES };
    let one = |name: &&str| Method::named(name, None).map(|method| Run::of(&subject, &method).timed(&request));
    let runs = methods.iter().map(one).collect::<Result<_, _>>()?;
    Ok(Comparison { runs })
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<14} {:>10} {:>10} {:>12} {:>10}", "method", "steps", "constraint", "energy error", "wall [s]")?;
        for run in &self.runs {
            let (name, slip, energy) = (run.method.name, run.constraint_max, run.energy.max_error);
            write!(f, "{name:<14} {:>10} {slip:>10.1e} {energy:>12.1e} {:>10.1e}", run.steps, run.wall_seconds)?;
            match &run.failure {
                Some(failure) => writeln!(f, "  {failure}")?,
                None => writeln!(f)?,
            }
        }
        Ok(())
    }
}

/// Why there is no work-precision diagram.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PrecisionError {
    /// A name is not the name of a method.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// There is no reference for the end of the motion.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
}

/// The time that accuracy costs each method. Displayed, it is a table.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkPrecision {
    /// The points of each method, from coarse to fine.
    pub curves: Vec<Curve>,
    /// Bound on the error of the reference (m or rad).
    pub reference_error: f64,
}

/// Measures the error at the end of a motion of `duration` (s) against the time of computing it, for each of these methods; runs take
/// `longest` (s) at most. The error is the largest among the coordinates, from a reference of order 16 that is computed first.
///
/// # Errors
/// [`PrecisionError`] names an unknown method, or says why there is no reference.
///
/// ```no_run
/// # noslip::system! {
/// #     struct Skate;
/// #     coordinates = { x = "m", y = "m", theta = "angle" }
/// #     lagrangian = "(x'^2 + y'^2 + theta'^2)/2 + x"
/// #     constraints = ["y'*cos(theta) - x'*sin(theta)"]
/// # }
/// let found = noslip::precision(&Skate::default(), &["dla4", "gauss16"], ([0.0; 3], [0.0, 0.0, 1.0]), 20.0, 0.1)?;
/// println!("{found}");
/// # Ok::<(), noslip::PrecisionError>(())
/// ```
pub fn precision<'a, const N: usize, const M: usize>(
    system: impl Into<Subject<'a, N, M>>,
    methods: &[&str],
    (q, v): ([f64; N], [f64; N]),
    duration: f64,
    longest: f64,
) -> Result<WorkPrecision, PrecisionError> {
    let methods = methods.iter().map(|name| Method::named(name, None)).collect::<Result<Vec<_>, _>>()?;
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |most, (a, b)| larger(most, (a - b).abs()));
    let subject = system.into();
    let motion = ReferenceMotion::new(&subject, &q, &v, duration);
    let reference = Reference::converged(&motion, &apart)?;
    let end_error = |method: &Method, steps: u64| motion.end(method, steps).map(|q| apart(&q, &reference.q));
    let aligned = |steps: u64| motion.aligned(steps);
    let bench = Bench { duration, reference_error: reference.error, end_error: &end_error, aligned: &aligned };
    let limits = LadderLimits { fewest: motion.aligned(2), longest };
    let (mut curves, _) = work_precision(&bench, &methods, &limits, &mut ());
    mark_pareto(&mut curves, reference.error);
    Ok(WorkPrecision { curves, reference_error: reference.error })
}

impl WorkPrecision {
    /// The cheapest methods at each of the errors [`LEVELS`].
    #[must_use]
    pub fn cheapest(&self) -> Vec<Cheapest> {
        cheapest(&self.curves)
    }
}

impl fmt::Display for WorkPrecision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<14}", "time [s]")?;
        LEVELS.iter().try_for_each(|error| write!(f, " {:>10}", format!("to {error:e}")))?;
        writeln!(f)?;
        for curve in &self.curves {
            write!(f, "{:<14}", curve.method)?;
            for error in LEVELS {
                match seconds_to(&curve.points, error) {
                    Some(seconds) => write!(f, " {seconds:>10.1e}")?,
                    None => write!(f, " {:>10}", "-")?,
                }
            }
            match curve.refusal {
                Some(reason) => writeln!(f, "  {reason}")?,
                None => writeln!(f)?,
            }
        }
        Ok(())
    }
}
