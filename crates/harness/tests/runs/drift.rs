//! Series of known kind get the verdict of their kind, at every scale; and a run saved in parts is the run made at once.

use super::{Particle, request, run};
use approx::assert_relative_eq;
use dla::{Checkpoint, Subject};
use harness::{Blocks, Drift, DriftVerdict, Method, Record, Request, Run, Saving};
use std::f64::consts::TAU;

/// Values a series has: not a power of two, so that blocks and periods do not agree.
const LENGTH: u32 = 200_000;
const RUN: f64 = 1000.0;

/// Uniform in `[-1, 1)` (SplitMix64, Steele, Lea and Flood 2014): the same series every time.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// The drift of the series that has the value `f` at each time (s).
fn drift(scale: f64, mut f: impl FnMut(f64) -> f64) -> Drift {
    let mut blocks = Blocks::default();
    for k in 0..LENGTH {
        let t = RUN * f64::from(k) / f64::from(LENGTH - 1);
        blocks.add(t, scale * f(t));
    }
    Drift::of(&blocks)
}

/// The drifts at all scales that errors of an energy have, rounding included.
fn at_all_scales(f: impl Fn() -> Box<dyn FnMut(f64) -> f64>) -> Vec<Drift> {
    let drifts: Vec<Drift> = [1e-16, 1e-9, 1.0, 1e3].map(|scale| drift(scale, f())).to_vec();
    for (drift, scale) in drifts.iter().zip([1e-16, 1e-9, 1.0, 1e3]) {
        // Nothing but rounding tells them apart; that of the mean of a block of 256 values is below 3e-14 of them.
        assert_eq!(drift.verdict, drifts[2].verdict);
        assert_relative_eq!(drift.amplitude, scale * drifts[2].amplitude, max_relative = 1e-9, epsilon = 1e-13 * scale);
    }
    drifts
}

fn verdicts(f: impl Fn() -> Box<dyn FnMut(f64) -> f64>) -> DriftVerdict {
    at_all_scales(f)[2].verdict
}

#[test]
fn an_oscillation_is_bounded() {
    for period in [0.01, 0.37, 3.7, 31.0, RUN / 32.0, RUN / 31.9, RUN / 1024.0, 111.0] {
        let drift = drift(1.0, |t| (TAU * t / period + 1.0).sin());
        assert_eq!(drift.verdict, DriftVerdict::Bounded, "period {period}: {drift:?}");
    }
    assert_eq!(verdicts(|| Box::new(|t| (TAU * t / 0.7).cos())), DriftVerdict::Bounded);
    let drift = drift(1.0, |t| 5.0 + 2.0 * (TAU * t / 0.7).cos());
    // The largest and the smallest value are met to the square of the phase between two nodes.
    assert_relative_eq!(drift.amplitude, 2.0, max_relative = 1e-3);
}

#[test]
fn a_slope_is_seen_above_the_noise_and_not_below() {
    let series = |slope: f64| drift(1.0, move |t| 2.0 * (TAU * t / 0.7).cos() + slope * t);
    for slope in [1e-3, -1e-3, 0.1] {
        let drift = series(slope);
        assert_eq!(drift.verdict, DriftVerdict::LinearDrift, "{drift:?}");
        assert!((drift.slope - slope).abs() <= drift.slope_ci.unwrap(), "{drift:?}");
        assert!(drift.slope_ci.unwrap() < 0.1 * slope.abs(), "{drift:?}");
        // Within a block the line is not taken off: half of a 512th of what it does over the run.
        assert!((drift.amplitude - 2.0).abs() < 2e-3 + slope.abs() * RUN / 1024.0, "{drift:?}");
    }
    assert_eq!(series(1e-5).verdict, DriftVerdict::Bounded);
    assert_eq!(verdicts(|| Box::new(|t| (TAU * t / 0.7).cos() + 2e-3 * t)), DriftVerdict::LinearDrift);
    let steep = drift(1.0, |t| 3.0 * t);
    assert_eq!(steep.verdict, DriftVerdict::LinearDrift);
    assert_relative_eq!(steep.slope, 3.0, max_relative = 1e-12);
    // The mean of the squares of an octave of lags, from 12 on, is not quite the square of their mean.
    assert_relative_eq!(steep.exponent.unwrap(), 1.0, max_relative = 1e-3);
}

test_systems::short_and_full! {
    a_random_walk_is_one_and_its_slope_is_none => check_walks(20, 14, 2);
    a_random_walk_is_one_and_its_slope_is_none_in_full => check_walks(100, 80, 6);
}

/// Of `all` walks so many at least are seen as such, and so many at most as lines: at the 5 % and 1 % of the tests and three standard
/// deviations of their counts.
fn check_walks(all: u64, least: u32, most: u32) {
    let (mut walks, mut lines) = (0, 0);
    for seed in 0..all {
        let (mut noise, mut sum) = (Noise(seed), 0.0);
        let drift = drift(1e-16, |_| {
            sum += noise.next();
            sum
        });
        walks += u32::from(drift.verdict == DriftVerdict::RandomWalk);
        lines += u32::from(drift.verdict == DriftVerdict::LinearDrift);
        assert!(drift.exponent.unwrap() > 0.2, "{drift:?}");
    }
    assert!(walks >= least && lines <= most, "{walks} walks, {lines} lines");
    let walk = || {
        let (mut noise, mut sum) = (Noise(7), 0.0);
        Box::new(move |_| {
            sum += noise.next();
            sum
        }) as Box<dyn FnMut(f64) -> f64>
    };
    assert_eq!(verdicts(walk), DriftVerdict::RandomWalk);
}

test_systems::short_and_full! {
    a_chaotic_wander_is_bounded => check_wander(10, [8, 9]);
    a_chaotic_wander_is_bounded_at_length => check_wander(100, [90, 95]);
}

/// Of `all` wanders so many at least are seen to be bounded, and so many to drift where they do.
fn check_wander(all: u64, least: [usize; 2]) {
    let wander = |seed: u64, slope: f64| {
        // Correlated over 300 values, a 700th of the series.
        let (mut noise, mut x) = (Noise(seed), 0.0);
        Box::new(move |t| {
            x += noise.next() - x / 300.0;
            x + slope * t
        }) as Box<dyn FnMut(f64) -> f64>
    };
    let count = |slope: f64, verdict: DriftVerdict| {
        (0..all).filter(|seed| drift(1.0, wander(*seed, slope)).verdict == verdict).count()
    };
    let bounded = count(0.0, DriftVerdict::Bounded);
    assert!(bounded >= least[0], "{bounded}");
    // Positive control: a drift of two amplitudes over the run.
    let lines = count(0.1, DriftVerdict::LinearDrift);
    assert!(lines >= least[1], "{lines}");
    assert_eq!(verdicts(|| wander(1, 0.0)), DriftVerdict::Bounded);
}

#[test]
fn constants_are_bounded_and_short_series_undecided() {
    let zero = drift(1.0, |_| 0.0);
    assert_eq!((zero.verdict, zero.amplitude.to_bits(), zero.slope.to_bits()), (DriftVerdict::Bounded, 0, 0));
    assert_eq!(verdicts(|| Box::new(|_| -0.3)), DriftVerdict::Bounded);
    let mut short = Blocks::default();
    (0..63_u32).for_each(|k| short.add(f64::from(k), f64::from(k)));
    let drift = Drift::of(&short);
    assert_eq!((drift.verdict, drift.slope_ci, drift.exponent), (DriftVerdict::Undecided, None, None));
    assert_relative_eq!(drift.slope, 1.0, max_relative = 1e-12);
    assert_eq!(Drift::of(&Blocks::default()).verdict, DriftVerdict::Undecided);
    short.add(63.0, f64::NAN);
    assert_eq!(Drift::of(&short).verdict, DriftVerdict::Undecided);
}

#[test]
fn what_settles_or_jumps_is_none_of_the_three() {
    let settles = drift(1.0, |t| 1.0 - (-10.0 * t / RUN).exp());
    let jumps = drift(1.0, |t| if t > 0.4 * RUN { 1.0 } else { 0.0 });
    assert_eq!((settles.verdict, jumps.verdict), (DriftVerdict::Undecided, DriftVerdict::Undecided));
    // What bends, but grows all along, drifts.
    assert_eq!(drift(1.0, |t| t * t).verdict, DriftVerdict::LinearDrift);
}

#[test]
fn the_smaller_slope_wins_from_where_the_lines_meet() {
    let of = |amplitude: f64, slope: f64| drift(1.0, move |t| amplitude * (TAU * t / 0.7).cos() + slope * t);
    let (flat, steep) = (of(2.0, 1e-5), of(0.1, 1e-2));
    // (2 - 0.1) / (1e-2 - 1e-5), to what amplitudes and slopes are known to.
    assert_relative_eq!(flat.better_from(&steep).unwrap(), 190.2, max_relative = 0.02);
    let t = flat.better_from(&steep).unwrap();
    assert_relative_eq!(flat.reach(t), steep.reach(t), max_relative = 1e-12);
    assert_eq!(steep.better_from(&flat), None);
    // Who starts better needs no time for it; who does not drift is not overtaken.
    assert_eq!(of(0.01, 1e-6).better_from(&steep), None);
    assert_eq!(of(2.0, 0.0).better_from(&of(0.1, 0.0)), None);
}

/// A run from checkpoint to checkpoint that ends at a given step; its record and its last checkpoint.
fn part(method: &str, steps: u64, from: Option<&Checkpoint>, stop: Option<u64>) -> (Record, Checkpoint) {
    struct Until(u64, Option<u64>);
    impl harness::Progress for Until {
        fn advance(&mut self, steps: u64) {
            self.0 += steps;
        }
        fn stops(&self) -> bool {
            self.1.is_some_and(|stop| self.0 >= stop)
        }
    }
    let (method, identity) = (Method::named(method, None).unwrap(), Checkpoint::of([("run", "a".to_owned())]));
    let mut last = Checkpoint::default();
    let mut save = |made: &Checkpoint| last = Checkpoint::from_text(&made.to_text()).unwrap();
    let mut saving = Saving { identity: &identity, from, every: Some(1 << 20), save: &mut save };
    let system = Particle::of(1.0);
    let (system, mut until) = (Subject::from(&system), Until(0, stop));
    let made = Run::of(&system, &method).progress(&mut until).saved(&request(steps, 0.05), &mut saving, None);
    (made.unwrap().record, last)
}

test_systems::short_and_full! {
    an_interrupted_run_goes_on_to_the_same_bit => check_interrupted(5000, 2000);
    an_interrupted_run_goes_on_to_the_same_bit_in_full => check_interrupted(100_000, 30_000);
}

fn check_interrupted(steps: u64, stop: u64) {
    let (whole, end) = part("dla", steps, None, None);
    let (half, middle) = part("dla", steps, None, Some(stop));
    // Asked every 2^10 steps.
    let made = stop.next_multiple_of(1 << 10);
    assert_eq!((half.interrupted, half.steps, whole.interrupted, whole.steps), (true, made, false, steps));
    let (rest, _) = part("dla", steps, Some(&middle), None);
    let timeless = |record: Record| Record { wall_seconds: 0.0, ..record };
    assert_eq!(timeless(rest), timeless(whole.clone()));
    // From its end no step is left.
    let (again, _) = part("dla", steps, Some(&end), None);
    assert_eq!(timeless(again), timeless(whole.clone()));
    assert!(whole.leaf_max.is_none() && whole.step_constraint_max < 1e-13);
}

#[test]
fn a_run_is_as_far_from_its_leaf_as_its_method_goes() {
    let system = Particle { leaf: true, ..Particle::of(1.0) };
    let request = Request { q: vec![0.1, 0.2, 0.02], v: vec![0.9, 0.7, 0.2 * 0.7], ..request(2000, 0.05) };
    let record = |name: &str| run(&Subject::from(&system), &Method::named(name, None).unwrap(), &request);
    // The chord of the midpoint rule has dz = y dy with the mean of y: exactly the change of y^2/2. The rest is rounding:
    // of z, of size one, at each of the nodes.
    let (dla, rk4) = (record("dla"), record("rk4"));
    assert!(dla.leaf_max.unwrap() < 2000.0 * 4.0 * f64::EPSILON, "{dla:?}");
    // Positive control: a method that knows no leaf leaves it.
    assert!(rk4.failure.is_none() && (1e-12..0.1).contains(&rk4.leaf_max.unwrap()), "{rk4:?}");
}
