use scalar::{Scalar, ScalarFunction, assigning_operators, exponential};
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Number of Taylor coefficients.
const TERMS: usize = 7;

/// A function of one variable near a place, by its Taylor coefficients up to the sixth power: a [`Tape`](crate::Tape) on such numbers gives
/// all derivatives at once, in a time that grows with the length of the tape alone.
///
/// ```
/// use expression::Series;
/// use scalar::Scalar;
/// let t = Series::variable(0.0);
/// assert_eq!((t * 2.0).exp().derivative(3), 8.0);
/// assert!(t.derivative(7).is_nan());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Series([f64; TERMS]);

impl Series {
    /// The variable at that place.
    #[must_use]
    pub fn variable(x: f64) -> Self {
        Self(from_fn(|k| [x, 1.0].get(k).copied().unwrap_or(0.0)))
    }

    /// The derivative of that order; not a number beyond the sixth.
    #[must_use]
    pub fn derivative(&self, order: usize) -> f64 {
        let factorial: f64 = (1..=order).map(|k| k as f64).product();
        self.0.get(order).map_or(f64::NAN, |x| x * factorial)
    }

    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }

    /// The series by its coefficients, each of its order and those before it.
    fn successive(first: f64, next: impl Fn(usize, &[f64; TERMS]) -> f64) -> Self {
        let mut x = [0.0; TERMS];
        x[0] = first;
        for k in 1..TERMS {
            x[k] = next(k, &x);
        }
        Self(x)
    }

    /// `sum_(j = 1..k) weight(j) self_j other_(k - j)`.
    fn convolved(&self, k: usize, other: &[f64; TERMS], weight: impl Fn(usize) -> f64) -> f64 {
        (1..=k).map(|j| weight(j) * self.0[j] * other[k - j]).sum()
    }

    /// The function with this value here, whose rate is `slope` times the rate of `self`.
    fn with_slope(self, value: f64, slope: Self) -> Self {
        Self::successive(value, |k, _| self.convolved(k, &slope.0, |j| j as f64) / k as f64)
    }

    /// Two functions each of which is the slope of the other, but for a sign.
    fn pair(self, [first, last]: [f64; 2], sign: f64) -> [Self; 2] {
        let (mut a, mut b) = ([0.0; TERMS], [0.0; TERMS]);
        (a[0], b[0]) = (first, last);
        for k in 1..TERMS {
            a[k] = self.convolved(k, &b, |j| j as f64) / k as f64;
            b[k] = sign * self.convolved(k, &a, |j| j as f64) / k as f64;
        }
        [Self(a), Self(b)]
    }
}

impl Neg for Series {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}
impl Add for Series {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self(from_fn(|k| self.0[k] + o.0[k]))
    }
}
impl Sub for Series {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self(from_fn(|k| self.0[k] - o.0[k]))
    }
}
impl Mul for Series {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self(from_fn(|k| (0..=k).map(|j| self.0[j] * o.0[k - j]).sum()))
    }
}
impl Div for Series {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let of = |k: usize, x: &[f64; TERMS]| (self.0[k] - o.convolved(k, x, |_| 1.0)) / o.0[0];
        Self::successive(self.0[0] / o.0[0], of)
    }
}
impl Add<f64> for Series {
    type Output = Self;
    fn add(mut self, c: f64) -> Self {
        self.0[0] += c;
        self
    }
}
impl Sub<f64> for Series {
    type Output = Self;
    fn sub(self, c: f64) -> Self {
        self + -c
    }
}
impl Mul<f64> for Series {
    type Output = Self;
    fn mul(self, c: f64) -> Self {
        self.map(|x| x * c)
    }
}
impl Div<f64> for Series {
    type Output = Self;
    fn div(self, c: f64) -> Self {
        self.map(|x| x / c)
    }
}
assigning_operators!([] Series);

impl Scalar for Series {
    fn constant(x: f64) -> Self {
        Self::successive(x, |_, _| 0.0)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0[0].sin_cos();
        let [sin, cos] = self.pair([sin, cos], -1.0);
        (sin, cos)
    }
    fn exp(self) -> Self {
        Self::successive(exponential(self.0[0]), |k, x| self.convolved(k, x, |j| j as f64) / k as f64)
    }
    fn ln(self) -> Self {
        self.with_slope(self.0[0].ln(), self.recip())
    }
    fn sqrt(self) -> Self {
        self.powf(0.5)
    }
    fn powi(self, n: i32) -> Self {
        let (mut result, mut square, mut left) = (Self::constant(1.0), self, n.unsigned_abs());
        while left > 0 {
            if left % 2 == 1 {
                result = result * square;
            }
            left /= 2;
            if left > 0 {
                square = square * square;
            }
        }
        if n < 0 { result.recip() } else { result }
    }
    fn recip(self) -> Self {
        Self::constant(1.0) / self
    }
    /// A function of which no more is known has two derivatives.
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        let x = self.0[0];
        let (value, slope) = (f.value(x), f.slope(x, f.value(x)));
        let apart = self - x;
        let series = apart * slope + apart * apart * (0.5 * f.curvature(x, value, slope)) + value;
        Self(from_fn(|k| if k > 2 { f64::NAN } else { series.0[k] }))
    }
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        if self.0[0] > 0.0 { then } else { otherwise }
    }
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        let square = components.iter().fold(Self::constant(0.0), |sum, &x| sum + x * x);
        square.where_positive(square.sqrt(), square * 0.0)
    }
    fn atan2(self, x: Self) -> Self {
        let square = self * self + x * x;
        let [slope_of_y, slope_of_x] =
            [x / square, -self / square].map(|slope| square.where_positive(slope, square * 0.0));
        let angle = self.0[0].atan2(x.0[0]);
        self.with_slope(0.0, slope_of_y) + x.with_slope(0.0, slope_of_x) + angle
    }
    fn is_zero(&self) -> bool {
        self.0.iter().all(|x| *x == 0.0)
    }
    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }
    fn asin(self) -> Self {
        self.with_slope(self.0[0].asin(), ((self + 1.0) * (-self + 1.0)).sqrt().recip())
    }
    fn acos(self) -> Self {
        self.with_slope(self.0[0].acos(), -((self + 1.0) * (-self + 1.0)).sqrt().recip())
    }
    fn atan(self) -> Self {
        self.with_slope(self.0[0].atan(), (self * self + 1.0).recip())
    }
    fn sinh(self) -> Self {
        self.pair([self.0[0].sinh(), self.0[0].cosh()], 1.0)[0]
    }
    fn cosh(self) -> Self {
        self.pair([self.0[0].sinh(), self.0[0].cosh()], 1.0)[1]
    }
    fn tanh(self) -> Self {
        // As its derivative elsewhere: neither overflows nor loses digits.
        let e = (self.abs() * -2.0).exp();
        let sum = e + 1.0;
        self.with_slope(self.0[0].tanh(), e * 4.0 / (sum * sum))
    }
    fn abs(self) -> Self {
        self * self.0[0].sign()
    }
    fn sign(self) -> Self {
        Self::constant(self.0[0].sign())
    }
    fn powf(self, p: f64) -> Self {
        let [x, ..] = self.0;
        let of = |k: usize, y: &[f64; TERMS]| {
            if x == 0.0 {
                // Of a power that has no derivative there.
                return if (k as f64) < p { 0.0 } else { f64::NAN };
            }
            self.convolved(k, y, |j| p * j as f64 - (k - j) as f64) / (k as f64 * x)
        };
        Self::successive(x.powf(p), of)
    }
}
