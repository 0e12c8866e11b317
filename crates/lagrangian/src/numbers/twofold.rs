use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number as the unevaluated sum `hi + lo`, `|lo|` at most half a unit in the last place of `hi`: some 106 bits.
///
/// The operations follow Dekker (1971), with exact products by a fused multiply-add. If a part overflows or underflows, only the extra
/// digits are lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twofold {
    /// The number, rounded.
    pub hi: f64,
    /// The rounding error of `hi`.
    pub lo: f64,
}

impl Twofold {
    /// The sum `hi + lo`, `|lo|` at most half a unit in the last place of `hi`.
    #[must_use]
    pub fn new(hi: f64, lo: f64) -> Self {
        Self { hi, lo }
    }

    /// `ln 2`.
    #[must_use]
    pub fn ln_2() -> Self {
        Self::new(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17)
    }

    /// The exact product of two numbers.
    #[must_use]
    pub fn product(a: f64, b: f64) -> Self {
        let hi = a * b;
        Self::new(hi, a.mul_add(b, -hi))
    }

    /// The square root.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let root = self.hi.sqrt();
        if root > 0.0 { Self::renormalised(root, 0.5 * self.residual(root, root) / root) } else { Self::from(root) }
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.hi < 0.0 { Self::new(-self.hi, -self.lo) } else { self }
    }

    /// `e^(hi + lo)`, with the relative accuracy of `f64` at any size of `hi`.
    #[must_use]
    pub fn exp(self) -> f64 {
        let exp = self.hi.exp();
        if exp > 0.0 && exp.is_finite() { exp + exp * self.lo } else { exp }
    }

    /// `self - a b`, where the two nearly cancel.
    fn residual(self, a: f64, b: f64) -> f64 {
        let product = Self::product(a, b);
        (self.hi - product.hi) + (self.lo - product.lo)
    }

    /// `hi + lo` for `|lo| <= |hi|`; without `lo` if the sum is infinite or NaN.
    fn renormalised(hi: f64, lo: f64) -> Self {
        let sum = hi + lo;
        if sum.is_finite() { Self::new(sum, lo - (sum - hi)) } else { Self::from(hi) }
    }
}

impl From<f64> for Twofold {
    fn from(value: f64) -> Self {
        Self::new(value, 0.0)
    }
}

impl Add for Twofold {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = self.hi + other.hi;
        let shift = sum - self.hi;
        let error = (self.hi - (sum - shift)) + (other.hi - shift);
        Self::renormalised(sum, error + (self.lo + other.lo))
    }
}

impl Neg for Twofold {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.hi, -self.lo)
    }
}

impl Sub for Twofold {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twofold {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = Self::product(self.hi, other.hi);
        Self::renormalised(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Mul<f64> for Twofold {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        let product = Self::product(self.hi, factor);
        Self::renormalised(product.hi, product.lo + self.lo * factor)
    }
}

impl Div for Twofold {
    type Output = Self;

    fn div(self, divisor: Self) -> Self {
        let quotient = self.hi / divisor.hi;
        Self::renormalised(quotient, (self.residual(quotient, divisor.hi) - quotient * divisor.lo) / divisor.hi)
    }
}

/// A sum with a further term, and the rounding error of it, to be added to the next term (Kahan 1965).
///
/// It is exact where the sum is the larger of the two, and else no more in error than rounding the term is.
#[must_use]
#[inline(always)]
pub fn added(sum: f64, term: f64) -> (f64, f64) {
    let new = sum + term;
    (new, term - (new - sum))
}

/// The rounded sum and its rounding error, whichever term is the larger (Knuth 1969, The Art of Computer Programming 2, section 4.2.2).
#[must_use]
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}
