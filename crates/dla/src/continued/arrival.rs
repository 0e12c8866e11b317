use super::Found;
use crate::dla::Dla;
use crate::settle::{Settle, sup};
use lagrangian::{Bordered, System, mass_matrix, momentum};
use std::array::from_fn;

impl<L, C> Dla<L, C> {
    /// The velocity `v1` at the end: `L_v(q1, v1) = p1 + A(q1)' mu`, `A(q1) v1 + b(q1) = 0`.
    #[inline(always)]
    pub(super) fn arrival<Sys: System<N, M>, const N: usize, const M: usize>(
        &mut self,
        system: &Sys,
        (t1, q1): (f64, &[f64; N]),
        p1: [f64; N],
        guess: [f64; N],
    ) -> Option<Found<N, M>> {
        let mut v = guess;
        let (a1, b1) = system.constraint(t1, q1);
        let mut p = if self.kept.mass.stale {
            let (p, mass) = mass_matrix(system, t1, q1, &v);
            self.kept.mass.renew(&mass)?;
            p
        } else {
            momentum(system, t1, q1, &v)
        };
        let mass = &self.kept.mass;
        let bordered = Bordered::new(
            #[inline(always)]
            |x| mass.times(x),
            &a1,
            &a1,
        )
        .ok()?;

        if !bordered.is_clear() {
            return None;
        }
        let (mut first, mut minus_mu) = (true, [0.0; M]);
        let settle = Settle { tolerance: self.newton.tolerance, most: sup(&v) };
        let corrections = settle.search(
            &mut v,
            #[inline(always)]
            |v| {
                if !first {
                    p = momentum(system, t1, q1, v);
                }
                first = false;
                let slip: [f64; M] = from_fn(|k| -(0..N).fold(b1[k], |sum, i| sum + a1[k][i] * v[i]));
                let d;
                (d, minus_mu) = bordered.solve(&mass.times(&from_fn(|i| p1[i] - p[i])), &slip);
                d
            },
        )?;
        Some(Found { v, lambda: minus_mu.map(|m| -m), corrections })
    }
}
