use super::Memory;
use super::foreseen::Foreseen;
use super::half_turn::half_turn;
use super::heading::NO_HEADING;

/// Number of backward differences of the mean velocities that are kept; the first are the last mean velocities themselves.
const KEPT: usize = 8;
const SIZE: usize = 6 + 2 * KEPT;
/// Identifies these numbers and their order. A checkpoint may come from an older version or another map.
const KIND: f64 = 6.0;

/// The numbers that a step of the pushed map leaves to the next.
pub(crate) type MeanMemory<'a> = Foreseen<'a, 2, KEPT, SIZE>;

/// The numbers left by steps of length `h`, for a step that begins at this heading with the velocities `x`. If there are none, they are
/// as after many steps with the velocities `x`; `None` if the blade would then turn by a right angle in half the step.
#[inline(always)]
pub(crate) fn remembered(memory: &mut Memory, h: f64, heading: f64, x: [f64; 2]) -> Option<MeanMemory<'_>> {
    if !memory.is_of(h, KIND) {
        begin(memory, h, x)?;
    }
    Some(Foreseen::of(memory, heading))
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn begin(memory: &mut Memory, h: f64, x: [f64; 2]) -> Option<()> {
    let (sin, cos) = half_turn(0.5 * h * x[1]).ok()?;
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    (*numbers, *heading) = ([0.0; SIZE], NO_HEADING);
    numbers[..8].copy_from_slice(&[sin, cos, x[0], x[1], x[0], x[1], x[0], x[1]]);
    Some(())
}
