use super::rule::Eight;
use lagrangian::linear::larger;
use lagrangian::simd::{Kernel, Pack, Simd, Square, Wide};
use lagrangian::{System, array, velocity_of};
use std::array::from_fn;

/// Eight stages of `N` slopes.
pub(super) type Rows<const N: usize> = [[f64; 8]; N];

/// The slopes of the stages, velocities and accelerations of quasi-velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slopes<const N: usize> {
    pub(super) velocity: Rows<N>,
    pub(super) acceleration: Rows<N>,
}

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
    /// Changes that shrink by no more than this do not converge.
    pub(super) hopeless: f64,
    /// Iterations that are made before any is looked at, where there was a step before.
    pub(super) unseen: u32,
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
    pub(super) before: Option<([&'a Rows<N>; 2], &'a Square)>,
    pub(super) ending: Ending<N>,
}

/// The rule of collocation in registers.
struct Along<S: Simd, const R: usize> {
    /// Not times h: rounded so, the coefficients would lose the symmetry that they have to the last bit.
    square: [Pack<S, R>; 8],
    h: Pack<S, R>,
}

impl<S: Simd, const R: usize> Along<S, R> {
    /// `from + h A slopes`.
    #[inline(always)]
    fn from(&self, from: f64, slopes: &Pack<S, R>) -> Wide<S, R> {
        Wide::Each(slopes.times(&self.square).mul_add(self.h, Pack::splat(self.h.simd(), from)))
    }
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
    /// The places of the stages where nothing moves.
    #[inline(always)]
    fn still<S: Simd, const R: usize>(&self, simd: S) -> [Wide<S, R>; N] {
        array(
            Wide::Zero,
            #[inline(always)]
            |k| Wide::Each(Pack::splat(simd, self.q0[k])),
        )
    }

    /// The places of the stages.
    #[inline(always)]
    fn q<S: Simd, const R: usize>(&self, along: &Along<S, R>, v: &[Pack<S, R>; N]) -> [Wide<S, R>; N] {
        array(
            Wide::Zero,
            #[inline(always)]
            |k| along.from(self.q0[k], &v[k]),
        )
    }

    /// The quasi-velocities of the stages.
    #[inline(always)]
    fn xi<S: Simd, const R: usize>(&self, along: &Along<S, R>, a: &[Pack<S, R>; N]) -> [Wide<S, R>; N] {
        array(
            Wide::Zero,
            #[inline(always)]
            |k| if k < N - M { along.from(self.xi0[k], &a[k]) } else { Wide::Zero },
        )
    }

    /// The velocities of quasi-velocities, one quadrature after another.
    #[inline(always)]
    fn reconstructed<S: Simd, const R: usize>(
        &self,
        along: &Along<S, R>,
        quadratures: u32,
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        let simd = along.h.simd();
        let mut v = self.velocity(simd, &self.still(simd), xi)?;
        for _ in 0..quadratures {
            v = self.velocity(simd, &self.q(along, &v), xi)?;
        }
        Some(v)
    }

    /// The times of the stages.
    #[inline(always)]
    fn times<S: Simd, const R: usize>(&self, simd: S) -> Wide<S, R> {
        let times = from_fn(|i| self.t + self.rule.nodes[i] * self.h);
        Wide::Each(Pack::load(simd, &times))
    }

    /// `q' = W xi + v_b` in every stage.
    #[inline(always)]
    fn velocity<S: Simd, const R: usize>(
        &self,
        simd: S,
        q: &[Wide<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        match velocity_of(self.system, self.times(simd), q, xi) {
            Ok(v) => Some(packed(simd, &v)),
            Err(_) => None,
        }
    }

    /// `xi'` in every stage.
    #[inline(always)]
    fn acceleration<S: Simd, const R: usize>(
        &self,
        simd: S,
        q: &[Wide<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        match self.system.reduced_motion(self.times(simd), q, xi) {
            Some(a) => Some(packed(simd, &a)),
            None => None,
        }
    }
}

#[allow(clippy::manual_map, reason = "a closure may stay a call, in which the registers are not known")]
impl<Sys: System<N, M>, const N: usize, const M: usize> Kernel for Stages<'_, Sys, N, M> {
    type Output = Outcome<N>;

    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> Outcome<N> {
        let along = Along::<S, R> { square: loaded(simd, &self.rule.square.terms), h: Pack::splat(simd, self.h) };
        let cascade = self.system.reconstruction();
        let alone = cascade.is_some() && self.system.stands_alone();

        // Where no step was before, nothing changes at first.
        let (mut v, mut a) = match self.before {
            Some(([velocity, acceleration], continued)) => {
                let continued = loaded(simd, &continued.terms);
                (ahead(simd, velocity, &continued), ahead(simd, acceleration, &continued))
            }
            None => ([Pack::splat(simd, 0.0); N], [Pack::splat(simd, 0.0); N]),
        };
        let mut scales = match &self.ending.scales {
            Some([v, a]) => Some([inverse(simd, v), inverse(simd, a)]),
            None => None,
        };
        // What is remembered may come from a file: the limit holds all the same.
        let unseen =
            if self.before.is_some() { self.ending.unseen.min(self.ending.limit.saturating_sub(1)) } else { 0 };
        let (mut last, mut rate, mut iteration, mut stalled) = (f64::INFINITY, 1.0, 0, 0);
        loop {
            // The accelerations are called at one place: for a list of effects they are much code.
            let xi = self.xi(&along, &a);
            let (v1, q) = match cascade {
                _ if alone => (Some(v), self.still(simd)),
                Some(quadratures) => match self.reconstructed(&along, quadratures, &xi) {
                    Some(v1) => (Some(v1), self.q(&along, &v1)),
                    None => (None, self.still(simd)),
                },
                None => {
                    let q = self.q(&along, &v);
                    (self.velocity(simd, &q, &xi), q)
                }
            };
            let (Some(v1), Some(a1)) = (v1, self.acceleration(simd, &q, &xi)) else { return Outcome::Unknown };
            iteration += 1;
            if iteration <= unseen {
                (v, a) = (v1, a1);
                continue;
            }
            let seen = iteration - unseen;
            let zero = Pack::splat(simd, 0.0);
            let [sv, sa] = match scales {
                Some(scales) => scales,
                None => [own(simd, &v1), own(simd, &a1)],
            };
            scales = Some([sv, sa]);
            let mut changes = zero;
            for k in 0..N {
                if cascade.is_none() {
                    changes = changes.max_abs((v1[k] - v[k]) * sv[k]);
                }
                if k < N - M {
                    changes = changes.max_abs((a1[k] - a[k]) * sa[k]);
                }
            }
            (v, a) = (v1, a1);
            let moved = changes.largest();
            let (slower, now) = (if seen > 2 { rate } else { 0.0 }, moved / last);
            rate = if seen > 1 { now } else { rate };
            // A search that begins near its end may shrink faster at first than it goes on.
            let expected = larger(larger(rate, slower), SLOWEST);
            let settled = seen > 1 && rate < 1.0 && moved * expected <= self.ending.left * (1.0 - rate);
            // Once may be an iteration that turns the error round before it shrinks.
            stalled = if moved >= 0.5 * last { stalled + 1 } else { 0 };
            let rounding =
                (stalled > 1 && moved <= self.ending.rounding) || (stalled > 0 && moved <= self.ending.noise);
            if moved == 0.0 || settled || rounding {
                break;
            }
            if moved.is_nan()
                || moved.is_infinite()
                || (seen > 3 && rate > self.ending.hopeless)
                || iteration >= self.ending.limit
            {
                return Outcome::Failed;
            }
            last = moved;
        }
        // The last accelerations' own.
        if let Some(quadratures) = cascade {
            match self.reconstructed(&along, quadratures, &self.xi(&along, &a)) {
                Some(last) => v = last,
                None => return Outcome::Unknown,
            }
        }
        let slopes = Slopes { velocity: rows(&v), acceleration: rows(&a) };
        Outcome::Found(Found { slopes, iterations: iteration, rate })
    }
}

/// Numbers that may have something in common, each in its registers.
#[inline(always)]
fn packed<S: Simd, const R: usize, const N: usize>(simd: S, x: &[Wide<S, R>; N]) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| x[k].pack(simd),
    )
}

/// Rows of eight numbers.
#[inline(always)]
fn loaded<S: Simd, const R: usize, const N: usize>(simd: S, x: &Rows<N>) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::load(simd, &x[k]),
    )
}

/// Rows as their polynomials go on.
#[inline(always)]
fn ahead<S: Simd, const R: usize, const N: usize>(
    simd: S,
    x: &Rows<N>,
    continued: &[Pack<S, R>; 8],
) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::load(simd, &x[k]).times(continued),
    )
}

/// The inverse of each scale, everywhere.
#[inline(always)]
fn inverse<S: Simd, const R: usize, const N: usize>(simd: S, scales: &[f64; N]) -> [Pack<S, R>; N] {
    array(
        Pack::splat(simd, 0.0),
        #[inline(always)]
        |k| Pack::splat(simd, larger(SMALLEST, scales[k]).recip()),
    )
}

/// The inverse of the size of each row.
#[inline(always)]
fn own<S: Simd, const R: usize, const N: usize>(simd: S, x: &[Pack<S, R>; N]) -> [Pack<S, R>; N] {
    let zero = Pack::splat(simd, 0.0);
    array(
        zero,
        #[inline(always)]
        |k| Pack::splat(simd, larger(SMALLEST, zero.max_abs(x[k]).largest()).recip()),
    )
}

/// The numbers of each row.
#[inline(always)]
fn rows<S: Simd, const R: usize, const N: usize>(x: &[Pack<S, R>; N]) -> Rows<N> {
    array(
        [0.0; 8],
        #[inline(always)]
        |k| x[k].row(),
    )
}

/// No iteration is expected to shrink its changes by more.
pub(crate) const SLOWEST: f64 = 0.05;

/// Nothing is measured by less: its inverse is finite.
const SMALLEST: f64 = 1e-290;

/// `h sum_j factors[j] slopes[j]`, summed so that a rule and its mirror image give the same bits.
pub(super) fn sum<const N: usize>(h: f64, factors: &[f64; 8], slopes: &Rows<N>) -> [f64; N] {
    slopes.each_ref().map(|x| {
        let p: [f64; 8] = from_fn(|i| factors[i] * x[i]);
        h * (((p[0] + p[7]) + (p[1] + p[6])) + ((p[2] + p[5]) + (p[3] + p[4])))
    })
}
