use crate::{Dual, System};

/// The power `F . v` of the generalised forces (W); `None` where there are none.
#[inline]
pub fn force_power<Sys, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> Option<f64>
where
    Sys: System<N, M>,
{
    system.force(t, q, v).map(|force| (0..N).map(|i| force[i] * v[i]).sum())
}

/// The power `-dL/dt` at which explicit time feeds the energy `v . L_v - L` (W).
#[inline]
pub fn lagrangian_power<Sys, const N: usize, const M: usize>(system: &Sys, t: f64, q: &[f64; N], v: &[f64; N]) -> f64
where
    Sys: System<N, M>,
{
    let time = Dual { re: t, eps: [1.0] };
    -system.lagrangian(time, &q.map(Dual::fixed), &v.map(Dual::fixed)).eps[0]
}
