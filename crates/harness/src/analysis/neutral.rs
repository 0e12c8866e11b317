/// Largest power of the time by which neighbours of a motion without positive exponents part company.
///
/// The power is one if speeds or frequencies differ by a constant, as in nearly all straight, periodic and quasi-periodic motions; two if
/// headings differ by a rate, as beside the straight motion of a sleigh whose spin nothing brakes; three if that motion is uniformly
/// accelerated besides.
const POWER: f64 = 3.0;

/// The possible error of an exponent because the time is finite (1/s), for a frame that is carried along for `before` seconds and then
/// counted for `time` seconds: `3 ln(1 + time/before) / time`.
///
/// Neighbours along a direction whose exponent is zero part company like a polynomial `p(t)` of the time without negative coefficients, of
/// degree three at most. Then `p(s t) <= s^3 p(t)` for `s >= 1`, so that the growth counted between `before` and `before + time` is at most
/// `3 ln((before + time)/before)`, for any units and any beginning of the growth. A direction that makes up for it shrinks by as much. With
/// `before` of a fixed length this is the known `ln T/T`; if it is a part of the run, `1/T`. (A power of the time times an exponential does
/// the same to an exponent that is not zero.)
pub(super) fn bias(before: f64, time: f64) -> f64 {
    POWER * (time / before).ln_1p() / time
}
