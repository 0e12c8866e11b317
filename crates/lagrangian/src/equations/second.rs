//! Second derivatives: for few variables in one evaluation, for many in blocks.

use crate::{HyperDual, Scalar, System, from_fn, mapped};

/// A function of at most `AT_ONCE` variables gets all its derivatives in one evaluation.
///
/// A number that carries all second derivatives has `(N + 1)^2` places, and a function of `N` variables has `N` such numbers: at
/// 60 variables 1.8 MB, which is a thread's whole stack.
pub const AT_ONCE: usize = 12;

/// Number of variables per block for functions of more than [`AT_ONCE`] variables.
pub(crate) const BLOCK: usize = 8;

/// A function of two groups of `N` variables, whose derivatives in each and mixed second derivatives are wanted.
pub trait TwiceDifferentiable<S, const N: usize> {
    /// Whether the two groups are the same variables, so that the mixed derivatives are symmetric.
    fn is_symmetric(&self) -> bool {
        false
    }

    /// The function with its derivatives in `P` variables of each group, those from number `first` of the first group on and from
    /// number `second` of the second.
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P>;
}

/// A gradient with the entry `x` for variable `i`, and zeros, in the `P` places for the variables from number `from` on.
#[must_use]
#[inline(always)]
pub fn seed<S: Scalar, const P: usize>(x: S, i: usize, from: usize) -> [S; P] {
    from_fn(|k| if from + k == i { x } else { S::zero() })
}

/// Value, gradients and mixed second derivatives of a function.
///
/// Functions of at most [`AT_ONCE`] variables take one evaluation. Others are differentiated in blocks, so that the numbers on the stack
/// grow with `N` and not with its cube. Both ways give the same bits, except that blocks fill one half of a symmetric matrix from the
/// other.
#[must_use]
#[inline(always)]
pub fn second_derivatives<S: Scalar, const N: usize>(f: &impl TwiceDifferentiable<S, N>) -> HyperDual<S, N, N> {
    match const { N <= AT_ONCE } {
        true => f.at::<N>(0, 0),
        false => by_blocks(f),
    }
}

#[inline(never)]
fn by_blocks<S: Scalar, F: TwiceDifferentiable<S, N>, const N: usize>(f: &F) -> HyperDual<S, N, N> {
    let (mut all, symmetric) = (HyperDual::fixed(S::zero()), f.is_symmetric());
    for first in (0..N).step_by(BLOCK) {
        let from = if symmetric { first } else { 0 };
        for second in (from..N).step_by(BLOCK) {
            let block = f.at::<BLOCK>(first, second);
            all.re = block.re;
            for (i, e) in (first..N).zip(block.e1) {
                all.e1[i] = e;
            }
            for (j, e) in (second..N).zip(block.e2) {
                all.e2[j] = e;
            }
            for (i, row) in (first..N).zip(block.e12) {
                for (j, e) in (second..N).zip(row) {
                    // What mirrors another entry comes from it, in a block on the diagonal too.
                    if symmetric && j < i {
                        continue;
                    }
                    all.e12[i][j] = e;
                    if symmetric {
                        all.e12[j][i] = e;
                    }
                }
            }
        }
    }
    all
}

/// The Lagrangian at a state, as a function of two groups of variables.
struct AtState<'a, Sys, S, const N: usize, const M: usize> {
    system: &'a Sys,
    t: S,
    q: &'a [S; N],
    v: &'a [S; N],
    /// How far variable `i` of the first group moves `q_i` and `v_i`.
    first: [S; 2],
    /// The same of the second group; `None` if both groups are the same variables.
    second: Option<[S; 2]>,
}

impl<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N>
    for AtState<'_, Sys, S, N, M>
{
    fn is_symmetric(&self) -> bool {
        self.second.is_none()
    }

    #[inline(always)]
    fn at<const P: usize>(&self, from: usize, second_from: usize) -> HyperDual<S, P, P> {
        let (first, second) = (self.first, self.second.unwrap_or(self.first));
        let moved = |x: &[S; N], d: usize| -> [HyperDual<S, P, P>; N] {
            from_fn(|i| HyperDual::linear(x[i], seed(first[d], i, from), seed(second[d], i, second_from)))
        };
        self.system.lagrangian(HyperDual::fixed(self.t), &moved(self.q, 0), &moved(self.v, 1))
    }
}

/// The Lagrangian with its gradients along `(dq, dv) = first e_i` and `second e_j`, and the mixed second derivatives; `None` as `second`
/// stands for the directions of `first`.
///
/// With `first = (h (1 - alpha), -1)` and `second = (h alpha, 1)` these are what a node at the fraction `alpha` of a step adds to
/// `D1 L_d`, `D2 L_d` and `h D1 D2 L_d`. The function is compiled once for a system, and serves all directions.
#[must_use]
#[inline(never)]
pub fn second_along<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    (q, v): (&[S; N], &[S; N]),
    first: [S; 2],
    second: Option<[S; 2]>,
) -> HyperDual<S, N, N> {
    second_derivatives(&AtState::<_, _, N, M> { system, t, q, v, first, second })
}

/// The Lagrangian, its momenta `L_v` in both gradients, and the mass matrix `L_vv`. Inlined, so that code evaluated beside it shares the
/// sines and other functions of the configuration.
#[must_use]
#[inline(always)]
pub(crate) fn second_in_velocity<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> HyperDual<S, N, N> {
    let first = [S::zero(), S::constant(1.0)];
    second_derivatives(&AtState::<_, _, N, M> { system, t, q, v, first, second: None })
}

/// Adds `sum_k factors[k] d^2 phi_k / dv dv` of the constraints that are not affine to a matrix: their reaction turns with the velocity.
pub fn add_reaction_curvature<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    (q, v): (&[f64; N], &[f64; N]),
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
) {
    add_curvature(&Functions { system, t, q, v: Some(v) }, factors, matrix);
}

/// Adds `sum_k factors[k] d^2 g_k / dq dq` of the constraints on positions to a matrix.
pub fn add_position_curvature<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
) {
    add_curvature(&Functions { system, t, q, v: None }, factors, matrix);
}

/// The functions of the constraints that are not affine, of the velocities `v`; without `v` the constraints on positions.
struct Functions<'a, Sys, const N: usize> {
    system: &'a Sys,
    t: f64,
    q: &'a [f64; N],
    v: Option<&'a [f64; N]>,
}

fn add_curvature<Sys: System<N, M>, const N: usize, const M: usize>(
    of: &Functions<'_, Sys, N>,
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
) {
    if const { N <= AT_ONCE } {
        return add_block::<_, N, M, N>(of, factors, matrix, (0, 0));
    }
    for first in (0..N).step_by(BLOCK) {
        for second in (0..N).step_by(BLOCK) {
            add_block::<_, N, M, BLOCK>(of, factors, matrix, (first, second));
        }
    }
}

#[inline(never)]
fn add_block<Sys: System<N, M>, const N: usize, const M: usize, const P: usize>(
    &Functions { system, t, q, v }: &Functions<'_, Sys, N>,
    factors: &[f64; M],
    matrix: &mut [[f64; N]; N],
    (first, second): (usize, usize),
) {
    let variables = |x: &[f64; N]| -> [HyperDual<f64, P, P>; N] {
        from_fn(|i| HyperDual::linear(x[i], seed(1.0, i, first), seed(1.0, i, second)))
    };
    let t = HyperDual::fixed(t);
    let functions = match v {
        Some(v) => system.nonlinear(t, &mapped(q, HyperDual::fixed), &variables(v)),
        None => system.holonomic(t, &variables(q)),
    };
    let Some(functions) = functions else { return };
    for (factor, function) in factors.iter().zip(functions) {
        let Some(function) = function else { continue };
        for (i, row) in (first..N).zip(&function.e12) {
            for (j, e) in (second..N).zip(row) {
                matrix[i][j] += factor * e;
            }
        }
    }
}
