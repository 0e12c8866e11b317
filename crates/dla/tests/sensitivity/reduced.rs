//! The derivative in quasi-velocities, whose columns are all admissible.

use crate::sensitivity::differences::{BAR, Input, extrapolated};
use crate::sensitivity::systems::{Controlled, Swivelling};
use crate::support::ByHand;
use dla::{Differentiable, Dla, Gauss, OneStep, ReducedVariation, Sensitivity, State};
use lagrangian::{System, quasi_velocities, velocity_of};
use sleigh::{Guided, Sleigh};
use std::array::from_fn;

/// The largest disagreement over all columns, relative; the place `v` of an input is that of the quasi-velocities.
fn disagreement<Sys, Method, const P: usize>(
    sensitivity: &Sensitivity<'_, 3, 1, P>,
    system: impl Fn(&[f64; P]) -> Sys,
    method: &Method,
    at: &Input<3, P>,
) -> f64
where
    Sys: System<3, 1>,
    Method: OneStep<3, 1> + Differentiable<3, 1> + Clone,
{
    let start = |x: &Input<3, P>| {
        let system = system(&x.p);
        let v = velocity_of(&system, x.t, &x.q, &x.v).unwrap();
        let state = State::new(x.q, v, system.angles());
        (system, state)
    };
    let derivative = sensitivity.step(&mut method.clone(), at.t, at.h, &mut start(at).1).unwrap().reduced.unwrap();
    assert_eq!(derivative.dimension, 2);

    let none = Input { q: [0.0; 3], v: [0.0; 3], t: 0.0, h: 0.0, p: [0.0; P] };
    let unit = |i: usize| from_fn(|k| f64::from(u8::from(k == i)));
    let mut columns: Vec<(Input<3, P>, ReducedVariation<3>)> = Vec::new();
    columns.extend((0..3).map(|i| (Input { q: unit(i), ..none }, derivative.from_q[i])));
    columns.extend((0..2).map(|i| (Input { v: unit(i), ..none }, derivative.from_xi[i])));
    let in_parameter = |i: usize| Input { p: from_fn(|k| f64::from(u8::from(k == i))), ..none };
    columns.extend((0..P).map(|i| (in_parameter(i), derivative.from_parameters[i])));
    columns.push((Input { t: 1.0, ..none }, derivative.from_time));
    columns.push((Input { h: 1.0, ..none }, derivative.from_step));

    let mut worst = 0.0f64;
    for (direction, column) in &columns {
        let expected: [f64; 6] = extrapolated(&|epsilon| {
            let x = at.moved(epsilon, direction);
            let (system, mut state) = start(&x);
            method.clone().step(&system, x.t, x.h, &mut state).unwrap();
            let xi = quasi_velocities(&system, x.t + x.h, state.q(), state.v()).unwrap();
            from_fn(|i| if i < 3 { state.unwrapped()[i] } else { xi[i - 3] })
        });
        let size = expected.iter().fold(0.0f64, |m, x| m.max(x.abs())).max(1e-3);
        for i in 0..3 {
            worst = worst.max((column.q[i] - expected[i]).abs() / size);
            worst = worst.max((column.xi[i] - expected[3 + i]).abs() / size);
        }
    }
    worst
}

#[test]
fn columns_in_quasi_velocities() {
    let at = Input { q: [0.3, -0.2, 0.5], v: [0.6, 1.1, 0.0], t: 0.2, h: 0.1, p: Controlled::PARAMETERS };
    let system = Controlled::at(&at.p);
    let worst = disagreement(&Sensitivity::of_member(&system), Controlled::at, &Dla::midpoint(), &at);
    println!("sleigh: {worst:.1e}");
    assert!(worst < BAR, "{worst:e}");

    // Both ends of a step have the basis of their own time, which depends on parameters.
    let moved = Input { q: at.q, v: at.v, t: at.t, h: at.h, p: Swivelling::PARAMETERS };
    let system = Swivelling::at(&moved.p);
    let worst = disagreement(&Sensitivity::of_member(&system), Swivelling::at, &Gauss::new::<4>(), &moved);
    println!("swivelling blade: {worst:.1e}");
    assert!(worst < BAR, "{worst:e}");

    // What is imposed on the velocity depends on the place.
    let table = || ByHand::from(Guided::turntable(Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.6).unwrap());
    let (system, at) = (table(), Input { q: at.q, v: at.v, t: at.t, h: at.h, p: [] });
    let worst = disagreement(&Sensitivity::of(&system), |_| table(), &Gauss::new::<4>(), &at);
    println!("turntable: {worst:.1e}");
    assert!(worst < BAR, "{worst:e}");
}
