use crate::tools::{bent, slope, train};
use assembly::parts::Train;
use assembly::{AssemblyMethod, Solver, SparseDla, SparseEnergy, SparseLobatto};
use rustix::time::{ClockId, clock_gettime};

/// The processor time of this thread (s): that of the clock on the wall is of all who work here.
fn seconds() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Processor seconds of the fastest of some steps.
fn step(blades: usize, solver: Solver, steps: u32) -> f64 {
    let train = train(blades);
    let mut method = SparseDla::new(&train.assembly, solver).unwrap().on_one_thread();
    of(&train, &mut method, steps)
}

fn of(train: &Train, method: &mut dyn AssemblyMethod, steps: u32) -> f64 {
    let mut state = bent(train);
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
fn a_step_costs_in_proportion_to_the_blades() {
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
fn sparse_is_faster_than_dense() {
    let (sparse, dense) = (step(100, Solver::Sparse, 20), step(100, Solver::Dense, 3));
    println!("{sparse:e} s against {dense:e} s: {} times", dense / sparse);
    assert!(dense > 20.0 * sparse, "{dense} against {sparse}");
}

/// Figures for the book: memory, and steps of trains up to ten thousand blades.
#[test]
#[ignore = "measures, and checks nothing"]
fn figures() {
    for blades in [1, 3, 10, 30, 100, 300, 1000, 3000, 10_000] {
        let mut seconds = 0.0;
        let memory = allocation_counter::measure(|| seconds = step(blades, Solver::Best, 30)).bytes_max;
        println!("{blades:>5} blades: {:.4} ms a step, {:.1} kB", seconds * 1e3, memory as f64 / 1024.0);
    }
}

/// Of the other methods too, to thousands of blades.
#[test]
#[ignore = "measures, and checks nothing"]
fn figures_of_methods() {
    for blades in [10, 100, 1000, 10_000] {
        let train = train(blades);
        let assembly = &train.assembly;
        let new: [(&str, Box<dyn AssemblyMethod>); 4] = [
            ("dla", Box::new(SparseDla::new(assembly, Solver::Best).unwrap().on_one_thread())),
            ("energy2", Box::new(SparseEnergy::new(assembly, Solver::Best).unwrap())),
            ("lobatto3", Box::new(SparseLobatto::new(assembly, Solver::Best, 3).unwrap())),
            ("lobatto5", Box::new(SparseLobatto::new(assembly, Solver::Best, 5).unwrap())),
        ];
        for (name, mut method) in new {
            println!("{blades:>5} blades, {name}: {:.4} ms a step", of(&train, method.as_mut(), 5) * 1e3);
        }
    }
}
