use crate::convergence::{most_roundings, without_reaction};
use crate::{Discretisation, EndMomenta, Mechanics, RoundedStep, State};
use lagrangian::linear::{Singular, normal_solve};
use lagrangian::{AdmissibleBasis, Rounded, Rows, from_fn, mapped};

/// The equations for the mean velocity `v` of a step, with the multiplier at its beginning.
pub(crate) struct Increment<'a, D, const N: usize, const M: usize> {
    /// The discrete Lagrangian and the discrete constraint.
    pub(crate) rules: &'a D,
    pub(crate) system: &'a dyn Mechanics<N, M>,
    pub(crate) t0: f64,
    pub(crate) h: f64,
    pub(crate) state: &'a State<N>,
    pub(crate) q0: [f64; N],
    pub(crate) p0: [f64; N],
    pub(crate) a0: [[f64; N]; M],
    pub(crate) basis: Option<AdmissibleBasis<f64, N, M>>,
}

/// `L_v(q0, v0) + D1 L_d + f_d^-` and `D2 L_d + f_d^+` at one mean velocity.
#[derive(Clone, Copy)]
pub(crate) struct Departure<const N: usize> {
    pub(crate) residual: [f64; N],
    pub(crate) arriving: [f64; N],
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Increment<'_, D, N, M> {
    /// The multipliers whose reaction balances the rest of the momenta.
    #[inline(always)]
    pub(crate) fn multipliers(&self, rest: &[f64; N]) -> Result<[f64; M], Singular> {
        normal_solve(&self.a0, &mapped(rest, |r| -r))
    }

    /// Both ends of a step with the mean velocity `v`, and by how much it misses the constraint, in first order alone.
    ///
    /// Not inlined: it is called for every simplified correction and for the end of the step.
    #[inline(never)]
    pub(crate) fn departure(&self, v: &[f64; N]) -> (Departure<N>, [f64; M]) {
        let at = self.momenta(v);
        let finite = (0..N).all(|i| (at.residual[i] + at.arriving[i]).is_finite());
        // A force that is too large for a number may have an impulse that is not: there it is never without the step.
        (if finite { at } else { self.linearised(v).0 }, self.level(v))
    }

    /// The residual of the constraint in a step with the mean velocity `v`, negated.
    #[inline(always)]
    pub(crate) fn level(&self, v: &[f64; N]) -> [f64; M] {
        let Self { rules, system, t0, h, state, q0, .. } = *self;
        let mut level = mapped(&rules.residual(system, (t0, h), &q0, v), |w| -w);
        if let Some(positions) = system.position_misses(t0 + h, &state.ahead(&mapped(v, |v| h * v))) {
            for k in 0..M {
                level[k] = positions[k].map_or(level[k], |g| -g.re / h);
            }
        }
        level
    }

    /// The derivatives of the discrete constraint in the mean velocity `v`, and by how much it is missed.
    #[inline(always)]
    pub(crate) fn rows(&self, v: &[f64; N]) -> ([[f64; N]; M], [f64; M]) {
        let Self { rules, system, t0, h, state, q0, .. } = *self;
        let w_d = rules.rows(system, (t0, h), &q0, v);
        let (mut rows, mut level) = (mapped(&w_d, |w| w.eps), mapped(&w_d, |w| -w.re));
        if let Some(positions) = system.position_misses(t0 + h, &state.ahead(&mapped(v, |v| h * v))) {
            for k in 0..M {
                if let Some(g) = positions[k] {
                    (rows[k], level[k]) = (g.eps, -g.re / h);
                }
            }
        }
        (rows, level)
    }

    /// Both ends of a step with the mean velocity `v`, and the derivatives of the beginning in it: one second-order evaluation.
    #[inline(never)]
    pub(crate) fn linearised(&self, v: &[f64; N]) -> (Departure<N>, [[f64; N]; N]) {
        let Self { rules, system, t0, h, q0, .. } = *self;
        let (momenta, block) = rules.linearised(system, (t0, h), &q0, v);
        (self.departing(&momenta), block)
    }

    /// Both ends of a step with the mean velocity `v`, in first order alone.
    #[inline]
    pub(crate) fn momenta(&self, v: &[f64; N]) -> Departure<N> {
        let Self { rules, system, t0, h, q0, .. } = *self;
        self.departing(&rules.momenta(system, (t0, h), &q0, v))
    }

    /// Both ends of a step that begins with the momenta `p0`.
    #[inline(always)]
    fn departing(&self, momenta: &EndMomenta<N>) -> Departure<N> {
        let [d1, d2] = momenta.slopes;
        let mut at = Departure { residual: from_fn(|i| self.p0[i] + d1[i]), arriving: d2 };
        if let Some([minus, plus]) = momenta.forces {
            for i in 0..N {
                at.residual[i] += minus[i];
                at.arriving[i] += plus[i];
            }
        }
        at
    }

    /// The largest residual of the equations at the mean velocity, in units of the round-off of its terms: of the momenta at the beginning
    /// without the reaction, and of the constraints, or only of the rows `some` if only these are solved for.
    #[cold]
    #[inline(never)]
    pub(crate) fn roundings(&self, velocity: &[Rounded; N], some: Option<Rows>) -> f64 {
        let Self { rules, system, t0, h, state, q0, p0, a0, .. } = *self;
        let RoundedStep { d1, minus, residual: mut level } = rules.rounded(system, (t0, h), &q0, velocity);
        let momenta = from_fn(|i| {
            let conservative = d1[i] + p0[i];
            minus.map_or(conservative, |minus| conservative + minus[i])
        });
        let q1 = state.ahead(&mapped(velocity, |v| h * v.value));
        let end = from_fn(|i| Rounded { value: q1[i], size: q1[i].abs() + (h * velocity[i].value).abs() });
        if let Some(positions) = system.positions_rounded(Rounded::exact(t0 + h), &end) {
            level = from_fn(|k| positions[k].map_or(level[k], |g| g / h));
        }
        let solved = (0..M).filter(|k| some.is_none_or(|rows| rows.contains(*k)));
        most_roundings(without_reaction(&a0, momenta).into_iter().chain(solved.map(|k| level[k])))
    }
}

impl<D, const N: usize, const M: usize> Clone for Increment<'_, D, N, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, const N: usize, const M: usize> Copy for Increment<'_, D, N, M> {}
