use super::{Curve, Mark, Setting};
use crate::Trend;

/// The measured order of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// The slope of the least-squares line through `(ln h, ln error)`; of the tolerance for an adaptive method.
    pub value: f64,
    /// The slope between the two finest points of the fit.
    pub finest: Option<f64>,
    /// How many points it goes through.
    pub points: usize,
}

/// Errors above this fraction of a metre or radian are those of steps too coarse for any order to show.
const COARSE: f64 = 1e-2;
/// Errors must be so many times the smallest one of a curve that has a plateau: rounding is in them too.
const CLEAR: f64 = 10.0;

impl Slope {
    /// Fits the part of a curve above the plateau and below saturation; none with fewer than two points.
    pub(super) fn of(curve: &Curve) -> Option<Self> {
        let rounding = curve.points.iter().filter(|point| point.mark == Some(Mark::Plateau));
        let rounding = rounding.filter_map(|point| point.error).fold(0.0, f64::max);
        let logs: Vec<[f64; 2]> = curve
            .points
            .iter()
            .filter(|point| point.is_regular())
            .filter_map(|point| {
                let (Setting::Step(size) | Setting::Tolerance(size)) = point.setting?;
                let error = point.error.filter(|error| *error <= COARSE && *error > CLEAR * rounding)?;
                Some([size.ln(), error.ln()])
            })
            .collect();
        let mut trend = Trend::default();
        for [x, y] in &logs {
            trend.add(*x, *y);
        }
        let finest = match logs[..] {
            [.., [x0, y0], [x1, y1]] => Some((y1 - y0) / (x1 - x0)),
            _ => None,
        };
        trend.slope().map(|value| Self { value, finest, points: logs.len() })
    }
}
