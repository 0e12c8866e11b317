use super::rule::Eight;
use lagrangian::linear::larger;
use lagrangian::simd::{Kernel, Pack, Simd, Wide};
use lagrangian::{System, velocity_of};
use std::array::from_fn;

/// Eight stages of `N` slopes.
pub(super) type Rows<const N: usize> = [[f64; 8]; N];

/// The slopes of the stages, velocities and accelerations of quasi-velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slopes<const N: usize> {
    pub(super) velocity: Rows<N>,
    pub(super) acceleration: Rows<N>,
}

/// Velocities and accelerations in registers.
type Packed<S, const R: usize, const N: usize> = ([Pack<S, R>; N], [Pack<S, R>; N]);

/// When the iteration has come to its end, in units of the scales.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ending<const N: usize> {
    /// What the next change may still be.
    pub(super) left: f64,
    /// Changes below which shrink no more, twice, are rounding.
    pub(super) rounding: f64,
    /// And once.
    pub(super) noise: f64,
    /// Iterations after which the search is given up.
    pub(super) limit: u32,
    /// What velocities and accelerations are measured by; their own sizes where none is given.
    pub(super) scales: Option<[[f64; N]; 2]>,
}

/// The equations of a collocation step, all stages at once.
pub(super) struct Stages<'a, Sys, const N: usize, const M: usize> {
    pub(super) rule: &'a Eight,
    pub(super) system: &'a Sys,
    pub(super) t: f64,
    pub(super) h: f64,
    pub(super) q0: &'a [f64; N],
    pub(super) xi0: &'a [f64; N],
    /// The slopes of the step before and what continues them to this one.
    pub(super) before: Option<([&'a Rows<N>; 2], &'a [[f64; 8]; 8])>,
    pub(super) ending: Ending<N>,
}

/// What came of a search.
pub(super) enum Outcome<const N: usize> {
    /// The system does not know its reduced equations by hand.
    Unknown,
    /// The iteration does not converge.
    Failed,
    /// The stages.
    Found(Found<N>),
}

/// A solution.
pub(super) struct Found<const N: usize> {
    pub(super) slopes: Slopes<N>,
    pub(super) iterations: u32,
    /// By how much the last changes shrank.
    pub(super) rate: f64,
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Stages<'_, Sys, N, M> {
    /// `q' = W xi + v_b` and `xi'` in every stage.
    #[inline(always)]
    fn slopes<S: Simd, const R: usize>(
        &self,
        simd: S,
        q: &[Wide<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<Packed<S, R, N>> {
        let t = Wide::Each(Pack::load(simd, &self.rule.nodes.map(|node| self.t + node * self.h)));
        let velocity = velocity_of(self.system, t, q, xi).ok()?;
        let acceleration = self.system.reduced_motion(t, q, xi)?;
        Some((velocity.map(|x| x.pack(simd)), acceleration.map(|x| x.pack(simd))))
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> Kernel for Stages<'_, Sys, N, M> {
    type Output = Outcome<N>;

    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> Outcome<N> {
        // Not times h: rounded so, the coefficients would lose the symmetry that they have to the last bit.
        let columns: [Pack<S, R>; 8] = from_fn(|j| Pack::load(simd, &self.rule.columns[j]));
        let h = Pack::splat(simd, self.h);
        let along = |k: usize, slopes: &[Pack<S, R>; N], from: f64| {
            Wide::Each(slopes[k].times(&columns).mul_add(h, Pack::splat(simd, from)))
        };
        let xi_of = |a: &[Pack<S, R>; N]| from_fn(|k| if k < N - M { along(k, a, self.xi0[k]) } else { Wide::Zero });
        let q_of = |v: &[Pack<S, R>; N]| from_fn(|k| along(k, v, self.q0[k]));
        let still = || self.q0.map(|q| Wide::Each(Pack::splat(simd, q)));
        let alone = self.system.reconstruction();

        let (mut v, mut a) = match self.before {
            Some(([velocity, acceleration], continued)) => {
                let continued: [Pack<S, R>; 8] = from_fn(|j| Pack::load(simd, &continued[j]));
                let ahead = |row: &[f64; 8]| Pack::load(simd, row).times(&continued);
                (velocity.each_ref().map(ahead), acceleration.each_ref().map(ahead))
            }
            None => {
                let xi = from_fn(|k| if k < N - M { Wide::Each(Pack::splat(simd, self.xi0[k])) } else { Wide::Zero });
                match self.slopes(simd, &still(), &xi) {
                    Some(slopes) => slopes,
                    None => return Outcome::Unknown,
                }
            }
        };
        let inverse = |scales: &[f64; N]| scales.map(|x| Pack::splat(simd, x.max(SMALLEST).recip()));
        let mut scales = self.ending.scales.map(|[v, a]| [inverse(&v), inverse(&a)]);
        let (mut last, mut rate, mut iteration, mut stalled) = (f64::INFINITY, 1.0, 0, 0);
        loop {
            iteration += 1;
            let xi = xi_of(&a);
            let (v1, a1) = if alone.is_some() {
                let t = Wide::Same(self.t);
                match self.system.reduced_motion(t, &self.q0.map(Wide::Same), &xi) {
                    Some(a1) => (v, a1.map(|x| x.pack(simd))),
                    None => return Outcome::Unknown,
                }
            } else {
                match self.slopes(simd, &q_of(&v), &xi) {
                    Some(slopes) => slopes,
                    None => return Outcome::Unknown,
                }
            };
            let zero = Pack::splat(simd, 0.0);
            let [sv, sa] = *scales.get_or_insert_with(|| {
                let size = |x: &Pack<S, R>| zero.max_abs(*x).largest();
                [inverse(&v1.each_ref().map(size)), inverse(&a1.each_ref().map(size))]
            });
            let mut changes = zero;
            for k in 0..N {
                if alone.is_none() {
                    changes = changes.max_abs((v1[k] - v[k]) * sv[k]);
                }
                if k < N - M {
                    changes = changes.max_abs((a1[k] - a[k]) * sa[k]);
                }
            }
            (v, a) = (v1, a1);
            let moved = changes.largest();
            let (slower, now) = (if iteration > 2 { rate } else { 0.0 }, moved / last);
            rate = if iteration > 1 { now } else { rate };
            // A search that begins near its end may shrink faster at first than it goes on.
            let expected = larger(larger(rate, slower), SLOWEST);
            let settled = iteration > 1 && rate < 1.0 && moved * expected <= self.ending.left * (1.0 - rate);
            // Once may be an iteration that turns the error round before it shrinks.
            stalled = if moved >= 0.5 * last { stalled + 1 } else { 0 };
            let rounding =
                (stalled > 1 && moved <= self.ending.rounding) || (stalled > 0 && moved <= self.ending.noise);
            if moved == 0.0 || settled || rounding {
                break;
            }
            if moved.is_nan() || moved.is_infinite() || (iteration > 3 && rate > 2.0) || iteration >= self.ending.limit
            {
                return Outcome::Failed;
            }
            last = moved;
        }
        if let Some(quadratures) = alone {
            let xi = xi_of(&a);
            let mut q = still();
            for _ in 0..=quadratures {
                match self.slopes(simd, &q, &xi) {
                    Some(slopes) => v = slopes.0,
                    None => return Outcome::Unknown,
                }
                q = q_of(&v);
            }
        }
        let slopes = Slopes { velocity: v.map(|x| x.row()), acceleration: a.map(|x| x.row()) };
        Outcome::Found(Found { slopes, iterations: iteration, rate })
    }
}

/// No iteration is expected to shrink its changes by more.
const SLOWEST: f64 = 0.05;

/// Nothing is measured by less: its inverse is finite.
const SMALLEST: f64 = 1e-290;

/// `h sum_j factors[j] slopes[j]`, summed so that a rule and its mirror image give the same bits.
pub(super) fn sum<const N: usize>(h: f64, factors: &[f64; 8], slopes: &Rows<N>) -> [f64; N] {
    slopes.each_ref().map(|x| {
        let p: [f64; 8] = from_fn(|i| factors[i] * x[i]);
        h * (((p[0] + p[7]) + (p[1] + p[6])) + ((p[2] + p[5]) + (p[3] + p[4])))
    })
}
