use lagrangian::{added, mul_add, sin_cos_wrapped};

/// Largest difference between the angle of a state and the angle of the direction that counts as equal (rad): a few roundings.
const SAME: f64 = 23.5 * f64::EPSILON;
/// Decrease of that difference with every step, and with every radian of turn: nothing is left after a hundred steps or four radians. The
/// rounding error of a direction is in proportion to how far the direction was turned.
const WORN: f64 = 0.2 * f64::EPSILON;
const WORN_BY_TURNING: f64 = 6.0 * f64::EPSILON;

/// The direction of the blade at the start of a step. Every step turns it along, and its sine and cosine are computed anew from time to
/// time.
///
/// Sine and cosine are sums of many small numbers, so their rounding errors are kept and added again (compensated summation).
#[derive(Debug)]
pub(crate) struct Heading<'a> {
    angle: f64,
    /// `angle` less the angle of the direction: rounding, since the angle of a state is a sum whose rest is not known here.
    off: f64,
    numbers: &'a mut HeadingNumbers,
}

/// The numbers kept between steps: angle of the direction, sine, cosine, the rests of sine and cosine, and the difference allowed to the
/// angle of a state.
pub(crate) type HeadingNumbers = [f64; 6];

/// The numbers before the first step.
pub(crate) const NO_HEADING: HeadingNumbers = [f64::NAN; 6];

impl<'a> Heading<'a> {
    /// The direction at an angle. It is kept from the end of the step before if the angles agree, else computed anew.
    #[inline(always)]
    pub(crate) fn at(angle: f64, numbers: &'a mut HeadingNumbers) -> Self {
        let same = (angle - numbers[0]).abs() <= numbers[5];
        if !same {
            renew(angle, numbers);
        }
        Self { angle, off: angle - numbers[0], numbers }
    }

    /// Sine and cosine.
    #[inline(always)]
    pub(crate) fn both(&self) -> [f64; 2] {
        [self.numbers[1], self.numbers[2]]
    }

    /// Turns the direction by `angle`, and returns the new sine and cosine. The chord of the turn is `chord` times the direction across
    /// `[sin_m, cos_m]`, the direction in the middle, whose length need not be one.
    #[inline(always)]
    pub(crate) fn turn(&mut self, angle: f64, chord: f64, [sin_m, cos_m]: [f64; 2]) -> [f64; 2] {
        let [_, sin, cos, rest_of_sin, rest_of_cos, slack] = *self.numbers;
        let (new_sin, rest_of_sin) = added(sin, mul_add(chord, cos_m, rest_of_sin));
        let (new_cos, rest_of_cos) = added(cos, mul_add(-chord, sin_m, rest_of_cos));
        // To the angle that the sum is rounded to; by the next step, since little waits for that.
        let (ended, rest) = added(self.angle, angle);
        let further = self.off - rest;
        let (rest_of_sin, rest_of_cos) = (mul_add(further, cos, rest_of_sin), mul_add(-further, sin, rest_of_cos));
        let slack = mul_add(-WORN_BY_TURNING, angle.abs(), slack - WORN);
        *self.numbers = [ended, new_sin, new_cos, rest_of_sin, rest_of_cos, slack];
        [new_sin, new_cos]
    }
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn renew(angle: f64, numbers: &mut HeadingNumbers) {
    let (sin, cos) = sin_cos_wrapped(angle);
    *numbers = [angle, sin, cos, 0.0, 0.0, SAME];
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const STEPS: u32 = 2000;

    /// The largest error of sine and cosine over `STEPS` turns, and how often they were computed anew. After each turn the angle strays
    /// by up to `stray` ulps of a radian, to either side.
    fn turned(turn: f64, stray: f64) -> (f64, u32) {
        let (mut numbers, mut angle, mut worst, mut anew) = (NO_HEADING, 0.3_f64, 0.0_f64, 0);
        let half = 0.5 * turn;
        for k in 0..STEPS {
            let mut heading = Heading::at(angle, &mut numbers);
            let [sin, cos] = heading.both();
            worst = worst.max((sin - angle.sin()).abs()).max((cos - angle.cos()).abs());
            anew += u32::from(heading.numbers[5] >= SAME);
            let middle = angle + half;
            heading.turn(turn, 2.0 * half.sin(), [middle.sin(), middle.cos()]);
            angle += turn + stray * f64::EPSILON * f64::from(k * k % 7 % 3).mul_add(1.0, -1.0);
            angle -= TAU * (angle / TAU).round();
        }
        (worst, anew)
    }

    #[test]
    fn a_direction_keeps_to_its_angle() {
        for turn in [0.0, 1e-9, -1e-3, 0.02, -0.3, 1.0, 2.9] {
            for stray in [0.0, 1.0, 3.0] {
                let (worst, anew) = turned(turn, stray);
                println!("{turn} and {stray}: {:.1} eps, {anew} times anew", worst / f64::EPSILON);
                // Half an ulp of an angle up to four, one of sine or cosine, and as much again of the turns since they were worked out;
                // and what the angle strayed in the last two steps, which is followed in the next but one.
                assert!(worst <= (4.0 + 2.0 * stray) * f64::EPSILON);
                // After a hundred steps or four radians, and where an angle is wrapped.
                let expected = f64::from(STEPS) * (0.01 + turn.abs() * (0.25 + 1.0 / TAU));
                assert!(f64::from(anew) <= 2.0 + 1.2 * expected, "{anew} for {expected}");
            }
        }
    }

    /// An angle that is another one has its own direction.
    #[test]
    fn another_angle_is_seen() {
        let mut numbers = NO_HEADING;
        Heading::at(1.0, &mut numbers);
        for other in [1.0 + 30.0 * f64::EPSILON, -1.0, f64::NAN] {
            let [sin, cos] = Heading::at(other, &mut numbers).both();
            let expected = <[f64; 2]>::from(sin_cos_wrapped(other));
            assert_eq!([sin, cos].map(f64::to_bits), expected.map(f64::to_bits), "{other}");
        }
    }
}
