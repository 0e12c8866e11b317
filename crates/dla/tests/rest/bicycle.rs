//! The benchmark bicycle of Carvallo and Whipple: five rows, one of which is the slope of a position, and straight ahead at zero steer
//! neither a division by zero nor a limit (<https://github.com/pydy/pydy/issues/446>).
//!
//! Parameters and the linear equations `M q'' + v C_1 q' + (g K_0 + v^2 K_2) q = 0` of lean and steer: Meijaard, Papadopoulos, Ruina and
//! Schwab 2007, Linearized dynamics equations for the balance and steer of a bicycle, Proc. R. Soc. A 463, table 1 and appendix A. The axes are
//! those of the paper, `z` downward.

use super::vectors::{M3, V3, about, add, cross, dot, fixed, product, sub, transposed, turned, wheel};
use dla::{Composition, Dla, Lobatto, OneStep, RunError, Schedule, State, consistent_start, drive};
use lagrangian::{Constraint, Scalar, System};
use nalgebra::{Matrix2, Matrix4, Vector4};
use std::f64::consts::PI;

const TILT: f64 = PI / 10.0;
const WHEELBASE: f64 = 1.02;
const TRAIL: f64 = 0.08;
const REAR: f64 = 0.3;
const FRONT: f64 = 0.35;
const GRAVITY: f64 = 9.81;

/// `q = (x, y, yaw, roll, pitch, steer, spin of the rear wheel, of the front wheel)`; `(x, y)` is the contact of the rear wheel.
struct Bicycle;

/// Where the parts are: the attitudes of frame and fork, the centres of the wheels, a point of the steering axis, the axles.
struct Parts<S> {
    frame: M3<S>,
    fork: M3<S>,
    rear: V3<S>,
    head: V3<S>,
    front: V3<S>,
    axles: [V3<S>; 2],
    up: V3<S>,
}

/// How the parts move: angular velocities, then velocities of the three points.
struct Rates<S> {
    frame: V3<S>,
    fork: V3<S>,
    wheels: [V3<S>; 2],
    rear: V3<S>,
    head: V3<S>,
    front: V3<S>,
}

fn parts<S: Scalar>(q: &[S; 8]) -> Parts<S> {
    let lean = product(about(2, q[2]), about(0, q[3]));
    let frame = product(lean, about(1, q[4]));
    let up = turned(lean, fixed([0.0, 0.0, 1.0]));
    let rear = sub([q[0], q[1], S::zero()], up.map(|part| part * REAR));
    let head = add(rear, turned(frame, fixed([WHEELBASE + TRAIL, 0.0, REAR])));
    let steering = product(about(1, S::constant(TILT)), product(about(2, q[5]), about(1, S::constant(-TILT))));
    let fork = product(frame, steering);
    let front = add(head, turned(fork, fixed([-TRAIL, 0.0, -FRONT])));
    let axles = [frame, fork].map(|attitude| turned(attitude, fixed([0.0, 1.0, 0.0])));
    Parts { frame, fork, rear, head, front, axles, up }
}

fn rates<S: Scalar>(p: &Parts<S>, q: &[S; 8], v: &[S; 8]) -> Rates<S> {
    let ahead = turned(about(2, q[2]), fixed([1.0, 0.0, 0.0]));
    let [rear_axle, front_axle] = p.axles;
    let lean = add([S::zero(), S::zero(), v[2]], ahead.map(|part| part * v[3]));
    let frame = add(lean, rear_axle.map(|part| part * v[4]));
    let rear = sub([v[0], v[1], S::zero()], cross(lean, p.up).map(|part| part * REAR));
    let head = add(rear, cross(frame, sub(p.head, p.rear)));
    let axis = turned(p.frame, fixed([TILT.sin(), 0.0, TILT.cos()]));
    let fork = add(frame, axis.map(|part| part * v[5]));
    let front = add(head, cross(fork, sub(p.front, p.head)));
    let wheels = [add(lean, rear_axle.map(|part| part * v[6])), add(fork, front_axle.map(|part| part * v[7]))];
    Rates { frame, fork, wheels, rear, head, front }
}

/// The lowest point of the front wheel, from its centre.
fn lowest<S: Scalar>(axle: V3<S>) -> V3<S> {
    let down = sub(fixed([0.0, 0.0, 1.0]), axle.map(|part| part * axle[2]));
    let length = S::length(&down);
    down.map(|part| part * FRONT / length)
}

/// `w . I w` of a body whose axes are the columns of `m`, by `[I_xx, I_yy, I_zz, I_xz]`.
fn turning<S: Scalar>(m: M3<S>, w: V3<S>, [xx, yy, zz, xz]: [f64; 4]) -> S {
    let w = turned(transposed(m), w);
    w[0] * w[0] * xx + w[1] * w[1] * yy + w[2] * w[2] * zz + w[0] * w[2] * (2.0 * xz)
}

impl System<8, 5> for Bicycle {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 8], v: &[S; 8]) -> S {
        let p = parts(q);
        let u = rates(&p, q, v);
        let rider = turned(p.frame, fixed([0.3, 0.0, REAR - 0.9]));
        let bars = turned(p.fork, fixed([0.9 - WHEELBASE - TRAIL, 0.0, -0.7]));
        let [rear_axle, front_axle] = p.axles;
        let moved = |mass: f64, v: V3<S>| dot(v, v) * mass;
        let kinetic = moved(85.0, add(u.rear, cross(u.frame, rider)))
            + turning(p.frame, u.frame, [9.2, 11.0, 2.8, 2.4])
            + moved(4.0, add(u.head, cross(u.fork, bars)))
            + turning(p.fork, u.fork, [0.05892, 0.06, 0.00708, -0.00756])
            + moved(2.0, u.rear)
            + wheel(rear_axle, u.wheels[0], 0.0603, 0.12)
            + moved(3.0, u.front)
            + wheel(front_axle, u.wheels[1], 0.1405, 0.28);
        let depths = (p.rear[2] + rider[2]) * 85.0 + (p.head[2] + bars[2]) * 4.0 + p.rear[2] * 2.0 + p.front[2] * 3.0;
        kinetic * 0.5 + depths * GRAVITY
    }
    /// The contacts rest: the rear one along and across the ground, the front one in the three directions of space.
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 8]) -> Constraint<S, 8, 5> {
        let (p, (sin, cos), zero, one) = (parts(q), q[2].sin_cos(), S::zero(), S::constant(1.0));
        let touching = lowest(p.axles[1]);
        let columns: [V3<S>; 8] = lagrangian::from_fn(|i| {
            let u = rates(&p, q, &lagrangian::from_fn(|j| if i == j { one } else { zero }));
            add(u.front, cross(u.wheels[1], touching))
        });
        let mut rows = [[zero; 8]; 5];
        (rows[0][0], rows[0][6]) = (one, cos * REAR);
        (rows[1][1], rows[1][6]) = (one, sin * REAR);
        for (i, column) in columns.iter().enumerate() {
            for (row, &part) in rows[2..].iter_mut().zip(column) {
                row[i] = part;
            }
        }
        (rows, [zero; 5])
    }
    /// The front wheel touches the ground.
    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 8]) -> Option<[Option<S>; 5]> {
        let p = parts(q);
        Some([None, None, None, None, Some(p.front[2] + lowest(p.axles[1])[2])])
    }
    fn angles(&self) -> [bool; 8] {
        [false, false, true, false, false, false, true, true]
    }
}

/// A run from straight ahead at zero steer, with that speed and rate of lean.
fn run<Method: OneStep<8, 5>>(
    mut method: Method,
    speed: f64,
    leaning: f64,
    (step, steps): (f64, u64),
) -> Result<State<8>, RunError> {
    let v = [speed, 0.0, 0.0, leaning, 0.0, 0.0, -speed / REAR, -speed / FRONT];
    let start = consistent_start(&Bicycle, 0.0, &[0.0; 8], &v).unwrap();
    assert!(start.changed <= 1e-15 * speed.max(1.0), "{start:?}");
    let mut state = State::new(start.q, start.v, Bicycle.angles());
    drive(&Bicycle, &mut method, &Schedule { t0: 0.0, step, steps }, &mut state, ()).map(|_| state)
}

/// `[lean, steer]` after a time by the linear equations.
fn linear(speed: f64, leaning: f64, time: f64) -> [f64; 2] {
    let masses = Matrix2::new(80.817_22, 2.319_413_322_087_09, 2.319_413_322_087_09, 0.297_841_881_996_86);
    let damping = Matrix2::new(0.0, 33.866_413_914_924_94, -0.850_356_414_569_78, 1.685_403_973_975_60);
    let weight = Matrix2::new(-80.95, -2.599_516_852_498_72, -2.599_516_852_498_72, -0.803_294_884_586_18);
    let wheels = Matrix2::new(0.0, 76.597_345_895_732_22, 0.0, 2.654_315_237_946_04);
    let inverse = masses.try_inverse().unwrap();
    let mut matrix = Matrix4::zeros();
    matrix.fixed_view_mut::<2, 2>(0, 2).fill_with_identity();
    matrix.fixed_view_mut::<2, 2>(2, 0).copy_from(&(-inverse * (weight * GRAVITY + wheels * speed * speed)));
    matrix.fixed_view_mut::<2, 2>(2, 2).copy_from(&(-inverse * damping * speed));
    let end = (matrix * time).exp() * Vector4::new(0.0, 0.0, leaning, 0.0);
    [end[0], end[1]]
}

/// The largest error of lean and steer after some time at 5 m/s, relative to the larger of them.
fn error<Method: OneStep<8, 5>>(method: Method, time: f64, steps: u64) -> f64 {
    // So small that the square of the lean, 1e-12 of the lean itself, is no part of the error.
    let leaning = 1e-6;
    let state = run(method, 5.0, leaning, (time / steps as f64, steps)).unwrap();
    let right = linear(5.0, leaning, time);
    let off = [state.unwrapped()[3] - right[0], state.unwrapped()[5] - right[1]];
    off[0].abs().max(off[1].abs()) / right[0].abs().max(right[1].abs())
}

fn has_order(name: &str, errors: &[f64], order: f64) {
    let halvings = (errors.len() - 1) as f64;
    let slope = (errors[0] / errors[errors.len() - 1]).log2() / halvings;
    assert!((slope - order).abs() <= 0.15, "{name}: slope {slope}, errors {errors:?}");
}

#[test]
fn leaning_a_little_it_follows_the_linear_equations() {
    has_order("dla", &[5, 10].map(|steps| error(Dla::midpoint(), 0.2, steps)), 2.0);
}

#[test]
#[ignore = "slow"]
fn leaning_a_little_it_follows_the_linear_equations_at_length() {
    let by_dla = [100, 200, 400].map(|steps| error(Dla::midpoint(), 2.0, steps));
    let by_dla4 = [50, 100, 200].map(|steps| error(Composition::suzuki4(Dla::midpoint()), 2.0, steps));
    let by_lobatto = [50, 100, 200].map(|steps| error(Lobatto::<3>::new(), 2.0, steps));
    for (name, errors, order) in [("dla", by_dla, 2.0), ("dla4", by_dla4, 4.0), ("lobatto3", by_lobatto, 4.0)] {
        has_order(name, &errors, order);
    }
    assert!(by_lobatto[2] <= 1e-5, "{by_lobatto:?}");
}

#[test]
fn the_linear_equations_are_those_of_the_report() {
    // The value of the report, by another program: lean after 2 s from 1e-4 rad/s.
    approx::assert_relative_eq!(linear(5.0, 1e-4, 2.0)[0], 5.683_658_349e-6, max_relative = 1e-9);
}

#[test]
fn upright_and_at_rest_it_stays_so() {
    stays_upright(&[(1e-2, 2), (1e-6, 2)]);
}

#[test]
#[ignore = "slow"]
fn upright_and_at_rest_it_stays_so_at_length() {
    stays_upright(&[(0.1, 50), (1e-2, 500), (1e-4, 500), (1e-6, 500)]);
}

fn stays_upright(runs: &[(f64, u64)]) {
    for &(step, steps) in runs {
        let stays = |name: &str, end: Result<State<8>, RunError>| {
            let state = end.unwrap_or_else(|error| panic!("{name}, step {step:e}: {error}"));
            // It falls: what the rounding of its weight moves it off upright grows with time, by some 3/s.
            let (q, t) = (state.q(), step * steps as f64);
            let bound = 1e3 * f64::EPSILON * (4.0 * t).exp();
            assert!(q.iter().all(|q| q.abs() <= bound), "{name}, step {step:e}: {q:?}");
        };
        stays("dla", run(Dla::midpoint(), 0.0, 0.0, (step, steps)));
        stays("dla4", run(Composition::suzuki4(Dla::midpoint()), 0.0, 0.0, (step, steps)));
        stays("lobatto3", run(Lobatto::<3>::new(), 0.0, 0.0, (step, steps)));
    }
}
