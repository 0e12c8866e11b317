use crate::branch;
use crate::convergence::{most_roundings, without_reaction};
use crate::corrections::{Corrections, Departure};
use crate::dependent::named_along;
use crate::newton::NewtonRoot;
use crate::{Discretisation, EndMomenta, Mechanics, Newton, NewtonError, RoundedStep, State, StepError};
use lagrangian::linear::{Singular, normal_solve};
use lagrangian::{AdmissibleBasis, Rounded, Rows, Saddle, from_fn};
use std::f64::consts::PI;

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

/// The mean velocity of a step, the impulse of the constraints at its beginning, and the momenta with which it ends.
pub(crate) struct Mean<const N: usize, const M: usize> {
    pub(crate) v: [f64; N],
    pub(crate) p1: [f64; N],
    pub(crate) lambda: [f64; M],
    pub(crate) iterations: u32,
    /// The rows that were solved for, where not all.
    pub(crate) some: Option<Rows>,
    /// The last Jacobian of the momenta at the beginning.
    pub(crate) block: Option<[[f64; N]; N]>,
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Increment<'_, D, N, M> {
    /// The solution that continues the motion, from the velocity `v0` at the beginning. Newton's method starts at the predictor `guess`
    /// where there is one, and where it fails from there at `v0`.
    ///
    /// # Errors
    /// [`StepError::Newton`] where none is found, [`StepError::Branch`] where what is found belongs to another motion.
    #[inline]
    pub(crate) fn solve(
        &self,
        newton: &Newton,
        v0: [f64; N],
        guess: Option<[f64; N]>,
    ) -> Result<Mean<N, M>, StepError> {
        // Dependent rows have no sign, and then it is not compared.
        let positive = Saddle::is_positive_at_rest(&self.a0, self.basis.as_ref());
        let time = (self.t0, self.h);
        let (mut search, mut v) = (Corrections::new(self), guess.unwrap_or(v0));
        let mut found = newton.search(&mut search, &mut v);
        if found.is_err() && guess.is_some() {
            (search, v) = (Corrections::new(self), v0);
            found = newton.search(&mut search, &mut v);
        }
        let NewtonRoot { mut iterations, certain, .. } =
            found.map_err(|source| named_along(self.system, time, *self.state, v, source))?;
        let turn = self.turn(&v);
        if !(certain && search.continues(positive) && turn <= branch::NEAR) {
            v = self.followed(newton, positive, turn, &v0).ok_or(StepError::Branch)?;
            search = Corrections::new(self);
            iterations += newton
                .solve(&mut search, &mut v)
                .map_err(|source| named_along(self.system, time, *self.state, v, source))?;
        }
        let some = search.some;
        let (p1, lambda) = search.ends(&v).map_err(|source| {
            let source = NewtonError::singular(source);
            named_along(self.system, time, *self.state, v, source)
        })?;
        Ok(Mean { v, p1, lambda, iterations, some, block: search.block() })
    }

    /// The multipliers whose reaction balances the rest of the momenta.
    #[inline(always)]
    pub(crate) fn multipliers(&self, rest: &[f64; N]) -> Result<[f64; M], Singular> {
        normal_solve(&self.a0, &rest.map(|r| -r))
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

    /// By how much a step with the mean velocity `v` misses the constraint.
    #[inline(always)]
    pub(crate) fn level(&self, v: &[f64; N]) -> [f64; M] {
        let Self { rules, system, t0, h, state, q0, .. } = *self;
        let mut level = rules.residual(system, (t0, h), &q0, v).map(|w| -w);
        if let Some(positions) = system.position_misses(t0 + h, &state.ahead(&v.map(|v| h * v))) {
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
        let (mut rows, mut level) = (w_d.map(|w| w.eps), w_d.map(|w| -w.re));
        if let Some(positions) = system.position_misses(t0 + h, &state.ahead(&v.map(|v| h * v))) {
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
        self.momenta_along(v, v)
    }

    /// The same with the nodes placed by the mean velocity `way`, which is near to `v`.
    #[inline]
    pub(crate) fn momenta_along(&self, way: &[f64; N], v: &[f64; N]) -> Departure<N> {
        let Self { rules, system, t0, h, q0, .. } = *self;
        self.departing(&rules.momenta(system, (t0, h), &q0, way, v))
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
    /// without the reaction, and of the constraints, or of `some` of them where only these are solved for.
    #[cold]
    #[inline(never)]
    pub(crate) fn roundings(&self, velocity: &[Rounded; N], some: Option<Rows>) -> f64 {
        let Self { rules, system, t0, h, state, q0, p0, a0, .. } = *self;
        let RoundedStep { d1, minus, residual: mut level } = rules.rounded(system, (t0, h), &q0, velocity);
        let momenta = from_fn(|i| {
            let conservative = d1[i] + p0[i];
            minus.map_or(conservative, |minus| conservative + minus[i])
        });
        let q1 = state.ahead(&velocity.map(|v| h * v.value));
        let end = from_fn(|i| Rounded { value: q1[i], size: q1[i].abs() + (h * velocity[i].value).abs() });
        if let Some(positions) = system.positions_rounded(Rounded::exact(t0 + h), &end) {
            level = from_fn(|k| positions[k].map_or(level[k], |g| g / h));
        }
        let solved = (0..M).filter(|k| some.is_none_or(|rows| rows.contains(*k)));
        most_roundings(without_reaction(&a0, momenta).into_iter().chain(solved.map(|k| level[k])))
    }

    /// The solution at the end of the branch that begins with a step of length zero.
    #[cold]
    #[inline(never)]
    fn followed(&self, newton: &Newton, positive: Option<bool>, turn: f64, v0: &[f64; N]) -> Option<[f64; N]> {
        branch::followed(v0, 0.5 * branch::NEAR / turn, |part, guess| {
            let within = Self { h: part * self.h, ..*self };
            let mut search = Corrections::new(&within);
            let found = newton.search(&mut search, guess).ok()?;
            (found.certain && search.continues(positive) && within.turn(guess) < PI).then_some(())
        })
    }

    #[inline(always)]
    fn turn(&self, v: &[f64; N]) -> f64 {
        branch::turn_of(self.system, (self.t0, self.h), &self.q0, v)
    }
}

impl<D, const N: usize, const M: usize> Clone for Increment<'_, D, N, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, const N: usize, const M: usize> Copy for Increment<'_, D, N, M> {}
