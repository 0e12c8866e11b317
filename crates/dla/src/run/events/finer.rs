use super::Event;
use super::interval::EventInterval;
use crate::AnyState;

/// How well the samples of a step show an event between them.
pub(super) enum Between {
    /// Well enough.
    Told,
    /// The event changes more quickly than they show: a number of finer parts of the step, and its values at their ends on the interpolated
    /// states.
    Finer(u32, Vec<(f64, f64)>),
    /// The event changes more quickly than any number of parts shows.
    Untold,
}

/// Largest distance of a value from the cubic through its neighbours, relative to half their range: a sine with four samples in a turn is
/// off by 0.14, and its crossings are found; crossings of a sine with fewer samples may be missed.
const BENDS: f64 = 0.1;
/// The same bound in finer parts: a sine then has six of them in a turn, and no two crossings are close.
const FINE: f64 = 0.03;
/// A cubic gives the states between samples. If an event on it is off by more than this fraction of its bend, the cubic says nothing of the
/// event.
const KNOWN: f64 = 0.25;
/// If it is off by more than this multiple of the bend, the event hardly changes.
const FLAT: f64 = 100.0;
/// A change of an event that this number of roundings of the state and of the time explain is no bend.
const ROUNDINGS: f64 = 64.0;
/// A corner or a jump bends in three neighbouring parts, however many parts there are: up to `CORNERS` bent parts are accepted, once there
/// are `ENOUGH` times as many parts as samples.
const CORNERS: usize = 6;
const ENOUGH: u32 = 8;
/// The most parts of a step.
const MOST: u32 = 1 << 14;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl EventInterval<'_> {
    /// Whether an event bends between the samples of a step, which include one beyond each end: one value in each part is compared with the
    /// cubic through the four samples about it, at a place that differs from part to part. A sine that is sampled too seldom does not meet
    /// the slower sine that it looks like at these places.
    pub(super) fn between(
        &self,
        event: &Event<'_>,
        states: &[(f64, Option<AnyState>)],
        known: &[(f64, f64)],
        parts: u32,
    ) -> Between {
        let on_the_way = |at: f64| {
            let place = at * f64::from(parts) + 1.0;
            let j = (place as usize).min(states.len().saturating_sub(2));
            match (&states[j].1, &states[j + 1].1) {
                (Some(from), Some(to)) => {
                    let [q, v] = cubic((from, to), self.h / f64::from(parts), place - j as f64);
                    event.value_at(self.time(at), &q, &v)
                }
                _ => f64::NAN,
            }
        };
        let (mut bends, mut untold) = (false, false);
        for (at, foretold, range) in places(known, parts) {
            let there = on_the_way(at);
            if (there - foretold).abs() > BENDS * range
                && let Some(state) = self.state(at)
            {
                let truth = event.value(self.time(at), &state);
                let (bend, off) = ((truth - foretold).abs(), (truth - there).abs());
                if bend > BENDS * range && bend > self.rounding(event, at, &state) {
                    bends |= off < KNOWN * bend;
                    untold |= (KNOWN * bend..FLAT * bend).contains(&off);
                }
            }
        }
        // If the states are known too little at one place, they are so at others.
        if untold || !bends {
            return if untold { Between::Untold } else { Between::Told };
        }
        let mut finer = parts;
        while finer <= MOST / 2 {
            finer *= 2;
            let part = |j: i64| j as f64 / f64::from(finer);
            let values: Vec<_> = (-1..=i64::from(finer) + 1).map(|j| (part(j), on_the_way(part(j)))).collect();
            let most = if finer >= ENOUGH * parts { CORNERS } else { 0 };
            let bent = |(at, foretold, range): &(f64, f64, f64)| (on_the_way(*at) - foretold).abs() > FINE * range;
            if places(&values, finer).filter(bent).take(most + 1).count() <= most {
                return Between::Finer(finer, values);
            }
        }
        Between::Untold
    }

    /// The change of an event by some roundings of the time and the state.
    fn rounding(&self, event: &Event<'_>, at: f64, state: &AnyState) -> f64 {
        let (t, off) = (self.time(at), ROUNDINGS * f64::EPSILON);
        let moved = |sign: f64| {
            let factor = |i: usize| 1.0 + off * if i % 2 == 0 { 1.0 } else { sign };
            let near = |x: &[f64]| -> Vec<f64> { x.iter().enumerate().map(|(i, x)| x * factor(i)).collect() };
            event.value_at(t * (1.0 + off), &near(&state.unwrapped()), &near(state.v()))
        };
        let value = event.value(t, state);
        (moved(1.0) - value).abs().max((moved(-1.0) - value).abs())
    }
}

/// Configuration and velocity between two states that are `s` seconds apart: a cubic in the coordinates.
fn cubic((from, to): (&AnyState, &AnyState), s: f64, c: f64) -> [Vec<f64>; 2] {
    let (q0, q1) = (from.unwrapped(), to.unwrapped());
    let parts = |i: usize| {
        let (d0, d1, change) = (s * from.v()[i], s * to.v()[i], q1[i] - q0[i]);
        [d0, 3.0 * change - 2.0 * d0 - d1, d0 + d1 - 2.0 * change]
    };
    let parts: Vec<[f64; 3]> = (0..q0.len()).map(parts).collect();
    let q = q0.iter().zip(&parts).map(|(q, part)| q + c * (part[0] + c * (part[1] + c * part[2])));
    let v = parts.iter().map(|part| (part[0] + c * (2.0 * part[1] + c * 3.0 * part[2])) / s);
    [q.collect(), v.collect()]
}

/// A place in each part, the value there of the cubic through the samples about it, and half the range of these samples plus the rounding
/// of a constant; parts with a missing value are left out.
fn places(known: &[(f64, f64)], parts: u32) -> impl Iterator<Item = (f64, f64, f64)> {
    known.windows(4).enumerate().filter_map(move |(j, four)| {
        let values = [0, 1, 2, 3].map(|k| four[k].1);
        let c = 0.25 + 0.5 * (0.5 + (j + 1) as f64 * GOLDEN).fract();
        let weights = [
            -c * (c - 1.0) * (c - 2.0) / 6.0,
            (c + 1.0) * (c - 1.0) * (c - 2.0) / 2.0,
            -(c + 1.0) * c * (c - 2.0) / 2.0,
            (c + 1.0) * c * (c - 1.0) / 6.0,
        ];
        let cubic = (0..4).map(|k| weights[k] * values[k]).sum::<f64>();
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let rounding = ROUNDINGS * f64::EPSILON * f64::max(most.abs(), least.abs()) / FINE;
        cubic.is_finite().then(|| ((j as f64 + c) / f64::from(parts), cubic, 0.5 * (most - least) + rounding))
    })
}
