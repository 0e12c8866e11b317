//! Constraints that do not determine their multipliers give an error, not a result.

use dla::{Dla, Form, NewtonError, OneStep, Stage, State, StepError};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use proptest::prelude::*;

/// A particle with one constraint given twice, the second time times a factor.
struct Twice {
    row: [f64; 3],
    factor: f64,
}

impl System<3, 2> for Twice {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] * 1.7 + v[2] * v[2] * 0.6) * 0.5 - q[0] * q[1]
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let a: [S; 3] = std::array::from_fn(|i| (q[i] * 0.3).cos() * self.row[i]);
        ([a, a.map(|x| x * self.factor)], [S::zero(); 2])
    }
    /// One of the two: the type asks for as many as independent rows would leave.
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 2>> {
        let ([a, _], _) = self.constraint(t, q);
        Some(AdmissibleBasis::new([[a[1], -a[0], S::zero()]]))
    }
}

/// `x x' = 0`: no constraint at all where `x = 0`.
struct Dropping {
    basis: bool,
}

impl System<2, 1> for Dropping {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[q[0], S::zero()]], [S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        self.basis.then(|| AdmissibleBasis::new([[S::zero(), S::constant(1.0)]]))
    }
}

fn refused<Sys: System<N, M>, const N: usize, const M: usize>(system: &Sys, q: [f64; N], v: [f64; N]) {
    for form in [Form::Best, Form::General, Form::Multipliers] {
        let start = State::new(q, v, [false; N]);
        let mut state = start;
        let outcome = Dla::midpoint().solved(form).step(system, 0.0, 0.1, &mut state);
        let expected = matches!(
            outcome,
            Err(StepError::Newton { stage: Stage::Increment, source: NewtonError::Singular { iteration: 1, .. } })
        );
        assert!(expected, "{form:?}: {outcome:?}, {state:?}");
        assert_eq!(state, start, "a failed step leaves the state");
    }
}

#[test]
fn a_constraint_given_twice() {
    refused(&Twice { row: [1.0, -0.5, 0.3], factor: 1.0 }, [0.1, 0.2, 0.3], [0.5, 1.0, 0.0]);
    refused(&Twice { row: [1.0, 0.0, 0.0], factor: -3.0 }, [0.0; 3], [0.0, 1.0, 2.0]);
}

#[test]
fn a_constraint_that_vanishes() {
    for basis in [false, true] {
        refused(&Dropping { basis }, [0.0, 1.0], [0.0, 1.0]);
        refused(&Dropping { basis }, [0.0, 1.0], [0.5, 1.0]);
        // Beside the point it holds, and the step keeps it.
        let mut state = State::new([1e-3, 1.0], [0.0, 1.0], [false; 2]);
        Dla::midpoint().step(&Dropping { basis }, 0.0, 0.1, &mut state).unwrap();
        approx::assert_abs_diff_eq!(&state.q()[..], &[1e-3, 1.1][..], epsilon = 1e-15);
    }
}

proptest! {
    /// Dependent rows of any numbers and units, where elimination leaves a rounding instead of a zero.
    #[test]
    fn dependent_rows_are_seen(
        row in prop::array::uniform3(0.1..2.0f64), factor in 0.1..10.0f64, unit in -8..8i32,
        q in prop::array::uniform3(-1.0..1.0f64), v in prop::array::uniform3(-1.0..1.0f64),
    ) {
        refused(&Twice { row, factor: factor * 10f64.powi(unit) }, q, v);
    }
}
