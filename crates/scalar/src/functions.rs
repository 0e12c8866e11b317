use crate::Scalar;

/// A function of one number, told by its value and its first two derivatives: what [`Scalar::apply`] carries to every number.
///
/// A model that needs a function which [`Scalar`] has not implements this. Where there is no derivative, at a corner or at a jump,
/// it may say a finite one all the same, as [`Scalar::abs`] does.
///
/// ```
/// use lagrangian::{Dual, ScalarFunction, Scalar};
///
/// /// `ln(1 + e^x)`, a ramp that begins smoothly.
/// #[derive(Clone, Copy)]
/// struct Softplus;
/// impl ScalarFunction for Softplus {
///     fn value(self, x: f64) -> f64 {
///         x.exp().ln_1p()
///     }
///     fn slope<S: Scalar>(self, x: S, _f: S) -> S {
///         ((-x).exp() + 1.0).recip()
///     }
///     fn curvature<S: Scalar>(self, _x: S, _f: S, slope: S) -> S {
///         slope * (-slope + 1.0)
///     }
/// }
///
/// let ramp = Dual::<f64, 1>::variable(0.0, 0).apply(Softplus);
/// assert_eq!((ramp.re, ramp.eps), (2.0_f64.ln(), [0.5]));
/// ```
pub trait ScalarFunction: Copy {
    /// Whether it has all derivatives wherever it has a value.
    const SMOOTH: bool = true;

    /// The function as operations on any number, if it is known so: then it is a formula too. `None` by default.
    fn expressed<S: Scalar>(self, _x: S) -> Option<S> {
        None
    }

    /// The value at `x`.
    fn value(self, x: f64) -> f64;
    /// The derivative at `x`, where the function is `f`.
    fn slope<S: Scalar>(self, x: S, f: S) -> S;
    /// The second derivative at `x`, where the function is `f` and its derivative `slope`.
    fn curvature<S: Scalar>(self, x: S, f: S, slope: S) -> S;
}

/// Functions by name: value, slope and curvature.
macro_rules! functions {
    ($($name:ident: $value:path $(, $smooth:literal)?; |$x:ident, $f:ident| $slope:expr; |$y:ident, $g:ident, $s:ident| $curvature:expr)*) => {$(
        #[derive(Clone, Copy)]
        pub(crate) struct $name;
        impl ScalarFunction for $name {
            $(const SMOOTH: bool = $smooth;)?

            #[inline(always)]
            fn value(self, x: f64) -> f64 {
                $value(x)
            }
            #[inline(always)]
            fn slope<S: Scalar>(self, $x: S, $f: S) -> S {
                $slope
            }
            #[inline(always)]
            fn curvature<S: Scalar>(self, $y: S, $g: S, $s: S) -> S {
                $curvature
            }
        }
    )*};
}
functions! {
    Tan: f64::tan; |_x, f| f * f + 1.0; |_x, f, slope| f * slope * 2.0
    // 1 - x^2 in factors: near 1 the square has lost digits.
    Asin: f64::asin; |x, _f| ((x + 1.0) * (-x + 1.0)).sqrt().recip(); |x, _f, slope| x * (slope * slope * slope)
    Acos: f64::acos; |x, _f| -((x + 1.0) * (-x + 1.0)).sqrt().recip(); |x, _f, slope| x * (slope * slope * slope)
    Atan: f64::atan; |x, _f| (x * x + 1.0).recip(); |x, _f, slope| x * (slope * slope) * -2.0
    Sinh: f64::sinh; |x, _f| x.cosh(); |_x, f, _slope| f
    Cosh: f64::cosh; |x, _f| x.sinh(); |_x, f, _slope| f
    Tanh: f64::tanh; |x, _f| inverse_square_of_cosh(x); |_x, f, slope| f * slope * -2.0
    Abs: f64::abs, false; |x, _f| x.sign(); |_x, _f, _slope| S::zero()
    Sign: sign, false; |_x, _f| S::zero(); |_x, _f, _slope| S::zero()
}

/// `1/cosh^2 = 4 e/(1 + e)^2` with `e = e^(-2 |x|)`, which neither overflows nor loses digits as `1 - tanh^2` does. It is even, so that
/// at zero either sign has its derivatives.
#[inline(always)]
fn inverse_square_of_cosh<S: Scalar>(x: S) -> S {
    let e = (x.where_positive(-x, x) * 2.0).exp();
    let sum = e + 1.0;
    e * 4.0 / (sum * sum)
}

/// The sign: 1, -1, zero for zero, and NaN for NaN.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x
    }
}

/// `x^p`.
#[derive(Clone, Copy)]
pub(crate) struct Power(pub(crate) f64);

impl Power {
    /// `factor x^p`; zero where the factor is, so that `0 x^-1` is no number nowhere.
    #[inline(always)]
    fn times<S: Scalar>(self, factor: f64, x: S) -> S {
        if factor == 0.0 { S::zero() } else { x.apply(self) * factor }
    }
}

impl ScalarFunction for Power {
    const SMOOTH: bool = false;

    #[inline(always)]
    fn value(self, x: f64) -> f64 {
        x.powf(self.0)
    }
    #[inline(always)]
    fn slope<S: Scalar>(self, x: S, _f: S) -> S {
        let Self(p) = self;
        Self(p - 1.0).times(p, x)
    }
    #[inline(always)]
    fn curvature<S: Scalar>(self, x: S, _f: S, _slope: S) -> S {
        let Self(p) = self;
        Self(p - 2.0).times(p * (p - 1.0), x)
    }
}
