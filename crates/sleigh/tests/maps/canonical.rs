//! The step that keeps the invariant measure, against the leapfrog of its Hamiltonian and quadrature of its path.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrangian::quadrature::gauss_legendre;
use proptest::prelude::*;
use sleigh::{Sleigh, SleighState};

/// Exponents and turns are below 2 and 6, where eight nodes integrate `e^x` and `cos x` to `6^16 (8!)^4 / (17 (16!)^3)`.
const QUADRATURE: f64 = 1e-10;

fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let (nodes, weights) = gauss_legendre::<8>();
    (0..8).map(|i| weights[i] * f(nodes[i])).sum()
}

proptest! {
    #[test]
    fn it_is_a_leapfrog(
        (m, i, a) in (0.5..2.0, 0.5..2.0, prop_oneof![-0.8..-0.1, 0.1..0.8]),
        (heading, u0, size, left) in (-3.0..3.0, -2.0..2.0, 0.1..2.0f64, any::<bool>()),
        h in prop_oneof![-0.5..-0.1, 0.1..0.5],
    ) {
        let sleigh = Sleigh::new(m, i, a).unwrap();
        let omega0 = if left { size } else { -size };
        let start = SleighState { x: 0.3, y: -0.2, heading, speed: u0, turn_rate: omega0 };
        let end = sleigh.canonical_step(h, &start);
        // `u' = a e^(2 s)`, `s' = -c u` with `s = ln |omega|`.
        let c = m * a / (i + m * a * a);
        let u = u0 + 0.5 * h * (a * (2.0 * size.ln()).exp());
        let s = |part: f64| size.ln() - part * h * c * u;
        let rate = |part: f64| s(part).exp().copysign(omega0);
        assert_relative_eq!(end.turn_rate, rate(1.0), max_relative = 1e-14);
        assert_abs_diff_eq!(end.speed, u + 0.5 * h * (a * (2.0 * s(1.0)).exp()), epsilon = 1e-13);
        let turn = h * integral(rate);
        assert_abs_diff_eq!(end.heading - heading, turn, epsilon = QUADRATURE);
        // The arc of that turn, at the speed between the kicks.
        let along = |part: f64| heading + part * turn;
        assert_abs_diff_eq!(end.x - 0.3, h * u * integral(|part| along(part).cos()), epsilon = QUADRATURE);
        assert_abs_diff_eq!(end.y + 0.2, h * u * integral(|part| along(part).sin()), epsilon = QUADRATURE);
    }
}

/// Without spin a straight line, without offset a circle, without speed a turn on the spot.
#[test]
fn where_its_quotients_are_limits() {
    let (h, heading) = (0.3, 0.7_f64);
    let state = |speed, turn_rate| SleighState { x: 1.0, y: 2.0, heading, speed, turn_rate };
    let close = |end: SleighState, x: f64, y: f64, turn: f64| {
        assert_abs_diff_eq!(end.x, 1.0 + x, epsilon = 1e-15);
        assert_abs_diff_eq!(end.y, 2.0 + y, epsilon = 1e-15);
        assert_abs_diff_eq!(end.heading, heading + turn, epsilon = 1e-15);
    };
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    close(sleigh.canonical_step(h, &state(1.5, 0.0)), h * 1.5 * heading.cos(), h * 1.5 * heading.sin(), 0.0);
    let balanced = Sleigh::new(1.0, 1.0, 0.0).unwrap();
    close(balanced.canonical_step(h, &state(0.0, 2.0)), 0.0, 0.0, 0.6);
    let end = balanced.canonical_step(h, &state(1.5, 2.0));
    let (radius, to) = (1.5 / 2.0, heading + 0.6);
    close(end, radius * (to.sin() - heading.sin()), radius * (heading.cos() - to.cos()), 0.6);
    assert_eq!((end.speed, end.turn_rate), (1.5, 2.0));
}
