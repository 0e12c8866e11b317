use super::heading::NO_HEADING;
use super::memory::{Foreseen, Memory};
use super::spin_equation::{FoundTurn, SpinEquation, settled};
use dla::ClosedStepError;
use lagrangian::mul_add;

/// Number of backward differences of the spin that are kept; the first is the last spin itself.
const KEPT: usize = 6;
/// Place of the last spin that was too small for a full significand: first as rounded, then times `LARGER`, with its digits.
const WITH_DIGITS: usize = 4 + KEPT;
const SIZE: usize = WITH_DIGITS + 2;
/// Identifies these numbers and their order. A checkpoint may come from an older version or another map.
const KIND: f64 = 5.0;
/// Factor by which a small spin is scaled to be kept with its digits: the smallest positive number then has a full significand.
const LARGER: f64 = (1u128 << 100) as f64;

/// The numbers that a step of the closed map leaves to the next.
pub(crate) type SpinMemory<'a> = Foreseen<'a, 1, KEPT, SIZE>;
/// The numbers of `SpinMemory` without the heading.
pub(crate) type SpinNumbers = [f64; SIZE];

/// The numbers left by steps of length `h`, for a step that begins at this heading. If there are none, they are as after steps with the
/// spin `w`.
#[inline(always)]
pub(crate) fn remembered(memory: &mut Memory, h: f64, (heading, w): (f64, f64)) -> SpinMemory<'_> {
    if !memory.is_of(h, KIND) {
        begin(memory, h, w);
    }
    Foreseen::of(memory, heading)
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn begin(memory: &mut Memory, h: f64, w: f64) {
    // Digits outlast steps of another length, as in a composition.
    let another = memory.is_empty() || memory.0[1].to_bits() != KIND.to_bits();
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    let ([none, zero], [rounded, larger]) = ([f64::NAN, 0.0], kept(numbers));
    let [rounded, larger] = if another { [zero; 2] } else { [rounded, larger] };
    (*numbers, *heading) = ([none, none, none, w, w, zero, zero, zero, zero, zero, rounded, larger], NO_HEADING);
}

fn kept(numbers: &SpinNumbers) -> [f64; 2] {
    [numbers[WITH_DIGITS], numbers[WITH_DIGITS + 1]]
}

/// The spin `omega` times a factor, rounded from the digits that are kept of `omega`; from `omega` itself if another spin was kept. All
/// other numbers are forgotten, so that the next step searches too.
fn with_digits(numbers: &mut SpinNumbers, omega: f64, factor: f64) -> f64 {
    let [rounded, larger] = kept(numbers);
    let larger = factor * if rounded.to_bits() == omega.to_bits() { larger } else { omega * LARGER };
    let rounded = larger / LARGER;
    *numbers = [f64::NAN; SIZE];
    numbers[WITH_DIGITS..].copy_from_slice(&[rounded, larger]);
    rounded
}

/// A spin below this (rad/s), for every metre a second of speed, loses digits in its products with the step: `h m a w/(2 J)` is
/// rounded to multiples of the least number there is, 4.9e-324, and multiplied by the speed.
const LEAST: f64 = 16.0 * f64::MIN_POSITIVE;

/// Whether the spin `omega0` is as small, at the speed `u0` (m/s); none at all has nothing to lose.
pub(crate) fn is_least(u0: f64, omega0: f64) -> bool {
    omega0 != 0.0 && omega0.abs() < LEAST * u0.abs().max(1.0)
}

/// The mean spin of a step where the spin has too few digits for products, or none: by the part `r = w/omega0` of it, which has all.
/// The spin at the end is `omega0 (2 r - 1)`.
///
/// What is rounded off there is kept: a step of a fiftieth of a time constant changes a spin of 30 times the least number by little
/// more than half of one, and parts of the step in a composition by less, so that it would grow wrongly or not at all.
#[inline(never)]
pub(crate) fn search_least(
    equation: SpinEquation,
    (u0, omega0): (f64, f64),
    numbers: &mut SpinNumbers,
) -> Result<FoundTurn, ClosedStepError> {
    let equation = equation.in_units_of(omega0);
    let found = settled(&equation, equation.guess(u0, 1.0), (u0, 1.0))?;
    let r = found.w + found.correction;
    let (w, omega1) = (omega0 * r, with_digits(numbers, omega0, mul_add(2.0, r, -1.0)));
    // The end of the step is found as 2 w minus its beginning: sums of such numbers are exact.
    Ok(FoundTurn { w, correction: 0.0, omega0: 2.0 * w - omega1, ..found })
}
