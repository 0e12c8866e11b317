use crate::tools::{bent, run, train};
use approx::assert_abs_diff_eq;
use assembly::{Assembly, Dla, OneStep, Solver, State};
use dla::Form;
use sleigh::{Sleigh, SleighState};

#[test]
fn one_sleigh_is_the_static_sleigh() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let mut alone = Assembly::new();
    let _: [usize; 3] = alone.body("blade", sleigh);
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let mut state = State::new(&alone, &q, &v);
    let mut fixed = dla::State::new(q, v, [false, false, true]);
    for solver in [Solver::Dense, Solver::Sparse] {
        let (mut method, mut reference) = (Dla::new(&alone, solver).unwrap(), dla::Dla::midpoint().solved(Form::Multipliers));
        let h = 0.05;
        for k in 0..400 {
            method.step(&alone, f64::from(k) * h, h, &mut state).unwrap();
            dla::OneStep::step(&mut reference, &sleigh, f64::from(k) * h, h, &mut fixed).unwrap();
        }
        for i in 0..3 {
            println!("{} {}", state.unwrapped(i) - fixed.unwrapped()[i], state.v(i) - fixed.v()[i]);
            assert_abs_diff_eq!(state.unwrapped(i), fixed.unwrapped()[i], epsilon = 1e-13);
            assert_abs_diff_eq!(state.v(i), fixed.v()[i], epsilon = 1e-13);
        }
    }
}

#[test]
fn sparse_and_dense_agree() {
    let train = train(100);
    let start = bent(&train);
    let [sparse, dense] = [Solver::Sparse, Solver::Dense].map(|solver| {
        let mut state = start.clone();
        let clock = std::time::Instant::now();
        let report = run(&train, solver, 0.02, 20, &mut state);
        println!("{solver:?} {:?} a step, {report:?} {:?}", clock.elapsed() / 20, train.assembly.misses(0.0, &state));
        state
    });
    println!("{:e}", sparse.distance(&dense));
    assert!(sparse.distance(&dense) < 1e-12);
}
