//! What the checks share.

use crate::case::Facts;
use harness::{Method, MethodInfo};

/// The method, an adaptive one with so loose a tolerance that it makes every step in one, as the others do.
pub fn method(name: &str) -> Method {
    Method::named(name, None).unwrap().with_tolerance(1e6).unwrap()
}

/// Why a method cannot do a system with these facts: what its error must speak of.
pub fn refuses(info: &MethodInfo, facts: &Facts) -> Option<&'static str> {
    let reduced = info.name.starts_with("gauss") || matches!(info.name, "rk4-reduced" | "dop853");
    let energy = info.name.starts_with("energy");
    match facts {
        Facts { without_basis: true, .. } if reduced || energy => Some("basis"),
        Facts { affine: true, .. } if energy => Some("b = 0"),
        Facts { timed: true, .. } if energy => Some("explicit time"),
        _ => None,
    }
}

/// Whether it is its own adjoint.
pub fn symmetric(info: &MethodInfo) -> bool {
    !matches!(info.name, "gni" | "dop853") && !info.name.starts_with("rk4")
}

/// The exponent `p` of `error = C h^p (1 + c h^2)`, fitted by least squares to pairs of a step and an error.
///
/// The second term is the next one of a symmetric method; without it the longest steps of a ladder would count for more
/// than they say.
pub fn fitted_order(ladder: &[(f64, f64)]) -> f64 {
    let mut equations = [[0.0; 4]; 3];
    for (h, error) in ladder {
        let row = [1.0, h.ln(), h * h, error.ln()];
        for i in 0..3 {
            for j in 0..4 {
                equations[i][j] += row[i] * row[j];
            }
        }
    }
    for i in 0..3 {
        for k in (0..3).filter(|k| *k != i) {
            let factor = equations[k][i] / equations[i][i];
            for j in i..4 {
                equations[k][j] -= factor * equations[i][j];
            }
        }
    }
    equations[1][3] / equations[1][1]
}

/// The slope of the least-squares line through the logarithms of steps and errors.
pub fn slope(ladder: &[(f64, f64)]) -> f64 {
    let mut trend = harness::Trend::default();
    for (h, error) in ladder {
        trend.add(h.ln(), error.ln());
    }
    trend.slope().unwrap()
}
