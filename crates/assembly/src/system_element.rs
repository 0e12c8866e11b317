use crate::element::{Element, ElementBlocks, local};
use dla::NotANumber;
use lagrangian::linear::larger;
use lagrangian::{
    DiscreteConstraint, DiscreteLagrangian, Dual, Midpoint, Motion, Rounded, Saddle, System, configuration_slope,
    constraint_residual, energy, force_power, from_fn, lagrangian_power, mass_matrix, momentum, position_misses,
    position_residual, reaction_rows, rows_along, velocity_slope,
};
use std::fmt;

/// Any static system as an element, with the midpoint rule for its discrete Lagrangian and constraint.
pub(crate) struct SystemElement<Sys, const N: usize, const M: usize> {
    pub(crate) system: Sys,
}

impl<Sys, const N: usize, const M: usize> fmt::Debug for SystemElement<Sys, N, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "system of {N} coordinates and {M} constraints")
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> SystemElement<Sys, N, M> {
    /// The equations for the mean velocity without their derivatives.
    fn residual(
        &self,
        (t0, h): (f64, f64),
        (q0, q1): (&[f64; N], &[f64; N]),
        v: &[f64; N],
        out: &mut ElementBlocks<'_>,
    ) {
        let system = &self.system;
        // D1 of L_d / h in units of h, as in `DiscreteLagrangian::derivatives`: q0 = h a, v = b - a.
        let along = |re: f64, i: usize, slope: f64| {
            let eps = from_fn(|k| if k == i { slope } else { 0.0 });
            Dual { re, eps }
        };
        let (a, b): ([Dual<f64, N>; N], [Dual<f64, N>; N]) =
            (from_fn(|i| along(q0[i], i, h)), from_fn(|i| along(v[i], i, -1.0)));
        let l = DiscreteLagrangian::<Sys, N, M>::average(&Midpoint, system, Dual::fixed(t0), Dual::fixed(h), &a, &b);
        let mut residual = l.eps;
        let forces = DiscreteLagrangian::<Sys, N, M>::forces(&Midpoint, system, t0, h, q0, v);
        if let Some((minus, _)) = forces {
            residual = from_fn(|i| residual[i] + minus[i]);
        }
        let w_d: [f64; M] = DiscreteConstraint::residual(&Midpoint, system, t0, h, q0, v);
        let mut level = w_d.map(|w| -w);
        if let Some(positions) = position_misses(system, t0 + h, q1) {
            level = from_fn(|k| positions[k].map_or(level[k], |g| -g.re / h));
        }
        out.momentum.copy_from_slice(&residual);
        out.level.copy_from_slice(&level);
    }
}

impl<Sys: System<N, M> + Send + Sync, const N: usize, const M: usize> Element for SystemElement<Sys, N, M> {
    fn size(&self) -> (usize, usize) {
        (N, M)
    }

    fn acts(&self) -> bool {
        true
    }

    fn angles(&self, angles: &mut [bool]) {
        angles.copy_from_slice(&self.system.angles());
    }

    fn beginning(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let (q, v) = (local(q), local(v));
        out.momentum.copy_from_slice(&momentum(&self.system, t, &q, &v));
        out.rows.copy_from_slice(reaction_rows(&self.system, t, &q, &v).as_flattened());
    }

    fn increment(&self, (t0, h): (f64, f64), [q0, q1]: [&[f64]; 2], v: &[f64], mut out: ElementBlocks<'_>) {
        let system = &self.system;
        let (q0, q1, v): ([f64; N], [f64; N], [f64; N]) = (local(q0), local(q1), local(v));
        if !out.derivatives {
            return self.residual((t0, h), (&q0, &q1), &v, &mut out);
        }
        let l_d = Midpoint.derivatives(system, t0, h, &q0, &v);
        let (mut residual, mut block) = (l_d.d1, l_d.d1d2.map(|row| row.map(|x| h * x)));

        // Forces and constraint with their derivatives in v.
        let (t, step) = (Dual::fixed(t0), Dual::fixed(h));
        let (q, in_v) = (q0.map(Dual::fixed), Dual::variables(&v));
        let forces = DiscreteLagrangian::<Sys, N, M>::forces(&Midpoint, system, t, step, &q, &in_v);
        if let Some((minus, _)) = forces {
            for i in 0..N {
                residual[i] += minus[i].re;
                for j in 0..N {
                    block[i][j] += minus[i].eps[j];
                }
            }
        }
        let w_d: [Dual<f64, N>; M] = DiscreteConstraint::residual(&Midpoint, system, t, step, &q, &in_v);
        let (mut rows, mut level) = (w_d.map(|w| w.eps), w_d.map(|w| -w.re));
        // Where it constrains positions, in place of the discrete constraint.
        if let Some(positions) = position_misses(system, t0 + h, &q1) {
            for k in 0..M {
                if let Some(g) = positions[k] {
                    (rows[k], level[k]) = (g.eps, -g.re / h);
                }
            }
        }
        out.momentum.copy_from_slice(&residual);
        out.block.copy_from_slice(block.as_flattened());
        out.rows.copy_from_slice(rows.as_flattened());
        out.level.copy_from_slice(&level);
    }

    fn end(&self, (t0, h): (f64, f64), q0: &[f64], v: &[f64], p1: &mut [f64]) {
        let (q0, v) = (local(q0), local(v));
        let mut p: [f64; N] = Midpoint.d2(&self.system, t0, h, &q0, &v);
        let forces = DiscreteLagrangian::<Sys, N, M>::forces(&Midpoint, &self.system, t0, h, &q0, &v);
        if let Some((_, plus)) = forces {
            p = from_fn(|i| p[i] + plus[i]);
        }
        p1.copy_from_slice(&p);
    }

    fn velocity(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let (q, v) = (local(q), local(v));
        if out.derivatives {
            let (p, mass) = mass_matrix(&self.system, t, &q, &v);
            out.momentum.copy_from_slice(&p);
            out.block.copy_from_slice(mass.as_flattened());
            out.rows.copy_from_slice(reaction_rows(&self.system, t, &q, &v).as_flattened());
        } else {
            out.momentum.copy_from_slice(&momentum(&self.system, t, &q, &v));
        }
        out.level.copy_from_slice(&constraint_residual(&self.system, t, &q, &v).map(|slip| -slip));
    }

    #[cold]
    fn sizes(&self, (t, h): (f64, f64), q: &[f64], v: &[f64], momentum: &mut [f64], level: &mut [f64]) {
        let (t, q, v): (_, [f64; N], [f64; N]) = (Rounded::exact(t), local(q), local(v));
        let (q, v) = (q.map(Rounded::once), v.map(Rounded::once));
        let p = velocity_slope(&self.system, t, &q, &v);
        let (slope, force) = (configuration_slope(&self.system, t, &q, &v), self.system.force(t, &q, &v));
        for (i, size) in momentum.iter_mut().enumerate().take(N) {
            *size = p[i].size + h.abs() * (slope[i].size + force.map_or(0.0, |force| force[i].size));
        }
        let slip = constraint_residual(&self.system, t, &q, &v);
        let positions = self.system.holonomic(t, &q);
        for (k, size) in level.iter_mut().enumerate().take(M) {
            let position = positions.and_then(|g| g[k]).map_or(0.0, |g| g.size / h.abs());
            *size = slip[k].size + position;
        }
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let Saddle { block, rows, right, level, .. } = Motion::equations(&self.system, t, &local(q), &local(v));
        out.momentum.copy_from_slice(&right);
        out.block.copy_from_slice(block.as_flattened());
        out.rows.copy_from_slice(rows.as_flattened());
        out.level.copy_from_slice(&level);
    }

    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        energy(&self.system, t, &local(q), &local(v))
    }

    fn power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let (q, v) = (local(q), local(v));
        force_power(&self.system, t, &q, &v).unwrap_or(0.0) + lagrangian_power(&self.system, t, &q, &v)
    }

    fn misses(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2] {
        let (q, v) = (local(q), local(v));
        let slips = constraint_residual(&self.system, t, &q, &v);
        let slip = slips.iter().fold(0.0, |most, slip| larger(most, slip.abs()));
        [slip, position_residual(&self.system, t, &q).abs()]
    }

    fn turn(&self, (t0, h): (f64, f64), q0: &[f64], v: &[f64]) -> f64 {
        let (q0, v): ([f64; N], [f64; N]) = (local(q0), local(v));
        dla::turn(&self.system.angles(), &from_fn(|i| h * v[i]), |step| rows_along(&self.system, (t0, h), &q0, step))
    }

    fn braking(&self, (t0, h): (f64, f64), q0: &[f64], [v, v1]: [&[f64]; 2]) -> [f64; 3] {
        let (q0, v, v1): ([f64; N], [f64; N], [f64; N]) = (local(q0), local(v), local(v1));
        let (t, q) = (t0 + 0.5 * h, from_fn(|i| q0[i] + 0.5 * h * v[i]));
        let along = |of: &dyn Fn(usize) -> f64| (0..N).map(of).sum::<f64>();
        let (mean, end) = (momentum(&self.system, t, &q, &v), momentum(&self.system, t, &q, &v1));
        let inertia = along(&|i| (v1[i] - v[i]) * (end[i] - mean[i]));
        let all = along(&|i| (v[i] * mean[i]).abs());
        let forces = self.system.force(t, &q, &v).zip(self.system.force(t, &q, &v1));
        let damping = forces.map_or(0.0, |(mean, end)| along(&|i| 0.5 * h * (v1[i] - v[i]) * (mean[i] - end[i])));
        [damping, inertia, all]
    }

    fn not_a_number(&self, t: f64, q: &[f64], v: &[f64]) -> Option<NotANumber> {
        dla::not_a_number(&self.system, t, &local(q), &local(v))
    }
}
