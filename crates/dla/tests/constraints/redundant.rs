//! Rows that depend on one another: everywhere, at a place, or in what they ask for.

use crate::constraints::tools::{distance, end, misses};
use crate::support::{Four, ThreeTwo};
use allocation_counter::measure;
use dla::{
    Dependency, Dependent, Dla, Gauss, Lobatto, OneStep, RunError, Schedule, State, StepError, consistent_start, drive,
    onto_constraint,
};
use lagrangian::{Constraint, Motion, Rows, Scalar, System};
use std::array::from_fn;
use test_systems::{CompoundPendulum, Model};

/// A pendulum with a third row, the first and twice the second, for velocities and positions alike, but for a `gap`.
struct ThirdRow {
    pendulum: CompoundPendulum,
    gap: f64,
    /// What the third row's `b` is, where the others have none.
    slip: f64,
}

impl System<3, 3> for ThirdRow {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.pendulum.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 3> {
        let ([x, y], [zero, _]) = self.pendulum.constraint(t, q);
        ([x, y, from_fn(|i| x[i] + y[i] * 2.0)], [zero, zero, S::constant(self.slip)])
    }
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<[Option<S>; 3]> {
        let [x, y] = self.pendulum.holonomic(t, q)?;
        let (x, y) = (x?, y?);
        Some([Some(x), Some(y), Some(x + y * 2.0 + self.gap)])
    }
    fn angles(&self) -> [bool; 3] {
        self.pendulum.angles()
    }
}

fn pendulum() -> CompoundPendulum {
    CompoundPendulum::new(1.3, 0.4, 0.9, 9.81)
}

fn third_row(gap: f64, slip: f64) -> ThirdRow {
    ThirdRow { pendulum: pendulum(), gap, slip }
}

fn run<Sys: System<N, M>, Method: OneStep<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    mut method: Method,
    state: &mut State<N>,
) -> Result<u64, RunError> {
    drive(system, &mut method, &Schedule { t0: 0.0, step: 0.0625, steps: 100 }, state, ())
}

fn dependent(error: RunError) -> (u64, Dependent) {
    println!("{error}");
    let found = match error.source {
        StepError::Dependent(found) => Some(found),
        _ => None,
    };
    (error.step, found.unwrap())
}

/// The discrete Lagrange-d'Alembert step goes on with two of the three, and keeps all.
fn rows_that_agree(steps: u64) {
    let (pendulum, redundant) = (pendulum(), third_row(0.0, 0.0));
    let [g, slip] = misses(&redundant, &mut Dla::midpoint(), pendulum.start(), 0.02, steps);
    // The third is the sum of three terms, each held to rounding.
    assert!(g <= 1e-14 && slip <= 1e-14, "g {g:e}, slip {slip:e}");
    let alone = end(&ThreeTwo::from(pendulum), &mut Dla::midpoint(), pendulum.start(), 0.02, 100);
    let with = end(&redundant, &mut Dla::midpoint(), pendulum.start(), 0.02, 100);
    let error = distance(&with, &(alone.unwrapped(), *alone.v()));
    assert!(error <= 1e-12, "{error:e}");
}

#[test]
fn redundant_rows_that_agree() {
    rows_that_agree(1500);
}

#[test]
#[ignore = "slow"]
fn redundant_rows_that_agree_in_full() {
    rows_that_agree(10_000);
}

/// The equations of motion, the start and the impulse at a jump go on, too.
#[test]
fn redundant_rows_outside_of_steps() {
    let (pendulum, redundant) = (pendulum(), third_row(0.0, 0.0));
    let (q, v) = pendulum.start();
    let motion = Motion::of(&redundant, 0.0, &q, &v).unwrap();
    approx::assert_abs_diff_eq!(
        &motion.acceleration[..],
        &Motion::of(&pendulum, 0.0, &q, &v).unwrap().acceleration[..],
        epsilon = 1e-13
    );
    let off = (q.map(|q| q + 0.1), v.map(|v| v + 0.1));
    let expected = consistent_start(&ThreeTwo::from(pendulum), 0.0, &off.0, &off.1).unwrap();
    let start = consistent_start(&redundant, 0.0, &off.0, &off.1).unwrap();
    approx::assert_abs_diff_eq!(&start.q[..], &expected.q[..], epsilon = 1e-14);
    approx::assert_abs_diff_eq!(&start.v[..], &expected.v[..], epsilon = 1e-14);
    let mut state = State::new(q, off.1, [false, false, true]);
    onto_constraint(&redundant, 0.0, &mut state).unwrap();
    assert!(lagrangian::constraint_residual(&redundant, 0.0, &q, state.v()).iter().all(|slip| slip.abs() <= 1e-15));
    // Rows that disagree have no start, at any place or at any velocity.
    assert!(consistent_start(&third_row(0.01, 0.0), 0.0, &q, &v).is_err());
    assert!(consistent_start(&third_row(0.0, 0.1), 0.0, &q, &v).is_err());
}

/// Nor does the search for independent rows allocate.
#[test]
fn no_allocation() {
    let redundant = third_row(0.0, 0.0);
    let (q, v) = pendulum().start();
    let mut state = State::new(q, v, [false, false, true]);
    let counted = measure(|| {
        Dla::midpoint().step(&redundant, 0.0, 0.01, &mut state).unwrap();
    });
    assert_eq!(counted.count_total, 0);
    assert!(measure(|| drop(std::hint::black_box(vec![1]))).count_total > 0);
}

/// Methods that need independent rows say which are not.
#[test]
fn redundant_rows_are_named() {
    let (q, v) = pendulum().start();
    let start = State::new(q, v, [false, false, true]);
    let mut state = start;
    let (step, found) = dependent(run(&third_row(0.0, 0.0), Lobatto::<3>::new(), &mut state).unwrap_err());
    assert_eq!((step, found.dependency, found.rows), (1, Dependency::Redundant, Rows::from_iter(0..3)));
    assert_eq!(state, start);
    // In a basis that it does not have.
    let error = run(&third_row(0.0, 0.0), Gauss::new::<2>(), &mut state).unwrap_err();
    assert!(matches!(error.source, StepError::Reduced(_)), "{error}");
}

/// Rows that ask for different places, or different velocities.
#[test]
fn contradictory_rows() {
    for system in [third_row(0.01, 0.0), third_row(0.0, 0.1)] {
        let (q, v) = pendulum().start();
        let mut state = State::new(q, v, [false, false, true]);
        let (step, found) = dependent(run(&system, Dla::midpoint(), &mut state).unwrap_err());
        assert_eq!((step, found.dependency), (1, Dependency::Contradictory));
        assert!(found.rows.contains(2));
    }
}

/// A point with two blades, each with a heading of its own: only where these line up can it move.
#[derive(Clone, Copy)]
pub(crate) struct TwoBlades;

impl System<4, 2> for TwoBlades {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 4], v: &[S; 4]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] * 0.3 + v[3] * v[3] * 0.2) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 4]) -> Constraint<S, 4, 2> {
        let row = |heading: S| {
            let (sin, cos) = heading.sin_cos();
            [-sin, cos, S::zero(), S::zero()]
        };
        ([row(q[2]), row(q[3])], [S::zero(); 2])
    }
}

/// The run ends before the node at which the blades line up, with both rows named; and where a node comes near to that.
#[test]
fn parallel_blades() {
    let mut state = State::new([0.0, 0.0, -0.5, 0.0], [0.0, 0.0, 1.0, 0.0], [false; 4]);
    let (step, found) = dependent(run(&Four::from(TwoBlades), Dla::midpoint(), &mut state).unwrap_err());
    assert_eq!((step, found.dependency, found.rows), (8, Dependency::RankDrops, Rows::from_iter([0, 1])));
    assert_eq!((state.q()[2], found.time), (-0.0625, 0.5));

    // In the middle of a step, where the midpoint rule asks.
    let mut state = State::new([0.0, 0.0, -0.46875, 0.0], [0.0, 0.0, 1.0, 0.0], [false; 4]);
    let (step, found) = dependent(run(&Four::from(TwoBlades), Dla::midpoint(), &mut state).unwrap_err());
    assert_eq!((step, found.rows, found.time), (8, Rows::from_iter([0, 1]), 0.46875));

    let (sin, cos) = 0.7f64.sin_cos();
    for (angle, rates) in [(0.0, [0.3, 0.1]), (1e-15, [0.3, 0.1]), (0.0, [0.0; 2]), (1e-9, [0.0; 2])] {
        let v = [0.5 * cos, 0.5 * sin, rates[0], rates[1]];
        let mut state = State::new([0.0, 0.0, 0.7 + angle, 0.7], v, [false; 4]);
        let (_, found) = dependent(run(&Four::from(TwoBlades), Dla::midpoint(), &mut state).unwrap_err());
        assert_eq!((found.dependency, found.rows), (Dependency::RankDrops, Rows::from_iter([0, 1])), "{angle}");
        assert!((found.distance - angle).abs() <= 1e-15, "{angle}: {}", found.distance);
    }
    // Farther apart they hold the point.
    let mut state = State::new([0.0, 0.0, 0.7 + 1e-6, 0.7], [0.0; 4], [false; 4]);
    run(&Four::from(TwoBlades), Dla::midpoint(), &mut state).unwrap();
    assert_eq!(state.q()[..2], [0.0; 2]);
}

#[test]
fn rows_by_name() {
    let shown = |rows: &[usize]| rows.iter().copied().collect::<Rows>().to_string();
    assert_eq!(shown(&[]), "no row");
    assert_eq!(shown(&[1]), "row 2");
    assert_eq!(shown(&[2, 0]), "rows 1 and 3");
    assert_eq!(shown(&[0, 1, 63, 64]), "rows 1, 2 and 64");
}
