use super::ending::{Ending, EndingVerdict};
use super::packs::{StageRows, ahead, everywhere, in_lanes, integral, loaded, of_lanes, own};
use super::rule::GaussRule;
use lagrangian::linear::larger;
use lagrangian::simd::{KNOWN_WHEN_BUILT, Kernel, Pack, Simd, Square, Wide, dispatch, each, packed};
use lagrangian::{
    Lanes, Reduced, StageEvaluation, System, acceleration_along, array, derived_acceleration, from_fn, velocity_of,
};
use std::fmt;
use std::ops::Deref;

/// The slopes of the stages, velocities and accelerations of quasi-velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StageSlopes<const N: usize> {
    pub(super) velocity: StageRows<N>,
    pub(super) acceleration: StageRows<N>,
}

impl<const N: usize> StageSlopes<N> {
    /// None yet.
    pub(super) const ZERO: Self = Self { velocity: [[0.0; 8]; N], acceleration: [[0.0; 8]; N] };

    /// The largest sum over stages, by these factors, of a slope in its unit.
    pub(super) fn weighed(&self, factors: &[f64; 8], counts: &[[f64; N]; 2]) -> f64 {
        let sums = |rows: &StageRows<N>| rows.map(|x| (0..8).map(|i| factors[i] * x[i]).sum::<f64>());
        let sums = [sums(&self.velocity), sums(&self.acceleration)];
        sums.iter().flatten().zip(counts.iter().flatten()).fold(0.0, |most, (x, count)| larger(most, (x * count).abs()))
    }
}

/// The equations of a collocation whose stages are solved all at once: what a method gives to the system, whose kernel solves them.
pub struct Collocation<'a, const N: usize> {
    pub(super) rule: &'a GaussRule,
    pub(super) t: f64,
    pub(super) h: f64,
    pub(super) q0: &'a [f64; N],
    pub(super) xi0: &'a [f64; N],
    /// The slopes of the last step, and the matrix that continues their polynomial to this one.
    pub(super) before: Option<([&'a StageRows<N>; 2], &'a Square)>,
    pub(super) ending: Ending,
    /// Inverse units of the velocities and of the accelerations; `None` for their own sizes.
    pub(super) counts: Option<[[f64; N]; 2]>,
    /// Where the slopes are left.
    pub(super) slopes: &'a mut StageSlopes<N>,
}

/// The rule of collocation in registers.
struct RuleInLanes<S: Simd, const R: usize> {
    /// Not multiplied by h: the round-off of the products would break the symmetry that the coefficients have to the last bit.
    square: [Pack<S, R>; 8],
    h: Pack<S, R>,
}

impl<S: Simd, const R: usize> RuleInLanes<S, R> {
    /// `from + h A slopes`.
    #[inline(always)]
    fn from(&self, from: f64, slopes: &Pack<S, R>) -> Pack<S, R> {
        slopes.times(&self.square).mul_add(self.h, Pack::splat(self.h.simd(), from))
    }
}

/// The result of the iteration.
#[derive(Debug)]
pub enum CollocationOutcome<const N: usize> {
    /// The system does not know its reduced equations by hand.
    Unknown,
    /// The iteration does not converge.
    Failed,
    /// The stages.
    Found(Found<N>),
}

/// A solution.
#[derive(Debug)]
pub struct Found<const N: usize> {
    /// `h sum_j b_j v_j`.
    pub(super) increment: [f64; N],
    /// `h sum_j b_j a_j`.
    pub(super) gain: [f64; N],
    /// The largest of the highest Legendre coefficients of the slopes, in their units; zero if no units were given.
    pub(super) roughness: f64,
    pub(super) iterations: u32,
    /// The contraction factor of the last iteration.
    pub(super) rate: f64,
}

impl<const N: usize> fmt::Debug for Collocation<'_, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rule, t, h, q0, xi0, .. } = self;
        let mut shown = f.debug_struct("Collocation");
        shown.field("stages", &rule.stages).field("t", t).field("h", h).field("q0", q0).field("xi0", xi0).finish()
    }
}

/// Solves for the stages of a system in vector registers; `None` if the machine has none that are known here.
#[inline]
pub(crate) fn collocate<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    of: Collocation<'_, N>,
) -> Option<CollocationOutcome<N>> {
    dispatch(StagesAtOnce { system, of })
}

/// The equations of a collocation step, all stages at once.
struct StagesAtOnce<'a, Sys, const N: usize, const M: usize> {
    system: &'a Sys,
    of: Collocation<'a, N>,
}

impl<'a, Sys, const N: usize, const M: usize> Deref for StagesAtOnce<'a, Sys, N, M> {
    type Target = Collocation<'a, N>;

    #[inline(always)]
    fn deref(&self) -> &Collocation<'a, N> {
        &self.of
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> StagesAtOnce<'_, Sys, N, M> {
    /// The places of the stages for zero velocity.
    #[inline(always)]
    fn still<S: Simd, const R: usize>(&self, simd: S) -> [Pack<S, R>; N] {
        everywhere(simd, self.q0)
    }

    /// The places of the stages.
    #[inline(always)]
    fn q<S: Simd, const R: usize>(&self, along: &RuleInLanes<S, R>, v: &[Pack<S, R>; N]) -> [Pack<S, R>; N] {
        array(
            Pack::splat(along.h.simd(), 0.0),
            #[inline(always)]
            |k| along.from(self.q0[k], &v[k]),
        )
    }

    /// The quasi-velocities of the stages.
    #[inline(always)]
    fn xi<S: Simd, const R: usize>(&self, along: &RuleInLanes<S, R>, a: &[Pack<S, R>; N]) -> [Wide<S, R>; N] {
        array(
            Wide::Zero,
            #[inline(always)]
            |k| if k < N - M { Wide::Each(along.from(self.xi0[k], &a[k])) } else { Wide::Zero },
        )
    }

    /// The velocities of quasi-velocities, one quadrature after another.
    #[inline(always)]
    fn reconstructed<S: Simd, const R: usize>(
        &self,
        along: &RuleInLanes<S, R>,
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
    fn times(&self) -> [f64; 8] {
        from_fn(|i| self.t + self.rule.nodes[i] * self.h)
    }

    /// The same in registers.
    #[inline(always)]
    fn times_at_once<S: Simd, const R: usize>(&self, simd: S) -> Wide<S, R> {
        Wide::Each(Pack::load(simd, &self.times()))
    }

    /// `q' = W xi + v_b` in every stage.
    #[inline(always)]
    fn velocity<S: Simd, const R: usize>(
        &self,
        simd: S,
        q: &[Pack<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        self.velocity_by(simd, &self.system.reduced(), q, xi)
    }

    #[inline(always)]
    fn velocity_by<By: Reduced<N, M>, S: Simd, const R: usize>(
        &self,
        simd: S,
        _by_hand: &By,
        q: &[Pack<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        if const { matches!(By::STAGES, StageEvaluation::Simplified) } {
            return velocity_of(self.system, Pack::load(simd, &self.times()), q, &packed(simd, xi)).ok();
        }
        if const { matches!(By::STAGES, StageEvaluation::InArrays) } {
            let t = Lanes(self.times());
            let v = velocity_of(self.system, t, &in_lanes(q), &in_lanes(&packed(simd, xi))).ok()?;
            return Some(of_lanes(simd, &v));
        }
        match velocity_of(self.system, self.times_at_once(simd), &each(q), xi) {
            Ok(v) => Some(packed(simd, &v)),
            Err(_) => None,
        }
    }

    /// `xi'` in every stage.
    #[inline(always)]
    fn acceleration<S: Simd, const R: usize>(
        &self,
        simd: S,
        q: &[Pack<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        let by_hand = self.system.reduced();
        match self.acceleration_by(simd, &by_hand, q, xi) {
            Some(a) => Some(a),
            None => self.derived(simd, &by_hand, q, xi),
        }
    }

    #[inline(always)]
    fn acceleration_by<By: Reduced<N, M>, S: Simd, const R: usize>(
        &self,
        simd: S,
        by_hand: &By,
        q: &[Pack<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        if const { matches!(By::STAGES, StageEvaluation::Simplified) } {
            return by_hand.reduced_motion(Pack::load(simd, &self.times()), q, &packed(simd, xi));
        }
        if const { matches!(By::STAGES, StageEvaluation::InArrays) } {
            let a = by_hand.reduced_motion(Lanes(self.times()), &in_lanes(q), &in_lanes(&packed(simd, xi)))?;
            return Some(of_lanes(simd, &a));
        }
        let a = by_hand.reduced_motion(self.times_at_once(simd), &each(q), xi)?;
        Some(packed(simd, &a))
    }

    /// `xi'` by derivatives along the basis, of a system that knows nothing by hand. Up to two accelerations are derived of all stages at
    /// once; the derivatives of more are too many numbers to be held in registers, and the stages then come one after another. So they do
    /// where the registers are found at run time only: functions of the user that are not inlined would be compiled without them.
    #[inline(always)]
    fn derived<By: Reduced<N, M>, S: Simd, const R: usize>(
        &self,
        simd: S,
        _by_hand: &By,
        q: &[Pack<S, R>; N],
        xi: &[Wide<S, R>; N],
    ) -> Option<[Pack<S, R>; N]> {
        // More than five accelerations come from the motion in full coordinates, whose matrices have no room on the stack beside eight
        // stages.
        if const { By::ANY || N - M > 5 } {
            return None;
        }
        if const { KNOWN_WHEN_BUILT && N - M <= 2 } {
            let a = acceleration_along(self.system, Pack::load(simd, &self.times()), q, &packed(simd, xi))?;
            return a.iter().all(|a| a.lanes().iter().all(|x| x.is_finite())).then_some(a);
        }
        let (q, xi) = (q.map(|q| q.row()), xi.map(|xi| xi.pack(simd).row()));
        let mut a = [[0.0; 8]; N];
        // Lanes beyond the stages stay at the beginning of the step, and count for nothing.
        for i in 0..self.rule.stages {
            let t = self.t + self.rule.nodes[i] * self.h;
            let found = derived_acceleration(self.system, t, &from_fn(|k| q[k][i]), &from_fn(|k| xi[k][i])).ok()?;
            for k in 0..N {
                a[k][i] = found[k];
            }
        }
        Some(loaded(simd, &a))
    }
}

#[allow(clippy::manual_map, reason = "a closure may stay a call, in which the registers are not known")]
impl<Sys: System<N, M>, const N: usize, const M: usize> Kernel for StagesAtOnce<'_, Sys, N, M> {
    type Output = CollocationOutcome<N>;

    #[inline(always)]
    fn run<S: Simd, const R: usize>(self, simd: S) -> CollocationOutcome<N> {
        let along = RuleInLanes::<S, R> { square: loaded(simd, &self.rule.square.terms), h: Pack::splat(simd, self.h) };
        let cascade = self.system.reduced().reconstruction();
        let alone = cascade.is_some() && self.system.reduced().stands_alone();

        // Without a predictor the slopes are zero at first.
        let (mut v, mut a) = match self.before {
            Some(([velocity, acceleration], continued)) => {
                let continued = loaded(simd, &continued.terms);
                (ahead(simd, velocity, &continued), ahead(simd, acceleration, &continued))
            }
            None => ([Pack::splat(simd, 0.0); N], [Pack::splat(simd, 0.0); N]),
        };
        let mut q = if cascade.is_some() { self.still(simd) } else { self.q(&along, &v) };
        let mut counts = match &self.counts {
            Some([v, a]) => Some([everywhere(simd, v), everywhere(simd, a)]),
            None => None,
        };
        let mut search = self.ending.begin(self.before.is_some());
        loop {
            // One call site for the accelerations: for a list of effects their inlined code is long.
            let xi = self.xi(&along, &a);
            let v1 = match cascade {
                _ if alone => Some(v),
                Some(quadratures) => self.reconstructed(&along, quadratures, &xi),
                None => self.velocity(simd, &q, &xi),
            };
            let Some(v1) = v1 else { return CollocationOutcome::Unknown };
            // Gauss-Seidel order: the accelerations use the new places.
            if !alone {
                q = self.q(&along, &v1);
            }
            let Some(a1) = self.acceleration(simd, &q, &xi) else { return CollocationOutcome::Unknown };
            let verdict = if search.next_is_untested() {
                EndingVerdict::Continue
            } else {
                let [cv, ca] = match counts {
                    Some(counts) => counts,
                    None => [own(simd, &v1), own(simd, &a1)],
                };
                counts = Some([cv, ca]);
                let mut changes = Pack::splat(simd, 0.0);
                for k in 0..N {
                    if cascade.is_none() {
                        changes = changes.max_abs((v1[k] - v[k]) * cv[k]);
                    }
                    if k < N - M {
                        changes = changes.max_abs((a1[k] - a[k]) * ca[k]);
                    }
                }
                search.look(changes.largest())
            };
            (v, a) = (v1, a1);
            match verdict {
                EndingVerdict::Continue => {}
                EndingVerdict::Done => break,
                EndingVerdict::Failed => return CollocationOutcome::Failed,
            }
        }
        // The velocities that belong to the last accelerations.
        if let Some(quadratures) = cascade {
            match self.reconstructed(&along, quadratures, &self.xi(&along, &a)) {
                Some(last) => v = last,
                None => return CollocationOutcome::Unknown,
            }
        }
        for k in 0..N {
            self.of.slopes.velocity[k] = v[k].row();
            self.of.slopes.acceleration[k] = a[k].row();
        }
        let weights = Pack::load(simd, &self.rule.weights);
        let mut found = Found {
            increment: integral(self.h, weights, &v),
            gain: integral(self.h, weights, &a),
            roughness: 0.0,
            iterations: search.iterations,
            rate: search.contraction,
        };
        if let Some([cv, ca]) = self.counts {
            let highest = Pack::load(simd, &self.rule.highest);
            let (rough_v, rough_a) = (integral(1.0, highest, &v), integral(1.0, highest, &a));
            for k in 0..N {
                found.roughness = larger(found.roughness, (rough_v[k] * cv[k]).abs());
                found.roughness = larger(found.roughness, (rough_a[k] * ca[k]).abs());
            }
        }
        CollocationOutcome::Found(found)
    }
}
