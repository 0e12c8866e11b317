use crate::{AdmissibleBasis, Constraint, Gradient, Scalar, ScalarFunction, from_fn, mapped};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number whose operations are calls, never inlined: for evaluations that are made seldom, and for numbers of many parts. A model on such
/// numbers compiles to a tenth of the code, in a tenth of the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Called<S>(pub S);

/// The number of questions that are asked seldom: with the derivatives along one direction and along another, and the second derivative.
pub type SeldomNumber = Called<Gradient<Gradient<f64, 1>, 1>>;

impl SeldomNumber {
    /// A number that changes at the given rate along the first direction.
    #[must_use]
    pub fn moving(re: f64, rate: f64) -> Self {
        Self(Gradient::moving(Gradient::fixed(re), Gradient::fixed(rate)))
    }

    /// A number that does not change.
    #[must_use]
    pub fn fixed(re: f64) -> Self {
        Self(Gradient::fixed(Gradient::fixed(re)))
    }

    /// The point `x`, its coordinate number `j` alone changing at unit rate; no coordinate changes if there is no such number.
    #[must_use]
    pub fn along_one<const N: usize>(x: &[f64; N], j: usize) -> [Self; N] {
        from_fn(|i| if i == j { Self::moving(x[i], 1.0) } else { Self::fixed(x[i]) })
    }

    /// The value.
    #[must_use]
    pub fn value(self) -> f64 {
        self.0.re.re
    }

    /// The derivative along the first direction.
    #[must_use]
    pub fn rate(self) -> f64 {
        let [rate] = self.0.gradient();
        rate.re
    }
}

impl<S: Scalar> Called<S> {
    /// Numbers whose operations are calls.
    #[must_use]
    pub fn all<const N: usize>(x: &[S; N]) -> [Self; N] {
        mapped(x, Self)
    }

    /// The numbers themselves.
    #[must_use]
    pub fn plain<const N: usize>(x: &[Self; N]) -> [S; N] {
        mapped(x, |Self(x)| x)
    }

    /// A constraint on the numbers themselves.
    #[must_use]
    pub fn plain_constraint<const N: usize, const M: usize>((a, b): Constraint<Self, N, M>) -> Constraint<S, N, M> {
        (mapped(&a, |row| Self::plain(&row)), Self::plain(&b))
    }

    /// A basis on the numbers themselves.
    #[must_use]
    pub fn plain_basis<const N: usize, const M: usize>(
        basis: &AdmissibleBasis<Self, N, M>,
    ) -> AdmissibleBasis<S, N, M> {
        AdmissibleBasis::from_fn(|k| Self::plain(&basis.vectors()[k]))
    }
}

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
