use crate::energy::systems::{Particle, Potential, at_centre, com};
use crate::support::{Three, Two};
use dla::{Energy, NewtonError, OneStep, Stage, State, StepError};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};

/// A particle in the plane with `y' + b = 0`.
#[derive(Clone, Copy)]
pub(crate) struct Rail {
    affine: f64,
    tide: f64,
    /// When the tide stands still (s).
    still: f64,
    basis: bool,
}
impl System<2, 1> for Rail {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0] * v[0] + v[1] * v[1] - q[0] * q[0]) * 0.5 + (t - self.still).squared() * q[0] * self.tide
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [q[0] * self.affine])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<AdmissibleBasis<S, 2, 1>> {
        self.basis.then(|| AdmissibleBasis::new([[S::constant(1.0), S::zero()]]))
    }
}

fn refused(system: Rail) -> &'static str {
    let start = State::new([0.0, 0.0], [1.0, 0.0], [false; 2]);
    let mut state = start;
    let error = Energy::new::<2>().step(&Two::from(system), 0.0, 0.1, &mut state).unwrap_err();
    assert_eq!(state, start, "a failed step moves nothing");
    let StepError::Unsupported { reason } = error else { panic!("{error}") };
    reason
}

/// Also where `b` happens to vanish at the start.
#[test]
fn what_the_methods_cannot_do_is_refused() {
    let plain = Rail { affine: 0.0, tide: 0.0, still: 0.0, basis: true };
    let mut state = State::new([0.0, 0.0], [1.0, 0.0], [false; 2]);
    Energy::new::<2>().step(&Two::from(plain), 0.0, 0.1, &mut state).unwrap();

    assert!(refused(Rail { affine: 0.3, ..plain }).contains("b = 0"));
    assert!(refused(Rail { basis: false, ..plain }).contains("basis"));
    let tidal = Rail { tide: 0.3, ..plain };
    // Also where the tide stands still at the start, at the end, or as long before as the step looks ahead.
    for still in [0.0, 0.1, -0.381_966 * 0.1] {
        state = State::new([0.1, 0.0], [1.0, 0.0], [false; 2]);
        let error = Energy::new::<2>().step(&Two::from(Rail { still, ..tidal }), 0.0, 0.1, &mut state).unwrap_err();
        assert!(error.to_string().contains("depend on time explicitly"), "{error}");
    }
    // At q = 0 the time cannot be seen, but the step does not keep the energy.
    state = State::new([0.0, 0.0], [1.0, 0.0], [false; 2]);
    let error = Energy::new::<2>().step(&Two::from(tidal), 0.0, 0.1, &mut state).unwrap_err();
    assert!(matches!(error, StepError::Energy { .. }), "{error}");
}

/// Ten radians of a ripple in a step are too many for the quadrature, two are not.
#[test]
fn an_energy_too_rough_is_refused() {
    let system = com(0.1, Potential::Ripple);
    let (q, v) = at_centre([0.3, 0.0, 0.0, 1.0, 0.1], 0.1);
    let start = State::new(q, v, [false, false, true]);
    let mut state = start;
    let error = Energy::new::<2>().step(&system, 0.0, 0.1, &mut state).unwrap_err();
    let StepError::Energy { defect, bound } = error else { panic!("{error}") };
    assert!(defect.abs() > bound && bound < 1e-11);
    assert_eq!(state, start);
    Energy::new::<2>().step(&system, 0.0, 0.02, &mut state).unwrap();
}

/// Steps too long for the iteration.
#[test]
fn steps_too_long_are_refused() {
    let system = Three::from(Particle { mass: 1.3, quartic: 0.2 });
    for h in [5.0, 1e3, f64::NAN] {
        let start = State::new([0.3, 0.5, -0.2], [0.6, -0.4, 0.3], [false; 3]);
        let mut state = start;
        let error = Energy::new::<3>().step(&system, 0.0, h, &mut state).unwrap_err();
        assert_eq!(state, start);
        match error {
            StepError::Newton { stage: Stage::Collocation, source } => {
                assert!(!matches!(source, NewtonError::Singular { .. }), "{source}");
            }
            error => panic!("{error}"),
        }
    }
}
