use super::{FoundMean, are_met, ends, with_reaction};
use crate::convergence::tolerances::SHRINKING;
use crate::derivatives::StepDerivatives;
use crate::dla::{Dla, expected, predicted};
use crate::increment::{Departure, Increment};
use crate::settle::{LEAST, Settle, sup};
use crate::{Discretisation, Mechanics, State};
use lagrangian::{Bordered, from_fn};

/// The square of a correction that is smaller, relative to the velocity, is below round-off.
const SMALL: f64 = 1e-9;

impl<D> Dla<D> {
    /// The mean velocity `v`, `p0 + D1 L_d + f_d^- + A(q0)' lambda = 0`, `w_d = 0`; and the momenta `D2 L_d + f_d^+` at the end.
    #[inline(always)]
    pub(super) fn mean<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t0, h): (f64, f64),
        state: &State<N>,
    ) -> Option<(FoundMean<N, M>, [f64; N])>
    where
        D: Discretisation<N, M>,
    {
        let v = predicted(state, h, expected(state, h))?;
        let rules = &self.rules;
        let (q0, v0) = (*state.q(), state.v());
        // Momenta and rows are evaluated again: the system may have been changed since the last step.
        let (p0, (a0, _)) = system.momentum_and_rows(t0, &q0, v0);
        let increment = Increment { rules, system, t0, h, state, q0, p0, a0, basis: None };
        let at = if self.kept.block.stale {
            let (at, block) = increment.linearised(&v);
            self.kept.block.renew(&block)?;
            at
        } else {
            increment.momenta(&v)
        };
        let block = &self.kept.block;
        let (rows, level) = increment.rows(&v);
        let bordered = Bordered::clear(
            #[inline(always)]
            |x| block.times(x),
            &a0,
            &rows,
        )?;
        if !bordered.is_as_at_rest(block.positive) {
            return None;
        }

        let (d, lambda) = bordered.solve(&block.times(&negative(&at.residual)), &level);
        let moved = from_fn(|i| v[i] + d[i]);
        let (size, large) = (sup(&d), sup(&moved));
        if size > SHRINKING * large {
            return None;
        }
        if block.suffice(size, large) {
            self.kept.block.go_unseen();
            return Some((FoundMean { v: moved, lambda, corrections: 1 }, with_reaction(ends(&at), &a0, &lambda)));
        }
        let (first, at, tolerance) = (at, increment.momenta(&moved), self.newton.tolerance);
        if size <= SMALL * large && are_met(&at.residual, &a0, &lambda, &p0, tolerance) {
            let both = ends(&at);
            // Each of the sums has two roundings.
            let same = || sup(&difference(&both, &ends(&first))) <= 2.0 * f64::EPSILON * sup(&both);
            self.kept.block.have_sufficed(size, large, same);
            return Some((FoundMean { v: moved, lambda, corrections: LEAST }, with_reaction(both, &a0, &lambda)));
        }
        let begun = Begun { increment, block, bordered, tolerance, v: moved, d, lambda, first, at };
        // Destructured and rebuilt, so that the results above stay in registers: returned as it is, all would go through the memory in
        // which the call leaves its result.
        let (FoundMean { v, lambda, corrections }, p1) = begun.settled()?;
        self.kept.block.have_not_sufficed();
        Some((FoundMean { v, lambda, corrections }, p1))
    }
}

/// The iteration after its first correction.
struct Begun<'a, D, const N: usize, const M: usize> {
    increment: Increment<'a, D, N, M>,
    block: &'a StepDerivatives,
    bordered: Bordered<N, M>,
    tolerance: f64,
    v: [f64; N],
    /// The first correction, the impulse that was solved for with it, and the momenta from which it was made.
    d: [f64; N],
    lambda: [f64; M],
    first: Departure<N>,
    /// The momenta at `v`.
    at: Departure<N>,
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Begun<'_, D, N, M> {
    /// Iterates to convergence. Takes `self` by value, so that nothing of it must be in memory if the first correction is enough.
    #[inline(never)]
    fn settled(self) -> Option<(FoundMean<N, M>, [f64; N])> {
        let Self { increment, block, bordered, tolerance, mut v, d, mut lambda, first, at } = self;
        let Increment { a0, p0, .. } = increment;
        let (mut both, mut size, mut known) = (ends(&first), sup(&d), Some(at));
        let (mut change, mut before, mut moved) = (0.0, 0.0, size);
        let corrections = Settle { tolerance, first: d }.search(
            &mut v,
            #[inline(always)]
            |v| {
                let at = known.take().unwrap_or_else(|| increment.momenta(v));
                let sums = ends(&at);
                change = sup(&difference(&sums, &both));
                both = sums;
                // After a correction the constraint is met up to its product with the distance from the place of its rows.
                let met = moved * size <= (SMALL * sup(v)).powi(2);
                if met && are_met(&at.residual, &a0, &lambda, &p0, tolerance) {
                    change = 0.0;
                    return None;
                }
                let level = if met { [0.0; M] } else { increment.level(v) };
                let d;
                (d, lambda) = bordered.solve(&block.times(&negative(&at.residual)), &level);
                (before, size) = (size, sup(&d));
                moved += size;
                Some(d)
            },
        )?;
        // If the equations at `v` are met, the momenta at the end are the sum of the momenta of both ends and the reaction. The last
        // correction changes that sum in proportion to its size, as the one before did.
        if change * size > f64::EPSILON * before * sup(&both) {
            both = ends(&increment.momenta(&v));
        }
        Some((FoundMean { v, lambda, corrections }, with_reaction(both, &a0, &lambda)))
    }
}

#[inline(always)]
fn difference<const N: usize>(x: &[f64; N], y: &[f64; N]) -> [f64; N] {
    from_fn(|i| x[i] - y[i])
}

// A loop, since the compiler does not inline `map` over more than a few.
#[inline(always)]
fn negative<const N: usize>(x: &[f64; N]) -> [f64; N] {
    let mut minus = *x;
    for x in &mut minus {
        *x = -*x;
    }
    minus
}
