//! Parks the sleigh in a gap: plans the moves, makes them with the full dynamics under a servo, and draws them.
//!
//! `cargo run --example parking [FILE.svg]`; without a file only the plan is printed.

use dla::{Mechanism, Method, Schedule, Subject, Trajectory};
use harness::Run;
use report::{SceneReport, Series, path_picture};
use sleigh::parking::{Gap, Move, ParkingPlan};
use sleigh::{Guided, Sleigh, SleighState};
use std::error::Error;
use std::io::Write;

/// Seconds for a move, and steps of the method in it.
const MOVE: (f64, u64) = (1.0, 16);

fn main() -> Result<(), Box<dyn Error>> {
    let start = SleighState { x: -2.5, y: -1.2, heading: 0.6, ..SleighState::default() };
    let goal = SleighState { x: 0.0, y: 0.0, heading: 0.0, ..SleighState::default() };
    // Between two others in a row: half a metre ahead and back, 0.8 m from the lane on the right.
    let gap = Gap { depth: 0.8, play: 0.5, swing: 0.45 };
    let plan = ParkingPlan::park(&start, &goal, &gap)?;

    for (k, step) in plan.moves.iter().enumerate() {
        match step {
            Move::Drive(d) => println!("{:2}  drive {d:+.4} m", k + 1),
            Move::Turn(angle) => println!("{:2}  turn  {angle:+.4} rad", k + 1),
        }
    }

    let [speed, turn_rate] = plan.controls(MOVE.0)?;
    let servo = Guided::<2>::servo(Sleigh::new(1.0, 1.0, 0.5)?, speed, turn_rate)?;
    let schedule = Schedule { t0: 0.0, step: MOVE.0 / MOVE.1 as f64, steps: MOVE.1 * plan.moves.len() as u64 };
    let system = Subject::<3, 3>::from(&servo);
    let mut state = system.state(&start.to_coordinates().0, &[0.0; 3]);
    let mut nodes = Trajectory::every(1);
    Run::of(&system, &Method::named("dla", None)?).observe(&mut nodes).moves(&schedule, &mut state)?;
    let [x, y, heading] = state.unwrapped()[..].try_into()?;
    let slip = nodes.nodes().iter().map(|node| node.constraint).fold(0.0, f64::max);
    println!(
        "ends {:.1e} m and {:.1e} rad from the goal",
        (x - goal.x).hypot(y - goal.y),
        (heading - goal.heading).abs()
    );
    println!("constraint {slip:.1e} m/s at most");

    if let Some(file) = std::env::args().nth(1) {
        let nodes = nodes.nodes();
        let series = Series {
            label: "dla".to_owned(),
            path: nodes.iter().map(|node| [node.q[0], node.q[1]]).collect(),
            heading: nodes.iter().map(|node| node.q[2]).collect(),
            rotor: Vec::new(),
            followers: Vec::new(),
            time: nodes.iter().map(|node| node.t).collect(),
            constraint: Vec::new(),
            energy_error: Vec::new(),
            ..Series::default()
        };
        let scene = SceneReport {
            name: "parking".to_owned(),
            title: "Parking".to_owned(),
            series: vec![series],
            ..SceneReport::default()
        };
        std::fs::File::create_new(&file)?.write_all(path_picture(&scene).as_bytes())?;
        println!("written: {file}");
    }
    Ok(())
}
