use super::{Curve, Mark, RungSetting};
use crate::Trend;

/// The measured order of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedSlope {
    /// The slope of the least-squares line through `(ln h, ln error)`; of the tolerance for an adaptive method.
    pub value: f64,
    /// The number of points of the line.
    pub points: usize,
}

/// Errors above this (m or rad) come from steps too coarse for any order to show.
const COARSE: f64 = 1e-2;
/// Errors must exceed this multiple of the largest one on the plateau of their curve: rounding is in them too.
const CLEAR: f64 = 10.0;
/// Slopes between neighbours agree if they differ by less than this fraction of their mean.
const AGREEING: f64 = 0.1;

impl FittedSlope {
    /// Fits the part of a curve above the plateau and below saturation; `None` with fewer than two points.
    ///
    /// If the step is varied, it fits the longest row of points with agreeing slopes from each to the next, of equally long ones the
    /// finest: the steps before are still too coarse for the leading power, the steps after show rounding. The order of the method is not
    /// used. If not three points agree, it fits all of them.
    pub(super) fn of(curve: &Curve) -> Option<Self> {
        let rounding = curve.points.iter().filter(|point| point.mark == Some(Mark::Plateau));
        let rounding = rounding.filter_map(|point| point.error).fold(0.0, f64::max);
        let clear = |error: &f64| *error <= COARSE && *error > CLEAR * rounding;
        let regular = curve.points.iter().filter(|point| point.is_regular());
        let logs: Vec<[f64; 2]> = regular
            .filter_map(|point| {
                let (RungSetting::Step(size) | RungSetting::Tolerance(size)) = point.setting?;
                Some([size.ln(), point.error.filter(clear)?.ln()])
            })
            .collect();
        let adaptive = curve.points.iter().any(|point| matches!(point.setting, Some(RungSetting::Tolerance(_))));
        let fitted = if adaptive { &logs[..] } else { settled(&logs) };
        let mut trend = Trend::default();
        for [x, y] in fitted {
            trend.add(*x, *y);
        }
        trend.slope().map(|value| Self { value, points: fitted.len() })
    }
}

/// The longest row of three points or more with agreeing slopes between neighbours, or else all points.
fn settled(logs: &[[f64; 2]]) -> &[[f64; 2]] {
    let slopes: Vec<f64> = logs.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).collect();
    let agree = |slopes: &[f64]| {
        let mean = slopes.iter().sum::<f64>() / slopes.len() as f64;
        let (low, high) = slopes
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), slope| (low.min(*slope), high.max(*slope)));
        high - low <= AGREEING * mean.abs()
    };
    for length in (2..=slopes.len()).rev() {
        for first in (0..=slopes.len() - length).rev() {
            if agree(&slopes[first..first + length]) {
                return &logs[first..=first + length];
            }
        }
    }
    logs
}
