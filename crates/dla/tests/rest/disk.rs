//! A thin disk that rolls on its edge, nearly flat, with its centre at rest: a coin that settles
//! (<https://github.com/google-deepmind/mujoco/issues/575>). The turning rates are large, and cancel to the small rate of the disk itself.
//!
//! With `alpha` between disk and floor the centre rests if `Omega^2 sin(alpha) = 4 g/R` (Euler's disk without loss; O'Reilly 1996, The dynamics of
//! rolling disks and sliding disks, Nonlinear Dynamics 10).

use super::vectors::{add, cross, dot, wheel};
use crate::support::Five;
use dla::convergence::tolerances::{OF_CORRECTION, ROUNDINGS};
use dla::{Composition, Dla, Lobatto, OneStep, Schedule, State, drive};
use lagrangian::{Constraint, Scalar, System};
use std::f64::consts::{FRAC_PI_2, TAU};

const RADIUS: f64 = 0.1;
const GRAVITY: f64 = 9.81;

/// `q = (x, y, yaw, lean, spin)`, of mass one; `(x, y)` is the contact, and upright the lean is none.
#[derive(Clone, Copy)]
pub(crate) struct Disk;

impl System<5, 2> for Disk {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 5], v: &[S; 5]) -> S {
        let ((sin, cos), (lean_sin, lean_cos), zero) = (q[2].sin_cos(), q[3].sin_cos(), S::zero());
        let up = [sin * lean_sin, -cos * lean_sin, lean_cos];
        let axle = [-sin * lean_cos, cos * lean_cos, lean_sin];
        let leaning = [cos * v[3], sin * v[3], v[2]];
        let turning = add(leaning, axle.map(|part| part * v[4]));
        let centre = add([v[0], v[1], zero], cross(leaning, up).map(|part| part * RADIUS));
        let inertia = 0.25 * RADIUS * RADIUS;
        let rotation = wheel(axle, turning, inertia, 2.0 * inertia);
        (dot(centre, centre) + rotation) * 0.5 - lean_cos * (GRAVITY * RADIUS)
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 5]) -> Constraint<S, 5, 2> {
        let ((sin, cos), zero, one) = (q[2].sin_cos(), S::zero(), S::constant(1.0));
        ([[one, zero, zero, zero, -cos * RADIUS], [zero, one, zero, zero, -sin * RADIUS]], [zero; 2])
    }
    fn angles(&self) -> [bool; 5] {
        [false, false, true, false, true]
    }
}

/// Rolls in steps of which a turn has 200, and asserts that lean, rate and centre keep within a part of themselves.
fn rolls<Method: OneStep<5, 2>>(name: &str, mut method: Method, (alpha, steps): (f64, u64), roundings: f64) {
    let disk = Five::from(Disk);
    let (rate, lean) = ((4.0 * GRAVITY / (RADIUS * alpha.sin())).sqrt(), FRAC_PI_2 - alpha);
    let spin = -lean.sin() * rate;
    let (q, v) = ([0.0, RADIUS * lean.sin(), 0.0, lean, 0.0], [RADIUS * spin, 0.0, rate, 0.0, spin]);
    let mut state = State::new(q, v, disk.angles());
    let schedule = Schedule { t0: 0.0, step: TAU / rate / 200.0, steps };
    drive(&disk, &mut method, &schedule, &mut state, ()).unwrap_or_else(|error| panic!("{name}, {alpha:e}: {error}"));
    let (q, v) = (state.q(), state.v());
    let centre = [q[0] + RADIUS * q[2].sin() * q[3].sin(), q[1] - RADIUS * q[2].cos() * q[3].sin()];
    // The spin of the disk itself, `w = alpha^2 Omega/2`, is the difference of two rates near `Omega`, whose equations are met to so many
    // roundings in every step; these add up. A change of `w` changes the balance by `d alpha = (C + m R^2)/A dw/Omega`, with moments
    // of inertia `A = C/2`: six times as much. `Omega` changes with `alpha^(-1/2)`.
    let bound = 6.0 * roundings * 0.5 * f64::EPSILON / alpha * schedule.steps as f64;
    assert!((q[3] - lean).abs() <= bound * alpha, "{name}, {alpha:e}: lean off by {:e}", q[3] - lean);
    assert!((v[2] / rate - 1.0).abs() <= 0.5 * bound, "{name}, {alpha:e}: rate off by {:e}", v[2] / rate - 1.0);
    assert!(centre.iter().all(|part| part.abs() <= RADIUS * bound), "{name}, {alpha:e}: centre at {centre:?}");
}

#[test]
fn its_centre_rests_however_flat_it_rolls() {
    // A whole turn: of a part of one the centre is off by the error of the method.
    rolls_flat(&[1e-3], 200);
}

/// Twenty turns.
#[test]
#[ignore = "slow"]
fn its_centre_rests_however_flat_it_rolls_at_length() {
    rolls_flat(&[0.5, 0.1, 1e-2, 1e-3, 1e-5], 20 * 200);
}

fn rolls_flat(alphas: &[f64], steps: u64) {
    for &alpha in alphas {
        rolls("dla", Dla::midpoint(), (alpha, steps), ROUNDINGS);
        rolls("dla4", Composition::suzuki4(Dla::midpoint()), (alpha, steps), 5.0 * ROUNDINGS);
        rolls("lobatto3", Lobatto::<3>::new(), (alpha, steps), OF_CORRECTION);
    }
}
