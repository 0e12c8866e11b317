/// Nodes in `(0, 1)` and weights of the Gauss-Legendre rule with 16 nodes on `[-1, 1]`, exact to degree 31.
const RULE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_37, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_73),
    (0.755_404_408_355_003, 0.124_628_971_255_533_88),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_79),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_894),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_096),
];

/// `int_from^to f` for `f` analytic and slowly varying over the interval: one Gauss-Legendre panel.
pub(super) fn panel(from: f64, to: f64, f: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; 2];
    for (node, weight) in RULE {
        let (left, right) = (f(middle - half * node), f(middle + half * node));
        sum[0] += weight * (left[0] + right[0]);
        sum[1] += weight * (left[1] + right[1]);
    }
    [half * sum[0], half * sum[1]]
}
