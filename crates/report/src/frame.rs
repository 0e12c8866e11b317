//! From numbers to points of a picture: ranges, scales, frames and clipping.

use super::canvas::Point;

/// Coordinates beyond this are taken for the debris of a run that blew up, and left out.
const LARGEST: f64 = 1e100;

/// Extents below this are no extents at all; half a range of this size still divides safely.
const SMALLEST: f64 = 1e-200;

/// Whether a coordinate can be drawn.
pub(crate) fn drawable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// A range of numbers.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Span {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
}

impl Span {
    /// The smallest range that holds the drawable ones of the values.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let [lo, hi] = values
            .filter(|value| drawable(*value))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], value| [lo.min(value), hi.max(value)]);
        (lo <= hi).then_some(Self { lo, hi })
    }

    pub(crate) fn middle(self) -> f64 {
        0.5 * (self.lo + self.hi)
    }

    pub(crate) fn half(self) -> f64 {
        0.5 * (self.hi - self.lo)
    }

    pub(crate) fn about(middle: f64, half: f64) -> Self {
        Self { lo: middle - half, hi: middle + half }
    }

    /// The part of this range within the other one, which it overlaps.
    pub(crate) fn within(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi) }
    }

    /// Half an extent to draw: never so small that rounding shows.
    pub(crate) fn visible(self) -> f64 {
        visible(self.half(), self.lo.abs().max(self.hi.abs()))
    }
}

/// Half an extent to draw, given the true one and the largest coordinate.
pub(crate) fn visible(half: f64, largest: f64) -> f64 {
    if half > SMALLEST && half > 1e-11 * largest {
        half
    } else if largest > SMALLEST {
        0.5 * largest
    } else {
        1.0
    }
}

/// How numbers lie along an axis.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) enum Scale {
    #[default]
    Plain,
    /// As decimal logarithms. Values below the given decade lie on it.
    Decades(f64),
}

impl Scale {
    pub(crate) fn of(self, value: f64) -> f64 {
        match self {
            Self::Plain => value,
            Self::Decades(least) => value.log10().max(least),
        }
    }
}

/// A rectangle of a picture and the ranges that it shows; upwards in the one is downwards in the other.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Frame {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) x: Span,
    pub(crate) y: Span,
    pub(crate) scales: [Scale; 2],
}

impl Frame {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The place in the picture of the point with these two numbers; `None` if it cannot be drawn.
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> Option<Point> {
        self.at([self.scales[0].of(x), self.scales[1].of(y)])
    }

    /// Where a point of the axes lies in the picture.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Option<Point> {
        let across = (x - self.x.lo) / (self.x.hi - self.x.lo);
        let up = (y - self.y.lo) / (self.y.hi - self.y.lo);
        let [px, py] = [self.left + across * self.width, self.bottom() - up * self.height];
        (drawable(x) && drawable(y) && drawable(px) && drawable(py)).then_some([px, py])
    }

    /// Whether a point of the picture lies in the frame.
    pub(crate) fn holds(&self, [px, py]: Point) -> bool {
        let slack = 1e-6;
        px >= self.left - slack && px <= self.right() + slack && py >= self.top - slack && py <= self.bottom() + slack
    }

    /// The part of the segment that lies in the frame (Liang and Barsky).
    fn clip(&self, from: Point, to: Point) -> Option<[Point; 2]> {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let lower = [self.left, self.top];
        let upper = [self.right(), self.bottom()];
        for axis in 0..2 {
            let step = to[axis] - from[axis];
            let (to_lower, to_upper) = (lower[axis] - from[axis], upper[axis] - from[axis]);
            if step.abs() < 1e-12 {
                if to_lower > 0.0 || to_upper < 0.0 {
                    return None;
                }
            } else {
                let (a, b) = (to_lower / step, to_upper / step);
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
        }
        // Written so that the end points themselves come back bit by bit where nothing is cut off.
        let at = |t: f64| {
            if t <= 0.0 {
                from
            } else if t >= 1.0 {
                to
            } else {
                [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]
            }
        };
        (enter <= leave).then(|| [at(enter), at(leave)])
    }

    /// The unbroken lines that the frame shows of a sequence of points.
    pub(crate) fn lines(&self, points: impl IntoIterator<Item = Option<Point>>) -> Vec<Vec<Point>> {
        let mut lines: Vec<Vec<Point>> = Vec::new();
        let mut before: Option<Point> = None;
        let mut open = false;
        for point in points {
            if let (Some(from), Some(to)) = (before, point) {
                match self.clip(from, to) {
                    Some([start, end]) => {
                        match lines.last_mut() {
                            Some(line) if open => line.push(end),
                            _ => lines.push(vec![start, end]),
                        }
                        open = distance(end, to) < 1e-9;
                    }
                    None => open = false,
                }
            } else {
                open = false;
            }
            before = point;
        }
        lines
    }
}

/// The distance of two points of a picture.
pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
