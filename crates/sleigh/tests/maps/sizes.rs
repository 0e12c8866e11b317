//! The step in closed form at the ends of the numbers: speeds whose squares are none, spins that have few digits or one.

use approx::assert_relative_eq;
use proptest::prelude::*;
use sleigh::closed::{ClosedForm, ClosedStart, ClosedStep, Memory};
use sleigh::{Sleigh, SleighState};

/// Blade speed and spin after each of some steps, with the heading carried along.
fn steps(sleigh: &Sleigh, start: [f64; 2], lengths: impl Iterator<Item = f64>) -> Vec<ClosedStep<3, 1>> {
    let state = SleighState { speed: start[0], turn_rate: start[1], ..SleighState::default() };
    let ((mut q, mut v), mut memory) = (state.to_coordinates(), Memory::EMPTY);
    let mut xi = [start[0], start[1], 0.0];
    lengths
        .map(|h| {
            let start = ClosedStart { xi: Some(xi), ..ClosedStart::new(&q, &v, &mut memory) };
            let step = sleigh.closed_step(0.0, h, start).unwrap().unwrap();
            q = [0, 1, 2].map(|i| q[i] + step.increment[i]);
            (v, xi) = (step.velocity, step.xi);
            step
        })
        .collect()
}

fn unit() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).unwrap()
}

/// The parts of a step of order 4 (Suzuki): steps of two lengths, one of which goes back.
fn composed(h: f64, steps: usize) -> impl Iterator<Item = f64> {
    let g = 1.0 / (4.0 - 4f64.cbrt());
    (0..5 * steps).map(move |k| if k % 5 == 2 { (1.0 - 4.0 * g) * h } else { g * h })
}

proptest! {
    /// In another unit of time the motion is the same, and to the last bit where that unit is a power of two: also where the square
    /// of a speed is infinite and that of a step nothing.
    #[test]
    fn the_unit_of_time_is_no_matter(
        (speed, spin) in (-1.0..1.0f64, 0.05..1.5f64), left: bool, power in -900i32..1000, offset in -1.0..1.0f64, back: bool,
    ) {
        let sleigh = Sleigh::new(1.3, 0.7, offset).unwrap();
        let (unit, h) = (2f64.powi(power), if back { -0.05 } else { 0.05 });
        let spin = if left { spin } else { -spin };
        let plain = steps(&sleigh, [speed, spin], composed(h, 8));
        let scaled = steps(&sleigh, [speed * unit, spin * unit], composed(h / unit, 8));
        for (plain, scaled) in plain.iter().zip(&scaled) {
            prop_assert_eq!(plain.increment.map(f64::to_bits), scaled.increment.map(f64::to_bits));
            prop_assert_eq!(plain.xi.map(|x| (x * unit).to_bits()), scaled.xi.map(f64::to_bits));
            prop_assert_eq!(plain.velocity.map(|x| (x * unit).to_bits()), scaled.velocity.map(f64::to_bits));
            prop_assert_eq!(plain.iterations, scaled.iterations);
        }
    }

    /// A spin that is small enough is a factor of its own motion, whatever it is: one of a few times the least number grows and dies
    /// out as any other does, to the rounding of a single number, in steps of one length and of several.
    #[test]
    fn the_least_spins_grow_as_all_do(times in 1u64..2000, left: bool, speed in prop_oneof![-2.0..-0.5, 0.5..2.0f64], parts: bool) {
        let least = f64::from_bits(1);
        let spin = f64::from_bits(times) * if left { 1.0 } else { -1.0 };
        let small = times as f64 * 1e-100 * spin.signum();
        let lengths = || -> Box<dyn Iterator<Item = f64>> {
            if parts { Box::new(composed(0.05, 400)) } else { Box::new(std::iter::repeat_n(0.05, 400)) }
        };
        let (tiny, known) = (steps(&unit(), [speed, spin], lengths()), steps(&unit(), [speed, small], lengths()));
        for (k, (tiny, known)) in tiny.iter().zip(&known).enumerate() {
            let (spin, expected) = (tiny.xi[1], known.xi[1] / 1e-100);
            // Where nothing is left of one that dies out it is nothing from then on.
            let gone = spin == 0.0 && expected.abs() < 2.0;
            let off = (spin / least - expected).abs();
            prop_assert!(gone || off <= 0.5 + 1e-12 * expected.abs(), "step {}: {} for {}", k, spin / least, expected);
            approx::assert_relative_eq!(tiny.xi[0], known.xi[0], max_relative = 1e-12);
        }
        // Something happens.
        let last = tiny[tiny.len() - 1].xi[1];
        prop_assert!((last.abs() > spin.abs()) == (speed < 0.0));
    }
}

/// Thirty times the least number in 50 s of steps of a twentieth of a second, 0.4/s being its rate at 1 m/s: the Cayley transform of
/// each step, 1000 times.
#[test]
fn thirty_of_the_least() {
    let least = f64::from_bits(1);
    let grown = (1.01f64 / 0.99).powi(1000);
    let run = steps(&unit(), [-1.0, 30.0 * least], std::iter::repeat_n(0.05, 1000));
    assert_relative_eq!(run[999].xi[1], 30.0 * grown * least, max_relative = 1e-9);
    assert!((7e-314..7.4e-314).contains(&run[999].xi[1]), "{:e}", run[999].xi[1]);
    // None at all stays none, in as few corrections as any other.
    let still = steps(&unit(), [-1.0, 0.0], std::iter::repeat_n(0.05, 1000));
    assert!(still.iter().all(|step| step.xi[1] == 0.0));
    assert!(still[5..].iter().all(|step| step.iterations == 1));
}

/// What is slow beside the speed is as small: 1e-160 rad/s at 1e160 m/s, where a step is of 1e-162 s.
#[test]
fn a_small_spin_at_a_high_speed() {
    let unit_of_time = 1e160;
    let known = steps(&unit(), [-1.0, 1e-100], std::iter::repeat_n(0.05, 400));
    let fast = steps(&unit(), [-unit_of_time, 1e-160], std::iter::repeat_n(0.05 / unit_of_time, 400));
    for (known, fast) in known.iter().zip(&fast) {
        assert_relative_eq!(fast.xi[1] * 1e160, known.xi[1] * 1e100, max_relative = 1e-11);
    }
}

/// A spin that is none of those a memory knows is taken as it is.
#[test]
fn digits_belong_to_one_spin() {
    let (sleigh, q) = (unit(), [0.0; 3]);
    let mut memory = Memory::EMPTY;
    let spin = |omega: f64, h: f64, memory: &mut Memory| {
        let v = [-1.0, 0.0, omega];
        let start = ClosedStart { xi: Some([-1.0, omega, 0.0]), ..ClosedStart::new(&q, &v, memory) };
        sleigh.closed_step(0.0, h, start).unwrap().unwrap().xi[1]
    };
    let (ten, fifty) = (f64::from_bits(10), f64::from_bits(50));
    assert_eq!(spin(ten, 0.05, &mut memory), ten);
    assert_eq!(spin(fifty, 0.05, &mut memory), spin(fifty, 0.05, &mut Memory::default()));
    // Ten and three fifths of one, that was not detected: a third step makes eleven of it.
    let mut memory = Memory::EMPTY;
    let grown = (0..3).fold(ten, |omega, _| spin(omega, 0.05, &mut memory));
    assert_eq!(grown, f64::from_bits(11));
    // A memory that was forgotten has no digits, nor has that of another map.
    for of_another in [false, true] {
        let mut memory = Memory::EMPTY;
        let twice = (0..2).fold(ten, |omega, _| spin(omega, 0.05, &mut memory));
        if of_another {
            memory.begin(0.05, 6.0);
        } else {
            memory.forget();
        }
        assert_eq!(spin(twice, 0.05, &mut memory), ten);
    }
}

/// What comes from larger spins dies out among the last numbers: it may stay where half a step changes it by less than one of them, and
/// never turns round.
#[test]
fn dying_out_among_the_last_numbers() {
    for spin in [1e-299, -3e-301, 1e-310] {
        let run = steps(&unit(), [1.0, spin], std::iter::repeat_n(0.05, 4000));
        let sizes: Vec<_> = run.iter().map(|step| step.xi[1] * f64::signum(spin)).collect();
        assert!(sizes.windows(2).all(|pair| 0.0 <= pair[1] && pair[1] <= pair[0]));
        assert!(sizes[3999] < 50.0 * f64::from_bits(1));
    }
}
