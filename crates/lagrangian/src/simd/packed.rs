use super::{Pack, Simd};
use crate::{Scalar, ScalarFunction, array};

/// The functions of several numbers that are made of `together`, lane by lane, and the loop over parts of a model.
macro_rules! functions_by_lane {
    () => {
        #[inline(always)]
        #[allow(clippy::redundant_closure, reason = "a function may stay a call, in which the registers are not known")]
        fn length<const K: usize>(components: &[Self; K]) -> Self {
            together(
                components,
                #[inline(always)]
                |x| f64::length(x),
            )
        }
        #[inline(always)]
        fn atan2(self, x: Self) -> Self {
            together(
                &[self, x],
                #[inline(always)]
                |&[y, x]| f64::atan2(y, x),
            )
        }
        #[inline(always)]
        fn over<I, T>(items: &[I], mut start: T, f: impl Fn(T, &I) -> T) -> T {
            for item in items {
                start = f(start, item);
            }
            start
        }
    };
}
pub(super) use functions_by_lane;

/// Eight numbers in registers, whatever they are: for formulas from which zeros and ones have been removed already.
impl<S: Simd, const R: usize> Scalar for Pack<S, R> {
    const IN_REGISTERS: bool = true;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::splat(S::of_this_machine(), x)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
    #[inline(always)]
    fn sin_cos_called(self) -> (Self, Self) {
        super::apart(
            self.simd(),
            #[inline(always)]
            || self.sin_cos(),
        )
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Self::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.each(f64::ln)
    }
    #[inline(always)]
    #[allow(clippy::redundant_closure_for_method_calls, reason = "a function may stay a call")]
    fn sqrt(self) -> Self {
        self.map(
            #[inline(always)]
            |s, x| s.sqrt_f64s(x),
        )
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        self.each(|x| x.powi(n))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        self.like(1.0) / self
    }
    #[inline(always)]
    fn apply<F: ScalarFunction>(self, f: F) -> Self {
        self.each(
            #[inline(always)]
            |x| f.value(x),
        )
    }
    #[inline(always)]
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        together(
            &[self, then, otherwise],
            #[inline(always)]
            |&[x, then, otherwise]| if x > 0.0 { then } else { otherwise },
        )
    }
    functions_by_lane!();
    #[inline(always)]
    fn array<const N: usize>(f: impl Fn(usize) -> Self) -> [Self; N] {
        let simd = S::of_this_machine();
        array(Self::splat(simd, 0.0), f)
    }
    #[inline(always)]
    fn called<T>(self, f: impl FnOnce(Self) -> T) -> T {
        super::apart(
            self.simd(),
            #[inline(always)]
            || f(self),
        )
    }
    #[inline(always)]
    fn called_on<const N: usize, const K: usize>(
        self,
        vectors: [[Self; N]; K],
        f: impl FnOnce(Self, [[Self; N]; K]) -> Option<[Self; N]>,
    ) -> Option<[Self; N]> {
        super::apart(
            self.simd(),
            #[inline(always)]
            || f(self, vectors),
        )
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.lanes().iter().all(Scalar::is_zero)
    }
}

/// A function of several numbers, without vector instructions.
#[inline(always)]
pub(super) fn together<S: Simd, const R: usize, const K: usize>(
    x: &[Pack<S, R>; K],
    f: impl Fn(&[f64; K]) -> f64,
) -> Pack<S, R> {
    if const { K == 0 } {
        return Scalar::constant(f(&[0.0; K]));
    }
    let mut all = x[0];
    for (i, place) in all.lanes_mut().iter_mut().enumerate() {
        *place = f(&array(
            0.0,
            #[inline(always)]
            |k| x[k].lanes()[i],
        ));
    }
    all
}

scalar::assigning_operators!([S: Simd, const R: usize] Pack<S, R>);
