//! A chain of unlike blades that rolls over hills, its own weight on each.
use crate::tools::{bent, slope, weighted};
use assembly::parts::Train;
use assembly::{Dla, OneStep, Solver};

/// The largest relative energy error of a run, of its first tenth and of all of it.
fn errors(train: &Train, h: f64, duration: f64) -> [f64; 2] {
    let assembly = &train.assembly;
    let (mut state, mut method) = (bent(train), Dla::new(assembly, Solver::Best).unwrap());
    let initial = assembly.energy(0.0, &state);
    let steps = (duration / h).round() as u32;
    let (mut most, mut first) = (0.0f64, 0.0);
    for k in 0..steps {
        method.step(assembly, f64::from(k) * h, h, &mut state).unwrap();
        most = most.max(((assembly.energy(0.0, &state) - initial) / initial).abs());
        if k == steps / 10 {
            first = most;
        }
    }
    [first, most]
}

/// The error is of the second order in the step, and no larger after ten times the time than what chance makes of a bounded
/// oscillation; the positive control loses energy to a drag so small that ten times the time shows it.
#[test]
fn its_energy_is_bounded_and_of_second_order() {
    let chain = weighted(10, 0.0);
    let runs = [0.04, 0.02, 0.01].map(|h| (h, errors(&chain, h, 40.0)));
    println!("{runs:?}");
    let order = slope(&runs.map(|(h, [_, all])| (f64::ln(h), all.ln())));
    assert!((order - 2.0).abs() < 0.25, "order {order}");
    let growth = |[first, all]: [f64; 2]| all / first;
    let control = errors(&weighted(10, 1e-3), 0.01, 40.0);
    println!("order {order}, {} against {}", growth(runs[2].1), growth(control));
    assert!(growth(runs[2].1) < 5.0);
    assert!(control[1] > 10.0 * runs[2].1[1]);
}
