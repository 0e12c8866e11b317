//! The effects by themselves: derivatives, what they refuse, functions of time and paths, what bodies pass on.

mod bodies;
mod closed;
mod derivatives;
mod forces;
mod guided_motion;
mod imposed;
mod own_axes;
mod paths;
mod pushed;
mod refusals;
mod time;

use sleigh::{Sleigh, TimeFunction};

/// `m = 1.3`, `I = 0.8`, `a = 0.4`.
fn sleigh() -> Sleigh {
    Sleigh::new(1.3, 0.8, 0.4).unwrap()
}

fn sine(amplitude: f64, frequency: f64, phase: f64) -> TimeFunction {
    TimeFunction::Sine { amplitude, frequency, phase }
}
