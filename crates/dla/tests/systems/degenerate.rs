//! Constraints that do not determine their multipliers: the motion goes on where it is determined, and elsewhere there is an
//! error that names the rows.

use crate::support::{Three, ThreeTwo, Two};
use approx::assert_abs_diff_eq;
use dla::{Dependency, Dla, Form, OneStep, State, StepError};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use proptest::prelude::*;

/// A particle with one constraint given twice, the second time times a factor.
#[derive(Clone, Copy)]
pub(crate) struct Twice {
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
#[derive(Clone, Copy)]
pub(crate) struct Dropping {
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

/// The same constraint, given once.
#[derive(Clone, Copy)]
pub(crate) struct Once(Twice);

impl System<3, 1> for Once {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.0.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let ([a, _], _) = self.0.constraint(t, q);
        ([a], [S::zero()])
    }
}

const FORMS: [Form; 2] = [Form::Best, Form::Multipliers];

/// With one row or with two that agree the motion is the same, whatever the form.
fn goes_on(row: [f64; 3], factor: f64, q: [f64; 3], v: [f64; 3]) {
    let twice = ThreeTwo::from(Twice { row, factor });
    let mut expected = State::new(q, v, [false; 3]);
    Dla::midpoint().step(&Three::from(Once(Twice { row, factor })), 0.0, 0.1, &mut expected).unwrap();
    for form in FORMS {
        let mut state = State::new(q, v, [false; 3]);
        Dla::midpoint().solved(form).step(&twice, 0.0, 0.1, &mut state).unwrap();
        // Equations of condition below a thousand in three unknowns below ten.
        assert_abs_diff_eq!(&state.q()[..], &expected.q()[..], epsilon = 1e-12);
        assert_abs_diff_eq!(&state.v()[..], &expected.v()[..], epsilon = 1e-12);
    }
}

#[test]
fn a_constraint_given_twice() {
    goes_on([1.0, -0.5, 0.3], 1.0, [0.1, 0.2, 0.3], [0.5, 1.0, 0.0]);
    goes_on([1.0, 0.0, 0.0], -3.0, [0.0; 3], [0.0, 1.0, 2.0]);
}

#[test]
fn a_constraint_that_vanishes() {
    for basis in [false, true] {
        for v in [[0.0, 1.0], [0.5, 1.0]] {
            for form in FORMS {
                let start = State::new([0.0, 1.0], v, [false; 2]);
                let mut state = start;
                let outcome = Dla::midpoint().solved(form).step(&Two::from(Dropping { basis }), 0.0, 0.1, &mut state);
                let Err(StepError::Dependent(error)) = outcome else { panic!("{form:?}: {outcome:?}, {state:?}") };
                assert_eq!(error.dependency, Dependency::RankDrops);
                assert!(error.rows.contains(0) && error.to_string().starts_with("row 1 of the constraint vanishes"));
                assert_eq!(state, start, "a failed step leaves the state");
            }
        }
        // Beside the point it holds, and the step keeps it.
        let mut state = State::new([1e-3, 1.0], [0.0, 1.0], [false; 2]);
        Dla::midpoint().step(&Two::from(Dropping { basis }), 0.0, 0.1, &mut state).unwrap();
        assert_abs_diff_eq!(&state.q()[..], &[1e-3, 1.1][..], epsilon = 1e-15);
    }
}

proptest! {
    /// Dependent rows of any numbers and units, where elimination leaves a rounding instead of a zero.
    #[test]
    fn dependent_rows_are_seen(
        row in prop::array::uniform3(0.1..2.0f64), factor in 0.1..10.0f64, unit in -8..8i32,
        q in prop::array::uniform3(-1.0..1.0f64), v in prop::array::uniform3(-1.0..1.0f64),
    ) {
        goes_on(row, factor * 10f64.powi(unit), q, v);
    }
}
