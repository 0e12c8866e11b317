/// About the binary logarithm of a positive number, at most .09 below it: good enough for the length of a step, and four
/// instructions.
#[inline(always)]
#[must_use]
pub fn octaves(x: f64) -> f64 {
    (x.to_bits() as i64 - 1.0f64.to_bits() as i64) as f64 / (1u64 << 52) as f64
}

/// The number with this logarithm in octaves, between about -1000 and 1000: the inverse of [`octaves`].
#[inline(always)]
#[must_use]
pub fn of_octaves(octaves: f64) -> f64 {
    f64::from_bits(((octaves * (1u64 << 52) as f64) as i64).wrapping_add(1.0f64.to_bits() as i64) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exact at powers of two, and never far below the logarithm; the inverse is one.
    #[test]
    fn octaves_are_about_the_logarithm() {
        for exponent in -1000..1000 {
            let power = f64::exp2(f64::from(exponent));
            approx::assert_abs_diff_eq!(octaves(power), f64::from(exponent), epsilon = 0.0);
            for part in [1.1, 1.44, 1.9] {
                let below = (power * part).log2() - octaves(power * part);
                assert!((0.0..0.0861).contains(&below), "{below}");
                // Octaves are rounded at the place of the exponent.
                approx::assert_relative_eq!(of_octaves(octaves(power * part)), power * part, max_relative = 1e-12);
            }
        }
    }
}
