use crate::{Scalar, ScalarFunction, mapped};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number whose operations are calls, never inlined: for evaluations that are made seldom. A model on such numbers compiles to a tenth of
/// the code, in a tenth of the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Called<S>(pub S);

/// Operations of numbers that are never inlined.
macro_rules! called {
    ($($trait:ident::$name:ident($self:ident, $o:ident: $other:ty) -> $value:expr;)*) => {
        $(impl<S: Scalar> $trait<$other> for Called<S> {
            type Output = Self;
            #[inline(never)]
            fn $name($self, $o: $other) -> Self {
                Self($value)
            }
        })*
    };
}
called! {
    Add::add(self, o: Self) -> self.0 + o.0;
    Sub::sub(self, o: Self) -> self.0 - o.0;
    Mul::mul(self, o: Self) -> self.0 * o.0;
    Div::div(self, o: Self) -> self.0 / o.0;
    Add::add(self, o: f64) -> self.0 + o;
    Sub::sub(self, o: f64) -> self.0 - o;
    Mul::mul(self, o: f64) -> self.0 * o;
    Div::div(self, o: f64) -> self.0 / o;
}

impl<S: Scalar> Neg for Called<S> {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
scalar::assigning_operators!([S: Scalar] Called<S>);

impl<S: Scalar> Scalar for Called<S> {
    fn constant(x: f64) -> Self {
        Self(S::constant(x))
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }
    #[inline(never)]
    fn exp(self) -> Self {
        Self(self.0.exp())
    }
    #[inline(never)]
    fn ln(self) -> Self {
        Self(self.0.ln())
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(never)]
    fn powi(self, n: i32) -> Self {
        Self(self.0.powi(n))
    }
    #[inline(never)]
    fn recip(self) -> Self {
        Self(self.0.recip())
    }
    #[inline(never)]
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        Self(self.0.apply(f))
    }
    #[inline(never)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        Self(self.0.where_positive(then.0, otherwise.0))
    }
    #[inline(never)]
    fn length<const K: usize>(components: &[Self; K]) -> Self {
        Self(S::length(&mapped(components, |Self(x)| x)))
    }
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}
