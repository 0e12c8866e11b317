use crate::tools::{bent, train};
use approx::assert_abs_diff_eq;
use assembly::parts::Train;
use assembly::{AssemblyMethod, Solver, SparseDla};
use lagrangian::linear::larger;
use sleigh::SleighState;

/// The largest constraint, joint equation and energy error of a run, the latter relative.
fn worst(train: &Train, h: f64, steps: u32, told: u32) -> [f64; 3] {
    let assembly = &train.assembly;
    let (mut state, mut method) = (bent(train), SparseDla::new(assembly, Solver::Best).unwrap());
    let initial = assembly.energy(0.0, &state);
    let mut most = [0.0; 3];
    for k in 1..=steps {
        method.step(assembly, f64::from(k - 1) * h, h, &mut state).unwrap();
        let t = f64::from(k) * h;
        let [slip, joint] = assembly.misses(t, &state);
        let error = (assembly.energy(t, &state) - initial) / initial;
        most = [larger(most[0], slip), larger(most[1], joint), larger(most[2], error)];
        if k % told == 0 {
            let SleighState { x, y, heading, speed, turn_rate } = train.blade(&state.unwrapped(), state.v(), 0);
            println!("t = {t}: {most:?}; ({x}, {y}) {heading} rad, {speed} m/s, {turn_rate} rad/s");
        }
    }
    most
}

#[test]
fn a_train_keeps_what_it_must() {
    keeps_what_it_must(5, 300);
}

#[test]
#[ignore = "slow"]
fn a_train_keeps_what_it_must_at_length() {
    keeps_what_it_must(30, 1000);
}

fn keeps_what_it_must(blades: usize, steps: u32) {
    let (one, many) = (worst(&train(1), 0.02, steps, steps), worst(&train(blades), 0.02, steps, steps));
    println!("{one:?} {many:?}");
    assert_abs_diff_eq!(many[0], 0.0, epsilon = 1e-14);
    assert_abs_diff_eq!(many[1], 0.0, epsilon = 1e-13);
    // Both are of the second order in the step; a train has more that turns.
    assert!(many[2] < 10.0 * one[2], "{} against {}", many[2], one[2]);
}

/// A minute of a thousand blades.
#[test]
#[ignore = "slow"]
fn a_long_train_keeps_what_it_must() {
    let (one, many) = (worst(&train(1), 0.02, 3000, 3000), worst(&train(1000), 0.02, 3000, 1000));
    println!("{one:?} {many:?}");
    assert!(many[0] <= 1e-11 && many[1] <= 1e-11);
}
