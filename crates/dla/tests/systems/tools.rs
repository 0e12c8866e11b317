//! Orders, measured.

use dla::{Discretisation, Dla, Form, Schedule, State, Trajectory, drive};
use lagrangian::System;

/// Configuration and velocity at a time.
pub type Place<const N: usize> = ([f64; N], [f64; N]);

/// The nodes of a run of `steps` steps to the time `end`.
pub fn run<Sys: System<N, M>, D: Discretisation<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    mut method: Dla<D>,
    (q, v): Place<N>,
    end: f64,
    steps: u64,
) -> Trajectory {
    let schedule = Schedule { t0: 0.0, step: end / steps as f64, steps };
    let mut trajectory = Trajectory::every(1);
    drive(system, &mut method, &schedule, &mut State::new(q, v, system.angles()), &mut trajectory).unwrap();
    trajectory
}

/// The largest errors in the configuration and in the velocity for 20, 40, 80, 160 steps.
pub fn errors<Sys: System<N, M>, D: Discretisation<N, M> + Copy, const N: usize, const M: usize>(
    system: &Sys,
    method: Dla<D>,
    end: f64,
    exact: impl Fn(f64) -> Place<N>,
) -> [[f64; 2]; 4] {
    [20, 40, 80, 160].map(|steps| {
        let mut errors = [0.0f64; 2];
        let trajectory = run::<_, _, N, M>(system, method, exact(0.0), end, steps);
        for node in trajectory.nodes() {
            // Multipliers and basis keep the constraint at the nodes alike: a few roundings of velocities below 10.
            assert!(node.constraint <= 1e-14, "residual {:e} at t = {}", node.constraint, node.t);
            let (q, v) = exact(node.t);
            for i in 0..N {
                errors[0] = errors[0].max((node.q[i] - q[i]).abs());
                errors[1] = errors[1].max((node.v[i] - v[i]).abs());
            }
        }
        errors
    })
}

/// Asserts the order of the errors in configuration and velocity.
pub fn assert_order(name: &str, errors: [[f64; 2]; 4], order: f64) {
    assert_slope(&format!("{name}, configuration"), errors.map(|e| e[0]), order);
    assert_slope(&format!("{name}, velocity"), errors.map(|e| e[1]), order);
}

/// Asserts the slope of the least-squares line through the logarithms of the errors, within 0.05.
pub fn assert_slope(name: &str, errors: [f64; 4], order: f64) {
    let e = errors.map(f64::log2);
    let slope = (3.0 * (e[0] - e[3]) + (e[1] - e[2])) / 10.0;
    println!("{name}: {errors:?}, slope {slope:.3}");
    assert!((slope - order).abs() <= 0.05, "{name}: slope {slope}, errors {errors:?}");
}

/// The step in the basis and with multipliers.
pub fn forms<D: Copy>(method: Dla<D>) -> [(&'static str, Dla<D>); 2] {
    [("basis", Form::Best), ("multipliers", Form::Multipliers)].map(|(name, form)| (name, method.solved(form)))
}
