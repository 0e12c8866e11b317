//! Gauss collocation of a sleigh in a round well: in its own axes the energy is of second degree, and kept whatever the step.

use crate::support::ByHand;
use dla::{Gauss, Schedule, State, drive};
use lagrangian::{System, With, energy};
use sleigh::effects::Bowl;
use sleigh::{RoundWell, Sleigh, SleighState};

const START: SleighState = SleighState { x: 0.0, y: 0.0, heading: 0.0, speed: -1.0, turn_rate: 0.1 };

fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// The last node, and the largest relative change of the energy.
fn run<Sys: System<3, 1>>(system: &Sys, (q, v): ([f64; 3], [f64; 3]), duration: f64, steps: u64) -> (State<3>, f64) {
    let mut state = State::new(q, v, system.angles());
    let first = energy(system, 0.0, &q, &v);
    let mut method = Gauss::new::<8>();
    let mut worst = 0.0f64;
    for part in 0..100 {
        let step = duration / steps as f64;
        let schedule = Schedule { t0: part as f64 * duration / 100.0, step, steps: steps / 100 };
        drive(system, &mut method, &schedule, &mut state, ()).unwrap();
        worst = worst.max((energy(system, 0.0, state.q(), state.v()) - first).abs() / first);
    }
    (state, worst)
}

#[test]
fn the_motion_is_that_on_the_plane() {
    let well = RoundWell::new(sleigh(), 0.1, [0.3, -0.2]).unwrap();
    let bowl = With { body: sleigh(), effects: Bowl::new([0.1, 0.1], [0.3, -0.2]).unwrap() };
    let (own, _) = run(&ByHand::from(well), well.coordinates(&START), 20.0, 200);
    let (plane, _) = run(&ByHand::from(bowl), START.to_coordinates(), 20.0, 200);
    let (a, b) = (well.state(&own.unwrapped(), own.v()), SleighState::from_coordinates(&plane.unwrapped(), plane.v()));
    // Both are of order 16 with a tenth of a second a step: what differs is rounding, grown some tenfold by the motion.
    for (a, b) in [(a.x, b.x), (a.y, b.y), (a.heading, b.heading), (a.speed, b.speed), (a.turn_rate, b.turn_rate)] {
        approx::assert_abs_diff_eq!(a, b, epsilon = 2e-13);
    }
}

#[test]
fn long_steps_keep_the_energy_in_the_axes_of_the_sleigh_only() {
    steps_of_three_seconds(200);
}

#[test]
#[ignore = "slow"]
fn long_steps_keep_the_energy_in_the_axes_of_the_sleigh_only_in_full() {
    steps_of_three_seconds(2000);
}

fn steps_of_three_seconds(steps: u64) {
    let duration = 3.0 * steps as f64;
    let well = RoundWell::new(sleigh(), 0.1, [0.0; 2]).unwrap();
    let bowl = With { body: sleigh(), effects: Bowl::new([0.1, 0.1], [0.0; 2]).unwrap() };
    let (_, own) = run(&ByHand::from(well), well.coordinates(&START), duration, steps);
    let (_, plane) = run(&ByHand::from(bowl), START.to_coordinates(), duration, steps);
    // The rounding of all steps, if it all went one way.
    assert!(own < steps as f64 * f64::EPSILON, "{own:e}");
    assert!(plane > 1e-9 * steps as f64 / 2000.0, "{plane:e}");
}
