use super::{FoundMean, are_met, constraint_holds, searched, sup, with_reaction};
use crate::convergence::CorrectionKind;
use crate::convergence::tolerances::SLIGHT;
use crate::derivatives::{LEAST, StepDerivatives};
use crate::dla::Dla;
use crate::newton::BlockEquations;
use crate::projection::Projection;
use crate::{Equations, Mechanics};
use lagrangian::linear::Singular;
use lagrangian::{Bordered, from_fn, mapped};

impl<D> Dla<D> {
    /// The velocity `v1` at the end: `L_v(q1, v1) = p1 + A(q1)' mu`, `A(q1) v1 + b(q1) = 0`.
    #[inline(always)]
    pub(super) fn arrival<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t1, q1): (f64, &[f64; N]),
        p1: [f64; N],
        guess: [f64; N],
    ) -> Option<FoundMean<N, M>> {
        let (p, (a1, b1)) = if self.kept.mass.stale {
            let (p, mass) = system.mass_matrix(t1, q1, &guess);
            self.kept.mass.renew(&mass)?;
            (p, system.constraint(t1, q1))
        } else {
            system.momentum_and_rows(t1, q1, &guess)
        };
        let mass = &self.kept.mass;
        let bordered = Bordered::clear(
            #[inline(always)]
            |x| mass.times(x),
            &a1,
            &a1,
        )?;
        let (tolerance, minus_mu) = (self.newton.tolerance, [0.0; M]);
        let (first, known) = (None, None);
        let mut here =
            Here { system, t1, q1: *q1, p1, a1, b1, mass, bordered, tolerance, first, known, minus_mu, met: false };

        let (d, minus_mu) = here.corrected(&guess, &p);
        let v = from_fn(|i| guess[i] + d[i]);
        if sup(&d) > sup(&guess) {
            return None;
        }
        let p = system.momentum(t1, q1, &v);
        if here.is_solution(&v, &p, &minus_mu, SLIGHT) {
            // What the frozen mass matrix leaves out has one sign in every step, and would add up.
            let (rest, _) = here.corrected(&v, &with_reaction(p, &here.a1, &minus_mu));
            let v = from_fn(|i| v[i] + rest[i]);
            return Some(FoundMean { v, lambda: mapped(&minus_mu, |m| -m), corrections: LEAST });
        }
        (here.first, here.known, here.minus_mu) = (Some(d), Some(p), minus_mu);
        // Destructured and rebuilt, so that the results above stay in registers: returned as it is, all would go through the memory in
        // which the call leaves its result.
        let FoundMean { v, lambda, corrections } = here.solved(guess)?;
        Some(FoundMean { v, lambda, corrections })
    }
}

/// The equations at the end.
struct Here<'a, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    t1: f64,
    q1: [f64; N],
    p1: [f64; N],
    a1: [[f64; N]; M],
    b1: [f64; M],
    mass: &'a StepDerivatives,
    bordered: Bordered<N, M>,
    tolerance: f64,
    /// The first correction, and the momenta after it, before they are asked for.
    first: Option<[f64; N]>,
    known: Option<[f64; N]>,
    /// `-mu`, solved for with the last correction.
    minus_mu: [f64; M],
    met: bool,
}

impl<const N: usize, const M: usize> Here<'_, N, M> {
    /// The correction of a velocity `v` that has the momenta `p`, and `-mu`.
    #[inline(always)]
    fn corrected(&self, v: &[f64; N], p: &[f64; N]) -> ([f64; N], [f64; M]) {
        let Self { p1, a1, b1, mass, bordered, .. } = self;
        let slip: [f64; M] = from_fn(|k| -(0..N).fold(b1[k], |sum, i| sum + a1[k][i] * v[i]));
        bordered.solve(&mass.times(&from_fn(|i| p1[i] - p[i])), &slip)
    }

    /// Whether the velocity `v`, which has the momenta `p`, is the solution with `mu`. The rounding of a large reaction may be more than the
    /// rounding of the terms of a constraint on small velocities: a second correction, made without the reaction that is known, removes it.
    #[inline(always)]
    fn is_solution(&self, v: &[f64; N], p: &[f64; N], minus_mu: &[f64; M], within: f64) -> bool {
        let rest = from_fn(|i| p[i] - self.p1[i]);
        constraint_holds((&self.a1, &self.b1), v, within)
            && are_met(&rest, (&self.a1, minus_mu), &self.p1, (self.mass, v), self.tolerance)
    }

    /// Iterates to convergence from the guess `v`. Takes `self` by value, so that nothing of it must be in memory if the first correction
    /// is enough.
    #[inline(never)]
    fn solved(mut self, v: [f64; N]) -> Option<FoundMean<N, M>> {
        let mut all = [v];
        let corrections = searched(self.tolerance, &mut self, &mut all)?;
        let [v] = all;
        constraint_holds((&self.a1, &self.b1), &v, SLIGHT).then(|| FoundMean {
            v,
            lambda: mapped(&self.minus_mu, |m| -m),
            corrections,
        })
    }
}

impl<const N: usize, const M: usize> BlockEquations<N, 1> for Here<'_, N, M> {
    #[inline(always)]
    fn correction(&mut self, [v]: &[[f64; N]; 1]) -> Result<[[f64; N]; 1], Singular> {
        if let Some(d) = self.first.take() {
            return Ok([d]);
        }
        let p = self.known.take().unwrap_or_else(|| self.system.momentum(self.t1, &self.q1, v));
        self.met = self.is_solution(v, &p, &self.minus_mu, 0.5 * self.tolerance);
        let (d, more) = self.corrected(v, &with_reaction(p, &self.a1, &self.minus_mu));
        self.minus_mu = from_fn(|k| self.minus_mu[k] + more[k]);
        Ok([d])
    }

    fn roundings(&self, [v]: &[[f64; N]; 1]) -> Option<f64> {
        Projection::new(self.system, self.t1, self.q1, self.p1, None).roundings(v)
    }

    #[inline(always)]
    fn kind(&self) -> CorrectionKind {
        CorrectionKind::Frozen
    }

    #[inline(always)]
    fn is_met(&self) -> bool {
        self.met
    }
}
