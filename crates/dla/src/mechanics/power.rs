use crate::{Hermite, Mechanics};
use lagrangian::quadrature::gauss_legendre;
use lagrangian::{PowerSources, from_fn};
use std::sync::LazyLock;

/// The power of all sources of work on a system (W), `F . v - dL/dt - lambda . b`: of the generalised forces, of explicit time in the
/// Lagrangian, and of the drive of affine constraints. NaN if the equations of motion do not determine the multipliers.
pub fn power<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    sources: PowerSources,
    t: f64,
    (q, v): (&[f64; N], &[f64; N]),
) -> f64 {
    let mut power = 0.0;
    if sources.time {
        power += system.lagrangian_power(t, q, v);
    }
    if sources.forces {
        power += system.force_power(t, q, v).unwrap_or(0.0);
    }
    if sources.constraints {
        let (_, b) = system.constraint(t, q);
        if b.iter().any(|b| *b != 0.0) {
            let Ok(motion) = system.motion(t, q, v) else { return f64::NAN };
            // lambda . (A v) is -lambda . b on the constraint, and keeps its order off it.
            let residual = system.residual(t, q, v);
            power += (0..M).map(|k| motion.multiplier[k] * (residual[k] - b[k])).sum::<f64>();
        }
    }
    power
}

/// The mean of a power over a step, by the weights of a quadrature rule, whose sum is one.
///
/// If the power at a node is not a number, because forces or multipliers are not determined at that one place, the node takes the mean of
/// the other nodes: so the work of all later steps stays known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeanPower {
    weighted: f64,
    sum: f64,
    known: u32,
    unknown: bool,
}

impl MeanPower {
    /// Adds the power (W) at a node of the rule.
    #[inline]
    pub fn add(&mut self, weight: f64, power: f64) {
        if power.is_finite() {
            self.weighted += weight * power;
            self.sum += power;
            self.known += 1;
        } else {
            self.unknown = true;
        }
    }

    /// The mean (W).
    #[must_use]
    pub fn mean(&self) -> f64 {
        if self.unknown { self.sum / f64::from(self.known.max(1)) } else { self.weighted }
    }
}

/// The work over a step between two places, times, configurations and velocities: [`power`] with four Gauss nodes along the polynomial of
/// degree five that has the accelerations of both ends too, or of degree three if an end has none.
pub(crate) fn work_between<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    sources: PowerSources,
    (t0, q0, v0): (f64, &[f64; N], &[f64; N]),
    (t1, q1, v1): (f64, &[f64; N], &[f64; N]),
) -> f64 {
    static RULE: LazyLock<([f64; 4], [f64; 4])> = LazyLock::new(gauss_legendre);
    let (nodes, weights) = &*RULE;
    let h = t1 - t0;
    let time = |c: f64| t0 + c * h;
    let moves = |t: f64, q: &[f64; N]| system.constraint(t, q).1.iter().any(|b| *b != 0.0);
    let mean = |c: f64| from_fn::<f64, N, _>(|i| q0[i] + c * (q1[i] - q0[i]));
    let powered = sources.constraints && (moves(t0, q0) || moves(t1, q1))
        || sources.forces && system.force(t0, q0, v0).is_some()
        || sources.time && nodes.iter().any(|c| system.lagrangian_power(time(*c), &mean(*c), v1) != 0.0);
    if !powered {
        return 0.0;
    }
    // An end without accelerations takes the acceleration of the cubic.
    let acceleration = |t: f64, q: &[f64; N], v: &[f64; N], other: &[f64; N], side: f64| match system.motion(t, q, v) {
        Ok(motion) => motion.acceleration,
        Err(_) => from_fn(|i| side * (6.0 * (q1[i] - q0[i]) / h - 4.0 * v[i] - 2.0 * other[i]) / h),
    };
    let (a0, a1) = (acceleration(t0, q0, v0, v1, 1.0), acceleration(t1, q1, v1, v0, -1.0));
    let hermite = Hermite::through((t0, h), [*q0, *v0, a0], [*q1, *v1, a1]);
    let mut mean = MeanPower::default();
    for (&c, &weight) in nodes.iter().zip(weights) {
        let (q, v) = hermite.at_part(c);
        mean.add(weight, power(system, sources, time(c), (&q, &v)));
    }
    h * mean.mean()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_place_without_a_power_counts_as_the_others() {
        let mean = |powers: [f64; 3]| {
            let mut mean = MeanPower::default();
            [0.25, 0.5, 0.25].into_iter().zip(powers).for_each(|(weight, power)| mean.add(weight, power));
            mean.mean()
        };
        for (powers, known) in
            [([1.0, 2.0, 4.0], 2.25), ([1.0, f64::NAN, 4.0], 2.5), ([f64::INFINITY; 3], 0.0), ([0.0; 3], 0.0)]
        {
            assert!((mean(powers) - known).abs() < 1e-15, "{powers:?}: {}", mean(powers));
        }
    }
}
