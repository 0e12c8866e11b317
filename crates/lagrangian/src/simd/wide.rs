use super::packed::functions_by_lane;
use super::{Pack, Simd};
use crate::{Scalar, ScalarFunction, array};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Eight numbers on which a model is evaluated: a [`Pack`], or one number that is the same in all lanes.
///
/// Which case a number is, is known when a model is compiled, after inlining, so the cases cost nothing at run time; a zero of the model
/// takes no instruction at all. (It hides an infinity or a NaN that it is multiplied by.)
#[derive(Debug, Clone, Copy)]
pub enum Wide<S: Simd, const R: usize> {
    /// Zero, by the model.
    Zero,
    /// The same number in all lanes.
    Same(f64),
    /// Eight numbers.
    Each(Pack<S, R>),
}
use Wide::{Each, Same, Zero};

impl<S: Simd, const R: usize> Wide<S, R> {
    /// The numbers.
    #[must_use]
    #[inline(always)]
    pub fn pack(self, simd: S) -> Pack<S, R> {
        match self {
            Zero => Pack::splat(simd, 0.0),
            Same(x) => Pack::splat(simd, x),
            Each(pack) => pack,
        }
    }

    #[inline(always)]
    fn with(self, o: Self, one: impl Fn(f64, f64) -> f64, all: impl Fn(Pack<S, R>, Pack<S, R>) -> Pack<S, R>) -> Self {
        let simd = match (self, o) {
            (Each(pack), _) | (_, Each(pack)) => pack.simd(),
            (a, b) => return Same(one(a.common(), b.common())),
        };
        Each(all(self.pack(simd), o.pack(simd)))
    }

    /// What all eight have in common.
    #[inline(always)]
    fn common(self) -> f64 {
        if let Same(x) = self { x } else { 0.0 }
    }

    #[inline(always)]
    fn apart(self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Zero => Same(f(0.0)),
            Same(x) => Same(f(x)),
            Each(x) => Each(x.each(f)),
        }
    }
}

/// Numbers, each in its registers.
#[inline(always)]
pub fn packed<S: Simd, const R: usize, const N: usize>(simd: S, x: &[Wide<S, R>; N]) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| x[k].pack(simd),
    )
}

/// Packs as a model takes them.
#[inline(always)]
pub fn each<S: Simd, const R: usize, const N: usize>(x: &[Pack<S, R>; N]) -> [Wide<S, R>; N] {
    array(
        Zero,
        #[inline(always)]
        |k| Each(x[k]),
    )
}

/// A function of several numbers, without vector instructions.
#[inline(always)]
fn together<S: Simd, const R: usize, const K: usize>(x: &[Wide<S, R>; K], f: impl Fn(&[f64; K]) -> f64) -> Wide<S, R> {
    let mut simd = None;
    for x in x {
        if let Each(pack) = x {
            simd = Some(pack.simd());
        }
    }
    match simd {
        None => Same(f(&array(
            0.0,
            #[inline(always)]
            |k| x[k].common(),
        ))),
        Some(simd) => Each(super::packed::together(&packed(simd, x), f)),
    }
}

impl<S: Simd, const R: usize> Add for Wide<S, R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        match (self, o) {
            (Zero, x) | (x, Zero) => x,
            (a, b) => a.with(
                b,
                |a, b| a + b,
                #[inline(always)]
                |a, b| a + b,
            ),
        }
    }
}
impl<S: Simd, const R: usize> Sub for Wide<S, R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        match (self, o) {
            (x, Zero) => x,
            (Zero, x) => -x,
            (a, b) => a.with(
                b,
                |a, b| a - b,
                #[inline(always)]
                |a, b| a - b,
            ),
        }
    }
}
impl<S: Simd, const R: usize> Mul for Wide<S, R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        match (self, o) {
            (Zero, _) | (_, Zero) => Zero,
            (a, b) => a.with(
                b,
                |a, b| a * b,
                #[inline(always)]
                |a, b| a * b,
            ),
        }
    }
}
impl<S: Simd, const R: usize> Div for Wide<S, R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        match (self, o) {
            (Zero, _) => Zero,
            (a, b) => a.with(
                b,
                |a, b| a / b,
                #[inline(always)]
                |a, b| a / b,
            ),
        }
    }
}
impl<S: Simd, const R: usize> Neg for Wide<S, R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        match self {
            Zero => Zero,
            Same(x) => Same(-x),
            Each(x) => Each(-x),
        }
    }
}
macro_rules! with_numbers {
    ($($operator:ident $method:ident),*) => {$(
        impl<S: Simd, const R: usize> $operator<f64> for Wide<S, R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, x: f64) -> Self {
                self.$method(Same(x))
            }
        }
    )*};
}
with_numbers!(Add add, Sub sub, Mul mul, Div div);
scalar::assigning_operators!([S: Simd, const R: usize] Wide<S, R>);

impl<S: Simd, const R: usize> Scalar for Wide<S, R> {
    const IN_REGISTERS: bool = true;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Same(x)
    }
    #[inline(always)]
    fn zero() -> Self {
        Zero
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        match self {
            Zero => (Zero, Same(1.0)),
            Same(x) => {
                let (sin, cos) = x.sin_cos();
                (Same(sin), Same(cos))
            }
            Each(x) => {
                let (sin, cos) = x.sin_cos();
                (Each(sin), Each(cos))
            }
        }
    }
    #[inline(always)]
    fn sin_cos_called(self) -> (Self, Self) {
        match self {
            Each(x) => {
                let (sin, cos) = x.sin_cos_called();
                (Each(sin), Each(cos))
            }
            Zero | Same(_) => crate::called(
                #[inline(always)]
                || self.sin_cos(),
            ),
        }
    }
    #[inline(always)]
    fn exp(self) -> Self {
        match self {
            Zero => Same(1.0),
            Same(x) => Same(scalar::exponential(x)),
            Each(x) => Each(x.exp()),
        }
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.apart(f64::ln)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        match self {
            Zero => Zero,
            Same(x) => Same(x.sqrt()),
            Each(x) => Each(Scalar::sqrt(x)),
        }
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        self.apart(|x| x.powi(n))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Same(1.0) / self
    }
    #[inline(always)]
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        self.apart(
            #[inline(always)]
            |x| f.value(x),
        )
    }
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        match self {
            Zero => otherwise,
            Same(_) | Each(_) => together(
                &[self, then, otherwise],
                #[inline(always)]
                |&[x, then, otherwise]| if x > 0.0 { then } else { otherwise },
            ),
        }
    }
    functions_by_lane!();
    #[inline(always)]
    fn array<const N: usize>(f: impl Fn(usize) -> Self) -> [Self; N] {
        array(Zero, f)
    }
    #[inline(always)]
    fn apart<T>(f: impl FnOnce() -> T) -> T {
        f()
    }
    #[inline(always)]
    fn called<T>(self, f: impl FnOnce(Self) -> T) -> T {
        match self {
            Each(x) => x.called(
                #[inline(always)]
                |x| f(Each(x)),
            ),
            // Of a number that all eight have in common: in a kernel no such question is there after inlining.
            Zero | Same(_) => crate::called(
                #[inline(always)]
                || f(self),
            ),
        }
    }
    #[inline(always)]
    fn called_on<const N: usize, const K: usize>(
        self,
        vectors: [[Self; N]; K],
        f: impl FnOnce(Self, [[Self; N]; K]) -> Option<[Self; N]>,
    ) -> Option<[Self; N]> {
        let Each(t) = self else {
            return crate::called(
                #[inline(always)]
                || f(self, vectors),
            );
        };
        let simd = t.simd();
        let none = [Pack::splat(simd, 0.0); N];
        let packs: [_; K] = array(
            none,
            #[inline(always)]
            |k| packed(simd, &vectors[k]),
        );
        let found = super::apart(
            simd,
            #[inline(always)]
            || {
                let vectors: [_; K] = array(
                    [Zero; N],
                    #[inline(always)]
                    |k| each(&packs[k]),
                );
                match f(Each(t), vectors) {
                    Some(found) => Some(packed(simd, &found)),
                    None => None,
                }
            },
        );
        match found {
            Some(found) => Some(each(&found)),
            None => None,
        }
    }
    #[inline(always)]
    fn carried_as(self, other: Self) -> Self {
        match other {
            Each(pack) => Each(self.pack(pack.simd())),
            Zero | Same(_) => self,
        }
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        match self {
            Zero => true,
            Same(x) => *x == 0.0,
            Each(x) => x.lanes().iter().all(Scalar::is_zero),
        }
    }
}
