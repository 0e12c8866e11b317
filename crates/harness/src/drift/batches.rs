use super::Blocks;
use super::blocks::DriftBlock;
use crate::Trend;

/// Number of batches.
const BATCHES: usize = 32;

/// The means of 32 batches of a series, about their least-squares line; time in units of the whole series.
///
/// Longer than the correlations of a series, batches are independent of each other (method of batch means: Schmeiser
/// 1982, Oper. Res. 30, 556-568).
#[derive(Debug)]
pub(super) struct Batches {
    residuals: Vec<f64>,
    increments: Vec<f64>,
    /// `sum (t - mean t)^2`.
    spread: f64,
}

impl Batches {
    /// The batches of a series; `None` if it is too short.
    pub(super) fn of(series: &[f64]) -> Option<Self> {
        let means = means(series)?;
        let (center, slope) = line(&means);
        let times = || (0..BATCHES).map(|j| (j as f64 + 0.5) / BATCHES as f64 - 0.5);
        Some(Self {
            residuals: means.iter().zip(times()).map(|(mean, t)| mean - center - slope * t).collect(),
            increments: means.windows(2).map(|pair| pair[1] - pair[0]).collect(),
            spread: times().map(|t| t * t).sum(),
        })
    }

    /// Root of the mean square of the means about their line.
    pub(super) fn residual(&self) -> f64 {
        (squares(&self.residuals) / BATCHES as f64).sqrt()
    }

    /// The standard error of the slope, if batches scatter independently about the line.
    pub(super) fn error(&self) -> f64 {
        (squares(&self.residuals) / (BATCHES - 2) as f64 / self.spread).sqrt()
    }

    /// The standard error of the slope, if the increments of the series are independent.
    ///
    /// A walk of variance `s` a unit of time has a least-squares slope of variance `6/5 s` over a unit of time (Durlauf and
    /// Phillips 1988, Econometrica 56, 1333-1354), and increments of its batch means of `2/3` of the variance of its own.
    pub(super) fn error_of_walk(&self) -> f64 {
        let mean = self.increments.iter().sum::<f64>() / self.increments.len() as f64;
        let scatter: f64 = self.increments.iter().map(|d| (d - mean).powi(2)).sum();
        let variance = scatter / (self.increments.len() - 1) as f64;
        (6.0 / 5.0 * 3.0 / 2.0 * variance * BATCHES as f64).sqrt()
    }

    /// The statistic of stationarity about a line, `sum S_j^2 / (k^2 s^2)` with the partial sums `S_j` of the residuals
    /// (Kwiatkowski, Phillips, Schmidt and Shin 1992, J. Econometrics 54, 159-178); batches take the place of its kernel.
    pub(super) fn stationarity(&self) -> f64 {
        let squared = squares(&self.residuals);
        if squared == 0.0 {
            return 0.0;
        }
        let (mut sum, mut sums) = (0.0, 0.0);
        for residual in &self.residuals {
            sum += residual;
            sums += sum * sum;
        }
        sums / (BATCHES as f64 * squared)
    }

    /// Whether the increments are spread over the whole series, as in a random walk: neither one of them nor one half of the series has
    /// nearly all of the sum of squares, as in a series that jumps or settles.
    pub(super) fn walks(&self) -> bool {
        let all = squares(&self.increments);
        let largest = self.increments.iter().map(|d| d * d).fold(0.0, f64::max);
        let first = squares(&self.increments[..self.increments.len() / 2]);
        largest < 0.5 * all && first > 0.05 * all && first < 0.95 * all
    }
}

/// The means of the batches of a series; `None` if it is too short.
fn means(series: &[f64]) -> Option<Vec<f64>> {
    (series.len() >= 2 * BATCHES).then(|| (0..BATCHES).map(|j| mean(&series[batch(j, series.len())])).collect())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The places of batch `j` in a series.
fn batch(j: usize, length: usize) -> std::ops::Range<usize> {
    j * length / BATCHES..(j + 1) * length / BATCHES
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// The least-squares line through a series: its value in the middle, and its slope over the whole length.
pub(super) fn line(series: &[f64]) -> (f64, f64) {
    let length = series.len() as f64;
    let center = series.iter().sum::<f64>() / length;
    let (mut products, mut spread) = (0.0, 0.0);
    for (i, value) in series.iter().enumerate() {
        let t = (i as f64 + 0.5) / length - 0.5;
        products += t * (value - center);
        spread += t * t;
    }
    (center, if spread > 0.0 { products / spread } else { 0.0 })
}

/// Number of last batches of a series that runs away, and the part of its sum of squares that they have at least: an error `exp(c t)` that
/// grows by more than `10^8` over the run has it. An error `t^p` has less up to `p = 17`.
const LAST: usize = 2;
const NEARLY_ALL: f64 = 0.9;
/// Of this number of batches at the end, all but two have a larger error than all before: that tells growth from a single event near the
/// end. (Two may have less, since the error of huge energies is their rounding, which is now and then zero.)
const GROWING: usize = 8;
const MAY_FALL: usize = 2;

/// The largest error, if the series grows faster and faster to its end; `None` otherwise, and for a series that is too short.
pub(super) fn runs_away(blocks: &[DriftBlock]) -> Option<f64> {
    if blocks.len() < 2 * BATCHES {
        return None;
    }
    let size = |block: &DriftBlock| block.min.abs().max(block.max.abs());
    let largest = |j: usize| blocks[batch(j, blocks.len())].iter().map(size).fold(0.0, f64::max);
    let sizes: Vec<f64> = (0..BATCHES).map(largest).collect();
    let before = |j: usize| sizes[..j].iter().copied().fold(0.0, f64::max);
    let most = before(BATCHES);
    let records = (BATCHES - GROWING..BATCHES).filter(|&j| sizes[j] > before(j)).count();
    let grows = records + MAY_FALL >= GROWING;
    // In units of the largest one nothing overflows.
    let relative: Vec<f64> = sizes.iter().map(|size| size / most).collect();
    (grows && squares(&relative[BATCHES - LAST..]) > NEARLY_ALL * squares(&relative)).then_some(most)
}

/// Half the largest range within a batch: about the line of the series or, if that is less because a drift bends, about the line of the
/// batch.
pub(super) fn amplitude(means: &[f64], ranges: &[[f64; 2]]) -> f64 {
    let length = means.len();
    let (_, slope) = line(means);
    if length < ENOUGH * BATCHES {
        return half_range(ranges, slope, length);
    }
    let within = |part: std::ops::Range<usize>| {
        let (_, own_slope) = line(&means[part.clone()]);
        let ranges = &ranges[part];
        let own = half_range(ranges, own_slope, ranges.len());
        own.min(half_range(ranges, slope, length))
    };
    (0..BATCHES).map(|j| within(batch(j, length))).fold(0.0, f64::max)
}

/// Number of blocks from which on a batch has a line of its own.
const ENOUGH: usize = 8;

/// Half the range about a line that has the slope `slope` over `length` blocks.
fn half_range(ranges: &[[f64; 2]], slope: f64, length: usize) -> f64 {
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for (i, [min, max]) in ranges.iter().enumerate() {
        let on_line = slope * (i as f64 + 0.5) / length as f64;
        lowest = lowest.min(min - on_line);
        highest = highest.max(max - on_line);
    }
    0.5 * (highest - lowest)
}

/// The growth exponent of a series from its structure function `D(l) = mean (x_{i+l} - x_i)^2`: half the slope of `log D` against `log l`,
/// over the octaves of lags between a 64th and a quarter of the series; `None` if the series is too short.
///
/// It is 0 for a bounded series, 1/2 for a random walk, 1 for a line. All lags of an octave count, so that none agrees with a period.
pub(super) fn exponent(series: &[f64]) -> Option<f64> {
    let shortest = series.len() / 64;
    if shortest == 0 {
        return None;
    }
    let points = (0..4).map(|octave| {
        let lags = (shortest << octave)..(shortest << (octave + 1));
        let count = lags.len() as f64;
        let mean_lag = lags.clone().map(|lag| lag as f64).sum::<f64>() / count;
        let structure = lags.map(|lag| structure(series, lag)).sum::<f64>() / count;
        (mean_lag.ln(), structure.ln())
    });
    let mut line = Trend::default();
    points.for_each(|(x, y)| line.add(x, y));
    // A constant series does not grow.
    Some(line.slope().filter(|slope| slope.is_finite()).map_or(0.0, |slope| 0.5 * slope))
}

fn structure(series: &[f64], lag: usize) -> f64 {
    let squares = series.iter().zip(&series[lag..]).map(|(a, b)| (b - a) * (b - a));
    squares.sum::<f64>() / (series.len() - lag) as f64
}

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
        let means = means(&series)?;
        let center = mean(&means);
        let variance = means.iter().map(|mean| (mean - center).powi(2)).sum::<f64>() / (BATCHES - 1) as f64;
        Some(T95 * (variance / BATCHES as f64).sqrt())
    }
}
