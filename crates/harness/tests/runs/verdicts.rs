//! What motions are: steady, periodic, running away, regular or chaotic; their known exponents, and the two sums of all.

use crate::runs::chaos::{exponents, exponents_by};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use dla::{Schedule, Subject};
use harness::Method;
use harness::analysis::{
    Evidence, Lyapunov, LyapunovFailure, LyapunovRequest, MotionVerdict, PARTS, Undecided, lyapunov,
};
use lagrangian::{AdmissibleBasis, Constraint, Piecewise, Reduced, Scalar, System, With};
use proptest::prelude::*;
use sleigh::effects::{Bowl, Drag, Thrust};
use sleigh::{Sleigh, SleighState};

fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// Straight along x, with `c = m a / J = 0.4` 1/m.
fn straight(speed: f64) -> ([f64; 3], [f64; 3]) {
    ([0.0; 3], [speed, 0.0, 0.0])
}

/// The intervals hold the known exponents; the interval of an exponent that is not zero does not hold zero.
fn check_intervals(found: &Lyapunov, known: [f64; 5]) {
    for ((exponent, ci), known) in found.exponents.iter().zip(&found.ci).zip(known) {
        let ci = ci.unwrap();
        assert!((exponent - known).abs() <= ci, "{known}: {exponent} ± {ci} of {:?}", found.exponents);
        assert!(known == 0.0 || exponent.abs() > ci, "{known}: {exponent} ± {ci}");
    }
}

/// Steps of a run: their length, those that are not counted, and those that are.
type Steps = (f64, u64, u64);

test_systems::short_and_full! {
    stable_straight_motion_is_steady => check_stable(&[(0.2, 30, 300), (0.2, 0, 500)]);
    stable_straight_motion_is_steady_in_full => check_stable(&[(0.1, 100, 1000), (0.1, 1000, 10_000), (0.1, 0, 1000)]);
}

/// About straight motion at 1 m/s the spin has the eigenvalue `-c u`; neighbours with another heading or speed part company
/// linearly.
fn check_stable(runs: &[Steps]) {
    for &steps in runs {
        let found = exponents(&sleigh(), straight(1.0), steps);
        check_intervals(&found, [0.0, 0.0, 0.0, 0.0, -0.4]);
        assert_eq!(found.verdict, MotionVerdict::Steady { unstable: false });
        assert_relative_eq!(found.sum(), found.divergence_mean, max_relative = 1e-11);
    }
}

/// In 1e5 s nothing goes to zero that is not (DynamicalSystems.jl, ChaosTools issue 111). Padé's approximation of `exp(-0.2)`, that steps of
/// 0.5 s make, is right to 1e-14.
#[test]
#[ignore = "slow"]
fn a_long_run_keeps_the_exponent_of_a_stable_motion() {
    let found = exponents(&sleigh(), straight(1.0), (0.5, 20_000, 200_000));
    assert_abs_diff_eq!(found.exponents[4], -0.4, epsilon = 1e-11);
    check_intervals(&found, [0.0, 0.0, 0.0, 0.0, -0.4]);
    assert!(found.ci.iter().all(|ci| ci.unwrap() < 1e-4), "{:?}", found.ci);
    assert_eq!(found.verdict, MotionVerdict::Steady { unstable: false });
}

test_systems::short_and_full! {
    driven_straight_motion_is_steady => check_driven((1.0, 200, 100));
    driven_straight_motion_is_steady_in_full => check_driven((0.1, 4000, 10_000));
}

/// A thrust of 0.08 N against drag of 0.08 kg/s is 1 m/s: the speed has `-0.08`, the spin `-c u - c_omega/J = -0.4 - 0.1`.
fn check_driven(steps: Steps) {
    let effects = (Thrust::new(0.08).unwrap(), Drag::new(0.08, 0.125).unwrap());
    let system = With { body: sleigh(), effects };
    for start in [1.0, 0.0] {
        let found = exponents(&system, straight(start), steps);
        check_intervals(&found, [0.0, 0.0, 0.0, -0.08, -0.5]);
        assert_abs_diff_eq!(found.exponents[3], -0.08, epsilon = 1e-3);
        assert_abs_diff_eq!(found.exponents[4], -0.5, epsilon = 1e-3);
        assert_eq!(found.verdict, MotionVerdict::Steady { unstable: false });
    }
}

test_systems::short_and_full! {
    unstable_straight_motion_is_steady_too => check_unstable(&[(0.1, 40, 400)]);
    unstable_straight_motion_is_steady_too_in_full => check_unstable(&[(0.05, 80, 800), (0.05, 200, 2000), (0.1, 1000, 10_000)]);
}

/// Backward it is unstable: an exponent is positive, and the motion as regular as can be.
fn check_unstable(runs: &[Steps]) {
    for &steps in runs {
        let found = exponents(&sleigh(), straight(-1.0), steps);
        check_intervals(&found, [0.4, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(found.verdict, MotionVerdict::Steady { unstable: true });
        assert!(found.failure.is_none());
    }
}

/// With a spin of 1e-3 rad/s it is not: after some seconds the sleigh swings round.
#[test]
fn a_motion_that_leaves_a_steady_one_is_not_steady() {
    let found = exponents(&sleigh(), ([0.0; 3], [-1.0, 0.0, 1e-3]), (0.05, 20, 400));
    assert!(!matches!(found.verdict, MotionVerdict::Steady { .. }), "{}", found.verdict);
}

fn ridge() -> (With<Sleigh, Bowl>, ([f64; 3], [f64; 3])) {
    let ridge = With { body: Sleigh::new(1.0, 1.0, 0.0).unwrap(), effects: Bowl::new([-1.0; 2], [0.0; 2]).unwrap() };
    (ridge, SleighState { x: 0.01, ..SleighState::default() }.to_coordinates())
}

/// On a ridge `u'' = u`. Neighbours in heading part company like `u` too, and volumes stay: 1, 1, 0, -1, -1 in these coordinates.
#[test]
fn on_a_ridge_a_sleigh_runs_away() {
    let (ridge, start) = ridge();
    let found = exponents(&ridge, start, (0.05, 40, 360));
    assert_eq!(found.verdict, MotionVerdict::RunsAway);
    check_intervals(&found, [1.0, 1.0, 0.0, -1.0, -1.0]);
    assert_abs_diff_eq!(found.exponents[0], 1.0, epsilon = 0.05);
    assert_abs_diff_eq!(found.sum(), found.divergence_mean, epsilon = 1e-3);
}

#[test]
#[ignore = "slow"]
fn on_a_ridge_a_sleigh_runs_away_in_full() {
    let (ridge, start) = ridge();
    let by_gauss8 = |settle: u64, steps: u64, count: usize| {
        let schedule = Schedule { t0: 0.0, step: 0.05, steps };
        let request =
            LyapunovRequest { schedule, settle, exponents: Some(count), q: start.0.into(), v: start.1.into() };
        let method = Method::named("gauss8", None).unwrap();
        lyapunov(&Subject::new(&ridge, &()), (3, 1), &method, &request, &mut ()).unwrap()
    };
    // Later rounding takes the digits of all exponents but the largest, also before anything is counted.
    let one = by_gauss8(120, 1200, 1);
    assert_eq!(one.verdict, MotionVerdict::RunsAway);
    assert!((one.exponents[0] - 1.0).abs() <= one.ci[0].unwrap(), "{:?}", one.exponents);
    for (settle, steps) in [(120, 1200), (180, 1800), (0, 1800), (1200, 1200)] {
        let found = by_gauss8(settle, steps, 5);
        assert_eq!(found.verdict, MotionVerdict::RunsAway, "{settle} {steps}");
        let Some(LyapunovFailure::Volumes { time, sums: [by_steps, by_flow], allowed }) = found.failure else {
            panic!("{:?}", found.failure)
        };
        println!("{time} s: {by_steps} and {by_flow}, {allowed}; {:?} ± {:?}", found.exponents, found.ci);
        assert!(time > 30.0 && time < 55.0, "{time}");
        assert!((by_steps - by_flow).abs() > allowed && by_flow == 0.0);
        assert!(found.failure.unwrap().to_string().contains("shorter"));
        // What is told ends before.
        assert!(found.time < time);
        if settle < 1200 {
            check_intervals(&found, [1.0, 1.0, 0.0, -1.0, -1.0]);
        }
    }
}

/// A constant thrust without drag: speeds grow like the time, places at other spins part company
/// like its cube, and all exponents are zero.
#[test]
fn a_sleigh_that_is_pushed_for_ever_runs_away() {
    let system = With { body: Sleigh::new(1.0, 1.0, 0.0).unwrap(), effects: Thrust::new(0.1).unwrap() };
    let found = exponents(&system, straight(0.1), (0.1, 100, 1000));
    assert_eq!(found.verdict, MotionVerdict::RunsAway);
    check_intervals(&found, [0.0; 5]);
}

/// The round well at 8 J: an attractor that is periodic but for a turn about the middle. Its period is that of the section
/// through the middle; two exponents are negative, and three zero.
#[test]
#[ignore = "slow"]
fn a_limit_cycle_is_periodic() {
    let system = With { body: sleigh(), effects: Bowl::new([1.0; 2], [0.0; 2]).unwrap() };
    let start = SleighState { x: -0.5, speed: 0.6, turn_rate: 0.715_541_752_799_933, ..SleighState::default() };
    let faster = 4.0;
    let start =
        SleighState { speed: faster * start.speed, turn_rate: faster * start.turn_rate, ..start }.to_coordinates();
    let found = exponents(&system, start, (0.05, 6000, 20_000));
    let MotionVerdict::Periodic { period, unstable: false } = found.verdict else { panic!("{}", found.verdict) };
    assert_abs_diff_eq!(period, 6.897_637_4, epsilon = 1e-4);
    check_intervals(&found, [0.0, 0.0, 0.0, -0.2343, -0.2343]);
    // Before it has settled it is not: what is left of the way there is more than a thousandth.
    let early = exponents(&system, start, (0.05, 0, 400));
    assert!(!matches!(early.verdict, MotionVerdict::Periodic { .. }), "{}", early.verdict);
}

test_systems::short_and_full! {
    a_periodic_motion_is_periodic => to_and_fro(&[1.0], (0.15, 20, 400));
    an_unstable_periodic_motion_is_periodic => assert!(to_and_fro(&[0.5, 1.0, 2.0, 3.0], (0.05, 400, 4000)) > 0);
}

/// Straight to and fro through the middle of a well, with the blade along it: unstable for some energies, and never chaotic. How many are
/// unstable.
fn to_and_fro(speeds: &[f64], steps: Steps) -> usize {
    let system = With { body: sleigh(), effects: Bowl::new([1.0; 2], [0.0; 2]).unwrap() };
    let mut unstable = 0;
    for &speed in speeds {
        let start = SleighState { x: -0.5, speed, ..SleighState::default() }.to_coordinates();
        let found = exponents(&system, start, steps);
        println!("{speed}: {} {:?} ± {:?}", found.verdict, found.exponents, found.ci);
        let MotionVerdict::Periodic { period, unstable: leaves } = found.verdict else { panic!("{}", found.verdict) };
        assert_relative_eq!(period, std::f64::consts::TAU, max_relative = 1e-4);
        unstable += usize::from(leaves);
    }
    unstable
}

/// Two springs and a friction, on a plane: `x'' = -x - g x'`, `y'' = -k^2 y`, `z' = 0`.
#[derive(Clone, Copy)]
struct Springs {
    /// Whether it knows these equations, or has them derived.
    by_hand: bool,
    friction: f64,
    frequency: f64,
}

impl Piecewise for Springs {
    fn piece(&self, _t: f64) -> Self {
        *self
    }
}

impl System<3, 1> for Springs {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let potential = q[0] * q[0] + q[1] * q[1] * (self.frequency * self.frequency);
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - potential) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[S::zero(), S::zero(), S::constant(1.0)]], [S::zero()])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([v[0] * -self.friction, S::zero(), S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, zero], [zero, one, zero]]))
    }
    fn reduced(&self) -> impl Reduced<3, 1> {
        self
    }
}

impl Reduced<3, 1> for Springs {
    fn reduced_motion<S: Scalar>(&self, _t: S, q: &[S; 3], xi: &[S; 3]) -> Option<[S; 3]> {
        let square = self.frequency * self.frequency;
        self.by_hand.then(|| [-q[0] - xi[0] * self.friction, q[1] * -square, S::zero()])
    }
}

impl Springs {
    /// What they do from rest at a place.
    fn verdict(&self, start: [f64; 2], steps: Steps) -> MotionVerdict {
        let found = exponents(self, ([start[0], start[1], 0.0], [0.0; 3]), steps);
        // Friction works on the speed, and the exponents of its oscillation are half of it.
        let half = -0.5 * self.friction;
        check_intervals(&found, if half < 0.0 { [0.0, 0.0, 0.0, half, half] } else { [0.0; 5] });
        found.verdict
    }

    /// Whether they repeat after that time, or never.
    fn check(&self, start: [f64; 2], period: Option<f64>, steps: Steps) {
        match (self.verdict(start, steps), period) {
            (MotionVerdict::Periodic { period: found, unstable: false }, Some(period)) => {
                assert_relative_eq!(found, period, max_relative = 1e-4);
            }
            (MotionVerdict::Regular, None) => {}
            (found, _) => panic!("{}: {found}", self.frequency),
        }
    }
}

const GOLDEN: f64 = 1.618_033_988_749_895;

#[test]
fn springs_repeat_or_not() {
    let free = |frequency| Springs { by_hand: true, friction: 0.0, frequency };
    let steps = (0.2, 15, 300);
    free(2.0).check([1.0, 0.3], Some(std::f64::consts::TAU), steps);
    free(GOLDEN).check([1.0, 0.3], None, steps);
}

/// Commensurable springs repeat, others do not; friction lets them repeat only when it has done its work.
#[test]
#[ignore = "slow"]
fn springs_repeat_or_not_at_length() {
    let turn = std::f64::consts::TAU;
    let springs = |friction, frequency| Springs { by_hand: false, friction, frequency };
    let steps = (0.1, 300, 3000);
    for (friction, frequency, start, period) in [
        (0.0, 2.0, [1.0, 0.3], Some(turn)),
        (0.0, 1.5, [1.0, 0.3], Some(2.0 * turn)),
        (0.0, 1.5, [1.0, 0.0], Some(turn)),
        (0.0, GOLDEN, [1.0, 0.3], None),
        (0.0, 1.003, [1.0, 0.3], None),
        (0.2, 1.5, [1.0, 0.3], Some(turn / 1.5)),
        (0.06, 1.5, [1.0, 0.3], None),
    ] {
        springs(friction, frequency).check(start, period, steps);
    }
    // All at rest, or come to rest.
    for (friction, start) in [(0.0, [0.0; 2]), (1.0, [1.0, 0.0])] {
        assert_eq!(springs(friction, 2.0).verdict(start, steps), MotionVerdict::Steady { unstable: false });
    }
}

/// A system that knows reduced equations by hand, and wrong ones.
#[derive(Clone, Copy)]
struct Wrong(Sleigh);

impl Piecewise for Wrong {
    fn piece(&self, _t: f64) -> Self {
        *self
    }
}

impl System<3, 1> for Wrong {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.0.lagrangian(t, q, v)
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        self.0.constraint(t, q)
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        self.0.admissible_basis(t, q)
    }
    fn reduced(&self) -> impl Reduced<3, 1> {
        self
    }
}

impl Reduced<3, 1> for Wrong {
    fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; 3], xi: &[S; 3]) -> Option<[S; 3]> {
        let right = self.0.reduced_motion(t, q, xi)?;
        Some([right[0], right[1] * 1.1, right[2]])
    }
}

test_systems::short_and_full! {
    sums_that_differ_are_a_failure => check_sums(200);
    sums_that_differ_are_a_failure_in_full => check_sums(1000);
}

/// The steps of `dla` know nothing of the equations by hand, so that the two sums find out what is wrong with these.
fn check_sums(steps: u64) {
    let (q, v) = straight(1.0);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    let request = LyapunovRequest { schedule, settle: 0, exponents: None, q: q.into(), v: v.into() };
    let method = Method::named("dla", None).unwrap();
    let system = Wrong(sleigh());
    let failure = lyapunov(&Subject::new(&system, &()), (3, 1), &method, &request, &mut ()).unwrap().failure;
    let Some(LyapunovFailure::Volumes { sums: [by_steps, by_flow], .. }) = failure else { panic!("{failure:?}") };
    assert_abs_diff_eq!(by_steps, -0.4, epsilon = 1e-3);
    assert_abs_diff_eq!(by_flow, -0.44, epsilon = 1e-12);
    // The right ones agree, with steps that are not short for a method of second order too.
    for step in [0.05, 0.5] {
        exponents_by("dla", &sleigh(), (q, v), (step, 0, steps));
    }
}

/// A motion of sizes `m` in the parts of a run.
fn evidence(maxima: impl Fn(f64) -> f64) -> Evidence {
    let parts: [f64; PARTS] = std::array::from_fn(|j| maxima((j + 1) as f64 / PARTS as f64));
    Evidence { largest: 0.3, ci: Some(0.1), size: parts[PARTS - 1], change: 1.0, maxima: Some(parts), period: None }
}

#[test]
fn verdicts_by_the_evidence() {
    let level = || evidence(|_| 2.0);
    assert_eq!(level().verdict(), MotionVerdict::Chaotic);
    assert_eq!(Evidence { largest: 0.05, ..level() }.verdict(), MotionVerdict::Regular);
    assert_eq!(Evidence { largest: -0.5, ..level() }.verdict(), MotionVerdict::Regular);
    assert_eq!(Evidence { change: 1e-9, ..level() }.verdict(), MotionVerdict::Steady { unstable: true });
    assert_eq!(
        Evidence { change: 0.0, size: 0.0, largest: 0.0, ..level() }.verdict(),
        MotionVerdict::Steady { unstable: false }
    );
    assert_eq!(
        Evidence { period: Some(3.0), ..level() }.verdict(),
        MotionVerdict::Periodic { period: 3.0, unstable: true }
    );
    for short in [Evidence { ci: None, ..level() }, Evidence { maxima: None, ..level() }] {
        assert_eq!(short.verdict(), MotionVerdict::Undecided(Undecided::TooShort));
    }
    // One large value is no growth all along, and no bound either.
    assert_eq!(
        evidence(|t| if t > 0.9 { 3.0 } else { 2.0 }).verdict(),
        MotionVerdict::Undecided(Undecided::NotBounded)
    );
    assert_eq!(evidence(|t| 2.0 + (9.0 * t).sin()).verdict(), MotionVerdict::Chaotic);
    // A motion that calms down is bounded.
    assert_eq!(evidence(|t| (-3.0 * t).exp()).verdict(), MotionVerdict::Chaotic);
    // What runs away does so before anything is known of its exponents.
    assert_eq!(Evidence { largest: f64::NAN, ci: None, ..evidence(f64::exp) }.verdict(), MotionVerdict::RunsAway);
}

proptest! {
    /// Powers of the time and exponentials run away in any units; what tends to a limit within the run does not.
    #[test]
    fn what_grows_for_ever_runs_away(power in 0.33..4.0_f64, rate in 0.5..300.0_f64, unit in -100.0..100.0_f64) {
        let unit = 10_f64.powf(unit);
        prop_assert_eq!(evidence(|t| unit * t.powf(power)).verdict(), MotionVerdict::RunsAway);
        prop_assert_eq!(evidence(|t| unit * (rate * t).exp()).verdict(), MotionVerdict::RunsAway);
        let settles = 3.0 + rate;
        prop_assert_ne!(evidence(|t| unit * (1.0 - (-settles * t).exp())).verdict(), MotionVerdict::RunsAway);
    }
}
