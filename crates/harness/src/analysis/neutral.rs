/// To this power of the time at most neighbours of a motion without positive exponents part company.
///
/// The first where speeds or frequencies differ by a constant, as those of nearly all straight, periodic and quasi-periodic motions;
/// the second where headings differ by a rate, as beside the straight motion of a sleigh whose spin nothing brakes; the third
/// where that is uniformly accelerated besides.
const POWER: f64 = 3.0;

/// What an exponent may be off by because the time is finite (1/s), of a frame that is carried along for `before` seconds and
/// counted for `time` seconds after them: `3 ln(1 + time/before) / time`.
///
/// Neighbours along a direction whose exponent is zero part company like a polynomial `p(t)` of the time without negative
/// coefficients, of degree three at most. Then `p(s t) <= s^3 p(t)` for `s >= 1`, so that what is counted between `before` and
/// `before + time` is at most `3 ln((before + time)/before)`, whatever the units and whenever the growth began. A direction that makes
/// up for it shrinks by as much. With `before` of a fixed length this is the known `ln T/T`; where it is a part of the run,
/// `1/T`. (A power of the time times an exponential does the same to an exponent that is not zero.)
pub(super) fn bias(before: f64, time: f64) -> f64 {
    POWER * (time / before).ln_1p() / time
}
