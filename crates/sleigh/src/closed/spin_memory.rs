use super::Memory;
use super::foreseen::Foreseen;
use super::heading::NO_HEADING;

/// Number of backward differences of the spin that are kept; the first is the last spin itself.
const KEPT: usize = 6;
/// Place of the last spin that was too small for a full significand: first as rounded, then times `LARGER`, with its digits.
const WITH_DIGITS: usize = 4 + KEPT;
const SIZE: usize = WITH_DIGITS + 2;
/// Identifies these numbers and their order. A checkpoint may come from an older version or another map.
const KIND: f64 = 5.0;
/// Factor by which a small spin is scaled to be kept with its digits: the smallest positive number then has a full significand.
const LARGER: f64 = (1u128 << 100) as f64;

/// The numbers that a step of the closed map leaves to the next.
pub(crate) type SpinMemory<'a> = Foreseen<'a, 1, KEPT, SIZE>;
/// The numbers of `SpinMemory` without the heading.
pub(crate) type SpinNumbers = [f64; SIZE];

/// The numbers left by steps of length `h`, for a step that begins at this heading. If there are none, they are as after steps with the
/// spin `w`.
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

/// The spin `omega` times a factor, rounded from the digits that are kept of `omega`; from `omega` itself if another spin was kept. All
/// other numbers are forgotten, so that the next step searches too.
pub(crate) fn with_digits(numbers: &mut SpinNumbers, omega: f64, factor: f64) -> f64 {
    let [rounded, larger] = kept(numbers);
    let larger = factor * if rounded.to_bits() == omega.to_bits() { larger } else { omega * LARGER };
    let rounded = larger / LARGER;
    *numbers = [f64::NAN; SIZE];
    numbers[WITH_DIGITS..].copy_from_slice(&[rounded, larger]);
    rounded
}
