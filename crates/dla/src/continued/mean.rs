use super::Found;
use crate::State;
use crate::dla::{Dla, predicted};
use crate::increment::Increment;
use crate::settle::{SHRINKING, Settle, sup};
use lagrangian::{Bordered, DiscreteConstraint, DiscreteLagrangian, System, momentum};
use std::array::from_fn;

impl<L, C> Dla<L, C> {
    /// The mean velocity `v`, `p0 + D1 L_d + f_d^- + A(q0)' lambda = 0`, `w_d = 0`; and the momenta `D2 L_d + f_d^+` at the end.
    #[inline(always)]
    pub(super) fn mean<Sys: System<N, M>, const N: usize, const M: usize>(
        &mut self,
        system: &Sys,
        (t0, h): (f64, f64),
        state: &State<N>,
    ) -> Option<(Found<N, M>, [f64; N])>
    where
        L: DiscreteLagrangian<Sys, N, M>,
        C: DiscreteConstraint<Sys, N, M>,
    {
        /// The square of a correction that is smaller, relative to the velocity, is below all rounding.
        const SMALL: f64 = 1e-9;
        let mut v = predicted(state, h)?;
        let rules = (&self.lagrangian, &self.constraint);
        let (q0, v0) = (*state.q(), state.v());
        // Of the system as it is now, which may not be the one of the step before.
        let (p0, (a0, _)) = (momentum(system, t0, &q0, v0), system.constraint(t0, &q0));
        let increment = Increment { rules, system, t0, h, state, q0, p0, a0, basis: None };
        let mut at = if self.kept.block.stale {
            let (at, block) = increment.linearised(&v);
            self.kept.block.renew(&block)?;
            at
        } else {
            increment.momenta(&v)
        };
        let block = &self.kept.block;
        let (rows, mut level) = increment.rows(&v);
        let bordered = Bordered::new(
            #[inline(always)]
            |x| block.times(x),
            &a0,
            &rows,
        )
        .ok()?;
        if !bordered.is_as_at_rest(block.positive) || !bordered.is_clear() {
            return None;
        }

        let (mut lambda, mut both, mut change) = ([0.0; M], [0.0; N], 0.0);
        let (mut first, mut size, mut before, mut moved) = (true, 0.0, 0.0, 0.0);
        let settle = Settle { tolerance: self.newton.tolerance, most: SHRINKING * sup(&v) };
        let corrections = settle.search(
            &mut v,
            #[inline(always)]
            |v| {
                if !first {
                    at = increment.momenta(v);
                    // A correction meets the constraint but for its product with the way from where the rows are.
                    let met = moved * size <= (SMALL * sup(v)).powi(2);
                    level = if met { [0.0; M] } else { increment.level(v) };
                }
                let d;
                (d, lambda) = bordered.solve(&block.times(&at.residual.map(|r| -r)), &level);
                let ends: [f64; N] = from_fn(|i| at.residual[i] + at.arriving[i]);
                change = sup(&from_fn::<_, N, _>(|i| ends[i] - both[i]));
                (first, both, before, size) = (false, ends, size, sup(&d));
                moved += size;
                d
            },
        )?;
        // With the equations at `v` met, the momenta at the end are what those at both ends sum to, and the impulse: of that the
        // last correction changes as much in its size as the one before.
        if change * size > f64::EPSILON * before * sup(&both) {
            let at = increment.momenta(&v);
            both = from_fn(|i| at.residual[i] + at.arriving[i]);
        }
        for k in 0..M {
            for i in 0..N {
                both[i] += a0[k][i] * lambda[k];
            }
        }
        Some((Found { v, lambda, corrections }, both))
    }
}
