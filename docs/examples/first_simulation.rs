//! The sleigh that is pushed backward and turns around, beside its closed form.
//!
//! `cargo run --example first_simulation`

use noslip::{Dla, Exact, Schedule, Sleigh, SleighState, State, System, Trajectory, drive};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Mass (kg), inertia about the centre of mass (kg m^2), centre of mass ahead of the blade (m).
    let sleigh = Sleigh::new(1.0, 1.0, 0.5)?;
    let start = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() };
    let exact = Exact::new(&sleigh, &start)?;

    let (q, v) = start.to_coordinates();
    let mut state = State::new(q, v, sleigh.angles());
    let mut trajectory = Trajectory::every(100);
    drive(&sleigh, &mut Dla::midpoint(), &Schedule { t0: 0.0, step: 0.05, steps: 800 }, &mut state, &mut trajectory)?;

    println!("   t [s]   speed [m/s]   heading [rad]   from the exact motion [m]   constraint [m/s]");
    for node in trajectory.nodes() {
        let now = SleighState::from_coordinates(node.q[..].try_into()?, node.v[..].try_into()?);
        let there = exact.at(node.t);
        let error = (now.x - there.x).hypot(now.y - there.y);
        println!("{:8.1} {:13.6} {:15.6} {error:27.1e} {:18.1e}", node.t, now.speed, now.heading, node.constraint);
    }
    println!("the whole turn, from ever to ever: {:.6} rad", exact.turning_angle());
    Ok(())
}
