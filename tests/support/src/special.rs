//! Quotients that closed forms need down to a zero denominator.

/// `sin(z) / z`.
pub(crate) fn sinc(z: f64) -> f64 {
    // A double `z` with sin(z) = z to rounding gives one; only zero itself needs a word.
    if z == 0.0 { 1.0 } else { z.sin() / z }
}

/// `(z - sin z) / (2 z^2)`.
pub(crate) fn sine_defect(z: f64) -> f64 {
    if z.abs() > 1.0 {
        return (z - z.sin()) / (2.0 * z * z);
    }
    // z/2 (1/3! - z^2/5! + z^4/7! - ..), nine terms: the tenth is below a rounding.
    let mut sum = 0.0;
    for n in (0..9).rev() {
        let k = f64::from(2 * n + 4);
        sum = 1.0 - z * z / (k * (k + 1.0)) * sum;
    }
    z / 12.0 * sum
}
