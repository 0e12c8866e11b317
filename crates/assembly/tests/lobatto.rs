//! The Lobatto methods: of one sleigh the static ones, of trains with joints and blades held.

use crate::tools::{bent, ground, hilly};
use approx::assert_abs_diff_eq;
use assembly::parts::Train;
use assembly::{Assembly, AssemblyError, AssemblyMethod, AssemblyState, Solver, SparseLobatto};
use lagrangian::linear::larger;
use lagrangian::{Piecewise, System, With};
use sleigh::{Sleigh, SleighState};

fn compare<Sys: System<3, 1> + Piecewise + Clone + Send + Sync + 'static>(
    system: &Sys,
    (stages, steps): (usize, u32),
    reference: &mut dyn dla::OneStep<3, 1>,
) {
    let mut alone = Assembly::new();
    let _: [usize; 3] = alone.body("blade", system.clone());
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let (mut state, mut fixed) = (AssemblyState::new(&alone, &q, &v), dla::State::new(q, v, [false, false, true]));
    let mut method = SparseLobatto::new(&alone, Solver::Best, stages).unwrap();
    let h = 0.1;
    for k in 0..steps {
        method.step(&alone, f64::from(k) * h, h, &mut state).unwrap();
        reference.step(system, f64::from(k) * h, h, &mut fixed).unwrap();
    }
    // As with `dla`: each step rounds the velocities by some four ulps, and a heading that is off by so much in each step puts the
    // end of a way, of 24 m in 200 steps, beside its place by so much of the way.
    let (turned, way) = (f64::from(steps) * 4.0 * f64::EPSILON, 24.0 * f64::from(steps) / 200.0);
    for i in 0..3 {
        assert_abs_diff_eq!(state.unwrapped(i), fixed.unwrapped()[i], epsilon = way * turned);
        assert_abs_diff_eq!(state.v(i), fixed.v()[i], epsilon = turned);
    }
}

#[test]
fn one_sleigh_is_the_static_sleigh() {
    is_the_static_sleigh(40);
}

#[test]
#[ignore = "slow"]
fn one_sleigh_is_the_static_sleigh_in_full() {
    is_the_static_sleigh(200);
}

/// Free and on the hills.
fn is_the_static_sleigh(steps: u32) {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    compare(&sleigh, (3, steps), &mut dla::Lobatto::<3>::new());
    let hills = With { body: sleigh, effects: ground() };
    compare(&hills, (3, steps), &mut dla::Lobatto::<3>::new());
    compare(&hills, (5, steps), &mut dla::Lobatto::<5>::new());
}

/// The end of a run, and what the constraints and the joints miss most.
fn end(train: &Train, duration: f64, method: &mut dyn AssemblyMethod, steps: u32) -> (AssemblyState, [f64; 2]) {
    let (mut state, h, mut most) = (bent(train), duration / f64::from(steps), [0.0; 2]);
    for k in 0..steps {
        method.step(&train.assembly, f64::from(k) * h, h, &mut state).unwrap();
        let misses = train.assembly.misses(f64::from(k + 1) * h, &state);
        most = [larger(most[0], misses[0]), larger(most[1], misses[1])];
    }
    (state, most)
}

#[test]
fn orders_on_a_train() {
    let train = hilly(2);
    have_their_orders(&train, 1.0, 20, &[(3, [10, 14, 20], 4.0)]);
    assert!(matches!(SparseLobatto::new(&train.assembly, Solver::Best, 2), Err(AssemblyError::Unsupported { .. })));
}

#[test]
#[ignore = "slow"]
fn orders_on_a_train_in_full() {
    let orders = [(3, [20, 40, 80], 4.0), (4, [10, 14, 20], 6.0), (5, [8, 10, 14], 8.0)];
    have_their_orders(&hilly(4), 2.0, 80, &orders);
}

/// Slopes of lines through the logarithms of error and step: stages, numbers of steps, and order.
fn have_their_orders(train: &Train, duration: f64, fine: u32, orders: &[(usize, [u32; 3], f64)]) {
    let method = |stages| SparseLobatto::new(&train.assembly, Solver::Best, stages).unwrap();
    let (exact, _) = end(train, duration, &mut method(5), fine);
    for &(stages, counts, expected) in orders {
        let mut most = [0.0; 2];
        let errors = counts.map(|steps| {
            let (state, misses) = end(train, duration, &mut method(stages), steps);
            most = [larger(most[0], misses[0]), larger(most[1], misses[1])];
            state.distance(&exact)
        });
        let fitted = (errors[0] / errors[2]).ln() / (f64::from(counts[2]) / f64::from(counts[0])).ln();
        println!("lobatto{stages}: {errors:?}, order {fitted}; {most:?}");
        assert!((fitted - expected).abs() < 0.1 * expected, "{stages}: {fitted}");
        assert!(most[0] < 4e-15 && most[1] < 4e-15, "{most:?}");
    }
}
