use crate::{MeanPower, Mechanics, OneStep, State, StepError, StepReport, power};
use lagrangian::PowerSources;

/// A symmetric composition of a symmetric one-step map `S_h`: `S_(g_1 h) S_(g_2 h) .. S_(g_n h)`, of higher order.
///
/// The base must be a one-step map on the distribution, as the discrete Lagrange-d'Alembert maps here are; what carries a
/// multiplier from step to step must not be composed. Some of the sub-steps go backward. From order 6 on the work of a
/// sub-step is measured by the trapezoidal rule, which is symmetric and of order 2 as the base is, so that their sum has the order of the
/// composition. (Hairer, Lubich and Wanner 2006,
/// Geometric Numerical Integration, section V.3; the book, (4.1).)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Composition<Base> {
    pub(crate) base: Base,
    weights: [f64; MOST],
    stages: usize,
    /// The sources whose work is reported.
    sources: PowerSources,
}

/// The stages of order 4, whose work is measured well enough from node to node.
const SUZUKI: usize = 5;
/// As many stages as any composition here has.
const MOST: usize = 15;

impl<Base> Composition<Base> {
    /// The composition of the base with the first weights, mirrored about a centre that makes the sum one.
    fn mirrored(base: Base, first: &[f64]) -> Self {
        let (centre, stages) = (1.0 - 2.0 * first.iter().sum::<f64>(), 2 * first.len() + 1);
        let weight = |i: usize| first.get(i.min((stages - 1).saturating_sub(i))).copied().unwrap_or(centre);
        Self { base, weights: lagrangian::from_fn(weight), stages, sources: PowerSources::NONE }
    }

    /// The parts of a step that its stages make, in their order; their sum is one.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights[..self.stages.min(MOST)]
    }

    /// Suzuki's five stages of order 4 on a base of order 2 (Suzuki 1990, Phys. Lett. A 146, 319-323).
    #[must_use]
    pub fn suzuki4(base: Base) -> Self {
        let g = 1.0 / (4.0 - 4f64.cbrt());
        Self::mirrored(base, &[g, g])
    }

    /// The nine stages of order 6 of Kahan and Li (1997, Math. Comp. 66, 1089-1099).
    #[must_use]
    pub fn kahan_li6(base: Base) -> Self {
        let first =
            [0.392_161_444_007_314_1, 0.332_599_136_789_359_44, -0.706_246_172_557_639_4, 0.082_213_596_293_550_8];
        Self::mirrored(base, &first)
    }

    /// The fifteen stages of order 8 of Suzuki and Umeno, with the digits of McLachlan (1995, SIAM J. Sci. Comput. 16,
    /// 151-168; Hairer, Lubich and Wanner 2006, (V.3.12)).
    #[must_use]
    pub fn fifteen8(base: Base) -> Self {
        let first = [
            0.741_670_364_350_612_6,
            -0.409_100_825_800_031_6,
            0.190_754_710_296_238_4,
            -0.573_862_471_116_082_3,
            0.299_064_181_303_655_9,
            0.334_624_918_245_298_2,
            0.315_293_092_396_766_6,
        ];
        Self::mirrored(base, &first)
    }
}

impl<Base, const N: usize, const M: usize> OneStep<N, M> for Composition<Base>
where
    Base: OneStep<N, M>,
{
    #[inline]
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        let mut inner = *state;
        let (mut total, mut work) = (StepReport::of(0), 0.0);
        let mut done = 0.0;
        let power = |done: f64, at: &State<N>| power(system, self.sources, t + done * h, (at.q(), at.v()));
        let mut before = if self.sources.any() { Some(power(done, &inner)) } else { None };
        for k in 0..self.stages.min(MOST) {
            let weight = self.weights[k];
            let report = self.base.step(system, t + done * h, weight * h, &mut inner)?;
            done += weight;
            total = total.then(&report);
            if let Some(before) = &mut before {
                let mut mean = MeanPower::default();
                mean.add(0.5, *before);
                *before = power(done, &inner);
                mean.add(0.5, *before);
                work += weight * h * mean.mean();
            }
        }
        *state = inner;
        Ok(StepReport { work: before.map(|_| work).or(total.work), ..total })
    }

    fn memory(&self) -> Vec<f64> {
        self.base.memory()
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        self.base.recall(memory, state);
    }

    fn measure_work(&mut self, sources: PowerSources) {
        self.sources = if self.stages > SUZUKI { sources } else { PowerSources::NONE };
    }
}
