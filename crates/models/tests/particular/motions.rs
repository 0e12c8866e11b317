//! Known motions and families of starts.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrangian::energy;
use models::{ContactOscillator, KnifeEdge, Model, Particle, QuarticOscillator, RollingDisk};

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
