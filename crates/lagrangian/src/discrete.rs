use crate::gradient::by_places;
use crate::second::{AT_ONCE, BLOCK, TwiceDifferentiable, second_derivatives, seed};
use crate::system::with_nonlinear;
use crate::{AdmissibleBasis, Dual, Gradient, HyperDual, Scalar, System, from_fn, mapped};

/// The derivatives of a discrete Lagrangian over one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives<S, const N: usize> {
    /// `L_d(q0, q1)` (J s).
    pub value: S,
    /// `D1 L_d = dL_d/dq0`.
    pub d1: [S; N],
    /// `D2 L_d = dL_d/dq1`.
    pub d2: [S; N],
    /// `D1 D2 L_d`: row `i`, column `j` is `d^2 L_d / dq0_i dq1_j`.
    pub d1d2: [[S; N]; N],
}

/// A discrete Lagrangian `L_d(q0, q1; t0, h)`, an approximation of the action over one step (the book, (2.1), and (2.5) for
/// rules).
///
/// A pair `(q0, q1)` is given as `q0` and the mean velocity `v = (q1 - q0)/h`: far from the origin the difference of
/// the rounded end points would lose the digits that a step needs. Every quadrature [`Rule`](crate::Rule) is one; a hand-made one
/// implements [`DiscreteLagrangian::average`], and [`DiscreteLagrangian::derivatives`] too where a closed form pays.
pub trait DiscreteLagrangian<Sys, const N: usize, const M: usize> {
    /// The mean Lagrangian over the step, `L_d(q0, q0 + h v) / h` (J).
    ///
    /// The action itself would bring factors `h` and `1/h` into the momenta that cancel but for their rounding, which is
    /// the same in every step: an energy drift of half an ulp a step.
    fn average<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> S;

    /// `L_d(q0, q0 + h v)` (J s).
    #[inline(always)]
    fn value<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> S {
        h * self.average(system, t0, h, q0, v)
    }

    /// Discrete forces `f_d^-` at `q0` and `f_d^+` at `q1` (N s), with the quadrature of the action; none by default.
    ///
    /// Marsden and West 2001, equation (3.2.1).
    #[inline(always)]
    fn forces<S: Scalar>(&self, _system: &Sys, _t0: S, _h: S, _q0: &[S; N], _v: &[S; N]) -> Option<([S; N], [S; N])> {
        None
    }

    /// Value, `D1`, `D2` and the mixed block, in one evaluation: automatic unless given by hand.
    #[inline]
    fn derivatives<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> Derivatives<S, N> {
        let l = second_derivatives(&OfPair { of: self, system, t0, h, q0, v });
        Derivatives { value: h * l.re, d1: l.e1, d2: l.e2, d1d2: mapped(&l.e12, |row| mapped(&row, |x| x / h)) }
    }

    /// `D1 L_d` and `D2 L_d` without the mixed block, in first-order evaluations: automatic unless given by hand.
    #[inline]
    fn slopes<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [[S; N]; 2] {
        let (t, step) = (Dual::fixed(t0), Dual::fixed(h));
        let directed = |x: S, i: usize, by: S| Dual { re: x, eps: from_fn(|k| if k == i { by } else { S::zero() }) };
        // Of q0 at a fixed q1, in units of h as above.
        let q: [Dual<S, N>; N] = from_fn(|i| directed(q0[i], i, h));
        let back: [Dual<S, N>; N] = from_fn(|i| directed(v[i], i, S::constant(-1.0)));
        let d1 = self.average(system, t, step, &q, &back).eps;
        [d1, self.d2(system, t0, h, q0, v)]
    }

    /// The same with the nodes placed by the mean velocity `way`, which is near to `v`: what depends on the nodes alone need not be
    /// evaluated again for `v`. By default the nodes are placed by `v`.
    #[inline(always)]
    fn slopes_along(
        &self,
        system: &Sys,
        time: (f64, f64),
        q0: &[f64; N],
        _way: &[f64; N],
        v: &[f64; N],
    ) -> [[f64; N]; 2] {
        self.slopes(system, time.0, time.1, q0, v)
    }

    /// The [`forces`](Self::forces) in the same way.
    #[inline(always)]
    fn forces_along(
        &self,
        system: &Sys,
        time: (f64, f64),
        q0: &[f64; N],
        _way: &[f64; N],
        v: &[f64; N],
    ) -> Option<([f64; N], [f64; N])> {
        self.forces(system, time.0, time.1, q0, v)
    }

    /// `D2 L_d` by itself, the momentum at the end of a step: automatic unless given by hand.
    #[inline]
    fn d2<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [S; N] {
        self.average(system, Dual::fixed(t0), Dual::fixed(h), &mapped(q0, Dual::fixed), &Dual::variables(v)).eps
    }
}

/// A discrete constraint `w_d(q0, q1; t0, h) = 0` on the pairs of a step, given as `q0` and `v = (q1 - q0)/h`.
///
/// It is chosen independently of the discrete Lagrangian. (Cortes and Martinez 2001, Nonlinearity 14, 1365-1392.)
pub trait DiscreteConstraint<Sys, const N: usize, const M: usize> {
    /// `w_d(q0, q0 + h v)`, in the units of `A v`.
    fn residual<S: Scalar>(&self, system: &Sys, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [S; M];

    /// The same with its derivatives in `v`, those of row `k` in its `eps`: automatic unless given by hand.
    #[inline]
    fn linearised(&self, system: &Sys, t0: f64, h: f64, q0: &[f64; N], v: &[f64; N]) -> [Dual<f64, N>; M] {
        let (t, step) = (Dual::fixed(t0), Dual::fixed(h));
        self.residual(system, t, step, &mapped(q0, Dual::fixed), &Dual::variables(v))
    }

    /// The basis of the mean velocities `v` with `w_d = 0` where it is the system's basis of admissible velocities at one
    /// configuration, `q0 + alpha h v` at that of the mean velocity `way`; none by default.
    #[inline(always)]
    fn basis_along(
        &self,
        _system: &Sys,
        _time: (f64, f64),
        _q0: &[f64; N],
        _way: &[f64; N],
    ) -> Option<AdmissibleBasis<f64, N, M>> {
        None
    }
}

/// A mean Lagrangian as a function of both ends of the step.
///
/// In units of h these are a = q0/h and b = q1/h: then q0 = h a, v = b - a, and D1 L_d is the derivative of L_d/h in a.
pub(crate) struct OfPair<'a, L: ?Sized, Sys, S, const N: usize, const M: usize> {
    pub(crate) of: &'a L,
    pub(crate) system: &'a Sys,
    pub(crate) t0: S,
    pub(crate) h: S,
    pub(crate) q0: &'a [S; N],
    pub(crate) v: &'a [S; N],
}

impl<L, Sys, S: Scalar, const N: usize, const M: usize> TwiceDifferentiable<S, N> for OfPair<'_, L, Sys, S, N, M>
where
    L: DiscreteLagrangian<Sys, N, M> + ?Sized,
{
    const SYMMETRIC: bool = false;

    #[inline(always)]
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<S, P, P> {
        let Self { of, system, t0, h, q0, v } = *self;
        let (zero, one) = (S::zero(), S::constant(1.0));
        let q0: [HyperDual<S, P, P>; N] = from_fn(|i| HyperDual::linear(q0[i], seed(h, i, first), [zero; P]));
        let v: [HyperDual<S, P, P>; N] =
            from_fn(|i| HyperDual::linear(v[i], seed(-one, i, first), seed(one, i, second)));
        of.average(system, HyperDual::fixed(t0), HyperDual::fixed(h), &q0, &v)
    }
}

/// The residual of each constraint with its derivatives along `(dq, dv) = (part, 1) e_j`.
#[must_use]
#[inline(always)]
pub fn residual_along<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    part: f64,
) -> [Dual<f64, N>; M] {
    let affine = match const { N <= AT_ONCE } {
        true => by_places!(affine_along::<Sys, N, M>(system, t, q, v, part)),
        false => affine_by_blocks(system, t, q, v, part),
    };
    let in_q = from_fn(|i| Dual { re: q[i], eps: from_fn(|j| if i == j { part } else { 0.0 }) });
    with_nonlinear(system, Dual::fixed(t), &in_q, &Dual::variables(v), affine)
}

/// The same of affine constraints, `d(A v + b) = (A + part d(A v + b)/dq) dv`, by derivatives in `W` places.
#[inline(always)]
fn affine_along<Sys: System<N, M>, const N: usize, const M: usize, const W: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    part: f64,
) -> [Dual<f64, N>; M] {
    let (a, b) = system.constraint(Gradient::<f64, W>::fixed(t), &Gradient::variables(q));
    from_fn(|k| {
        let mut along = b[k];
        for i in 0..N {
            along += a[k][i] * v[i];
        }
        let in_q: [f64; N] = along.gradient();
        Dual { re: along.re, eps: from_fn(|j| a[k][j].re + part * in_q[j]) }
    })
}

/// The same of many coordinates, some of them at a time.
#[inline(never)]
fn affine_by_blocks<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    part: f64,
) -> [Dual<f64, N>; M] {
    let mut rows = [Dual::fixed(0.0); M];
    for from in (0..N).step_by(BLOCK) {
        let (a, b) = system.constraint(Gradient::<f64, BLOCK>::fixed(t), &Gradient::some_variables(q, from));
        for k in 0..M {
            let along = (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i]);
            rows[k].re = along.re;
            let in_q: [f64; BLOCK] = along.gradient();
            for (j, x) in (from..N).zip(in_q) {
                rows[k].eps[j] = a[k][j].re + part * x;
            }
        }
    }
    rows
}

/// `L_q` and `L_v`.
#[must_use]
#[inline(always)]
pub fn gradients<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [[S; N]; 2] {
    by_places!(gradients_by::<Sys, S, N, M>(system, t, q, v))
}

/// The same, one function for all rules.
#[inline(never)]
pub(crate) fn gradients_apart<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [[S; N]; 2] {
    gradients(system, t, q, v)
}

/// The same by derivatives in `W` places.
#[inline(always)]
fn gradients_by<Sys: System<N, M>, S: Scalar, const N: usize, const M: usize, const W: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    v: &[S; N],
) -> [[S; N]; 2] {
    let t = Gradient::<S, W>::fixed(t);
    let l_v = system.lagrangian(t, &Gradient::all_fixed(q), &Gradient::variables(v));
    let l_q = system.lagrangian(t, &Gradient::variables(q), &Gradient::all_fixed(v));
    [l_q.gradient(), l_v.gradient()]
}

/// Time and configuration at the fraction `alpha` of a step.
#[must_use]
#[inline(always)]
pub fn on_line<S: Scalar, const N: usize>(alpha: f64, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> (S, [S; N]) {
    let part = h * alpha;
    (t0 + part, from_fn(|i| q0[i] + part * v[i]))
}
