use crate::Trend;

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
