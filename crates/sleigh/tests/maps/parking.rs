//! Plans that bring the sleigh to a pose, and the gaits that they are made of.

use approx::assert_abs_diff_eq;
use lagrangian::Piecewise;
use proptest::prelude::*;
use sleigh::parking::{Gap, Move, ParkingPlan, sinusoidal_gait, square_gait};
use sleigh::{SleighError, SleighState};
use std::f64::consts::{FRAC_PI_2, TAU};

fn pose(x: f64, y: f64, heading: f64) -> SleighState {
    SleighState { x, y, heading, ..SleighState::default() }
}

/// Of places (m), and of headings (rad) up to full turns.
fn distance(a: &SleighState, b: &SleighState) -> f64 {
    let turns = (a.heading - b.heading) / TAU;
    (a.x - b.x).hypot(a.y - b.y).max((turns - turns.round()).abs() * TAU)
}

/// A pose as seen from another: ahead of it, to its left, turned.
fn seen(from: &SleighState, pose: &SleighState) -> [f64; 3] {
    let (sin, cos) = from.heading.sin_cos();
    let (dx, dy) = (pose.x - from.x, pose.y - from.y);
    [cos * dx + sin * dy, cos * dy - sin * dx, pose.heading - from.heading]
}

/// Coordinates below ten, each move with a few roundings: some hundred of them.
const ROUNDING: f64 = 1e-12;

proptest! {
    #[test]
    fn a_plan_keeps_to_lane_and_gap(
        start in (-5.0..5.0, -5.0..5.0, -4.0..4.0), goal in (-5.0..5.0, -5.0..5.0, -4.0..4.0),
        (depth, play, swing) in (-1.5..1.5, 0.2..0.5, 0.3..2.5f64),
    ) {
        let (start, goal) = (pose(start.0, start.1, start.2), pose(goal.0, goal.1, goal.2));
        let plan = ParkingPlan::park(&start, &goal, &Gap { depth, play, swing }).unwrap();
        let poses = plan.poses(&start);
        prop_assert_eq!(poses.len(), plan.moves.len() + 1);
        prop_assert!(poses[0] == start && distance(poses.last().unwrap(), &goal) < ROUNDING);
        // Straight to the entry, beside the place and turned as in it.
        prop_assert!(matches!(plan.moves[..3], [Move::Turn(_), Move::Drive(d), Move::Turn(_)] if d >= 0.0));
        let [ahead, left, turned] = seen(&poses[3], &goal);
        assert_abs_diff_eq!(ahead, 0.0, epsilon = ROUNDING);
        assert_abs_diff_eq!(left, depth, epsilon = ROUNDING);
        assert_abs_diff_eq!((turned / TAU).fract().abs().min(1.0 - (turned / TAU).fract().abs()), 0.0, epsilon = ROUNDING);
        for turn in [0, 2] {
            prop_assert!(matches!(plan.moves[turn], Move::Turn(angle) if angle.abs() <= 0.5 * TAU + ROUNDING));
        }
        // As few pairs of rounds as play and swing allow, within both.
        let swing = swing.min(FRAC_PI_2);
        let pairs = (plan.moves.len() - 3) / 8;
        let reach = |pairs: usize| 2.0 * pairs as f64 * play * swing.sin();
        prop_assert!(reach(pairs) >= depth.abs() - ROUNDING);
        prop_assert!(pairs == 0 || reach(pairs - 1) < depth.abs());
        for at in &poses[3..] {
            let [ahead, left, turned] = seen(&poses[3], at);
            prop_assert!(ahead.abs() <= play + ROUNDING && turned.abs() <= swing + ROUNDING);
            prop_assert!(left.abs() <= depth.abs() + play);
        }
    }

    #[test]
    fn a_square_gait_goes_sideways(start in (-5.0..5.0, -5.0..5.0, -4.0..4.0), d in -1.0..1.0, p in -1.5..1.5) {
        let start = pose(start.0, start.1, start.2);
        let end = *ParkingPlan { moves: square_gait(d, p).to_vec() }.poses(&start).last().unwrap();
        let [ahead, left, turned] = seen(&start, &end);
        assert_abs_diff_eq!(ahead, d * (1.0 - p.cos()), epsilon = 1e-14);
        assert_abs_diff_eq!(left, d * p.sin(), epsilon = 1e-14);
        assert_abs_diff_eq!(turned, 0.0, epsilon = 1e-14);
    }

    #[test]
    fn a_sinusoidal_gait_is_its_sines(a in -2.0..2.0f64, b in -2.0..2.0f64, k in 0.5..3.0f64, t in -3.0..3.0f64) {
        let [speed, turn_rate] = sinusoidal_gait(a, b, k);
        assert_abs_diff_eq!(speed.value(t), a * k * (k * t).sin(), epsilon = 1e-14);
        // The rate of the heading `b sin(k t)`.
        assert_abs_diff_eq!(turn_rate.value(t), b * k * (k * t).cos(), epsilon = 1e-14);
    }
}

/// Without depth nothing but the lane; at the entry already, or straight beside it, no way to look for.
#[test]
fn plans_of_three_moves() {
    let gap = Gap { depth: 0.0, play: 0.3, swing: 0.5 };
    let goal = pose(2.0, 1.0, 0.4);
    let moves = |start| ParkingPlan::park(&start, &goal, &gap).unwrap().moves;
    assert_eq!(moves(goal), [Move::Turn(0.0), Move::Drive(0.0), Move::Turn(0.0)]);
    assert_eq!(moves(pose(2.0, 1.0, 0.1))[..2], [Move::Turn(0.0), Move::Drive(0.0)]);
    assert_eq!(moves(pose(0.5, 1.0, 0.0))[..2], [Move::Turn(0.0), Move::Drive(1.5)]);
    assert_eq!(moves(pose(2.0, 0.0, 0.0))[..2], [Move::Turn(FRAC_PI_2), Move::Drive(1.0)]);
    // Velocities are not read, and poses stand still.
    let moving = SleighState { speed: 2.0, turn_rate: 3.0, ..pose(0.5, 1.0, 0.1) };
    let plan = ParkingPlan::park(&moving, &goal, &gap).unwrap();
    assert!(plan.poses(&moving).iter().all(|pose| pose.speed == 0.0 && pose.turn_rate == 0.0));
}

#[test]
fn what_no_plan_reaches() {
    let park =
        |depth, play, swing| ParkingPlan::park(&pose(0.0, 0.0, 0.0), &pose(1.0, 0.0, 0.0), &Gap { depth, play, swing });
    for (depth, play, swing) in [(f64::NAN, 0.3, 0.5), (1.0, 0.0, 0.5), (1.0, 0.3, -0.5), (1.0, f64::INFINITY, 0.5)] {
        assert!(park(depth, play, swing).is_err(), "{depth} {play} {swing}");
    }
    assert!(
        ParkingPlan::park(&pose(f64::NAN, 0.0, 0.0), &pose(0.0, 0.0, 0.0), &Gap { depth: 1.0, play: 0.3, swing: 0.5 })
            .is_err()
    );
    assert!(
        ParkingPlan::park(&pose(0.0, 0.0, 0.0), &pose(0.0, f64::NAN, 0.0), &Gap { depth: 1.0, play: 0.3, swing: 0.5 })
            .is_err()
    );
    // Ten thousand pairs of rounds with a swing of a right angle: `2 n d`.
    assert_eq!(park(5000.0, 0.25, 2.0).unwrap().moves.len(), 3 + 8 * 10_000);
    assert!(matches!(park(5000.3, 0.25, 2.0), Err(SleighError::Path { .. })));
}

/// A pulse for each move, of its size, while the other control rests.
#[test]
fn controls_make_the_moves() {
    let plan = ParkingPlan { moves: vec![Move::Turn(0.4), Move::Drive(-1.5), Move::Turn(-0.2)] };
    let seconds = 2.0;
    let [drive, turn] = plan.controls(seconds).unwrap();
    assert_eq!(plan.duration(seconds), 6.0);
    for (k, [d, angle]) in [[0.0, 0.4], [-1.5, 0.0], [0.0, -0.2], [0.0, 0.0]].into_iter().enumerate() {
        let middle = (k as f64 + 0.5) * seconds;
        // A pulse is at its height, twice its mean, in the middle.
        assert_abs_diff_eq!(drive.piece(middle).value(middle), 2.0 * d / seconds, epsilon = 1e-15);
        assert_abs_diff_eq!(turn.piece(middle).value(middle), 2.0 * angle / seconds, epsilon = 1e-15);
    }
    assert_eq!(drive.jumps(0.0, 10.0), [2.0, 4.0, 6.0]);
    assert!(plan.controls(0.0).is_err());
}
