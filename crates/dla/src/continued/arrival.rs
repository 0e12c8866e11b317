use super::{FoundMean, are_met, constraint_holds};
use crate::Mechanics;
use crate::derivatives::StepDerivatives;
use crate::dla::Dla;
use crate::settle::{LEAST, Settle, sup};
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
        let here = Here { system, t1, q1: *q1, p1, a1, b1, mass, bordered, tolerance: self.newton.tolerance };

        let (d, minus_mu) = here.correction(&guess, &p);
        let v = from_fn(|i| guess[i] + d[i]);
        let (size, large) = (sup(&d), sup(&guess));
        if size > large {
            return None;
        }
        // Rounding of a large impulse in a light coordinate, or of a large velocity in rows that look at small ones, is more than the rounding
        // of the terms of the constraint: a second correction removes it.
        let holds = constraint_holds(&here.a1, &here.b1, &v);
        if holds && mass.suffice(size, large) {
            self.kept.mass.go_unseen();
            return Some(FoundMean { v, lambda: mapped(&minus_mu, |m| -m), corrections: 1 });
        }
        let p = system.momentum(t1, q1, &v);
        if holds && here.is_met(&p, &minus_mu) {
            self.kept.mass.have_sufficed(size, large, || true);
            return Some(FoundMean { v, lambda: mapped(&minus_mu, |m| -m), corrections: LEAST });
        }
        // Destructured and rebuilt, so that the results above stay in registers: returned as it is, all would go through the memory in
        // which the call leaves its result.
        let FoundMean { v, lambda, corrections } = here.settled(v, p, d)?;
        self.kept.mass.have_not_sufficed();
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
}

impl<const N: usize, const M: usize> Here<'_, N, M> {
    /// The correction of a velocity `v` that has the momenta `p`, and `-mu`.
    #[inline(always)]
    fn correction(&self, v: &[f64; N], p: &[f64; N]) -> ([f64; N], [f64; M]) {
        let Self { p1, a1, b1, mass, bordered, .. } = self;
        let slip: [f64; M] = from_fn(|k| -(0..N).fold(b1[k], |sum, i| sum + a1[k][i] * v[i]));
        bordered.solve(&mass.times(&from_fn(|i| p1[i] - p[i])), &slip)
    }

    /// Whether a velocity that has the momenta `p`, and meets the constraint, is the solution with `mu`.
    #[inline(always)]
    fn is_met(&self, p: &[f64; N], minus_mu: &[f64; M]) -> bool {
        are_met(&from_fn(|i| p[i] - self.p1[i]), &self.a1, minus_mu, &self.p1, self.tolerance)
    }

    /// Iterates to convergence, after the correction `d` to `v`, which has the momenta `p`. Takes `self` by value, so that nothing of it
    /// must be in memory if the first correction is enough.
    #[inline(never)]
    fn settled(self, mut v: [f64; N], p: [f64; N], d: [f64; N]) -> Option<FoundMean<N, M>> {
        let (mut known, mut minus_mu) = (Some(p), [0.0; M]);
        let corrections = Settle { tolerance: self.tolerance, first: d }.search(
            &mut v,
            #[inline(always)]
            |v| {
                let d;
                (d, minus_mu) = match known.take() {
                    Some(p) => self.correction(v, &p),
                    None => {
                        let p = self.system.momentum(self.t1, &self.q1, v);
                        if self.is_met(&p, &minus_mu) && constraint_holds(&self.a1, &self.b1, v) {
                            return None;
                        }
                        self.correction(v, &p)
                    }
                };
                Some(d)
            },
        )?;
        if !constraint_holds(&self.a1, &self.b1, &v) {
            return None;
        }
        Some(FoundMean { v, lambda: mapped(&minus_mu, |m| -m), corrections })
    }
}
