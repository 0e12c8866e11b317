//! Lyapunov exponents: of motions of which they are known, by both ways to differentiate a step, and of two strange attractors.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use dla::{FullMechanics, Gauss, Schedule, Sensitivity, State, Subject, has_tangents};
use harness::Method;
use harness::analysis::{Lyapunov, LyapunovError, LyapunovRequest, MotionVerdict, in_parallel, kaplan_yorke, lyapunov};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Reduced, Scalar, System, With};
use nalgebra::DMatrix;
use sleigh::effects::{Bowl, EggCrate};
use sleigh::{Sleigh, SleighState};

/// A point above a saddle, on a plane, with friction along `y`: `x'' = k^2 x`, `y'' = -g y'`, `z' = 0`.
#[derive(Clone, Copy)]
struct Saddle {
    /// Whether it knows these equations, or has them derived.
    by_hand: bool,
}

impl Piecewise for Saddle {
    fn piece(&self, _t: f64) -> Self {
        *self
    }
}

const GROWTH: f64 = 0.7;
const FRICTION: f64 = 0.3;

impl System<3, 1> for Saddle {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5 + q[0] * q[0] * (0.5 * GROWTH * GROWTH)
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[S::zero(), S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([S::zero(), v[1] * -FRICTION, S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, zero], [zero, one, zero]]))
    }
    fn reduced(&self) -> impl Reduced<3, 1> {
        self
    }
}

impl Reduced<3, 1> for Saddle {
    fn reduced_motion<S: Scalar>(&self, _t: S, q: &[S; 3], xi: &[S; 3]) -> Option<[S; 3]> {
        self.by_hand.then(|| [q[0] * (GROWTH * GROWTH), xi[1] * -FRICTION, S::zero()])
    }
}

/// Exponents of a run by the method of that name.
pub(crate) fn exponents_by(
    name: &str,
    system: &impl FullMechanics<3, 1>,
    (q, v): ([f64; 3], [f64; 3]),
    (step, settle, steps): (f64, u64, u64),
) -> Lyapunov {
    let schedule = Schedule { t0: 0.0, step, steps };
    let request = LyapunovRequest { schedule, settle, exponents: None, q: q.into(), v: v.into() };
    let (system, method) = (Subject::new(system, &()), Method::named(name, None).unwrap());
    let found = lyapunov(&system, (3, 1), &method, &request, &mut ()).unwrap();
    assert!(found.failure.is_none(), "{:?}", found.failure);
    assert_relative_eq!(found.time, step * steps as f64, max_relative = 1e-12);
    found
}

pub(crate) fn exponents(
    system: &impl FullMechanics<3, 1>,
    start: ([f64; 3], [f64; 3]),
    steps: (f64, u64, u64),
) -> Lyapunov {
    exponents_by("gauss8", system, start, steps)
}

fn egg_crate() -> (With<Sleigh, EggCrate>, ([f64; 3], [f64; 3])) {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.1).unwrap(), effects: EggCrate::new(0.5, [1.0, 1.0]).unwrap() };
    let start = SleighState { y: 1.0, heading: 0.3, speed: 0.798, turn_rate: 0.5, ..SleighState::default() };
    (system, start.to_coordinates())
}

/// The valley `Y^2/2` at the energy 2 J, from its bottom.
fn valley() -> (With<Sleigh, Bowl>, ([f64; 3], [f64; 3])) {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.5).unwrap(), effects: Bowl::new([0.0, 1.0], [0.0; 2]).unwrap() };
    let start = SleighState { y: -0.5 * 0.3_f64.sin(), heading: 0.3, speed: 1.8, ..SleighState::default() };
    let rest = 2.0 - 0.5 * start.speed.powi(2);
    (system, SleighState { turn_rate: (2.0 * rest / 1.25).sqrt(), ..start }.to_coordinates())
}

#[test]
fn a_saddle_with_friction() {
    // Steps of 0.25 s leave `4e-8 (0.25 GROWTH)^9 / 0.25`, 3e-14 1/s.
    check_saddle(true, (0.25, 400, 200));
}

#[test]
#[ignore = "slow"]
fn a_saddle_with_friction_at_length() {
    check_saddle(false, (0.1, 1000, 1000));
}

/// The exponents of a linear system are the real parts of its eigenvalues.
fn check_saddle(by_hand: bool, steps: (f64, u64, u64)) {
    let found = exponents(&Saddle { by_hand }, ([0.0, 0.3, 0.1], [0.0, 0.8, 0.0]), steps);
    // A frame that has had 100 s to turn into place is off by exp(-100 FRICTION).
    for (exponent, known) in found.exponents.iter().zip([GROWTH, 0.0, 0.0, -FRICTION, -GROWTH]) {
        assert_abs_diff_eq!(*exponent, known, epsilon = 1e-12);
    }
    assert_abs_diff_eq!(found.divergence_mean, -FRICTION, epsilon = 1e-14);
    assert_abs_diff_eq!(found.sum(), -FRICTION, epsilon = 1e-12);
    assert_relative_eq!(kaplan_yorke(&[0.5, 0.0, -1.0]), 2.5);
    assert_relative_eq!(kaplan_yorke(&[-0.5, -1.0]), 0.0);
    assert_relative_eq!(kaplan_yorke(&[1.0, -1.0]), 2.0);
}

test_systems::short_and_full! {
    the_straight_motion_of_the_free_sleigh => check_straight_motion(0.5, 120, [40, 40]);
    the_straight_motion_of_the_free_sleigh_in_full => check_straight_motion(0.1, 800, [2000, 400]);
}

/// About straight motion at the speed `u` the spin has the eigenvalue `-c u`, and all else is neutral. Differences in heading and
/// speed grow linearly, so the neutral exponents are `ln t / t`.
fn check_straight_motion(step: f64, settle: u64, [by_gauss, by_dla]: [u64; 2]) {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let rate = -sleigh.spin_gain() * 0.9;
    for (name, found) in [
        ("gauss8", exponents(&sleigh, ([0.0; 3], [0.9, 0.0, 0.0]), (step, settle, by_gauss))),
        ("dla", exponents_by("dla", &sleigh, ([0.0; 3], [0.9, 0.0, 0.0]), (step, settle, by_dla))),
    ] {
        let neutral = 2.0 * found.time.ln() / found.time;
        // The discrete map has (1 - h c u/2) / (1 + h c u/2) in the place of exp(-h c u).
        let discrete = if name == "dla" { 2.0 * (0.5 * step * rate).atanh() / step } else { rate };
        assert_abs_diff_eq!(found.exponents[4], discrete, epsilon = 1e-10);
        assert_abs_diff_eq!(found.sum(), discrete, epsilon = 1e-10);
        assert_abs_diff_eq!(found.divergence_mean, rate, epsilon = 1e-14);
        assert!(found.exponents[..4].iter().all(|exponent| exponent.abs() < neutral), "{name}: {:?}", found.exponents);
    }
}

test_systems::short_and_full! {
    a_balanced_sleigh_in_a_bowl_is_regular => check_balanced((0.2, 100, 300));
    a_balanced_sleigh_in_a_bowl_is_regular_in_full => check_balanced((0.1, 2000, 20_000));
}

/// With the centre of mass at the blade the motion in a round bowl is integrable: the spin stays, and in axes that turn with it the
/// equations are linear, with the frequencies `(k/m + omega^2)^(1/2)` and zero.
fn check_balanced(steps: (f64, u64, u64)) {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.0).unwrap(), effects: Bowl::new([1.0; 2], [0.0; 2]).unwrap() };
    let start = SleighState { x: 0.5, heading: 0.3, speed: 0.4, turn_rate: 0.7, ..SleighState::default() };
    let found = exponents(&system, start.to_coordinates(), steps);
    println!("{:?} ± {:?}", found.exponents, found.ci);
    let neutral = 2.0 * found.time.ln() / found.time;
    assert!(found.exponents.iter().all(|exponent| exponent.abs() < neutral), "{:?}", found.exponents);
    assert_abs_diff_eq!(found.sum(), 0.0, epsilon = 1e-12);
    let MotionVerdict::Periodic { period, unstable: false } = found.verdict else { panic!("{}", found.verdict) };
    assert_relative_eq!(period, std::f64::consts::TAU / (1.0 + 0.7_f64.powi(2)).sqrt(), max_relative = 1e-5);
    assert!(found.exponents.iter().zip(&found.ci).all(|(exponent, ci)| exponent.abs() <= ci.unwrap()));
}

/// The egg crate of 0.5 J at 1.2 J, and the valley at 2 J. Known with an error of about 0.01 each: (0.059, 0, 0, -0.021, -0.176) and
/// (0.24, 0, 0, 0, -0.47); and the sum is minus the mean of `c u`.
fn check_attractors(egg: u64, deep: u64) {
    let ((crate_, start), (valley, low)) = (egg_crate(), valley());
    let step = 0.1;
    let runs = in_parallel(2, |i| match i {
        0 => exponents(&crate_, start, (step, egg / 10, egg)),
        _ => exponents(&valley, low, (step, deep / 10, deep)),
    });
    let known = [[0.059, 0.0, 0.0, -0.021, -0.176], [0.24, 0.0, 0.0, 0.0, -0.47]];
    for (found, known) in runs.iter().zip(known) {
        println!("T = {} s: {:.5?}", found.time, found.exponents);
        println!(
            "    ± {:.5?}, sum {:.7}, divergence {:.7}, dimension {:.3}",
            found.ci,
            found.sum(),
            found.divergence_mean,
            kaplan_yorke(&found.exponents)
        );
        for ((exponent, ci), known) in found.exponents.iter().zip(&found.ci).zip(known) {
            assert_abs_diff_eq!(*exponent, known, epsilon = 0.015);
            assert!(ci.unwrap() < 0.015);
            // What is zero has zero in its interval, and what is not has not.
            assert_eq!(exponent.abs() <= ci.unwrap(), known == 0.0, "{exponent} ± {ci:?}");
        }
        assert_eq!(found.verdict, MotionVerdict::Chaotic);
        assert_abs_diff_eq!(found.sum(), found.divergence_mean, epsilon = 1e-4);
    }
}

#[test]
#[ignore = "slow"]
fn strange_attractors() {
    check_attractors(100_000, 200_000);
}

#[test]
#[ignore = "slow"]
fn long_strange_attractors() {
    check_attractors(200_000, 200_000);
}

test_systems::short_and_full! {
    far_from_the_origin => check_far(400);
    far_from_the_origin_in_full => check_far(3000);
}

/// Twenty kilometres away the places within a step are rounded to more than the slopes of its stages are, and yet each step ends.
fn check_far(steps: u64) {
    let (system, (mut q, v)) = egg_crate();
    q[0] += 2e4;
    let found = exponents(&system, (q, v), (0.1, 0, steps));
    assert_abs_diff_eq!(found.sum(), found.divergence_mean, epsilon = 1e-4);
}

/// A system that hides what it knows by hand.
#[derive(Clone)]
struct Plain<Sys>(Sys);

impl<Sys: Clone> Piecewise for Plain<Sys> {
    fn piece(&self, _t: f64) -> Self {
        self.clone()
    }
}

impl<Sys: System<3, 1>> System<3, 1> for Plain<Sys> {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.0.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        self.0.constraint(t, q)
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        self.0.admissible_basis(t, q)
    }
}

test_systems::short_and_full! {
    three_ways_to_differentiate_a_step => check_three_ways(16);
    three_ways_to_differentiate_a_step_in_full => check_three_ways(100);
}

/// Stages on dual numbers, with reduced equations by hand and without, and the implicit function theorem: the same exponents.
fn check_three_ways(steps: u32) {
    let (system, (q, v)) = valley();
    let by_hand = exponents_by("gauss4", &system, (q, v), (0.1, 0, steps.into()));
    let plain = Plain(valley().0);
    let hidden = exponents_by("gauss4", &plain, (q, v), (0.1, 0, steps.into()));
    assert_abs_diff_eq!(by_hand.divergence_mean, hidden.divergence_mean, epsilon = 1e-12);
    for (one, other) in by_hand.exponents.iter().zip(&hidden.exponents) {
        assert_abs_diff_eq!(one, other, epsilon = 1e-9);
    }

    let (sensitivity, mut state) = (Sensitivity::of(&plain), State::new(q, v, plain.angles()));
    let mut log_volume = 0.0;
    for k in 0..steps {
        let derivative = sensitivity.step(&mut Gauss::new::<2>(), 0.1 * f64::from(k), 0.1, &mut state).unwrap();
        let rows = derivative.reduced.unwrap().matrix();
        log_volume += DMatrix::from_row_iterator(5, 5, rows.into_iter().flatten()).determinant().ln();
    }
    assert_abs_diff_eq!(by_hand.sum(), log_volume / by_hand.time, epsilon = 1e-10);
}

#[test]
fn what_has_no_exponents_says_why() {
    let (system, (q, v)) = valley();
    let schedule = Schedule { t0: 0.0, step: 0.1, steps: 10 };
    for (name, exponents, told) in [
        ("gauss8", Some(0), "1 to 5"),
        ("gauss8", Some(6), "1 to 5"),
        ("gni", None, "gni"),
        ("dop853", None, "chooses its steps"),
    ] {
        let request = LyapunovRequest { schedule, settle: 0, exponents, q: q.into(), v: v.into() };
        let method = Method::named(name, None).unwrap();
        let error = lyapunov(&Subject::new(&system, &()), (3, 1), &method, &request, &mut ()).unwrap_err();
        assert!(error.to_string().contains(told), "{error}");
        assert_eq!(has_tangents(&method).is_err(), matches!(error, LyapunovError::Sensitivity(_)), "{name}");
    }
    // The start of a run that fails keeps what it has: here nothing.
    let request = LyapunovRequest { schedule, settle: 0, exponents: None, q: q.into(), v: vec![f64::NAN; 3] };
    let method = Method::named("gauss8", None).unwrap();
    let found = lyapunov(&Subject::new(&system, &()), (3, 1), &method, &request, &mut ());
    assert!(found.unwrap().failure.is_some());
}
