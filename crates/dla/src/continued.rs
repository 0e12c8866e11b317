//! A step that goes on from the last one: its search begins with the derivatives that were kept, and with rows of its own.

use crate::branch;
use crate::dla::{Dla, predicted};
use crate::increment::Increment;
use crate::overshoot::brakes_only;
use crate::{State, StepReport};
use lagrangian::linear::largest;
use lagrangian::{Bordered, DiscreteConstraint, DiscreteLagrangian, System, mass_matrix, momentum};
use std::array::from_fn;

/// Corrections shrink by at least as much, or the derivatives are no longer good enough.
const SHRINKING: f64 = 0.125;

/// Corrections below this part of the velocity are taken for rounding where they do not shrink. Where rounding is larger, the
/// general search sees it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The square of a correction that is smaller, relative to the velocity, is below all rounding.
const SMALL: f64 = 1e-10;

/// Improves `x` until every component is settled by the rule of [`Newton`](crate::Newton) for simplified corrections, the first of which
/// is no larger than the given size; and says in how many. None where they do not shrink as they should.
#[inline(always)]
fn settle<const N: usize>(
    tolerance: f64,
    most: f64,
    exact: bool,
    x: &mut [f64; N],
    mut correction: impl FnMut(&[f64; N]) -> [f64; N],
) -> Option<u32> {
    /// More are not worth it.
    const CORRECTIONS: u32 = 8;
    let (mut last, mut allowed) = ([f64::INFINITY; N], most);
    for made in 1..=CORRECTIONS {
        let d = correction(x);
        for i in 0..N {
            x[i] += d[i];
        }
        let size = sup(&d);
        let rounding = size <= ROUNDING * sup(x);
        if !(size <= allowed || rounding) {
            return None;
        }
        let mut settled = true;
        for i in 0..N {
            let (d, size) = (d[i].abs(), tolerance * x[i].abs());
            let predicted = made > 1 && d <= x[i].abs() && 2.0 * d * d <= size * last[i];
            let rounded = rounding && d >= 0.25 * last[i];
            settled &= d <= size || predicted || rounded;
            last[i] = d;
        }
        if settled || exact {
            return Some(made);
        }
        allowed = SHRINKING * size;
    }
    None
}

/// The size of the largest component, of numbers.
#[inline(always)]
fn sup<const N: usize>(x: &[f64; N]) -> f64 {
    x.iter().fold(0.0, |most, x| f64::max(most, x.abs()))
}

/// `x + A' lambda`.
#[inline(always)]
fn pushed<const N: usize, const M: usize>(mut x: [f64; N], a: &[[f64; N]; M], lambda: &[f64; M]) -> [f64; N] {
    for k in 0..M {
        for i in 0..N {
            x[i] += a[k][i] * lambda[k];
        }
    }
    x
}

impl<L, C> Dla<L, C> {
    /// The step in its general form where it goes on from the last one; none where it does not.
    #[inline(always)]
    pub(crate) fn continued_step<Sys: System<N, M>, const N: usize, const M: usize>(
        &mut self,
        system: &Sys,
        t0: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Option<StepReport<M>>
    where
        L: DiscreteLagrangian<Sys, N, M>,
        C: DiscreteConstraint<Sys, N, M>,
    {
        let (p0, a0) = self.kept.goes_on(state)?;
        let report = self.going_on(system, (t0, h), state, p0, a0);
        match report {
            Some(_) => self.kept.succeeds(),
            None => self.kept.fails(),
        }
        report
    }

    #[inline(never)]
    fn going_on<Sys: System<N, M>, const N: usize, const M: usize>(
        &mut self,
        system: &Sys,
        (t0, h): (f64, f64),
        state: &mut State<N>,
        p0: [f64; N],
        a0: [[f64; N]; M],
    ) -> Option<StepReport<M>>
    where
        L: DiscreteLagrangian<Sys, N, M>,
        C: DiscreteConstraint<Sys, N, M>,
    {
        let (q0, v0) = (*state.q(), *state.v());
        let mut v = predicted(state, h)?;
        let rules = (&self.lagrangian, &self.constraint);
        let increment = Increment { rules, system, t0, h, state, q0, p0, a0, basis: None };

        // The increment, by rows of its own.
        let mut at = if self.kept.block.stale {
            let (at, block) = increment.linearised(&v);
            self.kept.block.renew(&block).ok()?;
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
        let mut first = true;
        let (mut lambda, mut both, mut change) = ([0.0; M], [0.0; N], 0.0);
        let (mut size, mut before, mut moved) = (0.0, 0.0, 0.0);
        let most = SHRINKING * largest(&v);
        let made = settle(
            self.newton.tolerance,
            most,
            false,
            &mut v,
            #[inline(always)]
            |v| {
                if !first {
                    at = increment.momenta(v);
                    // A correction meets the constraint but for its product with the way to the rows.
                    let met = moved * size <= (SMALL * sup(v)).powi(2);
                    level = if met { [0.0; M] } else { increment.level(v) };
                }
                first = false;
                let (d, l) = bordered.solve(&block.times(&at.residual.map(|r| -r)), &level);
                let ends: [f64; N] = from_fn(|i| at.residual[i] + at.arriving[i]);
                change = sup(&from_fn::<_, N, _>(|i| ends[i] - both[i]));
                (lambda, both, before, size) = (l, ends, size, sup(&d));
                moved += size;
                d
            },
        )?;
        if branch::turn(system, (t0, h), &q0, &v) > branch::NEAR {
            return None;
        }
        // The equations hold at `v`: what the momenta at both ends sum to is all that the last correction has changed.
        if change * size > f64::EPSILON * before * sup(&both) {
            let at = increment.momenta(&v);
            both = from_fn(|i| at.residual[i] + at.arriving[i]);
        }
        let p1 = pushed(both, &a0, &lambda);

        // The momentum at the end, projected onto the constraint there.
        let d = v.map(|v| h * v);
        let (t1, q1) = (t0 + h, state.ahead(&d));
        let mut v1: [f64; N] = match self.kept.velocities.next(h) {
            Some(expected) if !self.kept.constant => from_fn(|i| expected[i]),
            _ => from_fn(|i| 2.0 * v[i] - v0[i]),
        };
        let mut p = if self.kept.mass.stale {
            let (p, matrix) = mass_matrix(system, t1, &q1, &v1);
            self.kept.mass.renew(&matrix).ok()?;
            p
        } else {
            momentum(system, t1, &q1, &v1)
        };
        let mass = &self.kept.mass;
        let (a1, b1) = system.constraint(t1, &q1);
        let bordered = Bordered::new(
            #[inline(always)]
            |x| mass.times(x),
            &a1,
            &a1,
        )
        .ok()?;
        let mut first = true;
        let mut minus_mu = [0.0; M];
        let project = |v1: &[f64; N]| {
            if !first {
                p = momentum(system, t1, &q1, v1);
            }
            first = false;
            let slip: [f64; M] = from_fn(|k| -(0..N).fold(b1[k], |sum, i| sum + a1[k][i] * v1[i]));
            let (d, l) = bordered.solve(&mass.times(&from_fn(|i| p1[i] - p[i])), &slip);
            minus_mu = l;
            d
        };
        let projected = settle(self.newton.tolerance, largest(&v), self.kept.constant, &mut v1, project)?;
        let mu = minus_mu.map(|m| -m);

        brakes_only(system, (t0, h), &q0, (&v, &v1)).ok()?;
        if !(0..N).fold(true, |all, i| all & q1[i].is_finite() & v1[i].is_finite()) {
            return None;
        }
        let acceleration = from_fn(|i| (v1[i] - v[i]) * (2.0 / h));
        state.advance_with_acceleration(h, &d, v1, acceleration);
        self.kept.block.took::<N>(made);
        self.kept.mass.took::<N>(projected);
        self.kept.ended(h, state, &pushed(p1, &a1, &mu), &a1);
        Some(StepReport { impulses: [lambda, mu], iterations: made, work: None })
    }
}
