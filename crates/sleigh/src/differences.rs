use lagrangian::mul_add;

/// The value after next of a sequence, where its `K`th backward difference vanishes; and its new differences.
///
/// `before` are the value before `x` and its first differences, as many as `x` and its own are returned. What is expected is
/// `x + 2 e_1 + .. + K e_(K-1)` with the new differences `e_j = e_(j-1) - before_(j-1)`, of which all but `x` is known: that is all that
/// waits for `x`.
#[inline(always)]
pub(crate) fn after_next<const P: usize, const K: usize>(
    x: [f64; P],
    before: [[f64; P]; K],
) -> ([f64; P], [[f64; P]; K]) {
    let all = (K * (K + 1) / 2) as f64;
    let (mut expected, mut after) = ([0.0; P], [x; K]);
    for i in 0..P {
        let mut left = all - 1.0;
        let mut known = left * before[0][i];
        for j in 1..K {
            after[j][i] = after[j - 1][i] - before[j - 1][i];
            left -= (j + 1) as f64;
            if j < K - 1 {
                known = mul_add(left, before[j][i], known);
            }
        }
        expected[i] = mul_add(all, x[i], -known);
    }
    (expected, after)
}
