use super::{Curve, PrecisionPoint, digits};

/// Which method is the cheapest at an error, and the one after it.
#[derive(Debug, Clone, PartialEq)]
pub struct Cheapest {
    /// The error (m or rad).
    pub error: f64,
    /// The methods that reach it with their times (s), the fastest first.
    pub methods: Vec<(String, f64)>,
}

impl Cheapest {
    /// How many times longer the second takes than the first.
    #[must_use]
    pub fn factor(&self) -> Option<f64> {
        match self.methods[..] {
            [(_, first), (_, second), ..] => Some(second / first),
            _ => None,
        }
    }
}

/// The errors at which methods are compared (m or rad).
pub const LEVELS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// Marks the points that no other beats in both error and time; errors below `known`, what of them is known (m or rad),
/// are as good as that.
pub fn mark_pareto(curves: &mut [Curve], known: f64) {
    let mut points: Vec<&mut PrecisionPoint> = curves.iter_mut().flat_map(|curve| &mut curve.points).collect();
    let mut order: Vec<(usize, [f64; 2])> =
        points.iter().enumerate().filter_map(|(k, point)| Some((k, point.measured()?))).collect();
    order.iter_mut().for_each(|(_, [error, _])| *error = error.max(known));
    order.sort_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0])));
    let mut least = f64::INFINITY;
    for point in &mut points {
        point.pareto = false;
    }
    for (k, [error, _]) in order {
        if error < least {
            least = error;
            points[k].pareto = true;
        }
    }
}

/// The cheapest methods at each of the [`LEVELS`].
#[must_use]
pub fn cheapest(curves: &[Curve]) -> Vec<Cheapest> {
    let at = |error: f64| {
        let reached = |curve: &Curve| Some((curve.label(), seconds_to(&curve.points, error)?));
        let mut methods: Vec<(String, f64)> = curves.iter().filter_map(reached).collect();
        methods.sort_by(|a, b| a.1.total_cmp(&b.1));
        Cheapest { error, methods }
    };
    LEVELS.iter().map(|error| at(*error)).collect()
}

/// The time (s) in which a method reaches an error: between two points by the line through their logarithms, at the coarse end by the first
/// point; or by a finer point, if that takes less. (Steps so long that their solution must be followed may take more.)
///
/// `None` if even the finest point misses it.
#[must_use]
pub fn seconds_to(points: &[PrecisionPoint], error: f64) -> Option<f64> {
    let measured: Vec<[f64; 2]> = points.iter().filter_map(PrecisionPoint::measured).collect();
    let reached = measured.iter().position(|point| point[0] <= error)?;
    let [e1, t1] = measured[reached];
    let finer = measured[reached..].iter().filter(|point| point[0] <= error).map(|point| point[1]);
    let least = finer.fold(t1, f64::min);
    let Some([e0, t0]) = reached.checked_sub(1).map(|before| measured[before]) else { return Some(least) };
    let share = (e0 / error).ln() / (e0 / e1).ln();
    Some(digits(least.min(t0 * (t1 / t0).powf(share))))
}
