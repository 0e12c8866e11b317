//! The step in the basis of admissible velocities, `v = W xi`: there are no multipliers to eliminate, and the derivatives hardly change
//! where the basis turns with a body.

use super::{Found, ends, with_reaction};
use crate::State;
use crate::branch;
use crate::corrections::Departure;
use crate::derivatives::COORDINATES;
use crate::dla::{Dla, predicted};
use crate::increment::Increment;
use crate::kept::in_bases;
use crate::overshoot::brakes_only;
use crate::settle::{LEAST, SHRINKING, sup};
use crate::{StepReport, continued::ROUNDING};
use lagrangian::{
    AdmissibleBasis, DiscreteConstraint, DiscreteLagrangian, System, clear_multipliers, linear_basis, mass_matrix,
    momentum,
};
use std::array::from_fn;

/// More corrections are not worth it.
const CORRECTIONS: u32 = 8;

/// A velocity with its quasi-velocities, and the impulse of the constraints.
struct InBasis<const N: usize, const M: usize> {
    found: Found<N, M>,
    xi: [f64; N],
}

/// The quasi-velocities at first, with the velocities that they are near to.
#[inline(always)]
fn first<const N: usize>(row: [f64; COORDINATES]) -> [f64; N] {
    from_fn(|i| row[i])
}

// Twice in a build for any machine, as the loop over steps is (`drive_part`).
#[cfg_attr(not(target_feature = "avx2"), multiversion::multiversion(targets("x86_64+avx2+bmi1+bmi2+lzcnt")))]
#[inline(never)]
pub(super) fn going_on<L, C, Sys: System<N, M>, const N: usize, const M: usize>(
    method: &mut Dla<L, C>,
    system: &Sys,
    (t0, h): (f64, f64),
    state: &mut State<N>,
) -> Option<StepReport<M>>
where
    L: DiscreteLagrangian<Sys, N, M>,
    C: DiscreteConstraint<Sys, N, M>,
{
    let q0 = *state.q();
    let (InBasis { found: Found { v, lambda, corrections }, xi }, p1) = mean(method, system, (t0, h), state)?;
    if branch::turn(system, (t0, h), &q0, &v) > branch::NEAR {
        return None;
    }

    let d = v.map(|v| h * v);
    let (t1, q1) = (t0 + h, state.ahead(&d));
    let end = arrival(method, system, (t1, h, &q1), p1)?;
    let v1 = end.found.v;

    brakes_only(system, (t0, h), &q0, (&v, &v1)).ok()?;
    // One by one they would be waited for.
    if !(0..N).fold(true, |all, i| all & q1[i].is_finite() & v1[i].is_finite()) {
        return None;
    }
    let acceleration = from_fn(|i| (v1[i] - v[i]) * (2.0 / h));
    state.advance_with_acceleration(h, &d, v1, acceleration);
    method.kept.block.took_in_basis::<N>(corrections.max(LEAST));
    method.kept.mass.took_in_basis::<N>(end.found.corrections.max(LEAST));
    // Not the velocity of the state, which has just been stored and would be waited for.
    method.kept.ended_in_basis(h, (state.q(), &v1), [&xi, &end.xi]);
    Some(StepReport { impulses: [lambda, end.found.lambda], iterations: corrections, work: None })
}

/// The mean quasi-velocities, `W(q0)' (p0 + D1 L_d + f_d^-) = 0` with `v = W xi` for the basis `W` of `w_d = 0`; and the momenta
/// `D2 L_d + f_d^+ ` at the end.
#[inline(always)]
fn mean<L, C, Sys: System<N, M>, const N: usize, const M: usize>(
    method: &mut Dla<L, C>,
    system: &Sys,
    (t0, h): (f64, f64),
    state: &State<N>,
) -> Option<(InBasis<N, M>, [f64; N])>
where
    L: DiscreteLagrangian<Sys, N, M>,
    C: DiscreteConstraint<Sys, N, M>,
{
    let dimension = AdmissibleBasis::<f64, N, M>::DIMENSION;
    let (way, xi) = (predicted(state, h)?, first(method.kept.means.following(h)?));
    let rules = (&method.lagrangian, &method.constraint);
    let (q0, v0) = (*state.q(), *state.v());
    // Of the system as it is now, which may not be the one of the step before.
    let (p0, (a0, w0)) = (momentum(system, t0, &q0, &v0), linear_basis(system, t0, &q0)?);
    let increment = Increment { rules, system, t0, h, state, q0, p0, a0, basis: None };
    let basis = |way: &[f64; N]| increment.rules.1.basis_along(system, (t0, h), &q0, way);
    if method.kept.block.stale {
        let (_, block) = increment.linearised(&way);
        method.kept.block.renew(&in_bases(&block, &w0, &basis(&way)?))?;
    }
    let (block, tolerance) = (&method.kept.block, method.newton.tolerance);
    if block.positive != dimension.is_multiple_of(2) {
        return None;
    }
    let correction = |at: &Departure<N>| -> [f64; N] { block.times_first(dimension, &w0.products(&at.residual)) };

    let w = basis(&way)?;
    let guess = w.combine(&xi);
    let at = increment.momenta_along(&way, &guess);
    let d = correction(&at);
    let xi = from_fn(|a| xi[a] - d[a]);
    let v = w.combine(&xi);
    // Of the way, and of the quasi-velocities.
    let size = sup(&from_fn::<f64, N, _>(|i| (v[i] - way[i]).abs() + (v[i] - guess[i]).abs()));
    let large = sup(&v);
    if size > SHRINKING * large {
        return None;
    }
    if block.suffice(size, large) {
        let result = with_impulse(&at, &a0, Found { v, lambda: [0.0; M], corrections: 1 }, xi)?;
        method.kept.block.go_unseen();
        return Some(result);
    }

    let (first, sized) = (ends(&at), size);
    let (mut v, mut xi, mut size, mut last) = (v, xi, size, d);
    for corrections in LEAST..=CORRECTIONS {
        let way = v;
        let w = basis(&way)?;
        v = w.combine(&xi);
        let at = increment.momenta_along(&way, &v);
        let off = sup(&from_fn::<f64, N, _>(|i| v[i] - way[i]));
        if off <= tolerance * large && are_met(&w0, &at.residual, &p0, tolerance) {
            let both = ends(&at);
            // Each of the sums is rounded twice.
            let same = || sup(&from_fn::<f64, N, _>(|i| both[i] - first[i])) <= 2.0 * f64::EPSILON * sup(&both);
            match corrections {
                LEAST => method.kept.block.have_sufficed(sized, large, same),
                _ => method.kept.block.have_not_sufficed(),
            }
            return with_impulse(&at, &a0, Found { v, lambda: [0.0; M], corrections }, xi);
        }
        let d = correction(&at);
        xi = from_fn(|a| xi[a] - d[a]);
        v = w.combine(&xi);
        let next = sup(&from_fn::<f64, N, _>(|i| v[i] - way[i]));
        let rounding = next <= ROUNDING * large;
        if rounding && has_settled(&d, &xi, &last, tolerance) {
            method.kept.block.have_not_sufficed();
            let at = increment.momenta_along(&way, &v);
            return with_impulse(&at, &a0, Found { v, lambda: [0.0; M], corrections }, xi);
        }
        if !(next <= SHRINKING * size || rounding) {
            return None;
        }
        (size, last) = (next, d);
    }
    None
}

/// With the impulse of the constraints, `r + A' lambda = 0`, and the momenta at the end.
#[inline(always)]
fn with_impulse<const N: usize, const M: usize>(
    at: &Departure<N>,
    a0: &[[f64; N]; M],
    found: Found<N, M>,
    xi: [f64; N],
) -> Option<(InBasis<N, M>, [f64; N])> {
    let lambda = clear_multipliers(a0, &at.residual)?.map(|lambda| -lambda);
    Some((InBasis { found: Found { lambda, ..found }, xi }, with_reaction(ends(at), a0, &lambda)))
}

/// Whether corrections `d` of the quasi-velocities are within the tolerance, or, among rounding, shrink no more.
#[inline(always)]
fn has_settled<const N: usize>(d: &[f64; N], xi: &[f64; N], last: &[f64; N], tolerance: f64) -> bool {
    (0..N).fold(true, |all, a| {
        let size = d[a].abs();
        all & ((size <= tolerance * xi[a].abs()) | (size >= 0.25 * last[a].abs()))
    })
}

/// Whether `W' r = 0` to the rounding of momenta `p` that are among the terms of `r`.
#[inline(always)]
fn are_met<const N: usize, const M: usize>(
    basis: &AdmissibleBasis<f64, N, M>,
    r: &[f64; N],
    p: &[f64; N],
    tolerance: f64,
) -> bool {
    let missed = basis.products(r);
    let mut all = true;
    for (missed, w) in missed.iter().zip(basis.vectors()) {
        let size = (0..N).fold(0.0, |sum, i| sum + (w[i] * p[i]).abs());
        all &= missed.abs() <= tolerance * size;
    }
    all
}

/// The quasi-velocities at the end: `W(q1)' (L_v(q1, v1) - p1) = 0`, `v1 = W(q1) xi`.
#[inline(always)]
fn arrival<L, C, Sys: System<N, M>, const N: usize, const M: usize>(
    method: &mut Dla<L, C>,
    system: &Sys,
    (t1, h, q1): (f64, f64, &[f64; N]),
    p1: [f64; N],
) -> Option<InBasis<N, M>> {
    let dimension = AdmissibleBasis::<f64, N, M>::DIMENSION;
    let (a1, w1) = linear_basis(system, t1, q1)?;
    let mut xi: [f64; N] = first(method.kept.velocities.following(h)?);
    let mut v = w1.combine(&xi);
    if method.kept.mass.stale {
        let (_, mass) = mass_matrix(system, t1, q1, &v);
        method.kept.mass.renew(&in_bases(&mass, &w1, &w1))?;
    }
    let (mass, tolerance) = (&method.kept.mass, method.newton.tolerance);
    let rest = |v: &[f64; N]| -> [f64; N] {
        let p = momentum(system, t1, q1, v);
        from_fn(|i| p1[i] - p[i])
    };

    let (mut size, mut last) = (f64::INFINITY, [f64::INFINITY; N]);
    let mut left = rest(&v);
    for corrections in LEAST..=CORRECTIONS {
        let d = mass.times_first(dimension, &w1.products(&left));
        xi = from_fn(|a| xi[a] + d[a]);
        let before = v;
        v = w1.combine(&xi);
        left = rest(&v);
        let next = sup(&from_fn::<f64, N, _>(|i| v[i] - before[i]));
        let rounding = next <= ROUNDING * sup(&v);
        if are_met(&w1, &left, &p1, tolerance) || (rounding && has_settled(&d, &xi, &last, tolerance)) {
            // `L_v(q1, v1) - p1 = A(q1)' mu`.
            let lambda = clear_multipliers(&a1, &left)?.map(|mu| -mu);
            return Some(InBasis { found: Found { v, lambda, corrections }, xi });
        }
        if !(next <= SHRINKING * size || rounding) {
            return None;
        }
        (size, last) = (next, d);
    }
    None
}
