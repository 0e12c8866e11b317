use super::lanes::StageSlopes;
use super::rule::GaussRule;
use crate::Mechanics;
use lagrangian::linear::larger;
use lagrangian::quadrature::{gauss_legendre, lagrange};
use lagrangian::{Smoothness, from_fn};

/// How far the Legendre coefficients of a step are trusted. They alone cannot tell a corner, a jump or a pulse from a smooth motion, nor a
/// smooth function that is as steep, so the trust depends on the kind of functions that the system has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Doubt {
    /// A step is examined again if its coefficients show an error above this (tolerances). `None` if the functions of the system are
    /// polynomials, sines and cosines of the state: the coefficients alone then determine its steps.
    above: Option<f64>,
    /// Whether a step that is much longer than the last is examined in any case: something may happen of which no state tells.
    of_grown: bool,
}

/// Largest accepted error of a step (tolerances); a run has many corners.
const MOST: f64 = 0.5;
/// Coefficients below this (tolerances) come from the error of the iteration.
const SMALL: f64 = 2.0;
/// The part of a step beyond its first or last node.
const OUTSIDE: f64 = 0.02;
/// Number of points between the nodes.
const POINTS: usize = 9;

/// The Gauss rule with nine nodes, for a step whose own rule has fewer and may have missed something: integrals and values of the Lagrange
/// polynomials of the stages at its nodes, and their values at both ends.
#[derive(Debug, PartialEq)]
pub(super) struct Between {
    nodes: [f64; POINTS],
    weights: [f64; POINTS],
    integrals: [[f64; 8]; POINTS],
    values: [[f64; 8]; POINTS],
    ends: [[f64; 8]; 2],
}

impl Between {
    /// The points for a rule with these nodes.
    pub(super) fn of(nodes: &[f64]) -> Self {
        let (points, weights) = gauss_legendre::<POINTS>();
        let (inner, shares) = gauss_legendre::<8>();
        let value = |j: usize, x: f64| if j < nodes.len() { lagrange(nodes, j, x) } else { 0.0 };
        let integral = |j: usize, x: f64| (0..8).map(|m| x * shares[m] * value(j, x * inner[m])).sum::<f64>();
        Self {
            nodes: points,
            weights,
            integrals: points.map(|x| from_fn(|j| integral(j, x))),
            values: points.map(|x| from_fn(|j| value(j, x))),
            ends: [0.0, 1.0].map(|x| from_fn(|j| value(j, x))),
        }
    }
}

/// A step that has been made, not yet accepted.
pub(super) struct Attempt<'a, const N: usize> {
    pub(super) rule: &'static GaussRule,
    pub(super) step: (f64, f64),
    /// Coordinates and quasi-velocities at its beginning and at its end.
    pub(super) ends: [[&'a [f64; N]; 2]; 2],
    pub(super) slopes: &'a StageSlopes<N>,
    /// The weight of each slope, in tolerances.
    pub(super) counts: &'a [[f64; N]; 2],
}

/// Velocities and accelerations.
type Pair<const N: usize> = [[f64; N]; 2];

impl Doubt {
    /// The doubt for functions of this smoothness.
    pub(super) fn of(Smoothness { corners, driven, narrow }: Smoothness) -> Self {
        let above = if corners { Some(MOST) } else { (driven || narrow).then_some(60.0 * MOST) };
        Self { above, of_grown: corners || driven }
    }

    /// The factor by which the error of a step is too large; `None` if it is not. A step that has `grown` is much longer than the last, so
    /// nothing is known of its later part.
    ///
    /// There are two estimates, of different kinds. The defect of the equations, summed by a quadrature at other points than the stages, is
    /// the error of the step if the motion is smooth, and with rare exceptions of its order if it is not. The sum of the sizes of the
    /// defects is weighted by how slowly the coefficients fall off. Changes beyond the last node, or before the first, show at the ends.
    #[inline]
    pub(super) fn excess<const N: usize, const M: usize>(
        self,
        system: &dyn Mechanics<N, M>,
        attempt: &Attempt<'_, N>,
        grown: bool,
    ) -> Option<f64> {
        let error = self.error(system, self.above?, attempt, grown);
        (error > MOST).then(|| error / MOST)
    }

    #[inline(never)]
    fn error<const N: usize, const M: usize>(
        self,
        system: &dyn Mechanics<N, M>,
        above: f64,
        of: &Attempt<'_, N>,
        grown: bool,
    ) -> f64 {
        let (t, h) = of.step;
        let tail = of.tail();
        let (mut error, mut doubtful) = (0.0, grown && self.of_grown);
        for &[last, before] in tail.iter().flatten() {
            let even = (last / before).min(1.0);
            doubtful |= last > SMALL && last * even * even * even > above;
        }
        let between = of.rule.between();
        for (at, (end, values)) in [t, t + h].into_iter().zip(of.ends.iter().zip(&between.ends)) {
            let [q, xi] = *end;
            let Some(defect) = of.defect(system, at, (q, xi), values) else { continue };
            for (defect, [last, _]) in defect.iter().flatten().zip(tail.iter().flatten()) {
                if defect.abs() > 2.0 * last + SMALL {
                    error = larger(error, OUTSIDE * defect.abs());
                }
            }
        }
        if !doubtful {
            return error;
        }
        let (mut signed, mut plain) = ([[0.0; N]; 2], [[0.0; N]; 2]);
        for i in 0..POINTS {
            let [q, xi] = of.along(&between.integrals[i]);
            let at = t + between.nodes[i] * h;
            let Some(defect) = of.defect(system, at, (&q, &xi), &between.values[i]) else { continue };
            for which in 0..2 {
                for k in 0..N {
                    let share = between.weights[i] * defect[which][k];
                    signed[which][k] += share;
                    plain[which][k] += share.abs();
                }
            }
        }
        for which in 0..2 {
            for k in 0..N {
                let [last, before] = tail[which][k];
                let even = (last / before).min(1.0);
                error = larger(error, larger(signed[which][k].abs(), plain[which][k] * even * even * even));
            }
        }
        error
    }
}

impl<const N: usize> Attempt<'_, N> {
    /// Sums over the stages by these factors, velocities and accelerations.
    #[inline(always)]
    fn weighed(&self, factors: &[f64; 8]) -> Pair<N> {
        [&self.slopes.velocity, &self.slopes.acceleration]
            .map(|rows| from_fn(|k| (0..8).map(|j| factors[j] * rows[k][j]).sum()))
    }

    /// The larger of the two highest Legendre coefficients of each slope, in tolerances, and the largest of the three below.
    fn tail(&self) -> [[[f64; 2]; N]; 2] {
        let sums: [Pair<N>; 5] = from_fn(|m| self.weighed(&self.rule.tail[m]));
        from_fn(|which| {
            from_fn(|k| {
                let size = |m: usize| (sums[m][which][k] * self.counts[which][k]).abs();
                [larger(size(0), size(1)), larger(larger(size(2), size(3)), larger(size(4), f64::MIN_POSITIVE))]
            })
        })
    }

    /// The place and the quasi-velocities on the polynomial of the step.
    fn along(&self, integrals: &[f64; 8]) -> Pair<N> {
        let ([start, _], h) = (self.ends, self.step.1);
        let moved = self.weighed(integrals);
        from_fn(|which| from_fn(|k| start[which][k] + h * moved[which][k]))
    }

    /// The slopes of the equations at a point minus the slopes of the polynomial, in tolerances; `None` if the equations have no slopes
    /// there.
    fn defect<const M: usize>(
        &self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        (q, xi): (&[f64; N], &[f64; N]),
        values: &[f64; 8],
    ) -> Option<Pair<N>> {
        let slope = system.reduced_slope(t, q, xi).ok()?;
        let (slopes, there) = ([slope.velocity, slope.acceleration], self.weighed(values));
        let moving = |which: usize, k: usize| which == 0 || k < N - M;
        let defect = |which: usize, k: usize| (slopes[which][k] - there[which][k]) * self.counts[which][k];
        Some(from_fn(|which| from_fn(|k| if moving(which, k) { defect(which, k) } else { 0.0 })))
    }
}
