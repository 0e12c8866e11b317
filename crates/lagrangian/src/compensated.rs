/// A sum with a further term, and the rounding error of it, to be added to the next term (Kahan 1965).
///
/// It is exact where the sum is the larger of the two, and else no more in error than rounding the term is.
#[must_use]
#[inline(always)]
pub fn added(sum: f64, term: f64) -> (f64, f64) {
    let new = sum + term;
    (new, term - (new - sum))
}
