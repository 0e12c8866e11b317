//! A system of one's own: a skate on a slope, by its Lagrangian and its constraint, beside its closed form.
//!
//! `cargo run --example own_system`

use noslip::dla::{Composition, RunError};
use noslip::{Constraint, Dla, OneStep, Scalar, Schedule, State, System, Trajectory, drive};

/// A skate of mass and inertia one, its centre of mass above the blade, on a slope that falls along x.
struct Skate {
    /// Tangential gravity (m/s^2).
    gravity: f64,
}

impl System<3, 1> for Skate {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5 + q[0] * self.gravity
    }

    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        ([[-q[2].sin(), q[2].cos(), S::zero()]], [S::zero()])
    }

    fn angles(&self) -> [bool; 3] {
        [false, false, true]
    }
}

const TURN_RATE: f64 = 1.0;
const DURATION: f64 = 20.0;

/// From rest: a cycloid across the slope, `x = g/(2 w^2) sin^2 w t`, `y = g/(2 w^2) (w t - sin(2 w t)/2)`.
fn exact(gravity: f64, t: f64) -> [f64; 2] {
    let (size, phase) = (0.5 * gravity / (TURN_RATE * TURN_RATE), TURN_RATE * t);
    [size * phase.sin().powi(2), size * (phase - 0.5 * (2.0 * phase).sin())]
}

/// The distance from the closed form at the end (m), and the largest residual of the constraint (m/s).
fn errors<M: OneStep<3, 1>>(skate: &Skate, mut method: M, steps: u64) -> Result<[f64; 2], RunError> {
    let mut state = State::new([0.0; 3], [0.0, 0.0, TURN_RATE], skate.angles());
    let mut nodes = Trajectory::every(1);
    let schedule = Schedule { t0: 0.0, step: DURATION / steps as f64, steps };
    drive(skate, &mut method, &schedule, &mut state, &mut nodes)?;
    let [x, y] = exact(skate.gravity, DURATION);
    let slip = nodes.nodes().iter().fold(0.0, |slip, node| node.constraint.max(slip));
    Ok([(state.q()[0] - x).hypot(state.q()[1] - y), slip])
}

fn main() -> Result<(), RunError> {
    let skate = Skate { gravity: 1.0 };
    println!("   h [s]    dla: error [m]   slip [m/s]    dla4: error [m]   slip [m/s]");
    for steps in [100, 200, 400, 800, 1600] {
        let [error, slip] = errors(&skate, Dla::midpoint(), steps)?;
        let [error4, slip4] = errors(&skate, Composition::suzuki4(Dla::midpoint()), steps)?;
        let h = DURATION / steps as f64;
        println!("{h:8.4} {error:17.2e} {slip:12.1e} {error4:18.2e} {slip4:12.1e}");
    }
    Ok(())
}
