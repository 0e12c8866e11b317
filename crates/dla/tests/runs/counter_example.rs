//! The geometric nonholonomic integrator under forces.

use crate::support::Two;
use approx::assert_abs_diff_eq;
use dla::{Gni, OneStep, State};
use lagrangian::{Constraint, Scalar, System};

/// A particle that is pushed by a constant force and braked in proportion to its velocity, held in its second coordinate.
#[derive(Clone, Copy)]
pub(crate) struct Pushed {
    force: f64,
    drag: f64,
}

impl System<2, 1> for Pushed {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        v[0] * v[0] + v[1] * v[1]
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> Option<[S; 2]> {
        Some([v[0] * -self.drag + self.force, S::zero()])
    }
}

/// Of mass 2: a constant force is a parabola, to rounding; equations that are linear need no second correction but the one that
/// sees so.
#[test]
fn the_counter_example_feels_forces() {
    let (mut state, mut method) = (State::new([0.0; 2], [0.5, 0.0], [false; 2]), Gni::<2>::default());
    for k in 0..20 {
        let t = 0.1 * f64::from(k);
        let report =
            OneStep::<2, 1>::step(&mut method, &Two::from(Pushed { force: 3.0, drag: 0.0 }), t, 0.1, &mut state)
                .unwrap();
        assert!(report.iterations <= 2);
        let t = t + 0.1;
        assert_abs_diff_eq!(state.q()[0], 0.5 * t + 0.75 * t * t, epsilon = 1e-13);
        assert_abs_diff_eq!(state.v()[0], 0.5 + 1.5 * t, epsilon = 1e-13);
        assert_abs_diff_eq!(state.q()[1], 0.0, epsilon = 1e-15);
    }
    // Braked it loses `e^(-c t/m)`, to the second order: the error of a step is below `(c h/m)^3`.
    let mut state = State::new([0.0; 2], [1.0, 0.0], [false; 2]);
    let mut method = Gni::<2>::default();
    for k in 0..20 {
        let system = Two::from(Pushed { force: 0.0, drag: 0.8 });
        let report = OneStep::<2, 1>::step(&mut method, &system, 0.1 * f64::from(k), 0.1, &mut state).unwrap();
        assert!(report.iterations <= 2);
    }
    assert_abs_diff_eq!(state.v()[0], (-0.4_f64 * 2.0).exp(), epsilon = 20.0 * 0.04_f64.powi(3));
}

/// Lifted at the speed `t`.
#[derive(Clone, Copy)]
pub(crate) struct Lifted;

impl System<2, 1> for Lifted {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        v[0] * v[0] + v[1] * v[1]
    }
    fn constraint<S: Scalar>(&self, t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [-t])
    }
}

/// The velocity of a node meets the constraint at the time of the node.
#[test]
fn the_counter_example_follows_a_moving_constraint() {
    let (mut state, mut method) = (State::new([0.0; 2], [0.5, 1.0], [false; 2]), Gni::<2>::default());
    for k in 0..5 {
        let t = 1.0 + 0.1 * f64::from(k);
        OneStep::<2, 1>::step(&mut method, &Two::from(Lifted), t, 0.1, &mut state).unwrap();
        assert_abs_diff_eq!(state.v()[1], t + 0.1, epsilon = 1e-15);
        assert_abs_diff_eq!(state.v()[0], 0.5, epsilon = 1e-15);
    }
}

/// A momentum across the constraint is carried from a node to the step that follows it, and to no other start.
#[test]
fn the_counter_example_begins_anew_from_another_start() {
    let step = |method: &mut Gni<2>, mut state: State<2>| {
        OneStep::<2, 1>::step(method, &Two::from(Lifted), 1.0, 0.1, &mut state).unwrap();
        state
    };
    let (here, there) = (State::new([0.0; 2], [0.5, 1.0], [false; 2]), State::new([0.0, 0.3], [0.7, 1.0], [false; 2]));
    let mut method = Gni::<2>::default();
    let next = step(&mut method, here);
    assert_eq!(step(&mut { method }, there), step(&mut Gni::default(), there));
    // The control: from its own node it goes on with what it remembers.
    assert_ne!(step(&mut method, next), step(&mut Gni::default(), next));
}
