use scalar::{Scalar, ScalarFunction};

/// Functions by name: how a text writes them, how many arguments they take, and their value.
macro_rules! functions {
    ($($(#[$doc:meta])* $function:ident $name:literal $arguments:literal |$a:ident, $b:ident| $value:expr;)*) => {
        /// The functions that a text may use.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Function {
            $($(#[$doc])* $function,)*
        }

        impl Function {
            /// All of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$function),*];

            /// The name in a text.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$function => $name,)*
                }
            }

            /// How many arguments it takes.
            #[must_use]
            pub fn arguments(self) -> usize {
                match self {
                    $(Self::$function => $arguments,)*
                }
            }

            /// Its value; a function of one argument does not look at the second.
            #[must_use]
            #[inline(always)]
            pub fn of<S: Scalar>(self, a: S, b: S) -> S {
                match self {
                    $(Self::$function => {
                        let ($a, $b) = (a, b);
                        $value
                    })*
                }
            }
        }
    };
}

functions! {
    /// Sine.
    Sin "sin" 1 |a, _b| a.sin();
    /// Cosine.
    Cos "cos" 1 |a, _b| a.cos();
    /// Tangent.
    Tan "tan" 1 |a, _b| a.tan();
    /// Arc sine.
    Asin "asin" 1 |a, _b| a.asin();
    /// Arc cosine.
    Acos "acos" 1 |a, _b| a.acos();
    /// Arc tangent.
    Atan "atan" 1 |a, _b| a.atan();
    /// Hyperbolic sine.
    Sinh "sinh" 1 |a, _b| a.sinh();
    /// Hyperbolic cosine.
    Cosh "cosh" 1 |a, _b| a.cosh();
    /// Hyperbolic tangent.
    Tanh "tanh" 1 |a, _b| a.tanh();
    /// Exponential.
    Exp "exp" 1 |a, _b| a.exp();
    /// Natural logarithm.
    Log "log" 1 |a, _b| a.ln();
    /// Square root.
    Sqrt "sqrt" 1 |a, _b| a.sqrt();
    /// Absolute value.
    Abs "abs" 1 |a, _b| a.abs();
    /// Sign: -1, 0 of zero, or 1.
    Sign "sign" 1 |a, _b| a.sign();
    /// Reciprocal, and 0 of zero: the derivative of a length, which counts as zero at length zero.
    Inverse "inverse" 1 |a, _b| a.abs().where_positive(a.recip(), a * 0.0);
    /// The largest whole number that is not larger.
    Floor "floor" 1 |a, _b| a.apply(WholePart);
    /// The second where the first is positive, elsewhere zero.
    Where "where_positive" 2 |a, b| a.where_positive(b, S::zero());
    /// The second where the first is not positive, elsewhere zero.
    Unless "where_not_positive" 2 |a, b| a.where_positive(S::zero(), b);
    /// The angle of the vector `(second, first)`.
    Atan2 "atan2" 2 |a, b| a.atan2(b);
    /// The smaller of two.
    Min "min" 2 |a, b| a.min(b);
    /// The larger of two.
    Max "max" 2 |a, b| a.max(b);
}

/// The largest whole number that is not larger; constant between its jumps.
#[derive(Debug, Clone, Copy)]
struct WholePart;

impl ScalarFunction for WholePart {
    const SMOOTH: bool = false;

    fn value(self, x: f64) -> f64 {
        x.floor()
    }
    fn slope<S: Scalar>(self, _x: S, _f: S) -> S {
        S::zero()
    }
    fn curvature<S: Scalar>(self, _x: S, _f: S, _slope: S) -> S {
        S::zero()
    }
}

impl Function {
    /// The function of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }
}

/// The root of a sum of squares, a length: its derivatives at zero are zero, as in [`Scalar::length`].
#[must_use]
#[inline(always)]
pub(crate) fn length<S: Scalar>(square: S) -> S {
    square.where_positive(square.sqrt(), square * 0.0)
}

/// `a^b` with a constant exponent: a product if `b` is whole, a root if `b` is a half.
#[must_use]
#[inline(always)]
pub(crate) fn power<S: Scalar>(a: S, b: f64) -> S {
    match whole(b) {
        Some(n) => a.powi(n),
        None if b.to_bits() == 0.5_f64.to_bits() => a.sqrt(),
        None => a.powf(b),
    }
}

/// A positive power of a base that may be zero in a whole region, as `max(0, x)`: its derivatives are zero there.
#[must_use]
#[inline(always)]
pub(crate) fn flat_power<S: Scalar>(a: S, p: f64) -> S {
    a.abs().where_positive(power(a, p), a * 0.0)
}

/// `x` as an integer, if `x` is whole and small enough for an exponent.
pub(crate) fn whole(x: f64) -> Option<i32> {
    let n = x as i32;
    (f64::from(n).to_bits() == (x + 0.0).to_bits() && n.unsigned_abs() <= 1 << 24).then_some(n)
}
