/// The least-squares line through a stream of points, in constant memory.
///
/// Sums are taken about the running means (Welford 1962, Technometrics 4, 419-420), so that a long run does not lose
/// the slope in cancellation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Trend {
    count: f64,
    mean_x: f64,
    mean_y: f64,
    sum_xx: f64,
    sum_xy: f64,
}

impl Trend {
    /// Adds a point.
    #[inline]
    pub fn add(&mut self, x: f64, y: f64) {
        self.count += 1.0;
        let (dx, dy) = (x - self.mean_x, y - self.mean_y);
        self.mean_x += dx / self.count;
        self.mean_y += dy / self.count;
        self.sum_xx += dx * (x - self.mean_x);
        self.sum_xy += dx * (y - self.mean_y);
    }

    /// All that it knows, for a checkpoint.
    #[must_use]
    pub fn sums(&self) -> [f64; 5] {
        [self.count, self.mean_x, self.mean_y, self.sum_xx, self.sum_xy]
    }

    /// The line of [`sums`](Self::sums).
    #[must_use]
    pub fn of_sums([count, mean_x, mean_y, sum_xx, sum_xy]: [f64; 5]) -> Self {
        Self { count, mean_x, mean_y, sum_xx, sum_xy }
    }

    /// The slope of the line; `None` before two different abscissae.
    #[must_use]
    pub fn slope(&self) -> Option<f64> {
        (self.sum_xx > 0.0).then(|| self.sum_xy / self.sum_xx)
    }
}
