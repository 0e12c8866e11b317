//! A chain of unlike blades that rolls over hills, its own weight on each.

use crate::tools::{bent, slope, weighted};
use assembly::parts::Train;
use assembly::{AssemblyMethod, Solver, SparseDla};

/// The largest relative energy error of a run.
fn error(train: &Train, method: &mut dyn AssemblyMethod, duration: f64, h: f64) -> f64 {
    let (assembly, mut state) = (&train.assembly, bent(train));
    let initial = assembly.energy(0.0, &state);
    let mut most = 0.0f64;
    for k in 0..(duration / h).round() as u32 {
        method.step(assembly, f64::from(k) * h, h, &mut state).unwrap();
        most = most.max(((assembly.energy(0.0, &state) - initial) / initial).abs());
    }
    most
}

/// The exponent of the step in the error, and the error with the shortest.
fn fitted(train: &Train, duration: f64, lengths: &[f64]) -> (f64, f64) {
    let of = |h: f64| error(train, &mut SparseDla::new(&train.assembly, Solver::Best).unwrap(), duration, h);
    let points: Vec<_> = lengths.iter().map(|h| (h.ln(), of(*h).ln())).collect();
    (slope(&points), points[points.len() - 1].1.exp())
}

#[test]
fn its_energy_error_is_of_second_order() {
    of_second_order((3, 0.1), 3.0, &[0.04, 0.02]);
}

#[test]
#[ignore = "slow"]
fn its_energy_error_is_of_second_order_at_length() {
    of_second_order((10, 1e-4), 40.0, &[0.04, 0.02, 0.01]);
}

/// Whatever the chain does for forty seconds, the midpoint rule bounds its energy error by the square of the step. The positive
/// control is a drag, too weak to see in the motion: what it takes does not shrink with the step. (In the long run the energy of
/// such a chain drifts, by the second order too: `docs/guide/many-bodies.md` has how far.)
fn of_second_order((blades, drag): (usize, f64), duration: f64, lengths: &[f64]) {
    let chain = weighted(blades, 0.0);
    let (order, least) = fitted(&chain, duration, lengths);
    let (control, taken) = fitted(&weighted(blades, drag), duration, lengths);
    println!("order {order}, {least:e}; with drag {control}, {taken:e}");
    assert!((order - 2.0).abs() < 0.1, "order {order}");
    assert!(control < 0.5 && taken > 10.0 * least, "{control}");
}
