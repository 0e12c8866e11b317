use crate::geometry::run;
use dla::{State, Trajectory};
use lagrangian::System;
use sleigh::parking::{Gap, Move, ParkingPlan};
use sleigh::{Guided, Sleigh, SleighError, SleighState};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Numbers between 0 and 1, the same every time. (Knuth's constants of a linear congruential generator.)
struct Numbers(u64);
impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.next()
    }
    fn pose(&mut self) -> SleighState {
        let (x, y) = (self.between(-5.0, 5.0), self.between(-5.0, 5.0));
        SleighState { x, y, heading: self.between(-4.0, 4.0), ..SleighState::default() }
    }
}

/// The distance of two poses: of places (m), and of headings (rad) up to full turns.
fn distance(a: &SleighState, b: &SleighState) -> f64 {
    let turn = (a.heading - b.heading + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
    (a.x - b.x).hypot(a.y - b.y).max(turn.abs())
}

test_systems::short_and_full! {
    random_pairs_are_reached => check_pairs(3);
    a_hundred_random_pairs_are_reached => check_pairs(100);
}

/// Smooth controls, sampled at equal steps over whole pulses: the midpoint rule integrates them to rounding.
fn check_pairs(pairs: u32) {
    let mut numbers = Numbers(7);
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let (mut worst, mut slip) = (0.0_f64, 0.0_f64);
    for _ in 0..pairs {
        let (start, goal) = (numbers.pose(), numbers.pose());
        let (depth, play) = (numbers.between(-1.5, 1.5), numbers.between(0.2, 0.5));
        let gap = Gap { depth, play, swing: numbers.between(0.3, 0.8) };
        let plan = ParkingPlan::park(&start, &goal, &gap).unwrap();
        let [speed, turn_rate] = plan.controls(1.0).unwrap();
        let servo = Guided::<2>::servo(sleigh, speed, turn_rate).unwrap();
        let mut state = State::new(start.to_coordinates().0, [0.0; 3], System::<3, 3>::angles(&servo));
        let mut nodes = Trajectory::every(1);
        run(&servo, "dla", (0.0625, 16 * plan.moves.len() as u64), &mut state, &mut nodes);
        let end = SleighState::from_coordinates(&state.unwrapped(), state.v());
        worst = worst.max(distance(&end, &goal));
        slip = nodes.nodes().iter().fold(slip, |slip, node| slip.max(node.constraint));
        assert!(distance(plan.poses(&start).last().unwrap(), &goal) < 1e-12);
    }
    println!("parking: error {worst:e}, constraint {slip:e}");
    assert!(worst < 1e-6, "{worst:e}");
    // Speeds up to 30 m/s, two of their digits lost in sines and sums.
    assert!(slip < 100.0 * f64::EPSILON * 30.0, "{slip:e}");
}

#[test]
fn a_plan_stays_in_its_gap() {
    let gap = Gap { depth: 1.2, play: 0.3, swing: 0.4 };
    let goal = SleighState { x: 2.0, y: 1.0, heading: 0.5, ..SleighState::default() };
    let start = SleighState::default();
    let plan = ParkingPlan::park(&start, &goal, &gap).unwrap();
    let poses = plan.poses(&start);
    // From the entry on, seen from the goal: along within the play, turned within the swing, aside only nearer.
    let (sin, cos) = goal.heading.sin_cos();
    for pose in &poses[3..] {
        let (dx, dy) = (pose.x - goal.x, pose.y - goal.y);
        let (along, aside) = (dx * cos + dy * sin, dy * cos - dx * sin);
        assert!(along.abs() <= gap.play + 1e-12, "{along}");
        assert!(aside >= -gap.depth - 1e-12 && aside <= 1e-12, "{aside}");
        assert!((pose.heading - goal.heading).abs() <= gap.swing + 1e-12);
    }
    // Without a gap three moves are enough, and none is needed where one is already.
    assert_eq!(ParkingPlan::park(&start, &goal, &Gap { depth: 0.0, ..gap }).unwrap().moves.len(), 3);
    let none = ParkingPlan::park(&goal, &goal, &Gap { depth: 0.0, ..gap }).unwrap();
    assert_eq!(none.moves, [Move::Turn(0.0), Move::Drive(0.0), Move::Turn(0.0)]);
}

#[test]
fn impossible_gaps_are_refused() {
    let (start, goal) = (SleighState::default(), SleighState { x: 1.0, ..SleighState::default() });
    let park = |depth, play, swing| ParkingPlan::park(&start, &goal, &Gap { depth, play, swing });
    assert!(matches!(park(1.0, 0.0, 0.3), Err(SleighError::NotPositive { quantity: "play in the gap", .. })));
    assert!(matches!(park(1.0, 0.3, -0.3), Err(SleighError::NotPositive { .. })));
    assert!(matches!(park(f64::NAN, 0.3, 0.3), Err(SleighError::NotFinite { .. })));
    assert!(matches!(park(1.0, 1e-9, 1e-9), Err(SleighError::Path { .. })));
    assert_eq!(park(1.0, 0.3, 3.0), park(1.0, 0.3, FRAC_PI_2));
    assert!(ParkingPlan { moves: vec![Move::Drive(1.0)] }.controls(0.0).is_err());
}
