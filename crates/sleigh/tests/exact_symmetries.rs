//! What holds for every free motion, of the closed form.

use approx::assert_relative_eq;
use proptest::prelude::*;
use sleigh::{Exact, Sleigh, SleighState};
use std::f64::consts::PI;

#[derive(Debug, Clone, Copy)]
struct Case {
    m: f64,
    inertia: f64,
    a: f64,
    start: SleighState,
}

impl Case {
    fn sleigh(&self) -> Sleigh {
        Sleigh::new(self.m, self.inertia, self.a).unwrap()
    }

    fn motion(&self) -> Exact {
        Exact::new(&self.sleigh(), &self.start).unwrap()
    }

    fn gyration(&self) -> f64 {
        (self.sleigh().pivot_inertia() / self.m).sqrt()
    }

    fn total_speed(&self) -> f64 {
        self.start.speed.hypot(self.gyration() * self.start.turn_rate)
    }

    fn kappa(&self) -> f64 {
        self.a * self.total_speed() / self.gyration().powi(2)
    }

    /// How far two results may differ after `time` seconds in all and a turn of `turn` radians in all.
    ///
    /// Both come of a dozen roundings. One of `U` or of `t` is, at the phase `kappa t`, a shift of the phase by that many
    /// roundings, which changes `u` by as many times `U`, `omega` by as many times itself, and the turn, whose derivative
    /// by the phase changes by less than the turn itself, by as many times the turn. The path, of length
    /// at most `U t`, is moved by all this and turned by the error of the heading.
    fn assert_close(&self, one: &SleighState, other: &SleighState, time: f64, turn: f64) -> Result<(), TestCaseError> {
        let rounding = 12.0 * f64::EPSILON * (1.0 + self.kappa().abs() * time);
        let heading = rounding * turn + f64::EPSILON * (one.heading.abs() + self.start.heading.abs() + PI);
        // Where the sleigh starts and where it is moved to, below fifteen on the way.
        let size = one.x.abs().max(one.y.abs()).max(15.0);
        let path = self.total_speed() * time * (rounding + heading) + 4.0 * f64::EPSILON * size;
        let pairs = [
            ("x", one.x, other.x, path),
            ("y", one.y, other.y, path),
            ("heading", one.heading, other.heading, heading),
            ("speed", one.speed, other.speed, rounding * self.total_speed()),
            ("turn rate", one.turn_rate, other.turn_rate, rounding * one.turn_rate.abs().max(f64::MIN_POSITIVE)),
        ];
        for (name, a, b, tolerance) in pairs {
            prop_assert!(
                (a - b).abs() <= tolerance,
                "{}: {:e} and {:e} differ by more than {:e}",
                name,
                a,
                b,
                tolerance
            );
        }
        Ok(())
    }
}

fn power(exponents: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    exponents.prop_map(|e| 10.0_f64.powf(e))
}

fn signed(size: impl Strategy<Value = f64>) -> impl Strategy<Value = f64> {
    (size, any::<bool>()).prop_map(|(size, negative)| if negative { -size } else { size })
}

fn cases() -> impl Strategy<Value = Case> {
    let offset = prop_oneof![6 => signed(power(-2.0..1.0)), 2 => signed(power(-15.0..-2.0)), 1 => Just(0.0)];
    let speed = prop_oneof![6 => signed(power(-2.0..1.0)), 1 => Just(0.0), 1 => signed(power(-12.0..-2.0))];
    let turn_rate = prop_oneof![6 => signed(power(-2.0..0.5)), 2 => signed(power(-300.0..-2.0)), 1 => Just(0.0)];
    let pose = (-5.0..5.0, -5.0..5.0, -7.0..7.0);
    (power(-1.0..1.0), power(-1.0..1.0), offset, pose, speed, turn_rate).prop_map(
        |(m, inertia, a, (x, y, heading), speed, turn_rate)| Case {
            m,
            inertia,
            a,
            start: SleighState { x, y, heading, speed, turn_rate },
        },
    )
}

fn times() -> impl Strategy<Value = f64> {
    prop_oneof![4 => signed(power(-3.0..3.0)), 1 => Just(0.0)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_start_is_the_start(case in cases()) {
        prop_assert_eq!(case.motion().at(0.0), case.start);
    }

    #[test]
    fn energy_is_constant(case in cases(), t in times()) {
        let motion = case.motion();
        let end = motion.at(t);
        let energy = 0.5 * (case.m * end.speed * end.speed + case.sleigh().pivot_inertia() * end.turn_rate * end.turn_rate);
        // tanh^2 + sech^2 = 1 whatever the error of the phase: what is left is a dozen roundings of U.
        assert_relative_eq!(energy, motion.energy(), max_relative = 16.0 * f64::EPSILON);
    }

    /// From the state at `t1` the motion goes on as it would have.
    #[test]
    fn it_is_a_flow(case in cases(), t1 in times(), t2 in times()) {
        let middle = case.motion().at(t1);
        let there = case.motion().at(t1 + t2);
        let again = Case { start: middle, ..case }.motion().at(t2);
        let turn = (middle.heading - case.start.heading).abs() + (there.heading - middle.heading).abs();
        // A spin that the restart cannot hold to its digits has lost them.
        prop_assume!(middle.turn_rate == 0.0 && case.start.turn_rate == 0.0 || middle.turn_rate.abs() > 1e-300);
        case.assert_close(&there, &again, t1.abs() + t2.abs(), turn)?;
    }

    #[test]
    fn reversed_in_time(case in cases(), t in times()) {
        let back = case.motion().at(-t);
        let start = SleighState { speed: -case.start.speed, turn_rate: -case.start.turn_rate, ..case.start };
        let end = Case { start, ..case }.motion().at(t);
        let end = SleighState { speed: -end.speed, turn_rate: -end.turn_rate, ..end };
        case.assert_close(&back, &end, t.abs(), (back.heading - case.start.heading).abs())?;
    }

    #[test]
    fn in_the_mirror(case in cases(), t in times()) {
        let mirror = |s: SleighState| SleighState { y: -s.y, heading: -s.heading, turn_rate: -s.turn_rate, ..s };
        let end = case.motion().at(t);
        let mirrored = mirror(Case { start: mirror(case.start), ..case }.motion().at(t));
        case.assert_close(&end, &mirrored, t.abs(), (end.heading - case.start.heading).abs())?;
    }

    /// The blade has no front: `(a, u) -> (-a, -u)` with the heading turned by `pi` is the same motion.
    #[test]
    fn with_the_axis_reversed(case in cases(), t in times()) {
        let reverse = |s: SleighState, by: f64| SleighState { speed: -s.speed, heading: s.heading + by, ..s };
        let end = case.motion().at(t);
        let reversed = reverse(Case { a: -case.a, start: reverse(case.start, PI), ..case }.motion().at(t), -PI);
        case.assert_close(&end, &reversed, t.abs(), (end.heading - case.start.heading).abs())?;
    }

    #[test]
    fn moved_rigidly(case in cases(), t in times(), (dx, dy, angle) in (-5.0..5.0, -5.0..5.0, -3.0..3.0)) {
        let (sin, cos) = f64::sin_cos(angle);
        let moved = |s: SleighState| SleighState {
            x: dx + cos * s.x - sin * s.y,
            y: dy + sin * s.x + cos * s.y,
            heading: s.heading + angle,
            ..s
        };
        let end = moved(case.motion().at(t));
        let other = Case { start: moved(case.start), ..case };
        other.assert_close(&end, &other.motion().at(t), t.abs(), (end.heading - other.start.heading).abs())?;
    }

    /// Against the circle of the balanced sleigh, by the integrals of `|u'| <= |a| Omega^2`, `Omega = U/k`, and
    /// `|omega'| <= kappa |omega|`, for `kappa t < 1/2`.
    #[test]
    fn towards_balance(case in cases(), a in signed(power(-305.0..-3.0)), t in times()) {
        let case = Case { a, ..case };
        let (kappa, time) = (case.kappa().abs(), t.abs());
        prop_assume!(kappa * time < 0.5);
        let (end, circle) = (case.motion().at(t), Case { a: 0.0, ..case }.motion().at(t));
        let (most, omega0) = (case.total_speed() / case.gyration(), case.start.turn_rate.abs());
        let rounding = 12.0 * f64::EPSILON;
        let speed = a.abs() * most * most * time + rounding * case.total_speed();
        let turn_rate = omega0 * (kappa * time).exp_m1() + rounding * omega0;
        let heading = turn_rate * time + f64::EPSILON * 14.0;
        let path = (speed + case.total_speed() * (heading + rounding)) * time + rounding * 5.0;
        prop_assert!((end.speed - circle.speed).abs() <= speed);
        prop_assert!((end.turn_rate - circle.turn_rate).abs() <= turn_rate);
        prop_assert!((end.heading - circle.heading).abs() <= heading);
        prop_assert!((end.x - circle.x).abs() <= path && (end.y - circle.y).abs() <= path);
    }

    /// Forty e-folds on either side of the turning point leave `4 sigma e^-40` to turn, below rounding.
    #[test]
    fn the_whole_turn(case in cases()) {
        let spin = case.gyration() * case.start.turn_rate.abs();
        prop_assume!(case.a != 0.0 && spin > 0.0);
        let time = (40.0 + (2.0 * case.total_speed() / spin).ln()) / case.kappa();
        let motion = case.motion();
        let turn = (motion.at(time).heading - motion.at(-time).heading).abs();
        let expected = PI * (case.sleigh().pivot_inertia() / (case.m * case.a * case.a)).sqrt();
        assert_relative_eq!(motion.turning_angle(), expected, max_relative = 8.0 * f64::EPSILON);
        assert_relative_eq!(turn, expected, max_relative = 8.0 * f64::EPSILON, epsilon = 14.0 * f64::EPSILON);
    }

    /// Sizes as wild as they come give numbers, the spin never changes its sign, and no energy appears.
    #[test]
    fn wild_sizes(
        (m, inertia) in (power(-60.0..60.0), power(-60.0..60.0)),
        (a, u, omega) in (signed(power(-310.0..40.0)), signed(power(-300.0..100.0)), signed(power(-310.0..100.0))),
        t in signed(power(-100.0..100.0)),
    ) {
        let start = SleighState { speed: u, turn_rate: omega, ..SleighState::default() };
        let case = Case { m, inertia, a, start };
        if let Ok(motion) = Exact::new(&case.sleigh(), &start) {
            let end = motion.at(t);
            prop_assert!(end.speed.abs() <= case.total_speed() * (1.0 + 8.0 * f64::EPSILON));
            prop_assert!(end.turn_rate * omega.signum() >= 0.0);
            prop_assert!(end.heading.is_finite());
            let length = case.total_speed() * t.abs();
            prop_assert!(end.x.hypot(end.y) <= length * (1.0 + 1e-12), "{:?}", end);
        }
    }
}
