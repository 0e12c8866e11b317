//! What holds for single models: the geometry behind their constraints, known motions, what is refused.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::float_cmp)]
mod common;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::{draws, parameters, state};
use lagrangian::{Dual, Scalar, System, energy, momentum, reduced_acceleration};
use models::{
    Attitude, ChaplyginBall, ContactOscillator, GaugedOscillator, KnifeEdge, Model, ModelError, Particle,
    QuarticOscillator, RollerRacer, RollingDisk, Snakeboard, Suslov,
};
use proptest::prelude::*;
use std::array::from_fn;

/// Some ten terms below four, each rounded a few times.
const ROUNDING: f64 = 1e-13;

/// Values that move at given rates.
fn moving<const N: usize>(q: &[f64; N], rates: &[f64; N]) -> [Dual<f64, 1>; N] {
    from_fn(|i| Dual { re: q[i], eps: [rates[i]] })
}

/// The angular velocity `w` of `R' = (w x) R`, in space.
fn spin(attitude: &Attitude<Dual<f64, 1>>) -> [f64; 3] {
    let r = attitude.rotation();
    let entry = |i: usize, j: usize| (0..3).map(|k| r[i][k].eps[0] * r[j][k].re).sum::<f64>();
    [entry(2, 1), entry(0, 2), entry(1, 0)]
}

proptest! {
    #[test]
    fn kinematics_of_the_attitude(draws in draws()) {
        let angles: [f64; 3] = [3.0 * draws[0], 1.2 * draws[1], 3.0 * draws[2]];
        let rates: [f64; 3] = [draws[3], draws[4], draws[5]];
        let attitude = Attitude::new(angles);
        let r = attitude.rotation();
        let in_space = spin(&Attitude::new(moving(&angles, &rates)));
        let omega = attitude.body_velocity(rates);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| r[i][k] * r[j][k]).sum();
                assert_abs_diff_eq!(product, if i == j { 1.0 } else { 0.0 }, epsilon = ROUNDING);
            }
            let from_body: f64 = (0..3).map(|k| r[i][k] * omega[k]).sum();
            let from_rates: f64 = (0..3).map(|k| attitude.space_velocity_matrix()[i][k] * rates[k]).sum();
            assert_abs_diff_eq!(from_body, in_space[i], epsilon = ROUNDING);
            assert_abs_diff_eq!(from_rates, in_space[i], epsilon = ROUNDING);
            assert_abs_diff_eq!(attitude.rates(omega)[i], rates[i], epsilon = ROUNDING);
        }
        // The orientation is right-handed.
        let volume = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1])
            - r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0])
            + r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
        assert_abs_diff_eq!(volume, 1.0, epsilon = ROUNDING);

        let second: [f64; 3] = [draws[6], draws[7], draws[8]];
        let turning = Attitude::new(moving(&angles, &rates)).body_velocity(moving(&rates, &second));
        let back = attitude.accelerations(rates, turning.map(|o| o.eps[0]));
        for i in 0..3 {
            assert_abs_diff_eq!(back[i], second[i], epsilon = ROUNDING);
        }
    }

    /// The point of the ball that touches the plane is at rest.
    #[test]
    fn the_ball_does_not_slip(p in parameters(), draws in draws()) {
        let ball = ChaplyginBall::new(p[0], p[1], [p[2], p[3], p[4]]).unwrap();
        let (q, v) = state(&ball, &draws);
        let [wx, wy, _] = spin(&Attitude::new(moving(&[q[2], q[3], q[4]], &[v[2], v[3], v[4]])));
        // V + w x (0, 0, -r).
        assert_abs_diff_eq!(v[0] - wy * ball.radius(), 0.0, epsilon = ROUNDING);
        assert_abs_diff_eq!(v[1] + wx * ball.radius(), 0.0, epsilon = ROUNDING);
    }

    /// Each axle of the snakeboard moves along its wheels.
    #[test]
    fn the_axles_of_the_board_do_not_slip(p in parameters(), draws in draws()) {
        let board = Snakeboard::new(p[0], p[1], p[2], p[3], p[4]).unwrap();
        let (q, v) = state(&board, &draws);
        let [x, y, theta, _, phi] = moving(&q, &v);
        let (sin, cos) = theta.sin_cos();
        for (side, wheels) in [(-1.0, theta + phi), (1.0, theta - phi)] {
            let at = [x + cos * (side * board.length()), y + sin * (side * board.length())];
            let (sin, cos) = wheels.re.sin_cos();
            assert_abs_diff_eq!(cos * at[1].eps[0] - sin * at[0].eps[0], 0.0, epsilon = ROUNDING);
        }
    }

    /// Each axle of the roller racer moves along its wheels.
    #[test]
    fn the_axles_of_the_racer_do_not_slip(p in parameters(), draws in draws()) {
        let racer = RollerRacer::new(p[0], p[1], p[2], p[3], p[4]).unwrap();
        let (q, v) = state(&racer, &draws);
        let [x, y, theta, phi] = moving(&q, &v);
        let [d1, d2] = racer.distances();
        let ((sin, cos), (front_sin, front_cos)) = (theta.sin_cos(), (theta + phi).sin_cos());
        let front = [x + cos * d1 + front_cos * d2, y + sin * d1 + front_sin * d2];
        let across = |at: [f64; 2], heading: f64| heading.cos() * at[1] - heading.sin() * at[0];
        assert_abs_diff_eq!(across([v[0], v[1]], q[2]), 0.0, epsilon = ROUNDING);
        // The hinge's rate divides by d2, up to 20.
        assert_abs_diff_eq!(across(front.map(|f| f.eps[0]), q[2] + q[3]), 0.0, epsilon = 10.0 * ROUNDING);
    }

    /// The closed form of the reduced Suslov problem solves its equations, is a flow, and keeps the energy.
    #[test]
    fn suslov_in_closed_form(p in parameters(), draws in draws()) {
        let [a, b, c, d, e] = p;
        let (i13, i23) = (c - d, d - e);
        let body = Suslov::new([a, b, c + i13 * i13 / a + i23 * i23 / b], i13, i23).unwrap();
        let start = [draws[0], draws[1]];
        let size = 1.0 + a / b + b / a;
        let t = 3.0 * draws[2];
        let here = body.exact_reduced(start, t);
        let slope = body.reduced_acceleration(here);
        // Richardson's extrapolation: an error of h^4 and a rounding over h.
        let central = |h: f64| {
            let (up, down) = (body.exact_reduced(start, t + h), body.exact_reduced(start, t - h));
            [(up[0] - down[0]) / (2.0 * h), (up[1] - down[1]) / (2.0 * h)]
        };
        let (wide, narrow) = (central(4e-4), central(2e-4));
        for i in 0..2 {
            assert_abs_diff_eq!((4.0 * narrow[i] - wide[i]) / 3.0, slope[i], epsilon = 1e-9 * size);
            assert_abs_diff_eq!(body.exact_reduced(start, 0.0)[i], start[i], epsilon = ROUNDING * size);
            // A flow; errors grow with exp(nu R t), below exp(20) here, on the way from the repeller.
            let two = body.exact_reduced(body.exact_reduced(start, 0.1 * t), 0.1 * t);
            assert_abs_diff_eq!(two[i], body.exact_reduced(start, 0.2 * t)[i], epsilon = 1e-10 * size);
        }
        let kinetic = |o: [f64; 2]| a * o[0] * o[0] + b * o[1] * o[1];
        assert_relative_eq!(kinetic(here), kinetic(start), max_relative = ROUNDING);
        // In the end a steady turn, in which I13 Omega1 + I23 Omega2 = 0.
        for far in [1e6, -1e6] {
            let [o1, o2] = body.exact_reduced(start, far);
            if (i13.abs() + i23.abs()) * kinetic(start).sqrt() > 1e-3 {
                assert_abs_diff_eq!(i13 * o1 + i23 * o2, 0.0, epsilon = ROUNDING * size);
            }
        }
    }

    /// What decouples leaves no trace in the motion: its size is that of the momenta and of the energy.
    #[test]
    fn named_invariants_have_their_size(p in parameters(), draws in draws()) {
        let [a, b, c, d, e] = p;
        let close = |ours: f64, expected: f64| assert_abs_diff_eq!(ours, expected, epsilon = 10.0 * ROUNDING);

        let disk = RollingDisk::new(a, b, c, d).unwrap();
        let (q, v) = state(&disk, &draws);
        let momenta = momentum(&disk, 0.0, &q, &v);
        let roll = disk.admissible_basis(0.0, &q).unwrap().vectors()[0];
        close(disk.spin_momentum(&v), (0..4).map(|i| momenta[i] * roll[i]).sum());
        close(disk.heading_momentum(&v), momenta[3]);
        close(energy(&disk, 0.0, &q, &v), 0.5 * ((c + a * b * b) * v[2] * v[2] + d * v[3] * v[3]));

        let particle = Particle::in_well(a, b).unwrap();
        let (q, v) = state(&particle, &draws);
        close(energy(&particle, 0.0, &q, &v), particle.energy_in_x(&q, &v) + particle.energy_in_y(&q, &v));

        let edge = KnifeEdge::new(a, b, c - d).unwrap();
        let (q, v) = state(&edge, &draws);
        close(edge.turn_momentum(&v), momentum(&edge, 0.0, &q, &v)[2]);
        let speed = v[0].hypot(v[1]);
        close(energy(&edge, 0.0, &q, &v), 0.5 * (a * speed * speed + b * v[2] * v[2]) - a * (c - d) * q[0]);

        // E = (K, omega)/2.
        let ball = ChaplyginBall::new(a, b, [c, d, e]).unwrap();
        let (q, v) = state(&ball, &draws);
        let omega = spin(&Attitude::new(moving(&[q[2], q[3], q[4]], &[v[2], v[3], v[4]])));
        let k = ball.contact_momentum(&q, &v);
        close(energy(&ball, 0.0, &q, &v), 0.5 * (0..3).map(|i| k[i] * omega[i]).sum::<f64>());

        let board = Snakeboard::new(a, b, c, d, e).unwrap();
        let (q, v) = state(&board, &draws);
        let momenta = momentum(&board, 0.0, &q, &v);
        close(board.rotor_momentum(&v), momenta[3]);
        close(board.rotor_momentum(&v), d * (v[2] + v[3]));
        close(board.steering_momentum(&v), momenta[4]);
        close(board.steering_momentum(&v), 2.0 * e * v[4]);
    }

    /// A total derivative changes the momenta, and neither motion nor energy.
    #[test]
    fn the_gauge_term_shifts_momenta_only(p in parameters(), draws in draws()) {
        let plain = ContactOscillator::new(p[0]).unwrap();
        let gauged = GaugedOscillator::new(plain, p[1]).unwrap();
        let (q, v) = state(&plain, &draws);
        let shift = momentum(&gauged, 0.0, &q, &v)[2] - momentum(&plain, 0.0, &q, &v)[2];
        assert_abs_diff_eq!(shift, p[1] * q[2].sin(), epsilon = ROUNDING);
        assert_relative_eq!(energy(&gauged, 0.0, &q, &v), energy(&plain, 0.0, &q, &v), max_relative = ROUNDING);
    }
}

/// The divergence of the reduced equations `q' = W xi`, `xi' = g` at one point; a central difference is exact for the
/// quadratic `g`.
fn divergence<Mo: Model<N, M>, const N: usize, const M: usize>(model: &Mo, q: &[f64; N], xi: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for j in 0..N {
        let seeded: [Dual<f64, 1>; N] = from_fn(|i| Dual { re: q[i], eps: [if i == j { 1.0 } else { 0.0 }] });
        let basis = model.admissible_basis(Dual::fixed(0.0), &seeded).unwrap();
        sum += basis.combine(&xi.map(Dual::fixed))[j].eps[0];
    }
    for j in 0..N - M {
        let shifted = |by: f64| {
            let xi = from_fn(|i| if i == j { xi[i] + by } else { xi[i] });
            reduced_acceleration(model, 0.0, q, &xi).unwrap()[j]
        };
        sum += shifted(0.5) - shifted(-0.5);
    }
    sum
}

proptest! {
    /// Where all but cyclic coordinates rest, a smooth measure needs a divergence of zero. Straight ahead it is
    /// `u/d2 (1 - g)/(1 + g d1/d2)` with `g = I2 d1/(I1 d2)`, and folded, at `phi = pi`, `-u/d2 (1 + g)/(1 + g d1/d2)`.
    #[test]
    fn straight_motions_of_the_racer_forbid_a_measure(p in parameters(), u in 0.5..1.5f64) {
        let [mass, rear, front, d1, d2] = p;
        let racer = RollerRacer::new(mass, rear, front, d1, d2).unwrap();
        let gain = front * d1 / (rear * d2);
        for (phi, sign) in [(0.0, 1.0), (std::f64::consts::PI, -1.0)] {
            let (q, xi) = ([0.0, 0.0, 0.0, phi], [u, 0.0, 0.0, 0.0]);
            let v = racer.admissible_basis(0.0, &q).unwrap().combine(&xi);
            let expected = sign * u / d2 * (1.0 - sign * gain) / (1.0 + gain * d1 / d2);
            // The terms add up to at most some 200, before they cancel.
            for a in racer.accelerations_by_hand(0.0, &q, &v) {
                assert_abs_diff_eq!(a, 0.0, epsilon = 100.0 * ROUNDING);
            }
            assert_abs_diff_eq!(divergence(&racer, &q, &xi), expected, epsilon = 100.0 * ROUNDING);
            assert!(sign > 0.0 || expected < -0.01);
        }
        assert!(!racer.labels().invariant_measure);
    }
}

#[test]
fn the_steady_turn_of_suslov_forbids_a_measure() {
    let body = Suslov::new([1.0, 2.0, 1.5], 0.3, 0.5).unwrap();
    // I13 Omega1 + I23 Omega2 = 0 stays, and the trace is (I13/I22 + ..) of the reduced equations.
    let omega = [0.5, -0.3];
    assert_eq!(body.reduced_acceleration(omega), [0.0; 2]);
    let trace = -0.3 * omega[1] / 1.0 + 0.5 * omega[0] / 2.0;
    let slopes = |i: usize| {
        let shifted =
            |by: f64| body.reduced_acceleration(from_fn(|k| if k == i { omega[k] + by } else { omega[k] }))[i];
        shifted(0.5) - shifted(-0.5)
    };
    assert_relative_eq!(slopes(0) + slopes(1), trace, max_relative = 1e-14);
    assert!(trace.abs() > 0.1 && !body.labels().invariant_measure);
    assert!(Suslov::new([1.0, 2.0, 1.5], 0.0, 0.0).unwrap().labels().invariant_measure);
}

/// Spin 1 and turn 2 rad/s: the circle `(sin(2t), 1 - cos(2t))/2`.
#[test]
fn the_disk_runs_a_circle() {
    let disk = RollingDisk::new(1.0, 1.0, 1.0, 1.0).unwrap();
    for t in [-7.0, 0.3, 1.0, 20.0f64] {
        let ([x, y, phi, theta], _) = disk.exact(t).unwrap();
        assert_abs_diff_eq!(x, 0.5 * (2.0 * t).sin(), epsilon = 1e-14);
        assert_abs_diff_eq!(y, 0.5 * (1.0 - (2.0 * t).cos()), epsilon = 1e-14);
        assert_eq!([phi, theta], [t, 2.0 * t]);
    }
    let straight = disk.exact_from(&([0.0; 4], [1.5, 0.0, 1.5, 0.0]), 4.0).unwrap();
    assert_eq!(straight, ([6.0, 0.0, 6.0, 0.0], [1.5, 0.0, 1.5, 0.0]));
}

/// From rest the edge runs a cycloid across the slope: `x = g/(2 w^2) sin^2(w t)`,
/// `y = g/(2 w^2) (w t - sin(2 w t)/2)`.
#[test]
fn the_edge_runs_a_cycloid() {
    let g = 1.7;
    let edge = KnifeEdge::new(2.0, 0.6, g).unwrap();
    for t in [-3.0, 0.2, 1.1, 9.0f64] {
        let ([x, y, theta], _) = edge.exact(t).unwrap();
        assert_abs_diff_eq!(x, 0.5 * g * t.sin().powi(2), epsilon = 1e-14);
        assert_relative_eq!(y, 0.5 * g * (t - 0.5 * (2.0 * t).sin()), max_relative = 1e-14);
        assert_eq!(theta, t);
    }
    // Without a turn it slides down its line, and slowly turning almost so.
    let heading = 0.8f64;
    let at = |w: f64| edge.exact_from(&([0.0, 0.0, heading], [0.0, 0.0, w]), 2.0).unwrap().0;
    let line = 0.5 * g * heading.cos() * 4.0;
    let ([x, y, _], [x1, y1, _]) = (at(0.0), at(1e-12));
    assert_relative_eq!(x, line * heading.cos(), max_relative = 1e-15);
    assert_relative_eq!(y, line * heading.sin(), max_relative = 1e-15);
    assert_abs_diff_eq!(x1, x, epsilon = 1e-11);
    assert_abs_diff_eq!(y1, y, epsilon = 1e-11);
}

/// `x = (k/w) (asinh y - asinh y0)`, `z = (k/w) (sqrt(1 + y^2) - sqrt(1 + y0^2))`, `k = x' sqrt(1 + y^2)`.
#[test]
fn the_particle_moves_by_asinh() {
    let particle = Particle::flat(1.4).unwrap();
    let k = 0.9 * 1.04f64.sqrt();
    for t in [-6.0, 0.4, 3.0] {
        let ([x, y, z], _) = particle.exact(t).unwrap();
        assert_relative_eq!(y, 0.2 + 0.7 * t, max_relative = 1e-15);
        assert_abs_diff_eq!(x, 0.1 + k / 0.7 * (y.asinh() - 0.2f64.asinh()), epsilon = 1e-14);
        assert_abs_diff_eq!(z, 0.3 + k / 0.7 * ((1.0 + y * y).sqrt() - 1.04f64.sqrt()), epsilon = 1e-14);
    }
    assert!(Particle::in_well(1.4, 0.5).unwrap().exact(1.0).is_none());
}

#[test]
fn families_of_starts() {
    for eps in [0.0, 0.3] {
        let oscillator = ContactOscillator::new(eps).unwrap();
        for z0 in [-1.2, 0.0, 0.7] {
            let (q, v) = oscillator.start_at(z0).unwrap();
            assert_relative_eq!(energy(&oscillator, 0.0, &q, &v), 1.5, max_relative = 1e-15);
            assert_eq!(oscillator.energy_in_y(&q, &v), 0.5);
            assert_eq!(q[2], z0);
        }
        assert_eq!(oscillator.start_at(0.3 * std::f64::consts::SQRT_2).unwrap(), oscillator.start());
        assert!(oscillator.start_at(1.5).is_err());
    }
    let quartic = QuarticOscillator::new(1.0).unwrap();
    let level = |angle: f64| {
        let (q, v) = quartic.start_at(angle);
        energy(&quartic, 0.0, &q, &v)
    };
    // (1 + 0.56 + 3 + 0.56 + 1)/2.
    for angle in [0.0, 0.5, 2.0] {
        assert_relative_eq!(level(angle), 3.06, max_relative = 1e-15);
    }
}

#[test]
fn bad_parameters_are_refused() {
    let refused = |name: &str, position: usize, build: &dyn Fn(f64) -> Option<ModelError>, bad: &[f64]| {
        assert_eq!(build(1.0), None, "{name}, {position}");
        for value in bad {
            let error = build(*value).unwrap_or_else(|| panic!("{name}, {position}: {value}"));
            let shown = match error {
                ModelError::NotPositive { value, .. }
                | ModelError::Negative { value, .. }
                | ModelError::NotFinite { value, .. }
                | ModelError::NotPositiveDefinite { determinant: value } => value,
            };
            assert!(shown.to_bits() == value.to_bits() || matches!(error, ModelError::NotPositiveDefinite { .. }));
            assert!(error.to_string().contains(&shown.to_string()), "{error}");
        }
    };
    let positive = [0.0, -1.0, f64::NAN, f64::INFINITY];
    let not_negative = [-1e-9, f64::NAN, f64::INFINITY];
    let not_finite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let put = |k: usize, x: f64| -> [f64; 5] { from_fn(|i| if i == k { x } else { 1.0 }) };
    for k in 0..5 {
        if k < 4 {
            refused(
                "disk",
                k,
                &|x| {
                    let p = put(k, x);
                    RollingDisk::new(p[0], p[1], p[2], p[3]).err()
                },
                &positive,
            );
        }
        if k < 2 {
            refused(
                "edge",
                k,
                &|x| {
                    let p = put(k, x);
                    KnifeEdge::new(p[0], p[1], 1.0).err()
                },
                &positive,
            );
        }
        if k < 3 {
            refused(
                "Suslov",
                k,
                &|x| {
                    let p = put(k, x);
                    Suslov::new([p[0], p[1], p[2]], 0.1, 0.1).err()
                },
                &positive,
            );
        }
        refused(
            "ball",
            k,
            &|x| {
                let p = put(k, x);
                ChaplyginBall::new(p[0], p[1], [p[2], p[3], p[4]]).err()
            },
            &positive,
        );
        refused(
            "board",
            k,
            &|x| {
                let p = put(k, x);
                Snakeboard::new(p[0], p[1], p[2], p[3], p[4]).err()
            },
            &positive,
        );
        refused(
            "racer",
            k,
            &|x| {
                let p = put(k, x);
                RollerRacer::new(p[0], p[1], p[2], p[3], p[4]).err()
            },
            &positive,
        );
    }
    refused("particle", 0, &|x| Particle::flat(x).err(), &positive);
    refused("particle", 1, &|x| Particle::in_well(1.0, x).err(), &not_negative);
    refused("edge", 2, &|x| KnifeEdge::new(1.0, 1.0, x).err(), &not_finite);
    refused("Suslov", 3, &|x| Suslov::new([2.0; 3], x, 0.5).err(), &not_finite);
    refused("Suslov", 4, &|x| Suslov::new([2.0; 3], 0.5, x).err(), &[2.0, f64::NAN]);
    refused("contact", 0, &|x| ContactOscillator::new(x).err(), &not_negative);
    refused("quartic", 0, &|x| QuarticOscillator::new(x).err(), &not_negative);
    let plain = ContactOscillator::new(0.0).unwrap();
    refused("gauged", 0, &|x| GaugedOscillator::new(plain, x).err(), &not_finite);
}
