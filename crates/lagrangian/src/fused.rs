/// `a b + c`: in one rounding where the build is for machines that have an instruction for it, else in two. `f64::mul_add` would
/// be a call there.
#[must_use]
#[inline(always)]
pub fn mul_add(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}
