//! The classical Runge-Kutta method (Kutta 1901), by hand.

/// `steps` equal steps over `duration` (s) from `y`.
#[inline(always)]
pub fn rk4<const D: usize>(
    slope: impl Fn(&[f64; D]) -> [f64; D],
    mut y: [f64; D],
    duration: f64,
    steps: u64,
) -> [f64; D] {
    let h = duration / steps as f64;
    let ahead = |y: &[f64; D], k: &[f64; D], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    for _ in 0..steps {
        let k1 = slope(&y);
        let k2 = slope(&ahead(&y, &k1, 0.5 * h));
        let k3 = slope(&ahead(&y, &k2, 0.5 * h));
        let k4 = slope(&ahead(&y, &k3, h));
        for i in 0..D {
            y[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
    y
}
