use lagrangian::{from_fn, mul_add};

/// Extrapolates `P` sequences by two steps, as if their `K`th backward differences vanished. `differences` has one row of `P` for each
/// order from 0 on; it changes from the differences before `x` to the differences at `x`.
///
/// The result is `x + 2 e_1 + .. + K e_(K-1)` with the new differences `e_j = e_(j-1) - before_(j-1)`. All of it but a multiple of `x`
/// is known beforehand, so only one product waits for `x`.
#[inline(always)]
pub(crate) fn after_next<const P: usize>(x: [f64; P], differences: &mut [f64]) -> [f64; P] {
    let rows = differences.len() / P;
    let all = (rows * (rows + 1) / 2) as f64;
    let mut left = all - 1.0;
    let (mut known, mut new): ([f64; P], _) = (from_fn(|i| left * differences[i]), x);
    for j in 1..rows {
        left -= (j + 1) as f64;
        for i in 0..P {
            let before = &mut differences[P * (j - 1) + i];
            (*before, new[i]) = (new[i], new[i] - *before);
            if j < rows - 1 {
                known[i] = mul_add(left, differences[P * j + i], known[i]);
            }
        }
    }
    for i in 0..P {
        differences[P * (rows - 1) + i] = new[i];
    }
    from_fn(|i| mul_add(all, x[i], -known[i]))
}
