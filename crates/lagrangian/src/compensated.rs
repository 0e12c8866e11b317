/// A sum with a further term, and the rounding error of it, to be added to the next term (Kahan 1965).
///
/// It is exact where the sum is the larger of the two, and else no more in error than rounding the term is.
#[must_use]
#[inline(always)]
pub fn added(sum: f64, term: f64) -> (f64, f64) {
    let new = sum + term;
    (new, term - (new - sum))
}

/// The rounded sum and its rounding error, whichever term is the larger (Knuth 1969, The Art of Computer Programming 2, section 4.2.2).
#[must_use]
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}
