use super::Memory;
use super::foreseen::Foreseen;
use super::heading::NO_HEADING;

/// As many differences of the spins are kept, with the last one itself.
const KEPT: usize = 6;
/// Behind them the last spin that was too small to have digits of its own: as it was rounded, and with them.
const WITH_DIGITS: usize = 4 + KEPT;
const SIZE: usize = WITH_DIGITS + 2;
/// Tells these numbers, in this order, from those of other maps and orders: a checkpoint may be older.
const KIND: f64 = 5.0;
/// So much larger a spin is kept with its digits: the least number there is then has them all.
const LARGER: f64 = (1u128 << 100) as f64;

/// What a step of the closed map leaves to the next.
pub(crate) type SpinMemory<'a> = Foreseen<'a, 1, KEPT, SIZE>;
/// The numbers of it, without the heading.
pub(crate) type SpinNumbers = [f64; SIZE];

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
    // Digits outlast steps of another length, as in a composition.
    let another = memory.is_empty() || memory.0[1].to_bits() != KIND.to_bits();
    memory.begin(h, KIND);
    let (heading, numbers) = memory.parts::<_, SIZE>();
    let ([none, zero], [rounded, larger]) = ([f64::NAN, 0.0], kept(numbers));
    let [rounded, larger] = if another { [zero; 2] } else { [rounded, larger] };
    (*numbers, *heading) = ([none, none, none, w, w, zero, zero, zero, zero, zero, rounded, larger], NO_HEADING);
}

fn kept(numbers: &SpinNumbers) -> [f64; 2] {
    [numbers[WITH_DIGITS], numbers[WITH_DIGITS + 1]]
}

/// The spin `omega` with the digits that are kept of it, times a factor: as much of it as a number holds. With none where another spin
/// was kept. Nothing else is remembered, so that the next step searches, too.
pub(crate) fn with_digits(numbers: &mut SpinNumbers, omega: f64, factor: f64) -> f64 {
    let [rounded, larger] = kept(numbers);
    let larger = factor * if rounded.to_bits() == omega.to_bits() { larger } else { omega * LARGER };
    let rounded = larger / LARGER;
    *numbers = [f64::NAN; SIZE];
    numbers[WITH_DIGITS..].copy_from_slice(&[rounded, larger]);
    rounded
}
