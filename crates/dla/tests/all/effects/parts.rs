//! Runs that are cut at jumps.
#![allow(clippy::single_range_in_vec_init, reason = "a run in one piece is a list of one range")]

use crate::effects::tools::{Laden, laden, moving, run, sleigh, steps};
use dla::{Dla, RunError, Schedule, State, StepError, Trajectory, drive, drive_part, onto_constraint, pieces};
use lagrangian::{System, constraint_residual, momentum};
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
    let RunError { step, time, source } = pieces(&steps(0.1, 100), vec![8.0, 0.55, 0.26]).unwrap_err();
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

/// The parts of a run are the run.
#[test]
fn parts_make_the_whole() {
    let system: Laden<Sleigh> = laden(sleigh(), vec![AnyEffect::Bowl(Bowl::new([0.4, 0.15], [0.2, -0.3]).unwrap())]);
    let (q, v) = moving().to_coordinates();
    let (schedule, start) = (steps(0.05, 100), State::new(q, v, system.angles()));
    let (mut whole, mut nodes) = (start, Trajectory::<3, 1>::every(1));
    drive(&system, &mut Dla::midpoint(), &schedule, &mut whole, &mut nodes).unwrap();
    let (mut parts, mut seen) = (start, Trajectory::<3, 1>::every(1));
    for (part, made) in [(0..30, 30), (30..31, 31), (31..100, 100)] {
        let done = drive_part(&system, &mut Dla::midpoint(), &schedule, part, &mut parts, &mut seen).unwrap();
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
