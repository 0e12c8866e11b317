//! At which speed does a bicycle without a rider's hands stop weaving?
//!
//! `cargo run --example bicycle`

#[path = "bicycle/vectors.rs"]
mod vectors;
#[path = "bicycle/whipple.rs"]
mod whipple;

use noslip::dla::Composition;
use noslip::{Dla, Schedule, State, System, Trajectory, consistent_start, drive};
use std::error::Error;
use whipple::{Bicycle, FRONT, REAR};

const STEP: f64 = 0.01;
/// The motions that die out are over at the begin (s).
const BEGIN: f64 = 8.0;
const END: f64 = 16.0;

/// The rate at which the weave grows (1/s), from the swings of the roll after a push of 1e-6 rad/s.
fn growth(speed: f64) -> Result<f64, Box<dyn Error>> {
    let (q, v) = ([0.0; 8], [speed, 0.0, 0.0, 1e-6, 0.0, 0.0, -speed / REAR, -speed / FRONT]);
    let start = consistent_start(&Bicycle, 0.0, &q, &v)?;
    let mut state = State::new(start.q, start.v, Bicycle.angles());
    let mut nodes = Trajectory::every(1);
    let schedule = Schedule { t0: 0.0, step: STEP, steps: (END / STEP) as u64 };
    drive(&Bicycle, &mut Composition::suzuki4(Dla::midpoint()), &schedule, &mut state, &mut nodes)?;

    // Where the roll turns back: the swing from one of these to the next has no offset in it.
    let turns: Vec<(f64, f64)> = nodes
        .nodes()
        .windows(3)
        .filter(|three| three[0].t > BEGIN && (three[1].q[3] - three[0].q[3]) * (three[2].q[3] - three[1].q[3]) <= 0.0)
        .map(|three| (three[1].t, three[1].q[3]))
        .collect();
    let swings: Vec<(f64, f64)> =
        turns.windows(2).map(|two| (0.5 * (two[0].0 + two[1].0), (two[1].1 - two[0].1).abs())).collect();
    let [first, .., last] = swings[..] else { return Ok(f64::NEG_INFINITY) };
    Ok((last.1 / first.1).ln() / (last.0 - first.0))
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("speed [m/s]   growth of the weave [1/s]");
    let tried = |speed: f64| {
        let rate = growth(speed)?;
        println!("{speed:11.4}   {rate:25.4}");
        Ok::<_, Box<dyn Error>>(rate)
    };
    let (mut before, mut speed) = (4.0, 4.2);
    let mut rates = [tried(before)?, tried(speed)?];
    // Newton's method with the slope of the last two.
    while rates[1].abs() > 1e-3 {
        let next = speed - rates[1] * (speed - before) / (rates[1] - rates[0]);
        (before, speed, rates) = (speed, next, [rates[1], tried(next)?]);
    }
    println!("the bicycle stops weaving at {speed:.3} m/s");
    Ok(())
}
