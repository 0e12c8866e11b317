//! What the checks share.

use crate::table::case::Facts;
use harness::{METHODS, Method, MethodInfo};

/// Some methods.
pub type Methods = [&'static MethodInfo];

/// Every method.
pub fn all_methods() -> Vec<&'static MethodInfo> {
    METHODS.iter().collect()
}

/// One method of every family.
pub fn families() -> Vec<&'static MethodInfo> {
    methods(&["dla", "dla-trapezoid", "dla4", "lobatto3", "gauss8", "energy2", "rk4", "rk4-reduced", "dop853"])
}

/// The methods of those names.
pub fn methods(names: &[&str]) -> Vec<&'static MethodInfo> {
    names.iter().map(|name| METHODS.iter().find(|info| info.name == *name).expect(name)).collect()
}

/// The method, `dop853` with so loose a tolerance that it makes every step in one, as the others do.
pub fn method(name: &str) -> Method {
    let method = Method::named(name, None).unwrap();
    if name == "dop853" { method.with_tolerance(1e6).unwrap() } else { method }
}

/// Why a method cannot do a system with these facts: what its error must speak of.
pub fn refuses(info: &MethodInfo, facts: &Facts) -> Option<&'static str> {
    let reduced = info.name.starts_with("gauss") || matches!(info.name, "rk4-reduced" | "dop853" | "taylor");
    let energy = info.name.starts_with("energy");
    match facts {
        Facts { without_basis: true, .. } if reduced || energy => Some("basis"),
        Facts { affine: true, .. } if energy => Some("b = 0"),
        Facts { positions: true, .. } if energy || info.name == "gni" => Some("positions"),
        Facts { timed: true, .. } if energy => Some("depend on time explicitly"),
        _ => None,
    }
}

/// Whether it is its own adjoint.
pub fn symmetric(info: &MethodInfo) -> bool {
    info.name != "gni" && !info.kind.is_adaptive() && !info.name.starts_with("rk4")
}

/// The exponent `p` of `error = C h^p (1 + c h^next + ..)`, fitted by least squares to pairs of a step and an error, which
/// is uncertain by `rounding`.
///
/// The logarithm has the terms `c h^next + d h^(2 next)`: of a symmetric method `next` is two. Without them the longest steps
/// of a ladder would count for more than they say.
pub fn fitted_order(ladder: &[(f64, f64)], next: i32, rounding: f64) -> f64 {
    let rows = ladder.iter().map(|(h, error)| {
        let sure = 1.0 / (rounding / error + 1e-3);
        ([1.0, h.ln(), h.powi(next), h.powi(2 * next)].map(|x| x * sure), error.ln() * sure)
    });
    let (matrix, right): (Vec<[f64; 4]>, Vec<f64>) = rows.unzip();
    let matrix = nalgebra::DMatrix::from_fn(matrix.len(), 4, |i, j| matrix[i][j]);
    let solution = matrix.svd(true, true).solve(&nalgebra::DVector::from_vec(right), 1e-14).unwrap();
    solution[1]
}

/// The slope of the least-squares line through the logarithms of steps and errors.
pub fn slope(ladder: &[(f64, f64)]) -> f64 {
    let mut trend = harness::Trend::default();
    for (h, error) in ladder {
        trend.add(h.ln(), error.ln());
    }
    trend.slope().unwrap()
}
