//! The method that keeps the energy: of one sleigh the static one, of trains with joints and blades held.
use crate::tools::{bent, ground, hilly};
use approx::assert_abs_diff_eq;
use assembly::parts::Train;
use assembly::{Assembly, Composition, Dla, Energy, OneStep, Solver, State};
use lagrangian::linear::larger;
use lagrangian::{System, With};
use sleigh::{Sleigh, SleighState};

/// Free and on the hills.
#[test]
fn one_sleigh_is_the_static_sleigh() {
    fn compare<Sys: System<3, 1> + Clone + Send + Sync + 'static>(system: &Sys) {
        let mut alone = Assembly::new();
        let _: [usize; 3] = alone.body("blade", system.clone());
        let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
        let (mut state, mut fixed) = (State::new(&alone, &q, &v), dla::State::new(q, v, [false, false, true]));
        let (mut method, mut reference) = (Energy::new(&alone, Solver::Best).unwrap(), dla::Energy::<1>::new());
        let h = 0.05;
        for k in 0..400 {
            method.step(&alone, f64::from(k) * h, h, &mut state).unwrap();
            dla::OneStep::step(&mut reference, system, f64::from(k) * h, h, &mut fixed).unwrap();
        }
        // As with `dla`: each step rounds the velocities by some four ulps, and a heading that is off by so much in each of 400
        // steps puts the end of a way of 24 m beside its place by so much of the way.
        let turned = 400.0 * 4.0 * f64::EPSILON;
        for i in 0..3 {
            assert_abs_diff_eq!(state.unwrapped(i), fixed.unwrapped()[i], epsilon = 24.0 * turned);
            assert_abs_diff_eq!(state.v(i), fixed.v()[i], epsilon = turned);
        }
    }
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    compare(&sleigh);
    compare(&With { body: sleigh, effects: ground() });
}

/// The largest relative error of the energy, and what the constraints and the joints miss most.
fn worst(train: &Train, method: &mut dyn OneStep, h: f64, steps: u32) -> [f64; 3] {
    let assembly = &train.assembly;
    let mut state = bent(train);
    let initial = assembly.energy(0.0, &state);
    let (mut most, mut far, mut turns) = ([0.0; 3], 0.0, 0.0);
    for k in 1..=steps {
        method.step(assembly, f64::from(k - 1) * h, h, &mut state).unwrap();
        let [slip, joint] = assembly.misses(f64::from(k) * h, &state);
        let error = (assembly.energy(f64::from(k) * h, &state) - initial) / initial;
        most = [larger(most[0], error), larger(most[1], slip), larger(most[2], joint)];
        far = larger(far, state.q(0));
        turns = larger(turns, state.unwrapped(2) - state.unwrapped(5));
    }
    println!("{most:?}, {far} m, {turns} rad between the first two");
    most
}

/// Ten thousand steps; the positive control is that the midpoint rule changes the energy.
#[test]
fn a_train_on_hills_keeps_its_energy() {
    let train = hilly(6);
    let kept = worst(&train, &mut Energy::new(&train.assembly, Solver::Best).unwrap(), 0.02, 10_000);
    let control = worst(&train, &mut Dla::new(&train.assembly, Solver::Best).unwrap(), 0.02, 10_000);
    // Rounding that walks at random, a few ulps a step.
    assert!(kept[0] < 4.0 * f64::EPSILON * 10_000f64.sqrt(), "{kept:?}");
    assert!(kept[1] < 1e-14 && kept[2] < 1e-14, "{kept:?}");
    assert!(control[0] > 1e4 * kept[0]);
}

/// Against the eighth order.
#[test]
fn order_two() {
    let train = hilly(4);
    let assembly = &train.assembly;
    let end = |method: &mut dyn OneStep, steps: u32| {
        let (mut state, h) = (bent(&train), 2.0 / f64::from(steps));
        for k in 0..steps {
            method.step(assembly, f64::from(k) * h, h, &mut state).unwrap();
        }
        state
    };
    let exact = end(&mut Composition::new(assembly, Solver::Best, 8).unwrap(), 160);
    let errors =
        [40, 80, 160].map(|steps| end(&mut Energy::new(assembly, Solver::Best).unwrap(), steps).distance(&exact));
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    println!("{errors:?} {orders:?}");
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.1), "{orders:?}");
}
