use crate::runs::{backward, state_of, system};
use approx::assert_relative_eq;
use dla::{Dla, OneStep, State};

/// The search begins nearer to its solution where the last step left the acceleration.
#[test]
fn a_step_is_predicted_from_the_last() {
    let (sleigh, mut method) = (system(), Dla::midpoint());
    let (mut carried, mut iterations) = (state_of(&backward()), [0, 0]);
    for k in 0..200 {
        let t = 0.05 * f64::from(k);
        // The same place without what the last step left.
        let mut fresh = State::new(*carried.q(), *carried.v(), [false, false, true]);
        let told = |state: &mut State<3>, method: &mut _| {
            let report = OneStep::<3, 1>::step(method, &sleigh, t, 0.05, state).unwrap();
            report.iterations
        };
        iterations[1] += told(&mut fresh, &mut method);
        iterations[0] += told(&mut carried, &mut method);
        // Both to the rounding of the search, of places a few metres off.
        for i in 0..3 {
            assert_relative_eq!(carried.v()[i], fresh.v()[i], epsilon = 1e-14);
        }
    }
    assert!(iterations[0] < iterations[1], "{iterations:?}");
    assert_eq!(carried.reversed().acceleration(), carried.acceleration(), "the same with time reversed");
}
