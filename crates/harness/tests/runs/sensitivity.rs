//! The derivatives of the baselines, against closed forms and extrapolated differences.

use dla::{
    Differentiable, Dop853, ImplicitMidpoint, OneStep, Rk4, Rk4Projected, Rk4Reduced, Sensitivity, SensitivityError,
    State, Tangent, Variation,
};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use std::array::from_fn;

/// A point with `z' = y x' + c cos t` in a well, under a force that depends on time.
#[derive(Debug, Clone, Copy)]
struct Pushed;

impl System<3, 1> for Pushed {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        let kinetic = v[0] * v[0] * (q[1].cos() * 0.2 + 1.0) + v[1] * v[1] + v[2] * v[2];
        (kinetic - q[0] * q[0] - q[1].powi(4)) * 0.5
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[1], S::zero(), S::constant(1.0)]], [-(t.cos() * 0.4)])
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        Some([t.sin() - v[0] * 0.3, q[2] * 0.5, S::zero()])
    }
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new([[one, zero, q[1]], [zero, one, zero]]))
    }
}

const TIME: f64 = 0.3;
const STEP: f64 = 0.1;

/// The state at the coordinates `q` and with the quasi-velocities `xi`.
fn state([x, y, z, along, across]: [f64; 5]) -> State<3> {
    State::new([x, y, z], [along, across, y * along + 0.4 * TIME.cos()], [false; 3])
}

/// The derivative at zero of a curve, by central differences with the steps `0.02 .. 0.0025`, extrapolated: what is left is
/// below `1e-12`.
fn extrapolated(curve: &dyn Fn(f64) -> [f64; 6]) -> [f64; 6] {
    let mut row: Vec<[f64; 6]> = (0..4)
        .map(|level| {
            let w = 0.02 / f64::from(1 << level);
            let (ahead, behind) = (curve(w), curve(-w));
            from_fn(|i| (ahead[i] - behind[i]) / (2.0 * w))
        })
        .collect();
    for order in 1..=3 {
        let factor = f64::from(1u32 << (2 * order));
        row = row.windows(2).map(|pair| from_fn(|i| (factor * pair[1][i] - pair[0][i]) / (factor - 1.0))).collect();
    }
    row[0]
}

fn flat(q: [f64; 3], v: [f64; 3]) -> [f64; 6] {
    from_fn(|i| if i < 3 { q[i] } else { v[i - 3] })
}

fn check<Method>(name: &str, method: &Method)
where
    Method: OneStep<3, 1> + Differentiable<3, 1> + Clone,
{
    let start = [0.2, -0.7, 0.4, 0.8, -0.5];
    let mut end = state(start);
    let derivative = Sensitivity::of(&Pushed).step(&mut method.clone(), TIME, STEP, &mut end).unwrap();
    assert!(derivative.defect < 1e-14, "{name}: {:e}", derivative.defect);
    let mut worst = 0.0f64;
    for k in 0..5 {
        let moved = |epsilon: f64| state(from_fn(|i| if i == k { start[i] + epsilon } else { start[i] }));
        let expected = extrapolated(&|epsilon| {
            let mut state = moved(epsilon);
            method.clone().step(&Pushed, TIME, STEP, &mut state).unwrap();
            flat(*state.q(), *state.v())
        });
        let variation = extrapolated(&|epsilon| flat(*moved(epsilon).q(), *moved(epsilon).v()));
        let state = Variation { q: from_fn(|i| variation[i]), v: from_fn(|i| variation[3 + i]) };
        let got = derivative.apply(&Tangent { state, parameters: [] }).state;
        let size = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for (x, y) in flat(got.q, got.v).iter().zip(&expected) {
            worst = worst.max((x - y).abs() / size);
        }
    }
    println!("{name}: {worst:.1e}");
    assert!(worst < 1e-9, "{name}: {worst:e}");
}

#[test]
fn the_baselines_have_derivatives() {
    check("rk4", &Rk4);
    check("rk4-projected", &Rk4Projected);
    check("rk4-reduced", &Rk4Reduced);
    check("implicit-midpoint", &ImplicitMidpoint::default());
}

#[test]
fn the_adaptive_method_refuses() {
    let mut end = state([0.2, -0.7, 0.4, 0.8, -0.5]);
    let before = end;
    let refused = Sensitivity::of(&Pushed).step(&mut Dop853::<3, 1>::new(1e-9), TIME, STEP, &mut end);
    let Err(SensitivityError::Unsupported { reason }) = refused else { panic!("{refused:?}") };
    assert!(reason.contains("adaptive"), "{reason}");
    assert_eq!(end, before);
}
