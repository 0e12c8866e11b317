use super::{InBasis, are_met, first, has_settled};
use crate::continued::{FoundMean, ends, with_reaction};
use crate::convergence::tolerances::{SHRINKING, SLIGHT};
use crate::dla::{Dla, predicted};
use crate::increment::{Departure, Increment};
use crate::kept::in_bases;
use crate::settle::{CORRECTIONS, LEAST, sup};
use crate::{Discretisation, Mechanics, State};
use lagrangian::{AdmissibleBasis, clear_multipliers, from_fn};

/// The mean quasi-velocities, `W(q0)' (p0 + D1 L_d + f_d^-) = 0` with `v = W xi` for the basis `W` of `w_d = 0`; and the momenta
/// `D2 L_d + f_d^+` at the end.
#[inline(always)]
pub(super) fn mean<D: Discretisation<N, M>, const N: usize, const M: usize>(
    method: &mut Dla<D>,
    system: &dyn Mechanics<N, M>,
    (t0, h): (f64, f64),
    state: &State<N>,
) -> Option<(InBasis<N, M>, [f64; N])> {
    let dimension = AdmissibleBasis::<f64, N, M>::DIMENSION;
    let way = predicted(state, h, method.kept.ways.next(h).map(first))?;
    let xi = first(method.kept.means.following(h)?);
    let rules = &method.rules;
    let (q0, v0) = (*state.q(), *state.v());
    // Momenta and rows are evaluated again: the system may have been changed since the last step.
    let (p0, (a0, w0)) = (system.momentum(t0, &q0, &v0), system.linear_basis(t0, &q0)?);
    let increment = Increment { rules, system, t0, h, state, q0, p0, a0, basis: None };
    let basis = |way: &[f64; N]| increment.rules.basis_along(system, (t0, h), &q0, way);
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
    // The correction of the mean velocity that places the nodes, plus the correction from the quasi-velocities.
    let size = sup(&from_fn::<f64, N, _>(|i| (v[i] - way[i]).abs() + (v[i] - guess[i]).abs()));
    let large = sup(&v);
    if size > SHRINKING * large {
        return None;
    }
    if block.suffice(size, large) {
        let result = with_impulse(&at, &a0, (v, xi), 1)?;
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
            // Each of the sums has two roundings.
            let same = || sup(&from_fn::<f64, N, _>(|i| both[i] - first[i])) <= 2.0 * f64::EPSILON * sup(&both);
            match corrections {
                LEAST => method.kept.block.have_sufficed(sized, large, same),
                _ => method.kept.block.have_not_sufficed(),
            }
            return with_impulse(&at, &a0, (v, xi), corrections);
        }
        let d = correction(&at);
        xi = from_fn(|a| xi[a] - d[a]);
        v = w.combine(&xi);
        let next = sup(&from_fn::<f64, N, _>(|i| v[i] - way[i]));
        let rounding = next <= SLIGHT * large;
        if rounding && has_settled(&d, &xi, &last, tolerance) {
            method.kept.block.have_not_sufficed();
            let at = increment.momenta_along(&way, &v);
            return with_impulse(&at, &a0, (v, xi), corrections);
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
    (v, xi): ([f64; N], [f64; N]),
    corrections: u32,
) -> Option<(InBasis<N, M>, [f64; N])> {
    let lambda = clear_multipliers(a0, &at.residual)?.map(|lambda| -lambda);
    Some((InBasis { found: FoundMean { v, lambda, corrections }, xi }, with_reaction(ends(at), a0, &lambda)))
}
