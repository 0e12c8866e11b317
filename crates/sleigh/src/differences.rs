use lagrangian::mul_add;

/// The value after next of a sequence, where its `K`th backward difference vanishes; and its new differences.
///
/// `before` are the value before `x` and its first differences, as many as `x` and its own are returned. What is expected is
/// `x + 2 e_1 + .. + K e_(K-1)` with the new differences `e`, of which all but `x` is known: that is all that waits for `x`.
#[inline(always)]
pub(crate) fn after_next<const P: usize, const K: usize>(
    x: [f64; P],
    before: [[f64; P]; K],
) -> ([f64; P], [[f64; P]; K]) {
    let mut after = [[0.0; P]; K];
    let all = (K * (K + 1) / 2) as f64;
    let (mut e, mut known, mut left) = (x, [0.0; P], all);
    for j in 0..K {
        after[j] = e;
        left -= (j + 1) as f64;
        for i in 0..P {
            known[i] = mul_add(left, before[j][i], known[i]);
            e[i] -= before[j][i];
        }
    }
    let mut expected = [0.0; P];
    for i in 0..P {
        expected[i] = mul_add(all, x[i], -known[i]);
    }
    (expected, after)
}
