use std::fmt;

/// A number as messages and tables show it: six digits without trailing zeros, with an exponent if it is large or small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded: f64 = format!("{:.5e}", self.0).parse().unwrap_or(self.0);
        let plain = rounded == 0.0 || !rounded.is_finite() || (1e-4..1e7).contains(&rounded.abs());
        if plain { write!(f, "{rounded}") } else { write!(f, "{rounded:e}") }
    }
}

#[cfg(test)]
mod tests {
    use super::Shown;

    #[test]
    fn six_digits_are_shown() {
        for (number, text) in [
            (0.0, "0"),
            (0.05, "0.05"),
            (23.547_172_916_517_72, "23.5472"),
            (9.700_000_000_000_001, "9.7"),
            (-1.0, "-1"),
            (1e308, "1e308"),
            (3_948_544.2, "3948540"),
            (1.234_567e-9, "1.23457e-9"),
            (99_999_999.0, "1e8"),
            (5e-324, "5e-324"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(Shown(number).to_string(), text);
        }
    }
}
