use std::fmt;

/// The kind of a motion, as far as a run can tell.
///
/// Judged by the quasi-velocities, which determine a motion up to its place: if the basis of admissible velocities turns and moves with the
/// body, a motion with constant quasi-velocities is a relative equilibrium, and one with periodic quasi-velocities is periodic but for a
/// displacement. So a sleigh that drives away along a straight line does not run away: its velocities stay. (If the basis is no such frame,
/// places can be irregular while the velocities are steady or periodic; that is not seen here.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionVerdict {
    /// The quasi-velocities are constant, to a [millionth](Evidence::verdict) of the largest of the run.
    Steady {
        /// Whether an exponent is positive beyond its interval: neighbours leave it.
        unstable: bool,
    },
    /// They repeat, to a thousandth of their range, throughout the second half of the run, four times at least.
    Periodic {
        /// The time after which they repeat (s).
        period: f64,
        /// Whether an exponent is positive beyond its interval: neighbours leave it.
        unstable: bool,
    },
    /// They grow all along the run, and no slower in its second half. The exponents of such a motion depend on the coordinates.
    RunsAway,
    /// They are bounded, neither constant nor periodic, and no exponent is positive beyond its interval.
    Regular,
    /// They are bounded, neither constant nor periodic, and an exponent is positive beyond its interval.
    Chaotic,
    /// The run does not tell.
    Undecided(Undecided),
}

/// Why a run does not tell the kind of its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Undecided {
    /// It is too short for intervals of the exponents.
    TooShort,
    /// The velocities of the second half are larger than in the first, but do not grow as in a motion that runs away.
    NotBounded,
}

/// The numbers by which a motion is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// The largest exponent (1/s).
    pub largest: f64,
    /// Half the width of its interval (1/s), which allows for what a zero exponent may show in this time; `None` if the run is too short.
    pub ci: Option<f64>,
    /// The largest size of the quasi-velocities, each in units of its energy (`J^(1/2)`), since the start of the run.
    pub size: f64,
    /// Their largest distance from their values at the start of the count, in the same units.
    pub change: f64,
    /// Their largest size in each of [`PARTS`] parts of the run of equal length; `None` if it has too few nodes.
    pub maxima: Option<[f64; PARTS]>,
    /// The time after which they repeat (s), if they do.
    pub period: Option<f64>,
}

/// Number of parts of a run in which the largest velocities are taken.
pub const PARTS: usize = 16;
/// Velocities that change by less, relative to the largest of the run, are constant: the remainder of a motion that settles, and the
/// rounding of a steady one, are far below this in runs of usual length.
const STEADY: f64 = 1e-6;
/// Least growth of the velocities of a motion that runs away in the second half of a run: `t^(1/3)`, the slowest that is known of a sleigh
/// (one that a moving mass accelerates), makes 1.26.
const GROWTH: f64 = 1.1;
/// Largest growth of the velocities of a bounded motion, by chance. A random walk makes 1.41.
const BOUNDED: f64 = 1.25;

impl Evidence {
    /// The verdict, by these tests in this order:
    ///
    /// 1. *runs away*: with the largest sizes `m(t)` up to the time `t` of a run of length `T`, all parts after the first quarter have a
    ///    larger one than the part before, `m(T) >= 1.1 m(T/2)`, and `m(T) - m(T/2) >= m(T/2) - m(T/4)`. Every power of `t`, its
    ///    logarithm and every growing exponential grow so;
    ///    velocities that tend to a limit do not, once the limit shows.
    /// 2. *undecided*, if the run is too short for intervals.
    /// 3. *steady*: the velocities change by at most 1e-6 of their size.
    /// 4. *periodic*: there is a period.
    /// 5. *undecided*, if the second half of the run has velocities 1.25 times as large as the first.
    /// 6. *chaotic*: the largest exponent is above its interval. Else *regular*.
    #[must_use]
    pub fn verdict(&self) -> MotionVerdict {
        if self.runs_away() {
            return MotionVerdict::RunsAway;
        }
        let (Some(ci), Some(maxima)) = (self.ci, &self.maxima) else {
            return MotionVerdict::Undecided(Undecided::TooShort);
        };
        let positive = self.largest > ci;
        if self.change <= STEADY * self.size {
            return MotionVerdict::Steady { unstable: positive };
        }
        if let Some(period) = self.period {
            return MotionVerdict::Periodic { period, unstable: positive };
        }
        let (first, second) = maxima.split_at(PARTS / 2);
        if largest(second) > BOUNDED * largest(first) {
            return MotionVerdict::Undecided(Undecided::NotBounded);
        }
        if positive { MotionVerdict::Chaotic } else { MotionVerdict::Regular }
    }

    fn runs_away(&self) -> bool {
        let Some(maxima) = &self.maxima else { return false };
        let [quarter, half, whole] = [PARTS / 4, PARTS / 2, PARTS].map(|parts| largest(&maxima[..parts]));
        let grows = maxima[PARTS / 4 - 1..].is_sorted_by(|before, after| before < after);
        grows && whole >= GROWTH * half && whole - half >= half - quarter
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

impl MotionVerdict {
    /// The name of the verdict, in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Steady { .. } => "steady",
            Self::Periodic { .. } => "periodic",
            Self::RunsAway => "running away",
            Self::Regular => "regular",
            Self::Chaotic => "chaotic",
            Self::Undecided(_) => "undecided",
        }
    }
}

impl fmt::Display for MotionVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.name())?;
        let neighbours = |unstable| {
            if unstable {
                "and neighbouring motions leave \
                it"
            } else {
                "and no exponent is seen to be positive"
            }
        };
        match self {
            Self::Steady { unstable } => write!(f, "the velocities do not change, {}", neighbours(*unstable)),
            Self::Periodic { period, unstable } => {
                write!(f, "the velocities repeat every {period:.6} s, {}", neighbours(*unstable))
            }
            Self::RunsAway => f.write_str("the velocities grow all along, and the exponents depend on the coordinates"),
            Self::Regular => f.write_str("bounded, and no exponent is seen to be positive"),
            Self::Chaotic => f.write_str("bounded, neither steady nor periodic, and the largest exponent is positive"),
            Self::Undecided(Undecided::TooShort) => f.write_str("the run is too short for a confidence interval"),
            Self::Undecided(Undecided::NotBounded) => f.write_str(
                "the velocities in the second half of the run exceed the velocities in the first half: a \
                    longer run may decide",
            ),
        }
    }
}
