use super::{FoundMean, are_met, ends, searched, sup, with_reaction};
use crate::convergence::CorrectionKind;
use crate::convergence::tolerances::{SHRINKING, UNBIASED};
use crate::derivatives::{LEAST, StepDerivatives};
use crate::dla::{Dla, expected, predicted};
use crate::increment::{Departure, Increment};
use crate::newton::BlockEquations;
use crate::{Discretisation, Mechanics, State};
use lagrangian::linear::Singular;
use lagrangian::{Bordered, Rounded, from_fn, mapped};

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
        let (first, at, tolerance) = (at, increment.momenta(&moved), self.newton.tolerance);
        if size <= SMALL * large && are_met(&at.residual, (&a0, &lambda), &p0, (block, &moved), tolerance) {
            return Some((FoundMean { v: moved, lambda, corrections: LEAST }, with_reaction(ends(&at), &a0, &lambda)));
        }
        let both = ends(&first);
        let begun = Predicted {
            increment,
            block,
            bordered,
            tolerance,
            first: Some(d),
            lambda,
            both,
            known: Some(at),
            size,
            before: 0.0,
            moved: 0.0,
            change: 0.0,
            met: false,
        };
        // Destructured and rebuilt, so that the results above stay in registers: returned as it is, all would go through the memory in
        // which the call leaves its result.
        let (FoundMean { v, lambda, corrections }, p1) = begun.solved(v)?;
        Some((FoundMean { v, lambda, corrections }, p1))
    }
}

/// The equations of the mean velocity with a frozen Jacobian, of which the first correction is known.
struct Predicted<'a, D, const N: usize, const M: usize> {
    increment: Increment<'a, D, N, M>,
    block: &'a StepDerivatives,
    bordered: Bordered<N, M>,
    tolerance: f64,
    /// The first correction, before it is asked for.
    first: Option<[f64; N]>,
    /// The impulse that was solved for with the last correction.
    lambda: [f64; M],
    /// The sums of the momenta of both ends at the last point, and how much they changed from the point before.
    both: [f64; N],
    change: f64,
    /// The momenta after the first correction.
    known: Option<Departure<N>>,
    /// The sizes of the last two corrections, and of all before the last together.
    size: f64,
    before: f64,
    moved: f64,
    met: bool,
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> BlockEquations<N, 1> for Predicted<'_, D, N, M> {
    #[inline(always)]
    fn correction(&mut self, [v]: &[[f64; N]; 1]) -> Result<[[f64; N]; 1], Singular> {
        if let Some(d) = self.first.take() {
            return Ok([d]);
        }
        self.moved += self.size;
        let Increment { a0, p0, .. } = &self.increment;
        let at = self.known.take().unwrap_or_else(|| self.increment.momenta(v));
        let sums = ends(&at);
        self.change = sup(&difference(&sums, &self.both));
        self.both = sums;
        // After a correction the constraint is met up to its product with the distance from the place of its rows.
        let holds = self.moved * self.size <= (SMALL * sup(v)).powi(2);
        self.met = holds && are_met(&at.residual, (a0, &self.lambda), p0, (self.block, v), self.tolerance);
        let level = if holds { [0.0; M] } else { self.increment.level(v) };
        let left = with_reaction(at.residual, a0, &self.lambda);
        let (d, more) = self.bordered.solve(&self.block.times(&negative(&left)), &level);
        self.lambda = from_fn(|k| self.lambda[k] + more[k]);
        (self.before, self.size) = (self.size, sup(&d));
        Ok([d])
    }

    fn roundings(&self, [v]: &[[f64; N]; 1]) -> Option<f64> {
        Some(self.increment.roundings(&mapped(v, Rounded::once), None))
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

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Predicted<'_, D, N, M> {
    /// Iterates to convergence from the predictor `v`. Takes `self` by value, so that nothing of it must be in memory if the first
    /// correction is enough.
    #[inline(never)]
    fn solved(mut self, v: [f64; N]) -> Option<(FoundMean<N, M>, [f64; N])> {
        let mut all = [v];
        let corrections = searched(self.tolerance, &mut self, &mut all)?;
        let [v] = all;
        // If the equations at `v` are met, the momenta at the end are the sum of the momenta of both ends and the reaction. The last
        // correction changes that sum in proportion to its size, as the one before did.
        let both = match self.change * self.size > UNBIASED * self.before * sup(&self.both) {
            true => ends(&self.increment.momenta(&v)),
            false => self.both,
        };
        let lambda = self.lambda;
        Some((FoundMean { v, lambda, corrections }, with_reaction(both, &self.increment.a0, &lambda)))
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
