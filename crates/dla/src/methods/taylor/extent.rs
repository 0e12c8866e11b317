//! How long a polynomial holds.

use super::center::Center;
use super::polynomial::Polynomial;
use super::root::first_negative;
use crate::{Mechanics, StepError};
use std::sync::Arc;

/// Longest polynomial, in its own unit of time.
const LONGEST: f64 = 1e6;
/// Length of a polynomial, in its own unit of time, if a length in the equations begins with zero: a length has no series at zero.
const FROM_ZERO: f64 = 1e-8;
/// Distance of corners that are one, as a part of the polynomial before them.
const SAME_PLACE: f64 = 1e-13;
/// Points at which the equations are asked in a polynomial much longer than the last, and in any other, if the state does not tell all that
/// may happen on the way.
const POINTS: [u32; 2] = [3, 9];
/// Largest defect of the equations along a polynomial, in tolerances; the part of it that is rounding, and of the change of an unknown.
const DEFECT: f64 = 1e3;
const ROUNDING: f64 = 1e-13;
const ROUNDING_OF_CHANGE: f64 = 1e-11;

impl Polynomial {
    /// Finds how long the polynomial about a center holds; the one before held for `before` (s).
    pub(super) fn settle<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        center: &mut Center<N>,
        before: Option<f64>,
    ) -> Result<(), StepError> {
        self.choose_sides(center)?;
        let mut full = self.pace.longest(&self.series).min(LONGEST);
        if self.series.leaves_zero() {
            full = full.min(FROM_ZERO);
        }
        center.full = (full * center.unit).min(self.longest);
        self.end_at_corner(center)?;
        let grown = self.doubted() && before.is_none_or(|before| center.full > 2.0 * before);
        if grown || self.of.recurrences.is_sudden() {
            while self.misses_something(system, center, POINTS[usize::from(grown && self.smoothness.driven)]) {
                center.full *= 0.5;
                center.after = None;
                if center.full <= f64::EPSILON * f64::EPSILON * center.unit {
                    return Err(StepError::Tolerance { tries: 1, step: center.full });
                }
            }
        }
        Ok(())
    }

    /// Whether the equations at some points are others than the polynomial says.
    fn misses_something<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        center: &Center<N>,
        points: u32,
    ) -> bool {
        (0..points).any(|k| {
            let s = (f64::from(k) + 0.5) / f64::from(points) * (center.end() - center.t);
            let t = center.t + s;
            self.rates_at(center, s);
            let mut place = center.clone();
            let Ok(()) = self.advance(&mut place, t) else { return true };
            let Ok(slope) = system.reduced_slope(t, place.state.q(), &place.xi[0]) else { return true };
            let n = self.of.coordinates;
            let rates = slope.velocity[..n].iter().chain(&slope.acceleration).take(self.rates.len());
            rates.enumerate().any(|(j, rate)| self.refutes(j, self.rates[j], *rate, center.full))
        })
    }

    /// The sides of corners at which the motion begins: those to which it goes. Of a number that stays zero there is no side.
    fn choose_sides<const N: usize>(&mut self, center: &mut Center<N>) -> Result<(), StepError> {
        for corner in 0..center.sides.len() {
            let value = self.series.argument(corner).next().unwrap_or(0.0);
            if center.sides[corner] != 0.0 {
                continue;
            }
            let sides = Arc::clone(&center.sides);
            let with = |side: f64| sides.iter().enumerate().map(move |(k, s)| if k == corner { side } else { *s });
            if value != 0.0 {
                center.sides = with(value.signum()).collect();
                continue;
            }
            let candidates: [Arc<[f64]>; 3] = [1.0, -1.0, 0.0].map(|side| with(side).collect());
            for sides in candidates {
                let side = sides[corner];
                center.sides = sides;
                self.expand(center)?;
                let sign = if center.forward { 1.0 } else { -1.0 };
                let mut higher = (0..).zip(self.series.argument(corner)).skip(1).filter(|(_, c)| *c != 0.0);
                let goes = higher.next().map_or(0.0, |(k, c)| c.signum() * if k % 2 == 1 { sign } else { 1.0 });
                if goes * side > 0.0 || (goes == 0.0 && side == 0.0) {
                    break;
                }
                if side == 0.0 {
                    // Driven back from both sides.
                    return Err(StepError::Tolerance { tries: 1, step: 0.0 });
                }
            }
        }
        Ok(())
    }

    /// Ends the polynomial at the first corners on its way.
    fn end_at_corner<const N: usize>(&self, center: &mut Center<N>) -> Result<(), StepError> {
        let length = center.full / center.unit;
        let step = if center.forward { length } else { -length };
        let mut parts = Vec::new();
        for (corner, &side) in center.sides.iter().enumerate() {
            let mut power = 1.0;
            let scaled = self.series.argument(corner).map(|c| {
                let term = side * c * power;
                power *= step;
                term
            });
            let mut terms: Vec<f64> = scaled.collect();
            // A corner at which the polynomial begins is no corner on its way.
            let turned = center.before.as_ref().is_some_and(|before| before[corner] * side < 0.0);
            if turned || terms.first() == Some(&0.0) {
                terms.remove(0);
                if terms.first().is_some_and(|slope| *slope < 0.0) {
                    return Err(StepError::Tolerance { tries: 1, step: 0.0 });
                }
            }
            parts.push(first_negative(&terms));
        }
        let Some(first) = parts.iter().flatten().copied().reduce(f64::min) else { return Ok(()) };
        center.full *= first;
        // Several may be at one place.
        let near = SAME_PLACE * first + 4.0 * f64::EPSILON * center.end().abs() / (length * center.unit);
        let here = |part: &Option<f64>| part.is_some_and(|part| part <= first + near);
        let after = center.sides.iter().zip(&parts).map(|(side, part)| if here(part) { -side } else { *side });
        center.after = Some(after.collect());
        Ok(())
    }

    /// Whether coefficients may be too small to foretell the motion; the coefficients of polynomials, sines and cosines never are.
    pub(super) fn doubted(&self) -> bool {
        self.smoothness.driven || self.smoothness.narrow
    }

    /// Whether the rates about a new center, in a unit of time, are others than a polynomial of this length (s) foretold.
    pub(super) fn refuted(&self, unit: f64, full: f64) -> bool {
        let rates = self.series.coefficients(1);
        (0..rates.len()).any(|j| self.refutes(j, self.rates[j], rates[j] / unit, full))
    }

    /// Whether a rate of an unknown is another than a polynomial of this length (s) foretold.
    fn refutes(&self, unknown: usize, foretold: f64, rate: f64, full: f64) -> bool {
        let size = 1.0 + self.start[unknown].abs();
        let allowed = (DEFECT * self.tolerance + ROUNDING) * size + ROUNDING_OF_CHANGE * full * rate.abs();
        let defect = (rate - foretold).abs() * full;
        defect > allowed || defect.is_nan()
    }
}
