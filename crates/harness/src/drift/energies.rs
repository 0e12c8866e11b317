use dla::{Checkpoint, CheckpointError};
use lagrangian::Shown;
use lagrangian::linear::larger;
use std::fmt;

/// An error of the energy that is larger than this many times the kinetic energy is not an error of the velocities: round-off of a potential,
/// say, while the system rests.
const OF_THE_MOTION: f64 = 8.0;

/// A step that changes the energy by this fraction of all that the motion has, beyond the work of the forces, does not follow the motion.
const OF_A_JUMP: f64 = 0.1;

/// Steps that change the energy by a tenth of it, or more, though no force does that work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyJump {
    /// The time at which the first of them ends (s).
    pub time: f64,
    /// The change of the energy beyond the work in that step (J).
    pub change: f64,
    /// The largest energy of the motion until then: at the start, kinetic, or as work (J).
    pub energy: f64,
    /// The number of such steps.
    pub count: u64,
}

impl fmt::Display for EnergyJump {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, change, energy, count } = self;
        write!(
            f,
            "the step to t = {} s changes the energy by {change:.1e} J of {energy:.1e} J, and no force does that work",
            Shown(*time)
        )?;
        if *count > 1 {
            write!(f, "; so do {} further steps", count - 1)?;
        }
        f.write_str(": the steps are too long for the motion, or for what drives it")
    }
}

/// The energies of a motion, beside which an error of the energy is large or small.
///
/// A kinetic energy counts only if the error is less than half of it: the kinetic energy of a run that has blown up is itself the error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// The largest of the energy at the start, the kinetic energy there and the work since (J).
    start: f64,
    /// The largest kinetic energy that counts (J).
    reached: f64,
    /// Whether an error was larger than all of them.
    exceeded: bool,
    /// The energy at the start or the kinetic energy there, the larger of them (J).
    initial: f64,
    /// The error at the last node, and the largest one (J).
    last: f64,
    largest: f64,
    /// The error when the kinetic energy was last asked for because the error had doubled (J).
    asked: f64,
    jump: Option<EnergyJump>,
    /// The largest change of a step that jumps (J).
    worst: f64,
}

impl Energies {
    /// The energies of a motion that starts with this energy and this kinetic energy (J).
    #[must_use]
    pub fn of_start(energy: f64, kinetic: f64) -> Self {
        let initial = larger(energy.abs(), kinetic.abs());
        Self { start: initial, initial, ..Self::default() }
    }

    /// Sees the error of the energy at the node at the time `t` (s), and the work since the start (J); the kinetic energy is asked for only
    /// if the error has doubled, or the error or its change is large beside all energies before.
    #[inline]
    pub fn see(&mut self, t: f64, error: f64, work: f64, kinetic: impl Fn() -> f64) {
        self.start = larger(self.start, work.abs());
        let change = error - self.last;
        self.last = error;
        if change.abs() > OF_A_JUMP * larger(self.start, self.reached) {
            self.jumps(t, change, kinetic().abs());
        }
        let error = error.abs();
        self.largest = larger(self.largest, error);
        // The rounding of a motion that runs away grows with its kinetic energy.
        let (doubled, small) = (error > 2.0 * self.asked, error <= larger(self.start, self.reached));
        if small && !doubled {
            return;
        }
        if doubled {
            self.asked = error;
        }
        let kinetic = kinetic().abs();
        if error < 0.5 * kinetic {
            self.reached = larger(self.reached, kinetic);
        } else if !small {
            let beyond = error > OF_THE_MOTION * kinetic;
            // Also if one of them is not a number.
            self.exceeded |= !beyond || !error.is_finite();
        }
    }

    #[cold]
    fn jumps(&mut self, time: f64, change: f64, kinetic: f64) {
        let energy = larger(larger(self.start, self.reached), kinetic);
        let of_the_motion = change.abs() <= OF_THE_MOTION * larger(larger(self.initial, self.reached), kinetic);
        if change.abs() > OF_A_JUMP * energy && of_the_motion {
            let first = self.jump.unwrap_or(EnergyJump { time, change, energy, count: 0 });
            self.jump = Some(EnergyJump { count: first.count + 1, ..first });
            self.worst = larger(self.worst, change);
        }
    }

    /// The steps that change the energy by a tenth of it, or more. Such steps do not count in a motion that begins at rest, with hardly any
    /// energy, if they are small beside its later energy.
    #[must_use]
    pub fn jump(&self) -> Option<EnergyJump> {
        /// Relative to the largest energy.
        const SMALL: f64 = 0.01;
        self.jump.filter(|_| self.worst > SMALL * larger(self.start, self.reached))
    }

    /// Whether the energy jumps again and again, to a multiple of what it was.
    pub(super) fn runs_off(&self) -> bool {
        /// Least number of jumps, and least multiple of the energy at the start.
        const OFTEN: u64 = 3;
        const MANY: f64 = 100.0;
        self.jump.is_some_and(|jump| jump.count >= OFTEN) && self.largest > MANY * self.initial
    }

    /// Whether an error was larger than all energies of the motion.
    #[must_use]
    pub fn exceeded(&self) -> bool {
        self.exceeded
    }

    /// The largest of the energy at the start, the kinetic energy there and the work (J).
    pub(super) fn start(&self) -> f64 {
        self.start
    }

    /// The largest of them all (J).
    pub(super) fn largest(&self) -> f64 {
        larger(self.start, self.reached)
    }

    /// Writes them to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("energies", &[self.start, self.reached, self.asked]);
        let Self { initial, last, largest, worst, .. } = *self;
        let jump = self.jump.map_or([0.0; 4], |jump| [jump.time, jump.change, jump.energy, jump.count as f64]);
        checkpoint.put("energy_jumps", &[[initial, last, largest, worst], jump].concat());
        checkpoint.put_counts("exceeded", &[u64::from(self.exceeded)]);
    }

    /// The energies that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has none.
    pub fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [start, reached, asked] = checkpoint.get("energies")?;
        let [exceeded] = checkpoint.counts("exceeded")?;
        let [initial, last, largest, worst, time, change, energy, count] = checkpoint.get("energy_jumps")?;
        let jump = (count > 0.0).then_some(EnergyJump { time, change, energy, count: count as u64 });
        Ok(Self { start, reached, exceeded: exceeded > 0, initial, last, largest, asked, worst, jump })
    }
}
