//! Methods that keep the energy: collocation on the dual of the distribution with averaged gradients.

mod ends;
mod gradient;
mod path;
mod rule;
mod start;

use crate::convergence::FixedPoint;
use crate::positions::{affine_only, velocities_only};
use crate::{Mechanics, OneStep, StackUse, Stage, State, StepError, StepReport};
use ends::Ends;
use lagrangian::linear::larger;
use lagrangian::{AT_ONCE, Lanes, Scalar, Twofold, from_fn, mapped, vectorized};
use path::{EnergyPath, PathPoints};
use rule::EnergyRule;
use start::EnergyStart;

/// The energy-preserving collocation method with `s` Gauss nodes, of order `2 s`, for `s` from 1 to 4.
///
/// With `z = (q, pi)` and `z' = B(z) grad H` as in [`Bracket`](lagrangian::Bracket), the path of a step is the polynomial `u` of degree `s` with
/// `u(0) = z0` and, at the Gauss nodes `c_i`,
///
/// ```text
/// u'(c_i) = B(u(c_i)) g_i + f_i,      g_i = int_0^1 (l_i(sigma) / b_i) grad H(u(sigma)) dsigma,      z1 = u(1).
/// ```
///
/// Since `B` is skew, `H(z1) - H(z0) = h sum_i b_i g_i . u'(c_i)` is the discrete work
/// `h sum_i b_i F(u(c_i), q'(c_i)) . q'(c_i)` of the forces, and zero without them; with the forces taken at the velocity
/// `q'(c_i)` of the path, a dissipative one can only lower the energy. The new velocity is `W(q1) xi1`, so the constraint
/// holds too. Both are exact but for rounding. The method is symmetric. `s = 1` is the discrete
/// gradient method `(z1 - z0)/h = B((z0 + z1)/2) DG(z0, z1)`.
///
/// Cohen and Hairer 2011, BIT 51, 91-101; on `D*`, Celledoni, Farre Puiggali, Hoiseth and Martin de Diego 2019,
/// J. Nonlinear Sci. 29, 1523-1562; the book, (5.3) and (5.4). The integrals are by a Gauss rule with eight nodes; a step along which the energy is
/// too rough for them is refused. The equations are solved by fixed-point iteration, for steps up to about the time in
/// which the system turns by a radian.
///
/// The system must have a basis of admissible velocities, `b = 0` and no explicit time; forces may depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    rule: EnergyRule,
    work: f64,
}

impl Energy {
    /// The method with `S` nodes, from one to four. The number is a value of the method and no part of its type:
    /// a step is compiled once for all of them.
    #[must_use]
    pub fn new<const S: usize>() -> Self {
        Self { rule: EnergyRule::new::<S>(), work: 0.0 }
    }

    /// The discrete work of the forces over the last step (J), which is the change of the energy.
    #[must_use]
    pub fn work(&self) -> f64 {
        self.work
    }
}

impl<const N: usize, const M: usize> OneStep<N, M> for Energy {
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { stack::<N>().exceeds::<N, M>() } {
            return Err(stack::<N>().refusal::<N, M>());
        }
        affine_only(system, t0, state)?;
        velocities_only(system, t0, state, POSITIONS)?;
        let mut start = EnergyStart::new(system, t0, h, state)?;
        let mut end = StepEnergy { system, rule: &self.rule, t0, h, start: &start }.solved();
        if let Err(StepError::Newton { .. }) = end
            && start.take_mass_ahead(system, t0, h).is_some()
        {
            end = StepEnergy { system, rule: &self.rule, t0, h, start: &start }.solved();
        }
        let end = end?;
        let q1 = state.ahead(&end.increment);
        let v1 = system.basis(t0 + h, &q1).ok_or(NO_BASIS)?.combine(&end.xi);
        state.stays_finite(&end.increment, &v1)?;
        state.advance_with_momenta(&end.increment, v1, end.xi, end.pi);
        self.work = end.work;
        Ok(StepReport { work: Some(end.work), rounding: end.rounding, ..StepReport::of(end.iterations) })
    }
}

/// Eight places at once: with few coordinates a basis with all its derivatives, with many coordinates one derivative after another.
const fn stack<const N: usize>() -> StackUse {
    StackUse { squares: if N <= AT_ONCE { 82 * (N + 1) } else { 440 }, rows: 24 }
}

const NO_BASIS: StepError = StepError::Unsupported {
    reason: "the energy-preserving methods need a basis of the admissible velocities, and the system has no basis",
};

/// To project the positions would change the potential energy, and at a turning point no velocity makes up for it.
const POSITIONS: &str = "the energy-preserving methods do not keep constraints on positions: positions drift by the \
    error of the method, and a projection of positions would change the energy";

/// The equations of one step.
struct StepEnergy<'a, const N: usize, const M: usize> {
    system: &'a dyn Mechanics<N, M>,
    rule: &'a EnergyRule,
    t0: f64,
    h: f64,
    start: &'a EnergyStart<N>,
}

/// The end of a step.
struct PathEnd<const N: usize> {
    increment: [f64; N],
    xi: [f64; N],
    pi: [Twofold; N],
    work: f64,
    iterations: u32,
    rounding: f64,
}

impl<const N: usize, const M: usize> StepEnergy<'_, N, M> {
    /// The energy may miss the work by this number of roundings; a larger miss is an error of the quadrature.
    const ROUNDINGS: f64 = 1024.0;

    /// Iterations after which the step fails.
    const LIMIT: u32 = 200;

    /// With the widest instructions that the machine has.
    #[inline(never)]
    fn solved(&self) -> Result<PathEnd<N>, StepError> {
        vectorized(
            #[inline(always)]
            || self.solve(),
        )
    }

    #[inline(always)]
    fn solve(&self) -> Result<PathEnd<N>, StepError> {
        let Self { system, rule, start, t0, h } = *self;
        let time = |tau: Lanes| tau * h + t0;
        let (mut path, mut points, mut nodes) = (EnergyPath::rest(), PathPoints::at(start), PathPoints::at(start));
        let mut convergence =
            FixedPoint::<3, N>::new(Self::LIMIT).in_units([1.0, h.abs() * start.largest_inverse_mass(), 1.0]);
        loop {
            let before = points.xi;
            points.follow(&path, rule.integrals_to_points(), start, h);
            let t = time(rule.points);
            // By reference: to take a bracket out of the option would copy all of it.
            let bracket = system.bracket(t, &points.q, &points.xi);
            let Some(bracket) = &bracket else { return Err(NO_BASIS) };
            points.pi = bracket.quasi_momenta();
            let ends = Ends::of(rule, bracket, &points, start);
            nodes.follow(&path, rule.integrals_to_nodes(), start, h);
            let averages = gradient::average(system, rule, time(rule.nodes), &mut nodes).ok_or(NO_BASIS)?;

            let (q_rate, mut pi_rate) = bracket.rates(&averages.h_q, &averages.h_pi);
            let mut power = Lanes::zero();
            if let Some(force) = system.force_at_eight(t, &points.q, &q_rate) {
                let along = bracket.along_basis(&force);
                for i in 0..N {
                    pi_rate[i] += along[i];
                    power += force[i] * q_rate[i];
                }
            }

            let changes = [
                compared(&q_rate, &path.q_rate, 0..rule.stages),
                compared(&pi_rate, &path.pi_rate, 0..rule.stages),
                compared(&points.xi, &before, rule.stages..rule.stages + 1),
            ];
            path = EnergyPath { q_rate, pi_rate };
            let settled = convergence.see(changes, || start.rounding(system, t0, h));
            let settled = settled.map_err(|source| StepError::Newton { stage: Stage::Collocation, source })?;
            if let Some(iterations) = settled {
                let work = h * rule.weighted(&power);
                self.check(&ends, work, &averages.steepest, &path)?;
                return Ok(self.end(&path, &points, work, (iterations, convergence.rounding())));
            }
        }
    }

    /// Increment, quasi-velocities and quasi-momenta at the end of the path.
    #[inline(always)]
    fn end(
        &self,
        path: &EnergyPath<N>,
        points: &PathPoints<N>,
        work: f64,
        (iterations, rounding): (u32, f64),
    ) -> PathEnd<N> {
        let (increment, gained) = path.increments(self.rule, self.h);
        let (start, last) = (self.start, self.rule.ends().0);
        let mut xi = mapped(&points.xi, |xi| xi.0[last]);
        for b in 0..N {
            let missing = gained[b] + start.rest[b] - (points.pi[b].0[last] - start.pi[b]);
            for a in 0..N {
                xi[a] += start.inverse_mass[a][b] * missing;
            }
        }
        let sum = |a: usize| Twofold::from(start.pi[a]) + Twofold::from(gained[a]) + Twofold::from(start.rest[a]);
        PathEnd { increment, xi, pi: from_fn(sum), work, iterations, rounding }
    }

    /// Checks that the energy has changed by the work of the forces.
    #[inline(always)]
    fn check(&self, ends: &Ends, work: f64, steepest: &[f64; N], path: &EnergyPath<N>) -> Result<(), StepError> {
        let defect = ends.after - ends.before - work;
        let size = ends.rounded_size(self.start.state.q(), steepest);
        // An energy among the last numbers is rounded by as much as the least normal one is.
        let bound = (Self::ROUNDINGS * f64::EPSILON * size).max(f64::MIN_POSITIVE);
        if defect.abs() <= bound { Ok(()) } else { self.check_at_rest((defect, bound), steepest, path) }
    }

    /// As [`Self::check`], if the energy is small because its terms cancel, as in a motion across a slope, or if the motion is as small as
    /// the round-off of the place: the energy then changes by its second order, the round-off of the forces times the round-off of the
    /// place.
    #[cold]
    #[inline(never)]
    fn check_at_rest(
        &self,
        (defect, bound): (f64, f64),
        steepest: &[f64; N],
        path: &EnergyPath<N>,
    ) -> Result<(), StepError> {
        let (way, _) = path.increments(self.rule, self.h);
        let along: f64 = (0..N).map(|i| steepest[i] * way[i].abs()).sum();
        let noise = f64::EPSILON * along + self.start.energy_rounding(self.system, self.t0, self.h);
        let bound = bound + Self::ROUNDINGS * noise;
        if defect.abs() <= bound { Ok(()) } else { Err(StepError::Energy { defect, bound }) }
    }
}

/// The largest change and the largest size of every component over some of the lanes.
#[inline(always)]
fn compared<const N: usize>(new: &[Lanes; N], old: &[Lanes; N], lanes: std::ops::Range<usize>) -> [(f64, f64); N] {
    from_fn(|i| {
        lanes.clone().fold((0.0, 0.0), |(change, size), k| {
            (larger(change, new[i].0[k] - old[i].0[k]), larger(size, new[i].0[k]))
        })
    })
}
