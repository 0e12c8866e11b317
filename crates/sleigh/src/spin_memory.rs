use crate::foreseen::Foreseen;
use crate::heading::NO_HEADING;
use lagrangian::Memory;

/// As many differences of the spins are kept, with the last one itself.
const KEPT: usize = 6;
const SIZE: usize = 4 + KEPT;
/// Tells these numbers, in this order, from those of other maps and orders: a checkpoint may be older.
const KIND: f64 = 5.0;

/// What a step of the closed map leaves to the next.
pub(crate) type SpinMemory<'a> = Foreseen<'a, 1, SIZE>;

/// What steps of length `h` have left to one that begins at this heading; before a first one nothing, as after many of the spin `w`.
#[inline(always)]
pub(crate) fn remembered(memory: &mut Memory, h: f64, (heading, w): (f64, f64)) -> SpinMemory<'_> {
    if !memory.is_of(h, KIND) {
        begin(memory, h, w);
    }
    Foreseen::of(memory, heading)
}

// A call, since few steps come here, into memory, where what was remembered is read from.
#[cold]
#[inline(never)]
fn begin(memory: &mut Memory, h: f64, w: f64) {
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    let [none, zero] = [f64::NAN, 0.0];
    (*numbers, *heading) = ([none, none, none, w, w, zero, zero, zero, zero, zero], NO_HEADING);
}
