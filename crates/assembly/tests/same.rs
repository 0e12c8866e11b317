use crate::tools::{bent, run, train};
use approx::assert_abs_diff_eq;
use assembly::parts::{Hinge, Trailer, Train};
use assembly::{Assembly, AssemblyMethod, AssemblyState, Joint, Solver, SparseDla};
use dla::Form;
use lagrangian::{Constraint, Scalar, System, position_rows};
use sleigh::{Sleigh, SleighState};

#[test]
fn one_sleigh_is_the_static_sleigh() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let mut alone = Assembly::new();
    let _: [usize; 3] = alone.body("blade", sleigh);
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let mut state = AssemblyState::new(&alone, &q, &v);
    let mut fixed = dla::State::new(q, v, [false, false, true]);
    for solver in [Solver::Dense, Solver::Sparse] {
        let (mut method, mut reference) =
            (SparseDla::new(&alone, solver).unwrap(), dla::Dla::midpoint().solved(Form::Multipliers));
        let h = 0.05;
        for k in 0..400 {
            method.step(&alone, f64::from(k) * h, h, &mut state).unwrap();
            dla::OneStep::step(&mut reference, &sleigh, f64::from(k) * h, h, &mut fixed).unwrap();
        }
        // Each step rounds the velocities by some four ulps, and a heading that is off by so much in each of 800 steps puts the end
        // of a way of 24 m beside its place by so much of the way.
        let turned = 800.0 * 4.0 * f64::EPSILON;
        for i in 0..3 {
            assert_abs_diff_eq!(state.unwrapped()[i], fixed.unwrapped()[i], epsilon = 24.0 * turned);
            assert_abs_diff_eq!(state.v()[i], fixed.v()[i], epsilon = turned);
        }
    }
}

/// Two sleighs on a hinge as one static system.
struct Pair(Sleigh, Hinge);

impl System<6, 4> for Pair {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 6], v: &[S; 6]) -> S {
        let half = |x: &[S; 6], k: usize| [x[k], x[k + 1], x[k + 2]];
        self.0.lagrangian(t, &half(q, 0), &half(v, 0)) + self.0.lagrangian(t, &half(q, 3), &half(v, 3))
    }

    fn constraint<S: Scalar>(&self, t: S, q: &[S; 6]) -> Constraint<S, 6, 4> {
        let (mut rows, level) = position_rows(self, t, q);
        for (k, row) in [0, 3].into_iter().zip(&mut rows[2..]) {
            let (sin, cos) = q[k + 2].sin_cos();
            (row[k], row[k + 1]) = (-sin, cos);
        }
        (rows, level)
    }

    fn holonomic<S: Scalar>(&self, t: S, q: &[S; 6]) -> Option<[Option<S>; 4]> {
        let [x, y] = self.1.position(t, q);
        Some([Some(x), Some(y), None, None])
    }

    fn angles(&self) -> [bool; 6] {
        [false, false, true, false, false, true]
    }
}

#[test]
fn a_hinged_pair_is_the_same_written_both_ways() {
    let (hinge, h) = (Hinge::new([-0.3, 0.0], [0.8, 0.0]), 0.02);
    let sleigh = Sleigh::new(1.0, 0.4, 0.2).unwrap();
    let train = Train::new(sleigh, vec![Trailer { sleigh, hitch: 0.3, bar: 0.8 }], |trailer| trailer.sleigh).unwrap();
    let mut state = train.start(&SleighState { speed: 1.0, turn_rate: 0.7, ..SleighState::default() }, &[0.4]);
    let pair = Pair(sleigh, hinge);
    let (q, v) = (std::array::from_fn(|i| state.q()[i]), std::array::from_fn(|i| state.v()[i]));
    let mut fixed = dla::State::new(q, v, pair.angles());
    let (mut method, mut reference) = (SparseDla::new(&train.assembly, Solver::Best).unwrap(), dla::Dla::midpoint());
    for k in 0..200 {
        method.step(&train.assembly, f64::from(k) * h, h, &mut state).unwrap();
        dla::OneStep::step(&mut reference, &pair, f64::from(k) * h, h, &mut fixed).unwrap();
    }
    // Two hundred steps round by about as many units of the last place.
    for i in 0..6 {
        assert_abs_diff_eq!(state.unwrapped()[i], fixed.unwrapped()[i], epsilon = 200.0 * 4.0 * f64::EPSILON);
        assert_abs_diff_eq!(state.v()[i], fixed.v()[i], epsilon = 200.0 * 4.0 * f64::EPSILON);
    }
    assert!(train.blade(&state.unwrapped(), state.v(), 0).heading > 0.5);
}

#[test]
fn sparse_and_dense_agree() {
    solvers_agree(20, 10);
}

#[test]
#[ignore = "slow"]
fn sparse_and_dense_agree_at_length() {
    solvers_agree(100, 20);
}

fn solvers_agree(blades: usize, steps: u32) {
    let train = train(blades);
    let start = bent(&train);
    let [sparse, dense] = [Solver::Sparse, Solver::Dense].map(|solver| {
        let mut state = start.clone();
        run(&train, solver, 0.02, steps, &mut state);
        state
    });
    assert!(sparse.distance(&start) > 0.1);
    assert!(sparse.distance(&dense) < 1e-12);
}
