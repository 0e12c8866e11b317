//! Tangents along runs.

use crate::sensitivity::differences::{BAR, admissible, extrapolated};
use crate::sensitivity::systems::Controlled;
use crate::support::ThreeTwo;
use dla::{Dla, Schedule, Sensitivity, State, Tangent, Variation, drive};
use std::array::from_fn;
use std::ops::ControlFlow;
use test_systems::{Model, SleighOnArm};

const START: ([f64; 3], [f64; 3]) = ([0.3, -0.2, 0.5], [0.6, 0.2, 0.4]);
const SCHEDULE: Schedule = Schedule { t0: 0.0, step: 0.05, steps: 100 };

/// The chain rule over a hundred steps, against runs from nearby starts and with nearby parameters.
#[test]
fn tangents_are_the_differences_of_runs() {
    let begin = |epsilon: f64, direction: &[f64; 6], p: &[f64; 6]| {
        let system = Controlled::at(&from_fn(|k| Controlled::PARAMETERS[k] + epsilon * p[k]));
        let q = from_fn(|i| START.0[i] + epsilon * direction[i]);
        (system, admissible(&system, 0.0, q, from_fn(|i| START.1[i] + epsilon * direction[3 + i])))
    };
    // Small enough for the extrapolation, since a hundred steps stretch a variation.
    let scale = 0.1;
    let directions = [
        ([scale, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 6]),
        ([0.0, 0.0, scale, 0.0, 0.0, 0.0], [0.0; 6]),
        ([0.0, 0.0, 0.0, scale, 0.0, scale], [0.0; 6]),
        ([0.0; 6], [scale, -scale, 0.0, 0.0, 0.0, 0.0]),
        ([0.0; 6], [0.0, 0.0, scale, 0.0, 0.0, 0.0]),
        ([0.0; 6], [0.0, 0.0, 0.0, 0.0, scale, scale]),
    ];
    let mut tangents = directions.map(|(direction, p)| {
        let v = extrapolated(&|epsilon| *begin(epsilon, &direction, &p).1.v());
        Tangent { state: Variation { q: from_fn(|i| direction[i]), v }, parameters: p }
    });

    let (system, mut state) = begin(0.0, &[0.0; 6], &[0.0; 6]);
    let sensitivity = Sensitivity::of_member(&system);
    let mut seen = 0;
    let made = sensitivity
        .drive(&mut Dla::midpoint(), &SCHEDULE, &mut state, &mut tangents, |t, _, tangents| {
            seen += 1;
            assert_eq!(t.to_bits(), SCHEDULE.time(seen).to_bits());
            assert_eq!(tangents.len(), 6);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!((made, seen), (100, 100));

    for (tangent, (direction, p)) in tangents.iter().zip(&directions) {
        let end = |epsilon: f64| {
            let (system, mut state) = begin(epsilon, direction, p);
            drive(&system, &mut Dla::midpoint(), &SCHEDULE, &mut state, ()).unwrap();
            state
        };
        let q = extrapolated(&|epsilon| end(epsilon).unwrapped());
        let v = extrapolated(&|epsilon| *end(epsilon).v());
        let size = q.iter().chain(&v).fold(0.0f64, |m, x| m.max(x.abs()));
        let off =
            (0..3).fold(0.0f64, |m, i| m.max((tangent.state.q[i] - q[i]).abs()).max((tangent.state.v[i] - v[i]).abs()));
        println!("{direction:?} {p:?}: {size:.3} {:.1e}", off / size);
        assert!(off < BAR * size, "{tangent:?}, differences {q:?} {v:?}");
    }
    let (_, mut alone) = begin(0.0, &[0.0; 6], &[0.0; 6]);
    drive(&system, &mut Dla::midpoint(), &SCHEDULE, &mut alone, ()).unwrap();
    assert_eq!(alone, state, "looking at tangents changes the run");
}

/// `Break` ends a run, and what `each` does to the tangents stays.
#[test]
fn a_run_may_be_ended_and_tangents_scaled() {
    let system = Controlled::at(&Controlled::PARAMETERS);
    let mut state = admissible(&system, 0.0, START.0, START.1);
    let mut tangents = [Tangent { state: Variation { q: [1.0, 0.0, 0.0], v: [0.0; 3] }, parameters: [0.0; 6] }];
    let mut seen = 0;
    let made = Sensitivity::of_member(&system)
        .drive(&mut Dla::midpoint(), &SCHEDULE, &mut state, &mut tangents, |_, _, tangents| {
            tangents[0].state = Variation::ZERO;
            seen += 1;
            if seen == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    assert_eq!(made, 3);
    assert_eq!(tangents[0].state, Variation::ZERO);
}

/// Between two pieces of a run the velocity is brought onto the new constraint, and a tangent with it.
#[test]
fn tangents_follow_the_impulse_of_the_constraint() {
    let system = Controlled::at(&Controlled::PARAMETERS);
    // The blade slips by half a metre a second.
    let (q, v) = ([0.3, -0.2, 0.5], [0.6, 0.7, 0.4]);
    let direction: [f64; 6] = [0.2, -0.4, 1.0, 0.5, 0.3, -0.7];
    let at = |epsilon: f64| {
        let moved = |x: &[f64; 3], k: usize| from_fn(|i| x[i] + epsilon * direction[k + i]);
        admissible(&system, 0.0, moved(&q, 0), moved(&v, 3))
    };
    let [dx, dy, dtheta, tail @ ..] = direction;
    let mut tangents = [Tangent { state: Variation { q: [dx, dy, dtheta], v: tail }, parameters: [0.0; 6] }];
    let mut state = State::new(q, v, [false, false, true]);
    Sensitivity::of_member(&system).onto_constraint(0.0, &mut state, &mut tangents).unwrap();
    assert_eq!(state, at(0.0));
    assert!((state.v()[1] - v[1]).abs() > 0.1, "nothing to project");
    let expected = extrapolated(&|epsilon| *at(epsilon).v());
    for i in 0..3 {
        approx::assert_abs_diff_eq!(tangents[0].state.v[i], expected[i], epsilon = BAR);
        approx::assert_abs_diff_eq!(tangents[0].state.q[i], direction[i], epsilon = BAR);
    }
}

/// So it is with the rows of a constraint on positions, which keep the velocity only: the tangent keeps its place.
#[test]
fn tangents_follow_the_impulse_of_an_arm() {
    let sleigh = SleighOnArm::new(1.3, 0.8, 0.4, 0.7, 1.5, 2.0);
    let (q, v) = (sleigh.start().0, [0.6, 0.7, 0.4]);
    let sleigh = ThreeTwo::from(sleigh);
    let direction: [f64; 6] = [0.2, -0.4, 1.0, 0.5, 0.3, -0.7];
    let at = |epsilon: f64| {
        let moved = |x: &[f64; 3], k: usize| from_fn(|i| x[i] + epsilon * direction[k + i]);
        admissible(&sleigh, 0.0, moved(&q, 0), moved(&v, 3))
    };
    let [dx, dy, dtheta, tail @ ..] = direction;
    let mut tangents = [Tangent { state: Variation { q: [dx, dy, dtheta], v: tail }, parameters: [] }];
    let mut state = State::new(q, v, [false, false, true]);
    Sensitivity::of(&sleigh).onto_constraint(0.0, &mut state, &mut tangents).unwrap();
    assert_eq!(state, at(0.0));
    assert!((state.v()[1] - v[1]).abs() > 0.1, "nothing to project");
    let expected = extrapolated(&|epsilon| *at(epsilon).v());
    for i in 0..3 {
        approx::assert_abs_diff_eq!(tangents[0].state.v[i], expected[i], epsilon = BAR);
        approx::assert_abs_diff_eq!(tangents[0].state.q[i], direction[i], epsilon = BAR);
    }
}
