use crate::{Discretisation, EndMomenta, Mechanics, RoundedStep, Rules};
use lagrangian::{
    Dual, HyperDual, Midpoint, Rounded, Rule, Scalar, TwiceDifferentiable, from_fn, mapped, second_derivatives, seed,
};

/// A discrete Lagrangian `L_d(q0, q1; t0, h)` of a system, an approximation of the action over one step (the book, (2.1)), that is written
/// by hand; [`Dla::of`](crate::Dla::of) makes a method of it. Quadrature rules are [`Rules`].
///
/// A pair `(q0, q1)` is given as `q0` and the mean velocity `v = (q1 - q0)/h`: far from the origin the difference of
/// the rounded end points would lose the digits that a step needs.
///
/// ```
/// use dla::{DiscreteLagrangian, Dla, OneStep, State};
/// use lagrangian::{Constraint, Scalar, System};
///
/// /// A mass on a spring.
/// struct Spring;
///
/// impl System<1, 0> for Spring {
///     fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 1], v: &[S; 1]) -> S {
///         (v[0] * v[0] - q[0] * q[0]) * 0.5
///     }
///     fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 1]) -> Constraint<S, 1, 0> {
///         ([], [])
///     }
/// }
///
/// /// Its action by Simpson's rule.
/// struct Simpson;
///
/// impl DiscreteLagrangian<1> for Simpson {
///     fn average<S: Scalar>(&self, t0: S, h: S, q0: &[S; 1], v: &[S; 1]) -> S {
///         let at = |alpha: f64| Spring.lagrangian(t0 + h * alpha, &[q0[0] + h * v[0] * alpha], v);
///         (at(0.0) + at(0.5) * 4.0 + at(1.0)) / 6.0
///     }
/// }
///
/// let mut state = State::new([1.0], [0.0], [false]);
/// let mut method = Dla::of(Simpson);
/// for k in 0..100 {
///     method.step(&Spring, 0.01 * f64::from(k), 0.01, &mut state)?;
/// }
/// assert!((state.q()[0] - 1f64.cos()).abs() < 1e-5);
/// # Ok::<(), dla::StepError>(())
/// ```
pub trait DiscreteLagrangian<const N: usize> {
    /// The mean Lagrangian over the step, `L_d(q0, q0 + h v) / h` (J).
    ///
    /// The action itself would bring factors `h` and `1/h` into the momenta that cancel but for their rounding, which is
    /// the same in every step: an energy drift of half an ulp a step.
    fn average<S: Scalar>(&self, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> S;

    /// Discrete forces `f_d^-` at `q0` and `f_d^+` at `q1` (N s), with the quadrature of the action; `None` by default.
    ///
    /// Marsden and West 2001, equation (3.2.1).
    fn forces<S: Scalar>(&self, _t0: S, _h: S, _q0: &[S; N], _v: &[S; N]) -> Option<[[S; N]; 2]> {
        None
    }

    /// The rule of the discrete constraint, which is chosen independently (Cortes and Martinez 2001, Nonlinearity 14, 1365-1392);
    /// [`Midpoint`] by default.
    fn constraint(&self) -> Rule {
        Midpoint.into()
    }
}

/// `D1 L_d` and `D2 L_d`, in first-order evaluations.
fn slopes<L, S: Scalar, const N: usize>(l: &L, t0: S, h: S, q0: &[S; N], v: &[S; N]) -> [[S; N]; 2]
where
    L: DiscreteLagrangian<N>,
{
    let (t, step) = (Dual::fixed(t0), Dual::fixed(h));
    let directed = |x: S, i: usize, by: S| Dual { re: x, eps: from_fn(|k| if k == i { by } else { S::zero() }) };
    // Of q0 at a fixed q1, in units of h as below.
    let q: [Dual<S, N>; N] = from_fn(|i| directed(q0[i], i, h));
    let back: [Dual<S, N>; N] = from_fn(|i| directed(v[i], i, S::constant(-1.0)));
    let d1 = l.average(t, step, &q, &back).eps;
    [d1, l.average(t, step, &mapped(q0, Dual::fixed), &Dual::variables(v)).eps]
}

/// The constraint by its rule.
fn constraint<L: DiscreteLagrangian<N>, const N: usize>(l: &L) -> Rules {
    Rules::new(l.constraint(), l.constraint())
}

/// A mean Lagrangian as a function of both ends of the step.
///
/// In units of h these are a = q0/h and b = q1/h: then q0 = h a, v = b - a, and D1 L_d is the derivative of L_d/h in a.
struct OfPair<'a, L, const N: usize> {
    of: &'a L,
    time: (f64, f64),
    q0: &'a [f64; N],
    v: &'a [f64; N],
}

impl<L: DiscreteLagrangian<N>, const N: usize> TwiceDifferentiable<f64, N> for OfPair<'_, L, N> {
    fn at<const P: usize>(&self, first: usize, second: usize) -> HyperDual<f64, P, P> {
        let Self { of, time: (t0, h), q0, v } = *self;
        let q0: [HyperDual<f64, P, P>; N] = from_fn(|i| HyperDual::linear(q0[i], seed(h, i, first), [0.0; P]));
        let v: [HyperDual<f64, P, P>; N] =
            from_fn(|i| HyperDual::linear(v[i], seed(-1.0, i, first), seed(1.0, i, second)));
        of.average(HyperDual::fixed(t0), HyperDual::fixed(h), &q0, &v)
    }
}

impl<L: DiscreteLagrangian<N>, const N: usize, const M: usize> Discretisation<N, M> for L {
    fn momenta(
        &self,
        _system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        q0: &[f64; N],
        v: &[f64; N],
    ) -> EndMomenta<N> {
        EndMomenta { slopes: slopes(self, t0, h, q0, v), forces: self.forces(t0, h, q0, v) }
    }

    fn linearised(
        &self,
        _system: &dyn Mechanics<N, M>,
        time: (f64, f64),
        q0: &[f64; N],
        v: &[f64; N],
    ) -> (EndMomenta<N>, [[f64; N]; N]) {
        let l = second_derivatives(&OfPair { of: self, time, q0, v });
        let (t0, h) = (Dual::<f64, N>::fixed(time.0), Dual::fixed(time.1));
        let forces = self.forces(t0, h, &mapped(q0, Dual::fixed), &Dual::variables(v));
        let mut block = l.e12;
        if let Some([minus, _]) = &forces {
            for i in 0..N {
                for j in 0..N {
                    block[i][j] += minus[i].eps[j];
                }
            }
        }
        let forces = forces.map(|ends| mapped(&ends, |end| mapped(&end, |f| f.re)));
        (EndMomenta { slopes: [l.e1, l.e2], forces }, block)
    }

    fn residual(&self, system: &dyn Mechanics<N, M>, time: (f64, f64), q0: &[f64; N], v: &[f64; N]) -> [f64; M] {
        constraint(self).residual(system, time, q0, v)
    }

    fn rows(&self, system: &dyn Mechanics<N, M>, time: (f64, f64), q0: &[f64; N], v: &[f64; N]) -> [Dual<f64, N>; M] {
        constraint(self).rows(system, time, q0, v)
    }

    #[cold]
    fn rounded(
        &self,
        system: &dyn Mechanics<N, M>,
        time: (f64, f64),
        q0: &[f64; N],
        v: &[Rounded; N],
    ) -> RoundedStep<N, M> {
        let (t0, h, q) = (Rounded::exact(time.0), Rounded::exact(time.1), mapped(q0, Rounded::exact));
        let [d1, _] = slopes(self, t0, h, &q, v);
        let minus = self.forces(t0, h, &q, v).map(|[minus, _]| minus);
        RoundedStep { d1, minus, ..constraint(self).rounded(system, time, q0, v) }
    }
}
