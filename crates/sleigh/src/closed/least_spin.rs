use super::settling::{FoundTurn, settled};
use super::spin_equation::SpinEquation;
use super::spin_memory::{SpinNumbers, with_digits};
use dla::ClosedStepError;
use lagrangian::mul_add;

/// A spin below this (rad/s), for every metre a second of speed, loses digits in its products with the step: `h m a w/(2 J)` is
/// rounded to multiples of the least number there is, 4.9e-324, and multiplied by the speed.
const LEAST: f64 = 16.0 * f64::MIN_POSITIVE;

/// Whether the spin `omega0` is one, at the speed `u0` (m/s); none at all has nothing to lose.
pub(crate) fn is_one(u0: f64, omega0: f64) -> bool {
    omega0 != 0.0 && omega0.abs() < LEAST * u0.abs().max(1.0)
}

/// The mean spin of a step where the spin has too few digits for products, or none: by the part `r = w/omega0` of it, which has all.
/// The spin at the end is `omega0 (2 r - 1)`.
///
/// What is rounded off there is kept: a step of a fiftieth of a time constant changes a spin of 30 times the least number by little
/// more than half of one, and parts of the step in a composition by less, so that it would grow wrongly or not at all.
#[inline(never)]
pub(crate) fn search(
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
