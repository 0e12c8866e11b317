//! The course of an error over a long run: its swings, its drift, and its growth.

mod batches;
mod blocks;
mod energies;

pub use blocks::Blocks;
pub use energies::{Energies, EnergyJump};

use batches::Batches;
use std::fmt;

/// The kind of the slow part of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriftVerdict {
    /// It is stationary, or moves too little beside the amplitude to be seen.
    Bounded,
    /// It grows with the time.
    LinearDrift,
    /// It grows with the square root of the time.
    RandomWalk,
    /// It never leaves the rounding of the energy itself, whatever it does there.
    RoundOff,
    /// It grows beyond the energies of the motion, or faster and faster to the end: the run has blown up.
    Diverged,
    /// The series is too short, or does none of these: it settles, jumps, wanders as slowly as the run is long.
    Undecided,
}

impl DriftVerdict {
    /// Its name, in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bounded => "bounded",
            Self::LinearDrift => "linear drift",
            Self::RandomWalk => "random walk",
            Self::RoundOff => "round-off",
            Self::Diverged => "diverged",
            Self::Undecided => "undecided",
        }
    }
}

impl fmt::Display for DriftVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The fast and the slow part of an error over a run, apart.
///
/// With the blocks of [`Blocks`] and 32 batches of them (the tests, their thresholds and sources: `docs/methods/drift.md`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    /// The fast part: half the largest range within a batch, a 32nd of the run, about a line.
    pub amplitude: f64,
    /// The secular part: slope of the least-squares line through the means of the blocks (per s).
    pub slope: f64,
    /// Half the width of the 95 % confidence interval of the slope (per s); `None` if the series is too short.
    pub slope_ci: Option<f64>,
    /// Growth exponent: 0 bounded, 1/2 a random walk, 1 linear; `None` if the series is too short.
    pub exponent: Option<f64>,
    /// The kind of the slow part.
    pub verdict: DriftVerdict,
}

/// Student's factor for 95 % and for 99 %, both sides, at the 30 degrees of freedom of 32 batches less two.
const T95: f64 = 2.042;
const T99: f64 = 2.750;
/// The 5 % point of the statistic of stationarity about a line (Kwiatkowski et al. 1992, table 1).
const STATIONARY: f64 = 0.146;
/// The energy is a sum of a few terms, each with its rounding: an error of up to this number of units in the last place of the largest
/// energy is no error of a method.
const OF_ROUNDING: f64 = 8.0;
/// Between the growth exponents of a bounded series and of a random walk.
const BETWEEN: f64 = 0.25;
/// A change over the run below this part of the amplitude counts as none: a sine of period `P` that is cut at the ends of the run and of
/// the batches has a least-squares slope of `(6/pi) P/T` amplitudes a run, which is `0.06` for a period of 1/32 of the run.
const SEEN: f64 = 1.0 / 16.0;

impl Drift {
    /// The drift of a series.
    #[must_use]
    pub fn of(blocks: &Blocks) -> Self {
        let nothing =
            Self { amplitude: 0.0, slope: 0.0, slope_ci: None, exponent: None, verdict: DriftVerdict::Undecided };
        let size = blocks.full().iter().map(|block| block.min.abs().max(block.max.abs())).fold(0.0, f64::max);
        if blocks.full().is_empty() || !blocks.means().all(f64::is_finite) {
            return nothing;
        }
        if size == 0.0 {
            return Self { slope_ci: Some(0.0), exponent: Some(0.0), verdict: DriftVerdict::Bounded, ..nothing };
        }
        // In units of the largest value and of the run's length nothing over- or underflows.
        let means: Vec<f64> = blocks.means().map(|mean| mean / size).collect();
        let run = blocks.spacing() * means.len() as f64;
        let ranges: Vec<[f64; 2]> = blocks.full().iter().map(|b| [b.min / size, b.max / size]).collect();
        let (_, slope) = batches::line(&means);
        let amplitude = batches::amplitude(&means, &ranges);
        let measured = Self { amplitude: amplitude * size, slope: slope * size / run, ..nothing };
        let (Some(batches), Some(exponent)) = (Batches::of(&means), batches::exponent(&means)) else { return measured };
        let stationary = batches.stationarity() < STATIONARY && exponent < BETWEEN;
        let error = if stationary { batches.error() } else { batches.error().max(batches.error_of_walk()) };
        // The means of constants differ by their rounding.
        let floor = (SEEN * amplitude).max(64.0 * f64::EPSILON);
        let verdict = if slope.abs() < floor && batches.residual() < floor {
            DriftVerdict::Bounded
        } else if slope.abs() > T99 * error && slope.abs() > floor {
            DriftVerdict::LinearDrift
        } else if stationary {
            DriftVerdict::Bounded
        } else if exponent >= BETWEEN && batches.stationarity() >= STATIONARY && batches.walks() {
            DriftVerdict::RandomWalk
        } else {
            DriftVerdict::Undecided
        };
        Self { slope_ci: Some(T95 * error * size / run), exponent: Some(exponent), verdict, ..measured }
    }

    /// The drift of the error of the energy of a run, beside the energies of its motion.
    ///
    /// It is round-off if it stays within a few units in the last place of the largest of the energies, which can show no drift. It has
    /// diverged if it was larger than all of them; if it ends above the energies of the start, nearly all of its sum of squares is in the
    /// last batches, and most of these are larger than all before; or if step after step changes the energy by a tenth of it. An error is
    /// not bounded if one step does so.
    #[must_use]
    pub fn of_energy(blocks: &Blocks, energies: &Energies) -> Self {
        let drift = Self::of(blocks);
        let runs_away = || batches::runs_away(blocks.full()).is_some_and(|largest| largest > energies.start());
        let largest = blocks.full().iter().map(|block| block.min.abs().max(block.max.abs())).fold(0.0, f64::max);
        let of_rounding = largest <= OF_ROUNDING * f64::EPSILON * energies.largest();
        let verdict = match drift.verdict {
            _ if energies.exceeded() || energies.runs_off() || runs_away() => DriftVerdict::Diverged,
            DriftVerdict::Bounded if energies.jump().is_some() => DriftVerdict::Undecided,
            DriftVerdict::LinearDrift | DriftVerdict::RandomWalk if of_rounding => DriftVerdict::RoundOff,
            // A motion that runs away has large energies, whose rounding is no small error beside those at the start.
            DriftVerdict::Bounded if of_rounding && largest > energies.start() => DriftVerdict::RoundOff,
            verdict => verdict,
        };
        Self { verdict, ..drift }
    }

    /// The largest error to be expected at a time (s) after the start: the fast part and the secular one.
    #[must_use]
    pub fn reach(&self, time: f64) -> f64 {
        self.amplitude + self.slope.abs() * time
    }

    /// The length of run (s) from which on this error is the smaller one, though it starts as the larger: the time at which both have the
    /// same [`reach`](Self::reach). `None` unless the other drifts, and faster beyond the two intervals of confidence.
    #[must_use]
    pub fn better_from(&self, other: &Self) -> Option<f64> {
        let (own, others) = (self.slope.abs(), other.slope.abs());
        let faster = own + self.slope_ci? < others - other.slope_ci?;
        let starts_worse = self.amplitude > other.amplitude;
        (starts_worse && faster && other.verdict == DriftVerdict::LinearDrift)
            .then(|| (self.amplitude - other.amplitude) / (others - own))
    }
}
