/// A point with the value of a function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RootPoint {
    pub(super) at: f64,
    pub(super) value: f64,
}

/// Iterations after which a bracket is reported as it is; a bisection would need 60.
const LIMIT: u32 = 100;

/// The zero of `f` between two points of opposite sign, and the width of its bracket.
///
/// Inverse quadratic interpolation if the last three points say that it will do, otherwise bisection, so that it ends no later than the
/// bisections. (Chandrupatla 1997, Adv. Eng. Software 28, 145-149.)
pub(super) fn root(from: RootPoint, to: RootPoint, tolerance: f64, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let (mut a, mut b) = (to, from);
    let mut part = 0.5_f64;
    for _ in 0..LIMIT {
        let best = if a.value.abs() < b.value.abs() { a } else { b };
        let width = (b.at - a.at).abs();
        let least = tolerance.max(2.0 * f64::EPSILON * best.at.abs()) / width;
        if best.value == 0.0 {
            return (best.at, 0.0);
        }
        if least > 0.5 {
            return (best.at, width);
        }
        let at = a.at + part.clamp(least, 1.0 - least) * (b.at - a.at);
        let new = RootPoint { at, value: f(at) };
        if new.value.is_nan() {
            return (best.at, width);
        }
        let c = if (new.value > 0.0) == (a.value > 0.0) { a } else { std::mem::replace(&mut b, a) };
        a = new;
        part = next(a, b, c).unwrap_or(0.5);
    }
    (if a.value.abs() < b.value.abs() { a.at } else { b.at }, (b.at - a.at).abs())
}

/// The fraction of the way from `a` to `b` at which the inverse quadratic through all three points is zero; `None` if it is not monotone.
fn next(a: RootPoint, b: RootPoint, c: RootPoint) -> Option<f64> {
    let xi = (a.at - b.at) / (c.at - b.at);
    let phi = (a.value - b.value) / (c.value - b.value);
    let monotone = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
    monotone.then(|| {
        a.value / (b.value - a.value) * (c.value / (b.value - c.value))
            + (c.at - a.at) / (b.at - a.at) * (a.value / (c.value - a.value)) * (b.value / (c.value - b.value))
    })
}
