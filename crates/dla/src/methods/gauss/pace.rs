//! The length of the next step.
use super::rule::{LONGER, SHORTER};
use lagrangian::linear::larger;
use lagrangian::octaves;

/// The largest roughness of a step at the tolerance one.
const SMOOTHNESS: f64 = 2.0;
/// Bounds on the contraction that the next step should have, in octaves an iteration: a contraction factor of `2^-0.75 = .6` is enough if
/// few iterations are needed, `2^-1.75 = .3` if many are (`docs/methods/gauss.md`).
const SHRINKING: [f64; 2] = [0.75, 1.75];
/// Number of iterations in which a step should converge, between these bounds.
const ITERATIONS: f64 = 12.0;

/// The largest roughness of a step at the tolerance `epsilon`: its power `2 s / (s - 1)` is about the error of the step.
pub(super) fn roughest(stages: usize, epsilon: f64) -> f64 {
    let s = stages as f64;
    SMOOTHNESS * epsilon.powf((s - 1.0) / (2.0 * s))
}

/// The degree of the predictor, the polynomial by which the slopes of a step are continued to the next: the looser the tolerance, the
/// further slopes are from it, and the lower the best degree (`docs/methods/gauss.md`).
pub(super) fn degree(stages: usize, epsilon: f64) -> usize {
    (1.5 - 0.5 * epsilon.log10()).clamp(0.0, stages as f64 - 1.0) as usize
}

/// Number of quarter octaves by which the next step may be longer than a step that had `rough` times the largest roughness, and the
/// contraction factor `rate` in its last iteration.
#[inline(always)]
pub(super) fn longer(stages: usize, rough: f64, rate: f64, iterations: u32) -> i32 {
    // Roughness goes with the power s - 1 of the step.
    let smooth = -octaves(larger(rough, 1e-300)) * (stages as f64 - 1.0).recip();
    let shrinking = -octaves(larger(rate, 1e-3));
    let few = shrinking * f64::from(iterations) / ITERATIONS;
    let converging = shrinking - few.clamp(SHRINKING[0], SHRINKING[1]);
    let longer = (4.0 * smooth.min(converging)).floor().clamp(-f64::from(SHORTER), f64::from(LONGER)) as i32;
    // A step that is smooth enough is not rejected for its iterations.
    if smooth >= 0.0 { longer.max(if converging < 0.0 { -1 } else { 0 }) } else { longer }
}

/// Number of quarter octaves by which a step must be shorter if its error is `excess` times too large: the error at a jump is proportional
/// to the step.
pub(super) fn shorter(excess: f64) -> i32 {
    (4.0 * octaves(excess)).ceil().clamp(3.0, f64::from(SHORTER)) as i32
}

/// The quarter octaves of a length (s), rounded down.
#[inline(always)]
pub(super) fn quarters_of(length: f64) -> i32 {
    (4.0 * octaves(length)).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rougher steps and slower iterations are followed by shorter steps; a smooth step with few iterations may grow although they converge
    /// slowly, one with many iterations may not.
    #[test]
    fn the_next_step_follows_from_the_last() {
        assert!(longer(8, 1e-9, 0.01, 8) == LONGER && longer(8, 1e-300, 0.0, 1) == LONGER);
        assert_eq!(longer(8, 1e9, 0.01, 8), -SHORTER);
        assert_eq!(longer(8, f64::INFINITY, 0.01, 8), -SHORTER);
        assert!(longer(8, 8.0, 0.01, 8) < longer(8, 0.1, 0.01, 8));
        assert!(longer(8, 1e-9, 0.35, 3) > 0 && longer(8, 1e-9, 0.35, 16) < 0);
        for tolerance in [1e-2, 1e-5, 1e-8, 1e-11, 1e-14] {
            assert!(roughest(8, tolerance) > roughest(8, 0.1 * tolerance));
            assert!(degree(8, tolerance) <= degree(8, 0.1 * tolerance));
        }
        assert_eq!([1e-2, 1e-14, 0.0].map(|tolerance| degree(8, tolerance)), [2, 7, 7]);
        assert_eq!(degree(3, 1e-14), 2);
    }
}
