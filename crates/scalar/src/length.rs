/// The length of a vector of numbers, without overflow or underflow in its squares.
#[inline(always)]
pub(crate) fn length<const K: usize>(x: &[f64; K]) -> f64 {
    /// Squares that add up to less may have lost digits: `2^53` times the smallest normal number.
    const LEAST: f64 = f64::MIN_POSITIVE / f64::EPSILON * 2.0;
    let sum = sum_of_squares(x, 1.0);
    if (LEAST..=f64::MAX).contains(&sum) { sum.sqrt() } else { scaled(x, sum) }
}

#[inline(always)]
fn sum_of_squares<const K: usize>(x: &[f64; K], scale: f64) -> f64 {
    let mut sum = 0.0;
    for x in x {
        let part = x / scale;
        sum += part * part;
    }
    sum
}

/// The length if the sum of the squares overflows or underflows: computed in units of the power of two below the largest component.
#[cold]
#[inline(never)]
fn scaled<const K: usize>(x: &[f64; K], sum: f64) -> f64 {
    const EXPONENT: u64 = f64::INFINITY.to_bits();
    let largest = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if sum.is_nan() || largest == 0.0 || largest.is_infinite() {
        return sum;
    }
    let scale = f64::from_bits(largest.to_bits() & EXPONENT).max(f64::MIN_POSITIVE);
    sum_of_squares(x, scale).sqrt() * scale
}
