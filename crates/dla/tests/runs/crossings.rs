//! The crossings of random free sleighs, against their closed form.

use crate::runs::Motion;
use crate::runs::events::{speed, times};
use dla::{Dla, Event, Gauss};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sleigh::{Sleigh, SleighState};
use std::cell::Cell;

#[test]
fn no_crossing_of_ten_thousand_runs_is_missed() {
    // Always the same.
    let config = Config { cases: 12, failure_persistence: None, ..Config::default() };
    let random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let [crossed, ..] = no_crossing_is_missed(TestRunner::new_with_rng(config, random), &free_sleighs());
    assert!(crossed > 0);
}

/// Pairs of crossings within a tenth of a long step, of which one was told twice, one not, or neither.
#[test]
fn both_crossings_of_a_pair_are_told() {
    let twice = (
        (0.5, 1.700_578_516_547_204_7, 0.781_323_095_951_806_9, false),
        (0.4, -0.431_337_400_587_173_3, false, -2.799_839_844_818_572_4),
        (0.232_111_808_645_754_5, 10),
    );
    let once = (
        (0.573_345_938_499_790_4, 1.692_600_158_911_632_4, 0.483_286_038_889_302_05, true),
        (0.4, 0.056_942_492_590_841_644, false, -2.910_952_883_697_836_8),
        (0.229_883_843_533_020_83, 10),
    );
    let never = (
        (1.148_321_306_023_009_5, 1.782_643_584_632_944_5, 0.218_660_292_581_811_88, true),
        (0.4, 0.083_867_452_138_022_59, false, -3.754_749_772_470_436),
        (0.175_146_846_607_724_17, 10),
    );
    for pair in [twice, once, never] {
        let runner = TestRunner::new(Config { cases: 1, ..Config::default() });
        assert_eq!(no_crossing_is_missed(runner, &Just(pair)), [2, 2, 0]);
    }
}

#[test]
#[ignore = "slow"]
fn no_crossing_of_ten_thousand_runs_is_missed_at_length() {
    let config = Config { cases: 10_000, failure_persistence: None, ..Config::default() };
    let [crossed, twice, near] = no_crossing_is_missed(TestRunner::new(config), &free_sleighs());
    assert!(crossed > 5000 && twice > 2000 && near < 1000);
}

/// Mass, inertia, offset, and whether the blade is behind; size, phase and turn of the motion, and the exponent of the low speed; the step, as
/// a part of the shortest time of the motion, and the number of steps.
type FreeSleigh = ((f64, f64, f64, bool), (f64, f64, bool, f64), (f64, u64));

fn free_sleighs() -> impl Strategy<Value = FreeSleigh> {
    (
        (0.5..2.0f64, 0.3..2.0f64, 0.2..0.8f64, any::<bool>()),
        (0.4..2.0f64, -1.5..1.5f64, any::<bool>(), -6.0..-0.5f64),
        (0.05..0.25f64, 10..30u64),
    )
}

/// Free sleighs: their speed crosses zero once, or not within the run, and its square crosses a value twice, often
/// within a step. Counts runs with a crossing, those with two in a tenth of a step, and those with one at an end.
fn no_crossing_is_missed(mut runner: TestRunner, strategy: &impl Strategy<Value = FreeSleigh>) -> [i32; 3] {
    let counts = &[const { Cell::new(0) }; 3];
    let [crossed, twice, near] = counts;
    let worst = &[const { Cell::new(0.0f64) }; 2];
    let outcome =
        runner.run(strategy, |((mass, inertia, offset, behind), (size, phase, left, exponent), (part, steps))| {
            let sleigh = Sleigh::new(mass, inertia, if behind { -offset } else { offset }).unwrap();
            let gyration = (sleigh.pivot_inertia() / mass).sqrt();
            // Of all the energy, in any part of the motion.
            let (speed0, spin) = (size * phase.tanh(), size / phase.cosh() / gyration);
            let start =
                SleighState { speed: speed0, turn_rate: if left { spin } else { -spin }, ..SleighState::default() };
            let motion = Motion::new(&sleigh, &start);
            let low = 10f64.powf(exponent) * motion.speed;
            let events = [
                Event::new("speed", |_, q, v| speed(q, v)),
                Event::new("size of the speed", |_, q, v| speed(q, v).abs() - low),
            ];
            // Steps from a small part of the shortest time of the motion to a large one.
            let step = part / motion.kappa.abs().max(size / gyration);
            let end = steps as f64 * step;
            // The midpoint map has the motion of a rate kappa that is wrong by its (kappa h)^2/12 (the artanh of its factor),
            // and by as much of the turn of a step. Order 16 leaves rounding, of which slow motions make more time.
            let phase = end * part * part / 6.0;
            let rounding = 1e-12 * f64::max(1.0, motion.kappa.abs().recip());
            for (method, found, tolerance) in [
                (0, times(&sleigh, Dla::midpoint(), &start, (step, steps), &events), phase),
                (1, times(&sleigh, Gauss::new::<8>(), &start, (step, steps), &events), rounding),
            ] {
                let (one, other) = (motion.at_speed(-low / motion.speed), motion.at_speed(low / motion.speed));
                let mut expected = vec![(0, motion.turnaround), (1, one), (1, other)];
                // A crossing within the error of the ends of the run may or may not be in it.
                if expected.iter().any(|(_, t)| t.abs() <= tolerance || (t - end).abs() <= tolerance) {
                    near.set(near.get() + 1);
                    continue;
                }
                expected.retain(|(_, t)| 0.0 < *t && *t < end);
                crossed.set(crossed.get() + i32::from(!expected.is_empty()));
                twice.set(twice.get() + i32::from(expected.len() == 3 && (other - one).abs() < 0.1 * step));
                for event in 0..2 {
                    let sorted = |list: &[(usize, f64)]| {
                        let mut times: Vec<f64> = list.iter().filter(|(e, _)| *e == event).map(|(_, t)| *t).collect();
                        times.sort_by(f64::total_cmp);
                        times
                    };
                    let (found, expected) = (sorted(&found), sorted(&expected));
                    prop_assert_eq!(found.len(), expected.len(), "{}: {:?}, expected {:?}", method, found, expected);
                    for (found, expected) in found.iter().zip(&expected) {
                        let error = (found - expected).abs();
                        prop_assert!(error <= tolerance, "{method}: {found} for {expected}, step {step}: {error:e}");
                        worst[method].set(worst[method].get().max(error / tolerance));
                    }
                }
            }
            Ok(())
        });
    println!("with a crossing {crossed:?}, twice in a tenth of a step {twice:?}, at an end {near:?}, worst {worst:?}");
    outcome.unwrap();
    counts.each_ref().map(Cell::get)
}
