//! Arrays of numbers to registers: a pack holds one coordinate of all stages.
use lagrangian::linear::larger;
use lagrangian::simd::{Pack, Simd};
use lagrangian::{Lanes, Scalar, array};

/// Eight stages of `N` slopes.
pub(super) type StageRows<const N: usize> = [[f64; 8]; N];

/// Rows of eight numbers.
#[inline(always)]
pub(super) fn loaded<S: Simd, const R: usize, const N: usize>(simd: S, x: &StageRows<N>) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::load(simd, &x[k]),
    )
}

/// Registers as arrays of numbers.
#[inline(always)]
pub(super) fn in_lanes<S: Simd, const R: usize, const N: usize>(x: &[Pack<S, R>; N]) -> [Lanes; N] {
    array(
        Lanes::constant(0.0),
        #[inline(always)]
        |k| Lanes(x[k].row()),
    )
}

/// Arrays of numbers in registers.
#[inline(always)]
pub(super) fn of_lanes<S: Simd, const R: usize, const N: usize>(simd: S, x: &[Lanes; N]) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::load(simd, &x[k].0),
    )
}

/// Rows continued by their polynomials to the next step.
#[inline(always)]
pub(super) fn ahead<S: Simd, const R: usize, const N: usize>(
    simd: S,
    x: &StageRows<N>,
    continued: &[Pack<S, R>; 8],
) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::load(simd, &x[k]).times(continued),
    )
}

/// Each number broadcast to all lanes.
#[inline(always)]
pub(super) fn everywhere<S: Simd, const R: usize, const N: usize>(simd: S, x: &[f64; N]) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::splat(simd, x[k]),
    )
}

/// The inverse of the size of each row.
#[inline(always)]
pub(super) fn own<S: Simd, const R: usize, const N: usize>(simd: S, x: &[Pack<S, R>; N]) -> [Pack<S, R>; N] {
    let zero = Pack::splat(simd, 0.0);
    array(
        zero,
        #[inline(always)]
        |k| Pack::splat(simd, larger(SMALLEST, zero.max_abs(x[k]).largest()).recip()),
    )
}

/// `h sum_j factors[j] x[j]` of every row, summed so that a rule and its mirror image give the same bits.
#[inline(always)]
pub(super) fn integral<S: Simd, const R: usize, const N: usize>(
    h: f64,
    factors: Pack<S, R>,
    x: &[Pack<S, R>; N],
) -> [f64; N] {
    array(
        0.0,
        #[inline(always)]
        |k| h * (factors * x[k]).folded(),
    )
}

/// The smallest unit of a change: its inverse is finite.
const SMALLEST: f64 = 1e-290;
