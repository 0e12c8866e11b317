/// `a b + c`: with one rounding where the build is for machines with a fused instruction, else with two. Without the instruction
/// `f64::mul_add` would be a call.
#[must_use]
#[inline(always)]
pub fn mul_add(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}
