use crate::{HyperDual, Scalar, from_fn};

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
    const SYMMETRIC: bool;

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
    let mut all = HyperDual::fixed(S::zero());
    for first in (0..N).step_by(BLOCK) {
        let from = if F::SYMMETRIC { first } else { 0 };
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
                    if F::SYMMETRIC && j < i {
                        continue;
                    }
                    all.e12[i][j] = e;
                    if F::SYMMETRIC {
                        all.e12[j][i] = e;
                    }
                }
            }
        }
    }
    all
}
