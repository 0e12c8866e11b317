use super::{InBasis, are_met, first, has_settled};
use crate::Mechanics;
use crate::continued::FoundMean;
use crate::convergence::tolerances::{SHRINKING, SLIGHT};
use crate::dla::Dla;
use crate::kept::in_bases;
use crate::settle::{CORRECTIONS, LEAST, sup};
use lagrangian::{AdmissibleBasis, clear_multipliers, from_fn};

/// The quasi-velocities at the end: `W(q1)' (L_v(q1, v1) - p1) = 0`, `v1 = W(q1) xi`.
#[inline(always)]
pub(super) fn arrival<D, const N: usize, const M: usize>(
    method: &mut Dla<D>,
    system: &dyn Mechanics<N, M>,
    (t1, h, q1): (f64, f64, &[f64; N]),
    p1: [f64; N],
) -> Option<InBasis<N, M>> {
    let dimension = AdmissibleBasis::<f64, N, M>::DIMENSION;
    let (a1, w1) = system.linear_basis(t1, q1)?;
    let mut xi: [f64; N] = first(method.kept.ends.following(h)?);
    let mut v = w1.combine(&xi);
    if method.kept.mass.stale {
        let (_, mass) = system.mass_matrix(t1, q1, &v);
        method.kept.mass.renew(&in_bases(&mass, &w1, &w1))?;
    }
    let (mass, tolerance) = (&method.kept.mass, method.newton.tolerance);
    let rest = |v: &[f64; N]| -> [f64; N] {
        let p = system.momentum(t1, q1, v);
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
        let rounding = next <= SLIGHT * sup(&v);
        if are_met(&w1, &left, &p1, tolerance) || (rounding && has_settled(&d, &xi, &last, tolerance)) {
            // `L_v(q1, v1) - p1 = A(q1)' mu`.
            let lambda = clear_multipliers(&a1, &left)?.map(|mu| -mu);
            return Some(InBasis { found: FoundMean { v, lambda, corrections }, xi });
        }
        if !(next <= SHRINKING * size || rounding) {
            return None;
        }
        (size, last) = (next, d);
    }
    None
}
