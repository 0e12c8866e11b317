use crate::second::{AT_ONCE, BLOCK, seed};
use crate::{HyperDual, System, from_fn, mapped};

/// `M` functions of `N` variables, some of which there are not; all second derivatives of each are wanted.
trait Curved<const N: usize, const M: usize> {
    /// The functions with their derivatives in `P` variables, those from number `first` on, and in those from `second` on.
    fn at<const P: usize>(&self, first: usize, second: usize) -> Option<[Option<HyperDual<f64, P, P>>; M]>;
}

/// Adds `sum_k factors[k] d^2 phi_k / dv dv` of the constraints that are not affine to a matrix: their reaction turns with the velocity.
#[inline(always)]
pub fn add_reaction_curvature<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    (q, v): (&[f64; N], &[f64; N]),
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
) {
    add(&Nonlinear { system, t, q, v }, factors, matrix);
}

/// Adds `sum_k factors[k] d^2 g_k / dq dq` of the constraints on positions to a matrix.
#[inline(always)]
pub fn add_position_curvature<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
) {
    add(&PositionCurvature { system, t, q }, factors, matrix);
}

/// Adds the second derivatives, for few variables in one evaluation, for many in blocks, as
/// [`second_derivatives`](crate::second_derivatives).
#[inline(always)]
fn add<const N: usize, const M: usize>(of: &impl Curved<N, M>, factors: &[f64; M], matrix: &mut [[f64; N]; N]) {
    match const { N <= AT_ONCE } {
        true => add_block::<_, N, M, N>(of, factors, matrix, (0, 0)),
        false => add_by_blocks(of, factors, matrix),
    }
}

#[inline(never)]
fn add_by_blocks<const N: usize, const M: usize>(
    of: &impl Curved<N, M>,
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
) {
    for first in (0..N).step_by(BLOCK) {
        for second in (0..N).step_by(BLOCK) {
            add_block::<_, N, M, BLOCK>(of, factors, matrix, (first, second));
        }
    }
}

#[inline(always)]
fn add_block<Of: Curved<N, M>, const N: usize, const M: usize, const P: usize>(
    of: &Of,
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
    (first, second): (usize, usize),
) {
    let Some(functions) = of.at::<P>(first, second) else { return };
    for (factor, function) in factors.iter().zip(functions) {
        let Some(function) = function else { continue };
        for (i, row) in (first..N).zip(&function.e12) {
            for (j, e) in (second..N).zip(row) {
                matrix[i][j] += factor * e;
            }
        }
    }
}

struct Nonlinear<'a, Sys, const N: usize, const M: usize> {
    system: &'a Sys,
    t: f64,
    q: &'a [f64; N],
    v: &'a [f64; N],
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Curved<N, M> for Nonlinear<'_, Sys, N, M> {
    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> Option<[Option<HyperDual<f64, P, P>>; M]> {
        let Self { system, t, q, v } = *self;
        let in_v: [_; N] = from_fn(|i| HyperDual::linear(v[i], seed(1.0, i, first), seed(1.0, i, second)));
        system.nonlinear(HyperDual::fixed(t), &mapped(q, HyperDual::fixed), &in_v)
    }
}

struct PositionCurvature<'a, Sys, const N: usize, const M: usize> {
    system: &'a Sys,
    t: f64,
    q: &'a [f64; N],
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Curved<N, M> for PositionCurvature<'_, Sys, N, M> {
    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> Option<[Option<HyperDual<f64, P, P>>; M]> {
        let Self { system, t, q } = *self;
        let in_q: [_; N] = from_fn(|i| HyperDual::linear(q[i], seed(1.0, i, first), seed(1.0, i, second)));
        system.holonomic(HyperDual::fixed(t), &in_q)
    }
}
