use dla::{Checkpoint, CheckpointError};
use lagrangian::linear::larger;

/// An error of the energy that is larger than this many times the kinetic energy is not an error of the velocities: round-off of a potential,
/// say, while the system rests.
const OF_THE_MOTION: f64 = 8.0;

/// The energies of a motion, beside which an error of the energy is large or small.
///
/// A kinetic energy counts only where the error is less than half of it: the kinetic energy of a run that has blown up is itself
/// the error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// The largest of the energy at the start, the kinetic energy there and the work since (J).
    start: f64,
    /// The largest kinetic energy that counts (J).
    reached: f64,
    /// Whether an error was larger than all of them.
    exceeded: bool,
}

impl Energies {
    /// Those of a motion that starts with this energy and this kinetic energy (J).
    #[must_use]
    pub fn of_start(energy: f64, kinetic: f64) -> Self {
        Self { start: larger(energy.abs(), kinetic.abs()), ..Self::default() }
    }

    /// Sees the error of the energy at a node, and the work since the start (J); the kinetic energy is asked for where the
    /// error is larger than all energies before.
    #[inline]
    pub fn see(&mut self, error: f64, work: f64, kinetic: impl FnOnce() -> f64) {
        self.start = larger(self.start, work.abs());
        let error = error.abs();
        if error <= larger(self.start, self.reached) {
            return;
        }
        let kinetic = kinetic().abs();
        if error < 0.5 * kinetic {
            self.reached = larger(self.reached, kinetic);
        } else {
            let beyond = error > OF_THE_MOTION * kinetic;
            // Also where one of them is not a number.
            self.exceeded |= !beyond || !error.is_finite();
        }
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
        checkpoint.put("energies", &[self.start, self.reached]);
        checkpoint.put_counts("exceeded", &[u64::from(self.exceeded)]);
    }

    /// Those that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] where the checkpoint has none.
    pub fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [start, reached] = checkpoint.get("energies")?;
        let [exceeded] = checkpoint.counts("exceeded")?;
        Ok(Self { start, reached, exceeded: exceeded > 0 })
    }
}
