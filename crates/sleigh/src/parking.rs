//! Controls of drive and turn that bring the sleigh to a pose: what its brackets promise, made.

use crate::error::{finite, positive};
use crate::planimeter::wrapped;
use crate::{Pulses, SleighError, SleighState, TimeFunction};
use std::f64::consts::FRAC_PI_2;

/// One move from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Move {
    /// Along the blade (m).
    Drive(f64),
    /// About the blade's contact point (rad).
    Turn(f64),
}

impl Move {
    /// Where it leads to from a pose, exactly.
    #[must_use]
    pub fn end(self, from: &SleighState) -> SleighState {
        match self {
            Self::Drive(d) => {
                let (sin, cos) = from.heading.sin_cos();
                SleighState { x: from.x + d * cos, y: from.y + d * sin, ..*from }
            }
            Self::Turn(angle) => SleighState { heading: from.heading + angle, ..*from },
        }
    }
}

/// A gap to park in, seen from the pose in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// How far it lies beside the lane that it is entered from, to the left where positive (m).
    pub depth: f64,
    /// How far the sleigh may move ahead and back of its place (m).
    pub play: f64,
    /// How far it may turn in it (rad); more than a right angle is of no use, and not used.
    pub swing: f64,
}

/// Moves, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct ParkingPlan {
    /// The moves.
    pub moves: Vec<Move>,
}

/// The square gait: forward `d` (m), turn by `-p` (rad), back, turn by `p`. It moves the blade by `d (1 - cos p, sin p)` in its own
/// frame, and leaves its heading.
#[must_use]
pub fn square_gait(d: f64, p: f64) -> [Move; 4] {
    [Move::Drive(d), Move::Turn(-p), Move::Drive(-d), Move::Turn(p)]
}

/// The sinusoidal gait: speed `A k sin(k t)` (m/s) and heading `B sin(k t)`, with `k` the frequency (rad/s).
///
/// Each period moves the blade sideways by `2 pi A J1(B)`, `J1` a Bessel function, and nowhere else: for small `B` by
/// `pi A B`, the area of the loop of controls, which the bracket of drive and turn is multiplied by.
#[must_use]
pub fn sinusoidal_gait(a: f64, b: f64, frequency: f64) -> [TimeFunction; 2] {
    let sine = |amplitude, phase| TimeFunction::Sine { amplitude, frequency, phase };
    [sine(a * frequency, 0.0), sine(b * frequency, FRAC_PI_2)]
}

impl ParkingPlan {
    /// Maximum number of rounds in the gap.
    const ROUNDS: f64 = 1e4;

    /// From the pose `start` to the pose `goal` in a gap.
    ///
    /// On the lane: turn to the entry, drive there, and turn as in the gap. Then sideways into it by the square gait, ahead and
    /// back by turns so that no way forward adds up, with all the play and as much swing as it needs:
    /// `2 n` rounds with `2 n d sin p = depth`. Velocities are not read.
    ///
    /// # Errors
    /// [`SleighError`] where a number is not finite, play or swing is not positive, or more than ten thousand pairs of rounds
    /// would be needed.
    pub fn park(start: &SleighState, goal: &SleighState, gap: &Gap) -> Result<Self, SleighError> {
        finite("start", [start.x, start.y, start.heading])?;
        finite("goal", [goal.x, goal.y, goal.heading])?;
        finite("depth of the gap", [gap.depth])?;
        positive("play in the gap", gap.play)?;
        positive("swing in the gap", gap.swing)?;
        let swing = gap.swing.min(FRAC_PI_2);

        let (sin, cos) = goal.heading.sin_cos();
        let entry = [goal.x + gap.depth * sin, goal.y - gap.depth * cos];
        let (dx, dy) = (entry[0] - start.x, entry[1] - start.y);
        let towards = if dx == 0.0 && dy == 0.0 { start.heading } else { dy.atan2(dx) };
        let mut moves = vec![
            Move::Turn(wrapped(towards - start.heading)),
            Move::Drive(dx.hypot(dy)),
            Move::Turn(wrapped(goal.heading - towards)),
        ];

        let pairs = (gap.depth.abs() / (2.0 * gap.play * swing.sin())).ceil();
        if pairs > Self::ROUNDS {
            let problem = format!("{pairs} pairs of rounds would be needed to enter the gap");
            return Err(SleighError::Path { problem });
        }
        let p = if pairs > 0.0 { (gap.depth / (2.0 * pairs * gap.play)).clamp(-1.0, 1.0).asin() } else { 0.0 };
        for _ in 0..pairs as u32 {
            moves.extend(square_gait(gap.play, p));
            moves.extend(square_gait(-gap.play, -p));
        }
        Ok(Self { moves })
    }

    /// The exact poses from `start` on: one more than moves.
    #[must_use]
    pub fn poses(&self, start: &SleighState) -> Vec<SleighState> {
        let mut poses = vec![SleighState { speed: 0.0, turn_rate: 0.0, ..*start }];
        for (k, step) in self.moves.iter().enumerate() {
            poses.push(step.end(&poses[k]));
        }
        poses
    }

    /// Speed (m/s) and turn rate (rad/s) that a servo needs to make the moves: one smooth pulse of `seconds` (s) for each move.
    ///
    /// # Errors
    /// [`SleighError`] if `seconds` is not positive.
    pub fn controls(&self, seconds: f64) -> Result<[TimeFunction; 2], SleighError> {
        positive("time of a move", seconds)?;
        let times: Vec<f64> = (0..=self.moves.len()).map(|k| k as f64 * seconds).collect();
        let pulses = |part: fn(&Move) -> f64| {
            let areas = self.moves.iter().map(part).collect();
            Ok::<_, SleighError>(TimeFunction::Pulses(Pulses::new(times.clone(), areas)?))
        };
        let drive = pulses(|step| if let Move::Drive(d) = step { *d } else { 0.0 })?;
        let turn = pulses(|step| if let Move::Turn(angle) = step { *angle } else { 0.0 })?;
        Ok([drive, turn])
    }

    /// Duration of the controls (s), with `seconds` (s) for each move.
    #[must_use]
    pub fn duration(&self, seconds: f64) -> f64 {
        self.moves.len() as f64 * seconds
    }
}
