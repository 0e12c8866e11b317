//! Events of a method of the table that has steps of its own.

use crate::common::{Watched, watched};
use approx::assert_abs_diff_eq;
use dla::{Event, Schedule, Subject};
use harness::{Method, Request};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Scalar, System};
use std::f64::consts::{PI, TAU};

/// A point of unit mass on a line, `x'' = -x`, which may be pushed aside from the time 10 on: `x'' = 2 - x`.
#[derive(Clone, Copy)]
struct Spring {
    jumps: bool,
    push: f64,
}

impl System<2, 1> for Spring {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1] - q[0] * q[0]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        Some(AdmissibleBasis::new([[S::constant(1.0), S::zero()]]))
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], _v: &[S; 2]) -> Option<[S; 2]> {
        self.jumps.then(|| [S::constant(self.push), S::zero()])
    }
}

impl Piecewise for Spring {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        if self.jumps && from < 10.0 && 10.0 < to { vec![10.0] } else { Vec::new() }
    }
    fn piece(&self, t: f64) -> Self {
        Self { push: if t > 10.0 { 2.0 } else { 0.0 }, ..*self }
    }
}

/// From `x = 0` with `x' = 1`, so that `x = sin t`, in long steps.
fn run(spring: Spring, (step, steps): (f64, u64), events: &[Event<'_>]) -> Watched {
    let method = Method::named("dop853", None).unwrap();
    let schedule = Schedule { t0: 0.0, step, steps };
    let request = Request { schedule, q: vec![0.0; 2], v: vec![1.0, 0.0], samples: 1 };
    watched(&Subject::from(&spring), &method, &request, events, 1)
}

const FREE: Spring = Spring { jumps: false, push: 0.0 };

fn half<'a>() -> Event<'a> {
    Event::new("x = 1/2", |_, q, _| q[0] - 0.5)
}

fn assert_times(watched: &Watched, expected: &[f64]) {
    let found: Vec<f64> = watched.crossings.iter().map(|crossing| crossing.t).collect();
    assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
    // Errors of 1e-12 in each of some hundred steps, over a slope of .87.
    found.iter().zip(expected).for_each(|(t, expected)| assert_abs_diff_eq!(*t, *expected, epsilon = 1e-9));
    assert_eq!(watched.close, None);
}

/// `sin t = 1/2` twice in each turn, forward, and backward `sin(-t)`.
#[test]
fn long_steps_hide_no_event() {
    let turns = |first: f64, second: f64| {
        let times = (0..10).flat_map(move |k| [first, second].map(|t| t + f64::from(k) * TAU));
        times.filter(|t| *t < 60.0).collect::<Vec<_>>()
    };
    let expected = turns(PI / 6.0, 5.0 * PI / 6.0);
    assert_eq!(expected.len(), 20);
    for schedule in [(60.0, 1), (20.0, 3), (7.5, 8), (0.6, 100)] {
        assert_times(&run(FREE, schedule, &[half()]), &expected);
    }
    let backward: Vec<f64> = turns(7.0 * PI / 6.0, 11.0 * PI / 6.0).iter().map(|t| -t).collect();
    assert_times(&run(FREE, (-20.0, 3), &[half()]), &backward);
}

/// The run ends at the event, in the middle of a long step, and the nodes before are the same as without events.
#[test]
fn a_long_step_ends_at_an_event() {
    let third = Event::new("x = -1/2", |_, q, _| q[0] + 0.5).terminal();
    let watched = run(FREE, (5.0, 12), &[half(), third]);
    let end = 7.0 * PI / 6.0;
    assert_times(&watched, &[PI / 6.0, 5.0 * PI / 6.0, end]);
    let nodes = &watched.nodes;
    assert_eq!((nodes.len(), nodes[1].t.to_bits(), watched.record.steps), (2, watched.record.t.to_bits(), 1));
    assert_abs_diff_eq!(watched.record.t, end, epsilon = 1e-9);
    assert_abs_diff_eq!(nodes[1].q[0], -0.5, epsilon = 1e-15);
}

/// Each piece has its own motion: `2 + (sin 10 - 2) cos s + cos 10 sin s` after the jump, `s = t - 10`.
#[test]
fn the_own_steps_of_each_piece_are_looked_at() {
    let amplitude = (10f64.sin() - 2.0).hypot(10f64.cos());
    let phase = f64::atan2(10f64.cos(), 10f64.sin() - 2.0);
    // `2 + A cos(s - phase) = 1/2`.
    let half_width = (-1.5 / amplitude).acos();
    let after = (-2..10).flat_map(|k| [-half_width, half_width].map(|side| phase + side + f64::from(k) * TAU));
    let mut expected: Vec<f64> = after.filter(|s| 0.0 < *s && *s < 20.0).map(|s| 10.0 + s).collect();
    let before = (0..2).flat_map(|k| [PI / 6.0, 5.0 * PI / 6.0].map(|t| t + f64::from(k) * TAU));
    expected.extend(before.filter(|t| *t < 10.0));
    expected.sort_by(f64::total_cmp);
    assert_times(&run(Spring { jumps: true, push: 0.0 }, (10.0, 3), &[half()]), &expected);
}
