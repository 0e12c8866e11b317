//! Runs that are sampled, triggered, stopped and resumed, given a step, and told why they failed.

mod checkpoint;
pub(crate) mod counter_example;
mod crossings;
mod dense;
pub(crate) mod events;
pub(crate) mod failures;
mod hints;
pub(crate) mod observers;
mod own_steps;
mod predicted;
mod recommend;
pub(crate) mod scripted;
mod trials;
mod units;

use crate::support::ByHand;
use dla::State;
use sleigh::{Sleigh, SleighState};

/// The sleigh of the scene `turnaround`.
fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// The same, to be passed to a method.
fn system() -> ByHand {
    sleigh().into()
}

/// Its start.
fn backward() -> SleighState {
    SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }
}

fn state_of(start: &SleighState) -> State<3> {
    let (q, v) = start.to_coordinates();
    State::new(q, v, [false, false, true])
}

fn sleigh_state(state: &State<3>) -> SleighState {
    SleighState::from_coordinates(&state.unwrapped(), state.v())
}

/// `k = sqrt(J/m)`, `U` and `kappa` of a motion, and the time when its speed is zero (see `sleigh::Exact`).
struct Motion {
    gyration: f64,
    speed: f64,
    kappa: f64,
    turnaround: f64,
}

impl Motion {
    fn new(sleigh: &Sleigh, start: &SleighState) -> Self {
        let gyration = (sleigh.pivot_inertia() / sleigh.mass()).sqrt();
        let spin = gyration * start.turn_rate.abs();
        let speed = start.speed.hypot(spin);
        let kappa = sleigh.offset() * speed / (gyration * gyration);
        Self { gyration, speed, kappa, turnaround: -(start.speed / spin).asinh() / kappa }
    }

    /// When the speed is a given part of `U`.
    fn at_speed(&self, part: f64) -> f64 {
        self.turnaround + part.atanh() / self.kappa
    }

    /// When the blade has turned by `turn` in the sense of its spin, over all time from the start: the Gudermannian of
    /// `s` has grown by `a turn/k`.
    fn at_turn(&self, offset: f64, turn: f64) -> f64 {
        let phi = offset * turn / self.gyration + 2.0 * (0.5 * (-self.kappa * self.turnaround)).tanh().atan();
        self.turnaround + phi.tan().asinh() / self.kappa
    }
}
