use crate::element::{Element, ElementBlocks, local};
use dla::{Discretisation, EndMomenta, Mechanics, NotANumber, Rules};
use lagrangian::linear::{larger, largest};
use lagrangian::{Dual, Midpoint, Motion, Piecewise, PowerSources, Rounded, Saddle, System, from_fn};
use std::fmt;

/// What an assembly asks of a system: what methods ask, and what only an assembly does.
pub(crate) trait ElementSystem<const N: usize, const M: usize>: Mechanics<N, M> + Send + Sync {
    /// The times at which it jumps, in the open interval from `from` to `to` (s).
    fn jumps_between(&self, from: f64, to: f64) -> Vec<f64>;

    /// The smooth piece that holds at the time `t` (s).
    fn piece_at(&self, t: f64) -> Box<dyn ElementSystem<N, M>>;

    /// The linear equations for the accelerations.
    fn equations(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Saddle<N, M>;
}

impl<Sys, const N: usize, const M: usize> ElementSystem<N, M> for Sys
where
    Sys: System<N, M> + Piecewise + Send + Sync + 'static,
{
    fn jumps_between(&self, from: f64, to: f64) -> Vec<f64> {
        self.jumps(from, to)
    }

    fn piece_at(&self, t: f64) -> Box<dyn ElementSystem<N, M>> {
        Box::new(self.piece(t))
    }

    fn equations(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Saddle<N, M> {
        Motion::equations(self, t, q, v)
    }
}

/// Any static system as an element, with the midpoint rule for its discrete Lagrangian and constraint.
///
/// The system is an object: the equations of an element are compiled once for a shape, and not for every body.
pub(crate) struct SystemElement<const N: usize, const M: usize> {
    pub(crate) system: Box<dyn ElementSystem<N, M>>,
}

impl<const N: usize, const M: usize> fmt::Debug for SystemElement<N, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "system of {N} coordinates and {M} constraints")
    }
}

/// The midpoint rule for both.
fn rules() -> Rules {
    Rules::new(Midpoint, Midpoint)
}

/// The momenta of a discrete Lagrangian at the ends of a step with the discrete forces.
fn with_forces<const N: usize>(EndMomenta { slopes, forces }: EndMomenta<N>) -> [[f64; N]; 2] {
    match forces {
        Some(forces) => from_fn(|end| from_fn(|i| slopes[end][i] + forces[end][i])),
        None => slopes,
    }
}

/// The configuration in the middle of a step.
fn middle<const N: usize>(h: f64, q0: &[f64], v: &[f64]) -> [f64; N] {
    let (q0, v): ([f64; N], [f64; N]) = (local(q0), local(v));
    from_fn(|i| q0[i] + 0.5 * h * v[i])
}

impl<const N: usize, const M: usize> Element for SystemElement<N, M> {
    fn size(&self) -> (usize, usize) {
        (N, M)
    }

    fn acts(&self) -> bool {
        true
    }

    fn angles(&self, angles: &mut [bool]) {
        angles.copy_from_slice(&self.system.angles());
    }

    fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        self.system.jumps_between(from, to)
    }

    fn smooth_piece(&self, t: f64) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { system: self.system.piece_at(t) }))
    }

    fn beginning(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let (q, v) = (local(q), local(v));
        out.momentum.copy_from_slice(&self.system.momentum(t, &q, &v));
        out.rows.copy_from_slice(self.system.reaction_rows(t, &q, &v).as_flattened());
    }

    fn increment(&self, step: (f64, f64), [q0, q1]: [&[f64]; 2], v: &[f64], out: ElementBlocks<'_>) {
        let (system, (t0, h)) = (&*self.system, step);
        let (q0, q1, v): ([f64; N], [f64; N], [f64; N]) = (local(q0), local(q1), local(v));
        let (momenta, mut w_d): (_, [Dual<f64, N>; M]) = if out.derivatives {
            let (momenta, block) = rules().linearised(system, step, &q0, &v);
            out.block.copy_from_slice(block.as_flattened());
            (momenta, rules().rows(system, step, &q0, &v))
        } else {
            (rules().momenta(system, step, &q0, &v), rules().residual(system, step, &q0, &v).map(Dual::fixed))
        };
        out.momentum.copy_from_slice(&with_forces(momenta)[0]);
        // Where it constrains positions, in place of the discrete constraint.
        if let Some(positions) = system.position_misses(t0 + h, &q1) {
            for (w, position) in w_d.iter_mut().zip(positions) {
                if let Some(g) = position {
                    *w = Dual { re: g.re / h, eps: g.eps };
                }
            }
        }
        out.level.copy_from_slice(&w_d.map(|w| -w.re));
        if out.derivatives {
            out.rows.copy_from_slice(w_d.map(|w| w.eps).as_flattened());
        }
    }

    fn end(&self, step: (f64, f64), q0: &[f64], v: &[f64], p1: &mut [f64]) {
        let (q0, v) = (local(q0), local(v));
        p1.copy_from_slice(&with_forces(rules().momenta(&*self.system, step, &q0, &v))[1]);
    }

    fn velocity(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let (q, v) = (local(q), local(v));
        if out.derivatives {
            let (p, mass) = self.system.mass_matrix(t, &q, &v);
            out.momentum.copy_from_slice(&p);
            out.block.copy_from_slice(mass.as_flattened());
            out.rows.copy_from_slice(self.system.reaction_rows(t, &q, &v).as_flattened());
        } else if !out.momentum.is_empty() {
            out.momentum.copy_from_slice(&self.system.momentum(t, &q, &v));
        }
        out.level.copy_from_slice(&self.system.residual(t, &q, &v).map(|slip| -slip));
    }

    #[cold]
    fn sizes(&self, (t, h): (f64, f64), q: &[f64], v: &[f64], momentum: &mut [f64], level: &mut [f64]) {
        let (t, q, v): (_, [f64; N], [f64; N]) = (Rounded::exact(t), local(q), local(v));
        let (q, v) = (q.map(Rounded::once), v.map(Rounded::once));
        let p = self.system.momentum_rounded(t, &q, &v);
        let (slope, force) = (self.system.slope_rounded(t, &q, &v), self.system.force_rounded(t, &q, &v));
        for (i, size) in momentum.iter_mut().enumerate().take(N) {
            *size = p[i].size + h.abs() * (slope[i].size + force.map_or(0.0, |force| force[i].size));
        }
        let slip = self.system.residual_rounded(t, &q, &v);
        let positions = self.system.positions_rounded(t, &q);
        for (k, size) in level.iter_mut().enumerate().take(M) {
            let position = positions.and_then(|g| g[k]).map_or(0.0, |g| g.size / h.abs());
            *size = slip[k].size + position;
        }
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let Saddle { block, rows, right, level, .. } = self.system.equations(t, &local(q), &local(v));
        out.momentum.copy_from_slice(&right);
        out.block.copy_from_slice(block.as_flattened());
        out.rows.copy_from_slice(rows.as_flattened());
        out.level.copy_from_slice(&level);
    }

    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.system.energy(t, &local(q), &local(v))
    }

    fn power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let (q, v) = (local(q), local(v));
        self.system.force_power(t, &q, &v).unwrap_or(0.0) + self.system.lagrangian_power(t, &q, &v)
    }

    fn misses(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2] {
        let (q, v) = (local(q), local(v));
        let slips = self.system.residual(t, &q, &v);
        let slip = slips.iter().fold(0.0, |most, slip| larger(most, slip.abs()));
        let positions = self.system.positions(t, &q).unwrap_or([None; M]);
        [slip, largest(&positions.map(|g| g.unwrap_or(0.0)))]
    }

    fn turn(&self, (t0, h): (f64, f64), q0: &[f64], v: &[f64]) -> f64 {
        let (q0, v): ([f64; N], [f64; N]) = (local(q0), local(v));
        let increment = from_fn(|i| h * v[i]);
        dla::turn(&self.system.angles(), &increment, || self.system.rows_along(t0, &q0, h, &increment))
    }

    fn power_sources(&self) -> PowerSources {
        self.system.power_sources()
    }

    fn damping(&self, (t0, h): (f64, f64), q0: &[f64], [v, v1]: [&[f64]; 2]) -> f64 {
        let (t, q) = (t0 + 0.5 * h, middle(h, q0, v));
        let forces = self.system.force(t, &q, &local(v)).zip(self.system.force(t, &q, &local(v1)));
        forces.map_or(0.0, |(mean, end)| dla::damping(h, [v, v1], [&mean, &end]))
    }

    fn inertia(&self, (t0, h): (f64, f64), q0: &[f64], [v, v1]: [&[f64]; 2]) -> [f64; 2] {
        let (t, q): (_, [f64; N]) = (t0 + 0.5 * h, middle(h, q0, v));
        let momentum = |v: &[f64]| self.system.momentum(t, &q, &local(v));
        dla::inertia([v, v1], [&momentum(v), &momentum(v1)])
    }

    fn not_a_number(&self, t: f64, q: &[f64], v: &[f64]) -> Option<NotANumber> {
        self.system.not_a_number(t, &local(q), &local(v))
    }
}
