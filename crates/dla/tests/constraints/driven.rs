//! Coordinates that are given as functions of time, through places where they vanish.

use crate::constraints::tools::misses;
use crate::support::Two;
use dla::{Composition, Dla, Gauss, Lobatto, OneStep};
use lagrangian::{Constraint, Scalar, System};
use std::f64::consts::PI;

/// A mass on a spring of length zero, whose other end is led: `s = 0.7 sin t`.
#[derive(Clone, Copy)]
pub(crate) struct Led;

impl System<2, 1> for Led {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 2], v: &[S; 2]) -> S {
        (v[0].squared() + v[1].squared() - (q[0] - q[1]).squared() * 0.3) * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, _q: &[S; 2]) -> Constraint<S, 2, 1> {
        ([[S::zero(), S::constant(1.0)]], [t.cos() * -0.7])
    }
    fn holonomic<S: Scalar>(&self, t: S, q: &[S; 2]) -> Option<[Option<S>; 1]> {
        Some([Some(q[1] - t.sin() * 0.7)])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, _q: &[S; 2]) -> Option<lagrangian::AdmissibleBasis<S, 2, 1>> {
        Some(lagrangian::AdmissibleBasis::from_fn(|_| [S::constant(1.0), S::zero()]))
    }
}

/// Where the coordinate vanishes, the error of a place is the rounding of the increment that leads there, which is larger than the rounding of the place.
fn passes_through_zero(nodes: &[u32], steps: u64) {
    let passes = |name: &str, method: &mut dyn OneStep<2, 1>| {
        for &nodes in nodes {
            let step = PI / f64::from(nodes);
            let [g, slip] = misses(&Two::from(Led), method, ([0.2, 0.0], [0.1, 0.7]), step, steps);
            // The time of a node is known to its rounding, and the coordinate is led by at most 0.7 units in a second.
            let bound = f64::EPSILON * (1.0 + step * steps as f64);
            assert!(g <= bound && slip <= bound, "{name}, {nodes} nodes: g {g:e}, slip {slip:e}");
        }
    };
    passes("dla", &mut Dla::midpoint());
    passes("dla4", &mut Composition::suzuki4(Dla::midpoint()));
    passes("gauss4", &mut Gauss::new::<2>());
    passes("gauss8", &mut Gauss::new::<4>());
    passes("lobatto3", &mut Lobatto::<3>::new());
}

#[test]
fn a_led_coordinate_passes_through_zero() {
    passes_through_zero(&[100, 317], 320);
}

#[test]
#[ignore = "slow"]
fn a_led_coordinate_passes_through_zero_in_full() {
    passes_through_zero(&[100, 314, 317], 5000);
}
