//! Runs that are cut at jumps.
#![allow(clippy::single_range_in_vec_init, reason = "a run in one piece is a list of one range")]

use crate::effects::tools::{Laden, laden, moving, run, sleigh, steps};
use dla::{
    Dla, RunError, Schedule, State, StepError, Trajectory, drive, drive_part, fitted, onto_constraint, pieces,
    smooth_pieces,
};
use lagrangian::{System, constraint_residual, momentum};
use proptest::prelude::*;
use scene::AnyEffect;
use sleigh::effects::{Bowl, Torque};
use sleigh::{Guide, Guided, Sleigh, Table, TimeFunction};

#[test]
fn a_run_is_cut_at_its_jumps() {
    let ten = steps(0.1, 100);
    assert_eq!(pieces(&ten, vec![]).unwrap(), [0..100]);
    // In any order, several at one time, one that misses its node by rounding.
    assert_eq!(pieces(&ten, vec![7.0, 0.1 + 0.2, 7.0]).unwrap(), [0..3, 3..70, 70..100]);
    // At the ends there is nothing to cut.
    assert_eq!(pieces(&ten, vec![0.0, 10.0]).unwrap(), [0..100]);
    assert_eq!(pieces(&steps(0.1, 0), vec![]).unwrap(), [0..0]);
}

#[test]
fn a_run_backward_meets_the_jumps_in_its_order() {
    let back = Schedule { t0: 10.0, step: -0.1, steps: 100 };
    assert_eq!(pieces(&back, vec![2.5, 7.0]).unwrap(), [0..30, 30..75, 75..100]);
    let error = pieces(&back, vec![2.5, 7.04, 0.33]).unwrap_err();
    assert_eq!(error.source, StepError::Jump { time: 7.04 });
    assert_eq!(error.step, 30);
}

#[test]
fn a_jump_inside_a_step_is_refused() {
    let RunError { step, time, source, .. } = pieces(&steps(0.1, 100), vec![8.0, 0.55, 0.26]).unwrap_err();
    // The third step begins at 0.2.
    assert_eq!((step, source), (3, StepError::Jump { time: 0.26 }));
    approx::assert_relative_eq!(time, 0.2, max_relative = f64::EPSILON);
    assert!(source.to_string().contains("0.26"));
}

/// Times and steps are decimals, each rounded: after many steps their ratio misses a whole number by more than `1e-9`.
#[test]
fn a_late_jump_is_on_its_node() {
    for (step, time, node) in
        [(0.01, 613_296.69, 61_329_669), (0.05, 793_484.2, 15_869_684), (0.1, 4_341_178.1, 43_411_781)]
    {
        let cut = pieces(&steps(step, 2 * node), vec![time]).unwrap();
        assert_eq!(cut, [0..node, node..2 * node]);
        // The control: a thousandth of a step is not rounding.
        assert!(pieces(&steps(step, 2 * node), vec![time + 1e-3 * step]).is_err());
    }
}

/// Where equal steps miss a jump, each piece has steps of its own.
#[test]
fn pieces_have_steps_of_their_own() {
    // 10 s with jumps at 2 pi and 7: pieces of 6.283, 0.717 and 3 s.
    let turn = std::f64::consts::TAU;
    let jumps = vec![7.0, turn];
    let schedule = fitted(&steps(0.1, 100), 0.1, jumps.clone());
    assert_eq!(schedule.steps, 63 + 8 + 30);
    approx::assert_relative_eq!(schedule.time(schedule.steps), 10.0, max_relative = 1e-15);
    let cut = smooth_pieces(&schedule, jumps).unwrap();
    let ranges: Vec<_> = cut.iter().map(|piece| piece.steps.clone()).collect();
    assert_eq!(ranges, [0..63, 63..71, 71..101]);
    for (piece, [from, to]) in cut.iter().zip([[0.0, turn], [turn, 7.0], [7.0, 10.0]]) {
        approx::assert_relative_eq!(piece.schedule.time(piece.steps.start), from, max_relative = 1e-14);
        approx::assert_relative_eq!(piece.schedule.time(piece.steps.end), to, max_relative = 1e-14);
    }
    // Fewer steps than pieces: nothing can be done.
    assert_eq!(smooth_pieces(&steps(5.0, 2), vec![7.0, turn]).unwrap_err().source, StepError::Jump { time: turn });
    // Where equal steps have every jump, they stay as they are.
    assert_eq!(fitted(&steps(0.1, 100), 0.1, vec![0.3, 7.0]), steps(0.1, 100));
}

proptest! {
    #[test]
    fn every_jump_is_a_node_and_no_step_is_longer(
        t0 in -100.0_f64..100.0,
        forward in any::<bool>(),
        step in 0.01_f64..1.0,
        count in 1_u64..2000,
        places in prop::collection::vec(0.001..0.999, 0..20),
        finer in 1_u64..5,
    ) {
        let step = if forward { step } else { -step };
        let whole = Schedule { t0, step, steps: count };
        let end = whole.time(count);
        let jumps: Vec<f64> = places.iter().map(|place| t0 + place * (end - t0)).collect();
        let schedule = fitted(&whole, step, jumps.clone());
        // The reference of a comparison has a multiple of the steps.
        let schedule = Schedule { step: schedule.step / finer as f64, steps: schedule.steps * finer, ..schedule };
        let cut = smooth_pieces(&schedule, jumps.clone()).unwrap();
        let size = 1e-12 * (t0.abs() + end.abs() + 1.0);
        let mut next = (0, t0);
        for piece in &cut {
            prop_assert_eq!(piece.steps.start, next.0);
            prop_assert!((piece.schedule.time(piece.steps.start) - next.1).abs() <= size);
            prop_assert!(piece.schedule.step.abs() * finer as f64 <= step.abs() * (1.0 + 1e-6));
            next = (piece.steps.end, piece.schedule.time(piece.steps.end));
        }
        prop_assert_eq!(next.0, schedule.steps);
        prop_assert!((next.1 - end).abs() <= size);
        let ends: Vec<f64> = cut.iter().map(|piece| piece.schedule.time(piece.steps.end)).chain([t0]).collect();
        for jump in jumps {
            let off = ends.iter().map(|end| (end - jump).abs()).fold(f64::INFINITY, f64::min);
            prop_assert!(off <= 2e-9 * step.abs() + size, "{} is off by {}", jump, off);
        }
    }
}

/// The parts of a run are the run.
#[test]
fn parts_make_the_whole() {
    let system: Laden<Sleigh> = laden(sleigh(), vec![AnyEffect::Bowl(Bowl::new([0.4, 0.15], [0.2, -0.3]).unwrap())]);
    let (q, v) = moving().to_coordinates();
    let (schedule, start) = (steps(0.05, 100), State::new(q, v, system.angles()));
    let (mut whole, mut nodes) = (start, Trajectory::every(1));
    drive(&system, &mut Dla::midpoint(), &schedule, &mut whole, &mut nodes).unwrap();
    let (mut parts, mut seen) = (start, Trajectory::every(1));
    let mut method = Dla::midpoint();
    for (part, made) in [(0..30, 30), (30..31, 31), (31..100, 100)] {
        let done = drive_part(&system, &mut method, &schedule, part, &mut parts, &mut seen).unwrap();
        assert!(done.made == made && !done.stopped);
    }
    assert_eq!(parts, whole);
    assert_eq!(seen.nodes(), nodes.nodes());
    // The control: with another step in one part it is not.
    let mut other = start;
    let longer = Schedule { step: 0.051, ..schedule };
    drive_part(&system, &mut Dla::midpoint(), &longer, 0..100, &mut other, ()).unwrap();
    assert_ne!(other, whole);
}

/// There and back again over the jumps of a torque and of a servo, whose impulses backward undo those forward.
#[test]
fn over_the_jumps_and_back() {
    let table = |values| TimeFunction::Table(Table::new(vec![0.0, 1.0, 2.5], values).unwrap());
    let torque = Torque::new(table(vec![0.4, -0.3, 0.2])).unwrap();
    let servo = Guided::<1>::servo(sleigh(), Guide::Speed(table(vec![0.7, -0.5, 0.6]))).unwrap();
    let system = laden(servo, vec![AnyEffect::Torque(torque)]);
    let (q, v) = moving().to_coordinates();
    let end = run(&system, &mut Dla::midpoint(), &steps(0.05, 80), (q, v), ());
    let back = Schedule { t0: 4.0, step: -0.05, steps: 80 };
    let start = run(&system, &mut Dla::midpoint(), &back, (*end.q(), *end.v()), ());
    for i in 0..3 {
        approx::assert_abs_diff_eq!(start.q()[i], q[i], epsilon = 1e-12);
    }
    assert!((end.q()[0] - q[0]).abs() > 0.1);
}

#[test]
fn a_velocity_off_the_constraint_is_brought_there_by_an_impulse() {
    let system: Laden<Sleigh> = laden(sleigh(), vec![]);
    let (q, v) = moving().to_coordinates();
    // On the constraint, nothing: not even the last digit.
    let mut state = State::new(q, v, system.angles());
    onto_constraint(&system, 0.0, &mut state).unwrap();
    assert_eq!(state, State::new(q, v, system.angles()));

    let off = [v[0] + 0.3, v[1] - 0.2, v[2]];
    let mut state = State::new(q, off, system.angles());
    onto_constraint(&system, 0.0, &mut state).unwrap();
    assert!(constraint_residual(&system, 0.0, &q, state.v())[0].abs() < 4.0 * f64::EPSILON);
    assert!((0..3).all(|i| state.q()[i].to_bits() == q[i].to_bits()));
    // The change of momentum is an impulse across the blade.
    let (before, after) = (momentum(&system, 0.0, &q, &off), momentum(&system, 0.0, &q, state.v()));
    let impulse: [f64; 3] = std::array::from_fn(|i| after[i] - before[i]);
    let (sin, cos) = q[2].sin_cos();
    approx::assert_abs_diff_eq!(cos * impulse[0] + sin * impulse[1], 0.0, epsilon = 1e-15);
    approx::assert_abs_diff_eq!(impulse[2], 0.0, epsilon = 1e-15);
    assert!(impulse[0].abs() > 0.1);
}
