use super::{LANES, Systems};
use crate::KnownAngle;
use lagrangian::simd::{Pack, Simd, Wide};
use lagrangian::{Reduced, Scalar, System, array, velocity_of};

/// `S` stages of eight trajectories.
///
/// A row of eight numbers fills a cache line, to which it is aligned.
#[repr(align(64))]
pub(super) struct LaneStages<Si: Simd, const R: usize, const S: usize, const N: usize> {
    pub(super) q: [[Pack<Si, R>; S]; N],
    /// Sines and cosines of those coordinates that are angles.
    sin: [[Pack<Si, R>; S]; N],
    cos: [[Pack<Si, R>; S]; N],
    pub(super) xi: [[Pack<Si, R>; S]; N],
}

/// What is asked of a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StageSlope {
    /// The velocity of the quasi-velocities.
    Velocity,
    /// The accelerations of the quasi-velocities.
    Acceleration,
}

/// A number of a model: eight at once, angles with their sines.
type KnownStage<Si, const R: usize> = KnownAngle<Wide<Si, R>>;

/// Where a model is evaluated, at eight points.
#[repr(align(64))]
struct StagePoints<Si: Simd, const R: usize, const N: usize> {
    q: [Pack<Si, R>; N],
    sin: [Pack<Si, R>; N],
    cos: [Pack<Si, R>; N],
    xi: [Pack<Si, R>; N],
}

impl<Si: Simd, const R: usize, const S: usize, const N: usize> LaneStages<Si, R, S, N> {
    /// All points at one place, whose sines are not computed yet.
    #[inline(always)]
    pub(super) fn still(q: &[Pack<Si, R>; N], xi: &[Pack<Si, R>; N]) -> Self {
        let none = [[q[0]; S]; N];
        Self { q: everywhere(q), sin: none, cos: none, xi: everywhere(xi) }
    }

    /// Finds sine and cosine of an angle.
    #[inline(always)]
    pub(super) fn turn(&mut self, k: usize) {
        for i in 0..S {
            (self.sin[k][i], self.cos[k][i]) = self.q[k][i].sin_cos();
        }
    }

    /// A slope in every stage, each of which is told to `found`, from the times of the stages.
    #[inline(always)]
    pub(super) fn slopes<Sys, const W: usize, const M: usize>(
        &self,
        slope: StageSlope,
        systems: &impl Systems<Sys, W>,
        register: usize,
        times: &[f64; S],
        mut found: impl FnMut(usize, [Pack<Si, R>; N]),
    ) where
        Sys: System<N, M>,
    {
        if let Some(system) = systems.common() {
            for i in 0..S {
                let t = KnownStage::constant(times[i]);
                found(i, self.points(i).slope::<Sys, M>(slope, system, t));
            }
            return;
        }
        // Where each lane has its own system, the stages of a lane are eight points of it.
        let simd = self.q[0][0].simd();
        let mut time = [times[0]; LANES];
        time[..S].copy_from_slice(times);
        let mut all = [[Pack::splat(simd, 0.0); S]; N];
        for lane in 0..LANES {
            let system = systems.of(LANES * register + lane);
            let t = KnownAngle::from(wide(Pack::load(simd, &time)));
            let of_lane = self.points_of_lane(lane).slope::<Sys, M>(slope, system, t);
            for k in 0..N {
                for i in 0..S {
                    all[k][i].lanes_mut()[lane] = of_lane[k].lanes()[i];
                }
            }
        }
        for i in 0..S {
            found(i, across(&all, i));
        }
    }

    /// All lanes of a stage.
    #[inline(always)]
    fn points(&self, i: usize) -> StagePoints<Si, R, N> {
        StagePoints {
            q: across(&self.q, i),
            sin: across(&self.sin, i),
            cos: across(&self.cos, i),
            xi: across(&self.xi, i),
        }
    }

    /// All stages of a lane.
    #[inline(always)]
    fn points_of_lane(&self, lane: usize) -> StagePoints<Si, R, N> {
        StagePoints {
            q: along(&self.q, lane),
            sin: along(&self.sin, lane),
            cos: along(&self.cos, lane),
            xi: along(&self.xi, lane),
        }
    }
}

impl<Si: Simd, const R: usize, const N: usize> StagePoints<Si, R, N> {
    /// What a system gives there; NaN where it does not know.
    #[inline(always)]
    fn slope<Sys: System<N, M>, const M: usize>(
        &self,
        slope: StageSlope,
        system: &Sys,
        t: KnownStage<Si, R>,
    ) -> [Pack<Si, R>; N] {
        let angles = system.angles();
        let q = array(
            KnownStage::zero(),
            #[inline(always)]
            |k| match angles[k] {
                true => KnownAngle::new(wide(self.q[k]), wide(self.sin[k]), wide(self.cos[k])),
                false => KnownAngle::from(wide(self.q[k])),
            },
        );
        let xi = array(
            KnownStage::zero(),
            #[inline(always)]
            |k| if k < N - M { KnownAngle::from(wide(self.xi[k])) } else { KnownStage::zero() },
        );
        let found = match slope {
            StageSlope::Velocity => velocity_of(system, t, &q, &xi).ok(),
            StageSlope::Acceleration => system.reduced().reduced_motion(t, &q, &xi),
        };
        let simd = self.q[0].simd();
        match found {
            Some(found) => array(
                self.q[0],
                #[inline(always)]
                |k| found[k].re.pack(simd).whole(),
            ),
            None => [Pack::splat(simd, f64::NAN); N],
        }
    }
}

/// The same in all stages.
#[inline(always)]
fn everywhere<Si: Simd, const R: usize, const S: usize, const N: usize>(x: &[Pack<Si, R>; N]) -> [[Pack<Si, R>; S]; N] {
    array(
        [x[0]; S],
        #[inline(always)]
        |k| [x[k]; S],
    )
}

/// A number, as a model takes it.
#[inline(always)]
fn wide<Si: Simd, const R: usize>(x: Pack<Si, R>) -> Wide<Si, R> {
    Wide::Each(x.whole())
}

/// The numbers of a stage.
#[inline(always)]
fn across<Si: Simd, const R: usize, const S: usize, const N: usize>(
    x: &[[Pack<Si, R>; S]; N],
    i: usize,
) -> [Pack<Si, R>; N] {
    array(
        x[0][0],
        #[inline(always)]
        |k| x[k][i],
    )
}

/// The numbers of a lane; of fewer stages than eight the first fills the other places.
#[inline(always)]
fn along<Si: Simd, const R: usize, const S: usize, const N: usize>(
    x: &[[Pack<Si, R>; S]; N],
    lane: usize,
) -> [Pack<Si, R>; N] {
    array(
        x[0][0],
        #[inline(always)]
        |k| {
            let mut row = [x[k][0].lanes()[lane]; LANES];
            for i in 1..S {
                row[i] = x[k][i].lanes()[lane];
            }
            Pack::load(x[k][0].simd(), &row)
        },
    )
}
