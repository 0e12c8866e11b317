use super::Blocks;
use super::batches::{BATCHES, batch};

/// Student's factor for 95 %, both sides, at the 31 degrees of freedom of 32 batches less one.
const T95: f64 = 2.040;

impl Blocks {
    /// Half the width of the 95 % confidence interval of the mean of the series, from the scatter of the means of 32 batches; `None` if the
    /// series is too short.
    ///
    /// It holds if the series is stationary and batches are longer than its correlations (Schmeiser 1982, Oper. Res. 30, 556-568).
    #[must_use]
    pub fn interval_of_mean(&self) -> Option<f64> {
        let series: Vec<f64> = self.means().collect();
        if series.len() < 2 * BATCHES {
            return None;
        }
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let means: Vec<f64> = (0..BATCHES).map(|j| mean(&series[batch(j, series.len())])).collect();
        let center = mean(&means);
        let variance = means.iter().map(|mean| (mean - center).powi(2)).sum::<f64>() / (BATCHES - 1) as f64;
        Some(T95 * (variance / BATCHES as f64).sqrt())
    }
}
