//! What a step costs, counted; and measured by
//!
//! ```text
//! NOSLIP_MEASURE=1 cargo test --release -p noslip-assembly -- --ignored --nocapture cost
//! ```

use crate::tools::{bent, slope, train};
use assembly::parts::Train;
use assembly::{AssemblyMethod, Solver, SparseDla};
use lagrangian::{Constraint, Piecewise, Scalar, System};
use rustix::time::{ClockId, clock_gettime};
use sleigh::Sleigh;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// A sleigh that counts how often it is asked for its Lagrangian.
struct Counted {
    sleigh: Sleigh,
    asked: Arc<AtomicUsize>,
}

impl System<3, 1> for Counted {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.asked.fetch_add(1, Relaxed);
        self.sleigh.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        self.sleigh.constraint(t, q)
    }
    fn angles(&self) -> [bool; 3] {
        self.sleigh.angles()
    }
}

impl Piecewise for Counted {
    fn piece(&self, _t: f64) -> Self {
        Self { sleigh: self.sleigh, asked: Arc::clone(&self.asked) }
    }
}

const STEPS: u32 = 3;

/// How often a blade is asked in an iteration, in the mean, and the iterations of some steps.
fn evaluations(blades: usize) -> (f64, u32) {
    let plain = train(blades);
    let asked = Arc::new(AtomicUsize::new(0));
    let counted = |sleigh: Sleigh| Counted { sleigh, asked: Arc::clone(&asked) };
    let lead = counted(Sleigh::new(1.0, 1.0, 0.5).unwrap());
    let train = Train::new(lead, plain.trailers().to_vec(), |trailer| counted(trailer.sleigh)).unwrap();
    let mut method = SparseDla::new(&train.assembly, Solver::Sparse).unwrap().on_one_thread();
    let mut state = bent(&train);
    asked.store(0, Relaxed);
    let mut step = |k: u32| method.step(&train.assembly, f64::from(k) * 0.02, 0.02, &mut state).unwrap();
    let iterations = (0..STEPS).map(&mut step).sum();
    (asked.load(Relaxed) as f64 / (f64::from(iterations) * blades as f64), iterations)
}

/// Bytes of a method after `steps` steps.
fn memory(blades: usize, solver: Solver, steps: u32) -> f64 {
    let train = train(blades);
    let mut state = bent(&train);
    let run = || {
        let mut method = SparseDla::new(&train.assembly, solver).unwrap().on_one_thread();
        for k in 0..steps {
            method.step(&train.assembly, f64::from(k) * 0.02, 0.02, &mut state).unwrap();
        }
    };
    allocation_counter::measure(run).bytes_max as f64
}

/// A blade of a long train is asked no more often than one of a short train, and the factors, which are as long as what is done with them,
/// grow with the blades; the control is the dense matrix, which has the room of its factors from the beginning.
#[test]
fn evaluations_and_factors_are_in_proportion_to_the_blades() {
    let ((few, short), (many, long)) = (evaluations(10), evaluations(80));
    println!("{few} evaluations a blade in {short} iterations, {many} in {long}");
    assert!(few > 0.0 && many < 1.25 * few && long <= short + STEPS, "{few} {short}, {many} {long}");
    let exponent =
        |solver, steps| slope(&[10, 40, 160].map(|blades| ((blades as f64).ln(), memory(blades, solver, steps).ln())));
    let (sparse, dense) = (exponent(Solver::Sparse, 1), exponent(Solver::Dense, 0));
    println!("exponents {sparse}, {dense}");
    assert!(sparse < 1.4 && dense > 1.6, "{sparse} {dense}");
}

/// Whether figures of this machine are asked for.
fn measures() -> bool {
    std::env::var_os("NOSLIP_MEASURE").is_some_and(|value| value == "1")
}

/// The processor time of this thread (s). The clock on the wall also counts the work of others.
fn seconds() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Processor seconds of the fastest of some steps.
fn step(blades: usize, solver: Solver, steps: u32) -> f64 {
    let train = train(blades);
    let mut method = SparseDla::new(&train.assembly, solver).unwrap().on_one_thread();
    let mut state = bent(&train);
    let mut fastest = f64::INFINITY;
    for k in 0..steps {
        let clock = seconds();
        method.step(&train.assembly, f64::from(k) * 0.02, 0.02, &mut state).unwrap();
        fastest = fastest.min(seconds() - clock);
    }
    fastest
}

/// Of a hundred blades on, where a step is more than its overhead: below, the exponent is less than one.
#[test]
#[ignore = "measures, if NOSLIP_MEASURE=1"]
fn a_step_costs_in_proportion_to_the_blades() {
    if !measures() {
        return;
    }
    let points: Vec<(f64, f64)> = [100usize, 400, 1600, 6400]
        .map(|blades| {
            let seconds = step(blades, Solver::Sparse, 20);
            println!("{blades} blades: {seconds:e} s a step");
            ((blades as f64).ln(), seconds.ln())
        })
        .to_vec();
    let exponent = slope(&points);
    println!("exponent {exponent}");
    assert!(exponent < 1.25, "exponent {exponent}");
}

/// The bar is 20, met many times over.
#[test]
#[ignore = "measures, if NOSLIP_MEASURE=1"]
fn sparse_is_faster_than_dense() {
    if !measures() {
        return;
    }
    let (sparse, dense) = (step(100, Solver::Sparse, 20), step(100, Solver::Dense, 3));
    println!("{sparse:e} s against {dense:e} s: {} times", dense / sparse);
    assert!(dense > 20.0 * sparse, "{dense} against {sparse}");
}

/// Figures for the book: memory, and steps of trains up to ten thousand blades.
#[test]
#[ignore = "measures, if NOSLIP_MEASURE=1"]
fn figures() {
    if !measures() {
        return;
    }
    for blades in [1, 3, 10, 30, 100, 300, 1000, 3000, 10_000] {
        let mut seconds = 0.0;
        let memory = allocation_counter::measure(|| seconds = step(blades, Solver::Best, 30)).bytes_max;
        println!("{blades:>5} blades: {:.4} ms a step, {:.1} kB", seconds * 1e3, memory as f64 / 1024.0);
    }
}
