use crate::{Mechanics, SecondSlopes, Slopes};
use lagrangian::{ConstraintSlopes, Rounded, from_fn, mapped};

/// A configuration and a velocity at one time, with the impulse of the constraint there.
#[derive(Debug, Clone, Copy)]
pub struct StagePoint<const N: usize, const M: usize> {
    /// Time (s).
    pub t: f64,
    /// Configuration.
    pub q: [f64; N],
    /// Velocity.
    pub v: [f64; N],
    /// The impulses `h Lambda`, one for each row.
    pub impulse: [f64; M],
}

/// The terms of the equations of a step at one stage, with all first derivatives.
#[derive(Debug, Clone, Copy)]
pub struct LinearisedStage<const N: usize, const M: usize> {
    /// `p = L_v`.
    pub p: [f64; N],
    /// Its derivatives in `q`.
    pub p_q: [[f64; N]; N],
    /// Its derivatives in `v`.
    pub p_v: [[f64; N]; N],
    /// `w = h (L_q + F) + A' l`, with `l` the impulse of the constraint.
    pub w: [f64; N],
    /// Its derivatives in `q`.
    pub w_q: [[f64; N]; N],
    /// Its derivatives in `v`.
    pub w_v: [[f64; N]; N],
    /// `g = A v + b`, with `g_v = A`.
    pub g: [f64; M],
    /// Its derivatives in `q`.
    pub g_q: [[f64; N]; M],
    /// Its derivatives in `v`, the rows `A`.
    pub a: [[f64; N]; M],
}

/// `p`, `w`, `g` and `a` of [`LinearisedStage`], and the functions of constraints on positions, with bounds on their rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terms<const N: usize, const M: usize> {
    pub(super) p: [Rounded; N],
    pub(super) w: [Rounded; N],
    pub(super) g: [Rounded; M],
    pub(super) a: [[f64; N]; M],
    pub(super) positions: [Option<Rounded>; M],
}

impl<const N: usize, const M: usize> StagePoint<N, M> {
    /// `h (L_q + F) + A' l`.
    #[must_use]
    #[inline]
    pub fn gain(&self, system: &dyn Mechanics<N, M>, h: f64) -> [f64; N] {
        let Self { t, q, v, impulse } = self;
        let Slopes { l_q, force, .. } = system.slopes(*t, q, v);
        let (a, _) = system.constraint(*t, q);
        from_fn(|i| {
            let constrained: f64 = (0..M).map(|k| a[k][i] * impulse[k]).sum();
            h * (l_q[i] + force.map_or(0.0, |f| f[i])) + constrained
        })
    }

    /// The terms of the equations here, with bounds on their round-off; `way` is the sum of the sizes of the increments that led to the
    /// configuration.
    pub(super) fn terms(&self, system: &dyn Mechanics<N, M>, h: f64, way: &[f64; N]) -> Terms<N, M> {
        let t = Rounded::exact(self.t);
        let q: [Rounded; N] = from_fn(|i| Rounded { value: self.q[i], size: self.q[i].abs() + way[i] });
        let v = mapped(&self.v, Rounded::once);
        let l_q = system.slope_rounded(t, &q, &v);
        let force = system.force_rounded(t, &q, &v);
        let (a, b) = system.constraint_rounded(t, &q);
        let w = from_fn(|i| {
            let pushed = force.map_or(l_q[i], |force| l_q[i] + force[i]) * h;
            (0..M).fold(pushed, |sum, k| sum + a[k][i] * self.impulse[k])
        });
        let g = from_fn(|k| (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i]));
        let positions = system.positions_rounded(t, &q).unwrap_or([None; M]);
        Terms { p: system.momentum_rounded(t, &q, &v), w, g, a: mapped(&a, |row| mapped(&row, |x| x.value)), positions }
    }

    /// All that the equations need here, with its derivatives.
    #[must_use]
    #[inline]
    pub fn linearised(&self, system: &dyn Mechanics<N, M>, h: f64) -> LinearisedStage<N, M> {
        let Self { t, q, v, impulse } = self;
        let SecondSlopes { l_q, l_qq, l_qv: mixed, l_v: p, l_vv: p_v, force } = system.second_slopes(*t, q, v);

        let mut w = mapped(&l_q, |x| h * x);
        let mut w_q = mapped(&l_qq, |row| mapped(&row, |x| h * x));
        let mut w_v = mapped(&mixed, |row| mapped(&row, |x| h * x));
        if let Some([in_place, in_velocity]) = force {
            for i in 0..N {
                w[i] += h * in_place[i].re;
                w_q[i] = from_fn(|j| w_q[i][j] + h * in_place[i].eps[j]);
                w_v[i] = from_fn(|j| w_v[i][j] + h * in_velocity[i].eps[j]);
            }
        }

        let ConstraintSlopes { a, g, g_q } = system.constraint_slopes(*t, (q, v), impulse, (&mut w, &mut w_q));
        let p_q = from_fn(|i| from_fn(|j| mixed[j][i]));
        LinearisedStage { p, p_q, p_v, w, w_q, w_v, g, g_q, a }
    }
}
