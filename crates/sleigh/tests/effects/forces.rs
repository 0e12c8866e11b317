//! What the forces do: their power, and their components along the blade, across it and about it.

use super::sleigh;
use approx::assert_abs_diff_eq;
use lagrangian::{Effect, EffectSlope};
use proptest::prelude::*;
use sleigh::effects::{Drag, EggCrate, Friction, MovingMass, QuadraticDrag, Thrust, Torque};
use sleigh::{Flywheel, Sleigh, TimeFunction};

/// Along the blade (N), across it (N), and about its contact point (N m).
fn components<E: Effect<Sleigh, 3>>(effect: &E, t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
    let sleigh = sleigh();
    let [x, y, torque] = effect.force(&sleigh, t, q, v).unwrap();
    let (sin, cos) = q[2].sin_cos();
    [x * cos + y * sin, y * cos - x * sin, torque]
}

fn close(found: [f64; 3], expected: [f64; 3]) {
    for i in 0..3 {
        // Numbers below five, a dozen operations.
        assert_abs_diff_eq!(found[i], expected[i], epsilon = 5.0 * 12.0 * f64::EPSILON);
    }
}

proptest! {
    /// Half of the mass times the square of the velocity of `P + R(theta) r(t)`, in the plane's axes.
    #[test]
    fn a_moving_mass_has_its_energy(
        q in proptest::array::uniform3(-3.0..3.0f64), v in proptest::array::uniform3(-2.0..2.0f64), t in 0.0..5.0f64,
    ) {
        let place = |phase: f64| TimeFunction::Sine { amplitude: 0.3, frequency: 2.0, phase };
        let mass = MovingMass::new(0.4, place(0.1), place(1.0)).unwrap();
        let phases = [0.1, 1.0f64];
        let [rx, ry] = phases.map(|phase| 0.3 * (2.0 * t + phase).sin());
        let [dx, dy] = phases.map(|phase| 0.6 * (2.0 * t + phase).cos());
        let (sin, cos) = q[2].sin_cos();
        let point = [
            v[0] - v[2] * (sin * rx + cos * ry) + cos * dx - sin * dy,
            v[1] + v[2] * (cos * rx - sin * ry) + sin * dx + cos * dy,
        ];
        let energy = mass.lagrangian(&sleigh(), t, &q, &v).unwrap();
        let expected = 0.2 * (point[0] * point[0] + point[1] * point[1]);
        // Squares below thirty, two dozen operations.
        assert_abs_diff_eq!(energy, expected, epsilon = 30.0 * 24.0 * f64::EPSILON);
    }

    /// Minus `V_0 (cos(k_x X) + cos(k_y Y))` at the centre of mass, and its derivatives by hand.
    #[test]
    fn an_egg_crate_has_its_waves(q in proptest::array::uniform3(-3.0..3.0f64)) {
        let (sleigh, [kx, ky], height, a) = (sleigh(), [2.5, 0.4], 0.7, 0.4);
        let crate_ = EggCrate::new(height, [kx, ky]).unwrap();
        let (sin, cos) = q[2].sin_cos();
        let [x, y] = [kx * (q[0] + a * cos), ky * (q[1] + a * sin)];
        let value: f64 = crate_.lagrangian(&sleigh, 0.0, &q, &[0.0; 3]).unwrap();
        // Arguments below ten and their rounding, times the wave number.
        assert_abs_diff_eq!(value, -height * (x.cos() + y.cos()), epsilon = 1e-14);
        let EffectSlope::Known(slope) = crate_.slope(&sleigh, 0.0, &q) else { panic!("no slope by hand") };
        let (fx, fy) = (height * kx * x.sin(), height * ky * y.sin());
        let expected = [fx, fy, a * (cos * fy - sin * fx)];
        for i in 0..3 {
            assert_abs_diff_eq!(slope[i], expected[i], epsilon = 1e-14);
        }
    }

    #[test]
    fn forces_act_where_they_say(q in proptest::array::uniform3(-3.0..3.0f64), u in -2.0..2.0f64, w in -2.0..2.0f64, t in 0.0..5.0f64) {
        let (sin, cos) = q[2].sin_cos();
        let v = [u * cos, u * sin, w];
        close(components(&Drag::new(0.3, 0.7).unwrap(), t, &q, &v), [-0.3 * u, 0.0, -0.7 * w]);
        close(components(&QuadraticDrag::new(0.3, 0.7).unwrap(), t, &q, &v), [-0.3 * u * u.abs(), 0.0, -0.7 * w * w.abs()]);
        let friction = Friction::new(0.3, 0.2, 0.7, 0.4).unwrap();
        close(components(&friction, t, &q, &v), [-0.3 * (u / 0.2).tanh(), 0.0, -0.7 * (w / 0.4).tanh()]);
        let function = TimeFunction::Sine { amplitude: 1.2, frequency: 0.9, phase: 0.4 };
        let value = 1.2 * (0.9 * t + 0.4).sin();
        close(components(&Thrust::new(function.clone()).unwrap(), t, &q, &v), [value, 0.0, 0.0]);
        close(components(&Torque::new(function).unwrap(), t, &q, &v), [0.0, 0.0, value]);
        // On more coordinates the others feel nothing.
        let rotor = Flywheel::new(sleigh(), 0.2, None).unwrap();
        let (q, v) = ([q[0], q[1], q[2], 0.5], [v[0], v[1], v[2], 0.6]);
        for force in [
            Drag::new(0.3, 0.7).unwrap().force(&rotor, t, &q, &v),
            QuadraticDrag::new(0.3, 0.7).unwrap().force(&rotor, t, &q, &v),
            friction.force(&rotor, t, &q, &v),
            Thrust::new(1.5).unwrap().force(&rotor, t, &q, &v),
            Torque::new(1.5).unwrap().force(&rotor, t, &q, &v),
        ] {
            prop_assert_eq!(force.unwrap()[3].to_bits(), 0);
        }
    }
}
