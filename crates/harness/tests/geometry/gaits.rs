use crate::geometry::run;
use approx::assert_relative_eq;
use dla::State;
use lagrangian::System;
use sleigh::parking::{ParkingPlan, sinusoidal_gait, square_gait};
use sleigh::{Guided, Sleigh, SleighState};
use std::f64::consts::{PI, TAU};

/// `J1(x) = sum (-1)^k (x/2)^(2k+1) / (k! (k+1)!)`.
fn bessel(x: f64) -> f64 {
    let mut term = 0.5 * x;
    let mut sum = term;
    for k in 1..30_u32 {
        term *= -0.25 * x * x / (f64::from(k) * f64::from(k + 1));
        sum += term;
    }
    sum
}

#[test]
fn the_square_gait_moves_sideways() {
    let (d, p) = (0.7, 0.4_f64);
    let end = *ParkingPlan { moves: square_gait(d, p).to_vec() }.poses(&SleighState::default()).last().unwrap();
    assert_relative_eq!(end.x, d * (1.0 - p.cos()), epsilon = 1e-15);
    assert_relative_eq!(end.y, d * p.sin(), epsilon = 1e-15);
    assert!(end.heading.abs() < 1e-15);
}

/// `dx = 0`, `dy = 2 pi A J1(B)`, with the full dynamics under the servo.
#[test]
fn the_sinusoidal_gait_moves_by_a_bessel_function() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    for (a, b) in [(0.5, 0.1), (0.8, 1.0), (0.3, 2.5)] {
        let [speed, turn_rate] = sinusoidal_gait(a, b, 2.0);
        let servo = Guided::<2>::servo(sleigh, speed, turn_rate).unwrap();
        let mut state = State::new([0.0; 3], [0.0, 0.0, 2.0 * b], System::<3, 3>::angles(&servo));
        run(&servo, "gauss8", (PI / 64.0, 64), &mut state, &mut ());
        let [x, y, heading] = state.unwrapped();
        assert_relative_eq!(y, TAU * a * bessel(b), epsilon = 1e-10);
        assert!(x.abs() < 1e-10 && heading.abs() < 1e-10, "{x} {heading}");
    }
    // Small loops: the bracket times the area of the loop in the controls.
    assert_relative_eq!(TAU * bessel(1e-3), PI * 1e-3, max_relative = 1e-6);
}
