//! The benchmark bicycle of Meijaard, Papadopoulos, Ruina and Schwab (2007, Proc. R. Soc. A 463, 1955-1982): rear frame with its rider,
//! front frame, two wheels that roll without slip.

use super::vectors::{
    M3, V3, about_x, about_y, about_z, add, constant, cross, dot, mul, product, scale, sub, transpose,
};
use noslip::{Constraint, Scalar, System};
use std::f64::consts::PI;

/// Tilt of the steering axis (rad), wheel base, trail, radii of rear and front wheel (m), gravity (m/s^2).
const TILT: f64 = PI / 10.0;
const BASE: f64 = 1.02;
const TRAIL: f64 = 0.08;
pub(crate) const REAR: f64 = 0.3;
pub(crate) const FRONT: f64 = 0.35;
const GRAVITY: f64 = 9.81;

/// A body: mass (kg), place of its centre relative to the point that carries it (m), moments of inertia `xx`, `yy`, `zz`, `xz` (kg m^2).
struct Body(f64, [f64; 3], [f64; 4]);

const FRAME: Body = Body(85.0, [0.3, 0.0, -0.9 + REAR], [9.2, 11.0, 2.8, 2.4]);
const FORK: Body = Body(4.0, [0.9 - (BASE + TRAIL), 0.0, -0.7], [0.05892, 0.06, 0.00708, -0.00756]);
/// Mass, moment of inertia about a diameter and about the axle.
const REAR_WHEEL: [f64; 3] = [2.0, 0.0603, 0.12];
const FRONT_WHEEL: [f64; 3] = [3.0, 0.1405, 0.28];

impl Body {
    /// Twice the kinetic energy, and the height of the centre below the carrying point.
    fn moving<S: Scalar>(&self, attitude: M3<S>, velocity: V3<S>, turning: V3<S>) -> [S; 2] {
        let Self(mass, arm, [xx, yy, zz, xz]) = *self;
        let (arm, [x, y, z]) = (mul(attitude, constant(arm)), mul(transpose(attitude), turning));
        let centre = add(velocity, cross(turning, arm));
        let spin = x * x * xx + y * y * yy + z * z * zz + x * z * (2.0 * xz);
        [dot(centre, centre) * mass + spin, arm[2]]
    }
}

/// Twice the kinetic energy of a wheel with the axle `n`.
fn wheel<S: Scalar>([mass, across, along]: [f64; 3], velocity: V3<S>, turning: V3<S>, n: V3<S>) -> S {
    let spin = dot(turning, n);
    dot(velocity, velocity) * mass + (dot(turning, turning) - spin * spin) * across + spin * spin * along
}

/// In `q = (x, y, yaw, roll, pitch, steer, rear spin, front spin)`, the third axis down: `(x, y)` is where the rear wheel touches.
pub(crate) struct Bicycle;

/// Attitudes, the centre of the rear wheel, the point where the frames meet, the centre of the front wheel, and directions.
struct Places<S> {
    frame: M3<S>,
    fork: M3<S>,
    rear: V3<S>,
    joint: V3<S>,
    front: V3<S>,
    ahead: V3<S>,
    axle: V3<S>,
    down: V3<S>,
    front_axle: V3<S>,
}

impl<S: Scalar> Places<S> {
    fn of(q: &[S; 8]) -> Self {
        let rolled = product(about_z(q[2]), about_x(q[3]));
        let frame = product(rolled, about_y(q[4]));
        let steered = product(about_y(S::constant(TILT)), product(about_z(q[5]), about_y(S::constant(-TILT))));
        let (fork, down) = (product(frame, steered), mul(rolled, constant([0.0, 0.0, 1.0])));
        let rear = sub([q[0], q[1], S::zero()], scale(down, S::constant(REAR)));
        let joint = add(rear, mul(frame, constant([BASE + TRAIL, 0.0, REAR])));
        let front = add(joint, mul(fork, constant([-TRAIL, 0.0, -FRONT])));
        let across = constant([0.0, 1.0, 0.0]);
        let ahead = mul(about_z(q[2]), constant([1.0, 0.0, 0.0]));
        Self { frame, fork, rear, joint, front, ahead, axle: mul(rolled, across), down, front_axle: mul(fork, across) }
    }

    /// From the centre of the front wheel to its point of contact.
    fn radius(&self) -> V3<S> {
        let n = self.front_axle;
        let fall = sub(constant([0.0, 0.0, 1.0]), scale(n, n[2]));
        scale(fall, S::constant(FRONT) / S::length(&fall))
    }

    /// Velocity and turning of the rear wheel, of the rear frame at that wheel, of the front frame at the joint, and of the front wheel.
    fn velocities(&self, v: &[S; 8]) -> [(V3<S>, V3<S>); 4] {
        let carried = add([S::zero(), S::zero(), v[2]], scale(self.ahead, v[3]));
        let rear = sub([v[0], v[1], S::zero()], scale(cross(carried, self.down), S::constant(REAR)));
        let frame = add(carried, scale(self.axle, v[4]));
        let joint = add(rear, cross(frame, sub(self.joint, self.rear)));
        let axis = mul(self.frame, constant([TILT.sin(), 0.0, TILT.cos()]));
        let fork = add(frame, scale(axis, v[5]));
        let front = add(joint, cross(fork, sub(self.front, self.joint)));
        [
            (rear, add(carried, scale(self.axle, v[6]))),
            (rear, frame),
            (joint, fork),
            (front, add(fork, scale(self.front_axle, v[7]))),
        ]
    }
}

impl System<8, 5> for Bicycle {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 8], v: &[S; 8]) -> S {
        let places = Places::of(q);
        let [rear, frame, fork, front] = places.velocities(v);
        let [energy, depth] = FRAME.moving(places.frame, frame.0, frame.1);
        let [fork_energy, fork_depth] = FORK.moving(places.fork, fork.0, fork.1);
        let wheels =
            wheel(REAR_WHEEL, rear.0, rear.1, places.axle) + wheel(FRONT_WHEEL, front.0, front.1, places.front_axle);
        let weights = (places.rear[2] + depth) * FRAME.0
            + (places.joint[2] + fork_depth) * FORK.0
            + places.rear[2] * REAR_WHEEL[0]
            + places.front[2] * FRONT_WHEEL[0];
        (energy + fork_energy + wheels) * 0.5 + weights * GRAVITY
    }

    /// Both wheels roll; the last row holds the front wheel on the ground.
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 8]) -> Constraint<S, 8, 5> {
        let (places, (sin, cos)) = (Places::of(q), q[2].sin_cos());
        let mut rows = [[S::zero(); 8]; 5];
        (rows[0][0], rows[0][6]) = (S::constant(1.0), cos * REAR);
        (rows[1][1], rows[1][6]) = (S::constant(1.0), sin * REAR);
        for i in 0..8 {
            let unit = std::array::from_fn(|j| S::constant(f64::from(u8::from(i == j))));
            let [.., (velocity, turning)] = places.velocities(&unit);
            let contact = add(velocity, cross(turning, places.radius()));
            (rows[2][i], rows[3][i], rows[4][i]) = (contact[0], contact[1], contact[2]);
        }
        (rows, [S::zero(); 5])
    }

    fn holonomic<S: Scalar>(&self, _t: S, q: &[S; 8]) -> Option<[Option<S>; 5]> {
        let places = Places::of(q);
        Some([None, None, None, None, Some(places.front[2] + places.radius()[2])])
    }

    fn angles(&self) -> [bool; 8] {
        [false, false, true, false, false, false, true, true]
    }
}
