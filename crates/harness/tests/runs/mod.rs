//! Runs are measured as they are: means, extremes and slopes of known series, and the part of a run that fails.

mod baselines;
mod chaos;
mod diverged;
mod drift;
mod ensembles;
mod measures;
mod precision;
mod same_bits;
mod substeps;
mod train_pieces;
mod trains;
mod verdicts;
mod watched;
mod work;

use approx::assert_relative_eq;
use dla::{Mechanism, Schedule, Subject};
use harness::{METHODS, Method, MethodError, MethodInfo, MethodKind, Record, Request, Run, Trend};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Scalar, System};
use proptest::prelude::*;

/// A point of unit mass with `z' = y x'`, in a well that has no floor beyond `|y| = 1`.
#[derive(Clone)]
struct Particle {
    depth: f64,
    /// `z' = y y'` in its place, the rate of `z - y^2/2`.
    leaf: bool,
    /// Whether its admissible velocities have a basis.
    basis: bool,
}

impl Particle {
    fn of(depth: f64) -> Self {
        Self { depth, leaf: false, basis: false }
    }
}

impl System<3, 1> for Particle {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        // The mass across grows without bound at y = -1: a wall that no step may cross.
        let across = (q[1] + 1.0).recip();
        (v[0] * v[0] + v[1] * v[1] * across * across + v[2] * v[2]) * 0.5 - q[1] * q[1] * (0.5 * self.depth)
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let row = if self.leaf { [S::zero(), -q[1]] } else { [-q[1], S::zero()] };
        ([[row[0], row[1], S::constant(1.0)]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        self.basis.then(|| AdmissibleBasis::new([[one, zero, q[1]], [zero, one, zero]]))
    }
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<[Option<S>; 1]> {
        self.leaf.then(|| [Some(q[2] - q[1] * q[1] * 0.5)])
    }
}

impl Piecewise for Particle {
    fn piece(&self, _t: f64) -> Self {
        self.clone()
    }
}

fn run(system: &dyn Mechanism, method: &Method, request: &Request) -> Record {
    Run::of(system, method).timed(request)
}

fn request(steps: u64, step: f64) -> Request {
    let (q, v) = (vec![0.1, 0.2, 0.3], vec![0.9, 0.7, 0.2 * 0.9]);
    Request { schedule: Schedule { t0: 0.0, step, steps }, q, v, samples: 10 }
}

#[test]
fn a_record_tells_of_its_run() {
    let mut told = 0;
    let method = Method::named("dla", None).unwrap();
    let record = Run::of(&Subject::from(&Particle::of(1.0)), &method)
        .progress(&mut |steps| told += steps)
        .timed(&request(95, 0.05));
    assert_eq!((record.steps, told), (95, 95));
    assert_relative_eq!(record.t, 95.0 * 0.05);
    assert!(record.failure.is_none() && record.wall_seconds > 0.0);
    assert!(record.newton.mean >= 1.0 && f64::from(record.newton.max) >= record.newton.mean);
    assert!(record.constraint_max < 1e-14);
    assert!((record.energy.last - record.energy.initial).abs() <= record.energy.max_error);
    // The first, every tenth, the last; and no peak between them is lost.
    let times: Vec<f64> = record.samples.iter().map(|s| (s.t / 0.05).round()).collect();
    assert_eq!(times, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 95.0]);
    let peak = record.samples.iter().map(|s| s.energy_error).fold(0.0, f64::max);
    assert_relative_eq!(peak, record.energy.max_error);
}

#[test]
fn explicit_methods_have_no_newton() {
    let method = Method::named("rk4", None).unwrap();
    let record = run(&Subject::from(&Particle::of(1.0)), &method, &request(20, 0.05));
    assert_eq!((record.newton.mean.to_bits(), record.newton.max), (0, 0));
    assert!(record.constraint_max > 0.0);
}

/// A method that needs a basis says so instead of running.
#[test]
fn a_refusal_is_a_record_with_its_reason() {
    let method = Method::named("rk4-reduced", None).unwrap();
    let record = run(&Subject::from(&Particle::of(1.0)), &method, &request(20, 0.05));
    let failure = record.failure.unwrap();
    assert_eq!((failure.step, record.steps), (1, 0));
    assert!(failure.to_string().contains("basis"), "{failure}");
}

/// A node beyond all numbers is none, by any method: the run ends at the last that is one.
#[test]
fn a_run_ends_where_the_numbers_do() {
    let system = Particle { basis: true, ..Particle::of(0.0) };
    let system = Subject::from(&system);
    let at_the_end = |step| Request { q: vec![f64::MAX, 0.0, 0.0], v: vec![1.0, 0.0, 0.0], ..request(2, step) };
    for info in general() {
        let method = Method::named(info.name, None).unwrap();
        let record = run(&system, &method, &at_the_end(1e293));
        assert!(record.failure.is_some() && record.steps == 0, "{record:?}");
        assert_eq!((record.q[0], record.v[0]), (f64::MAX, 1.0), "{}", info.name);
        // The control: an ordinary step is below the rounding of such a place, and is made.
        let record = run(&system, &method, &at_the_end(1.0));
        assert!(record.failure.is_none() && record.q[0].to_bits() == f64::MAX.to_bits(), "{record:?}");
    }
}

/// The methods for any system: all but the series, which only a sleigh has.
fn general() -> impl Iterator<Item = &'static MethodInfo> + Clone {
    METHODS.iter().filter(|info| info.kind != MethodKind::Taylor)
}

/// Some of them: one of each family, with those that carry something from step to step.
fn families() -> impl Iterator<Item = &'static MethodInfo> + Clone {
    const NAMES: [&str; 7] = ["dla", "dla4", "lobatto3", "gauss-adaptive", "energy4", "gni", "dop853"];
    METHODS.iter().filter(|info| NAMES.contains(&info.name))
}

#[test]
fn methods_are_found_by_their_names() {
    for info in METHODS {
        assert_eq!(Method::named(info.name, None).unwrap().info().kind, info.kind);
        assert_eq!(METHODS.iter().filter(|other| other.name == info.name || other.kind == info.kind).count(), 1);
    }
    let error = Method::named("dlb", None).unwrap_err();
    assert!(error.to_string().contains("dla-trapezoid"), "{error}");
    assert!(matches!(Method::named("dla-alpha", Some(1.5)), Err(MethodError::Alpha(_))));
    assert_eq!(Method::named("dla-alpha", Some(0.3)).unwrap().info().order, 1);
    assert_eq!(Method::named("dla-alpha", None).unwrap().info().order, 2);
    let adaptive = Method::named("dop853", None).unwrap();
    assert_eq!(adaptive.tolerance().to_bits(), Method::TOLERANCE.to_bits());
    assert_eq!(adaptive.with_tolerance(1e-9).unwrap().tolerance().to_bits(), 1e-9f64.to_bits());
    for tolerance in [0.0, -1e-9, f64::NAN, f64::INFINITY] {
        let error = adaptive.with_tolerance(tolerance).unwrap_err();
        assert!(error.to_string().contains("tolerance"), "{error}");
    }
}

proptest! {
    /// The slope of a line with noise that cancels is the line's, far from the origin too.
    #[test]
    fn the_trend_of_a_line(slope in -1e3..1e3f64, offset in -1e6..1e6f64, far in 0.0..1e6f64) {
        let mut trend = Trend::default();
        for k in 0..1000 {
            let x = far + f64::from(k);
            let noise = if k % 2 == 0 { 1e-3 } else { -1e-3 };
            trend.add(x, offset + slope * (x - far) + noise);
        }
        // Alternating noise tilts a line through n points by 6 e / n^2; rounding of y is relative to its size.
        let rounding = f64::EPSILON * (offset.abs() + 1e3 * slope.abs() + far);
        prop_assert!((trend.slope().unwrap() - slope).abs() <= 6e-3 / 1e6 * 2.0 + rounding);
    }
}

#[test]
fn a_trend_needs_two_points() {
    let mut trend = Trend::default();
    assert_eq!(trend.slope(), None);
    trend.add(1.0, 2.0);
    assert_eq!(trend.slope(), None);
    trend.add(1.0, 3.0);
    assert_eq!(trend.slope(), None);
    trend.add(2.0, 2.0);
    assert_relative_eq!(trend.slope().unwrap(), -0.5, epsilon = 1e-15);
}
