//! The rows of the constraint say what is imposed: the motion that is asked for meets them, and no other does.

use super::{sine, sleigh};
use approx::assert_abs_diff_eq;
use lagrangian::{System, constraint_residual};
use proptest::prelude::*;
use sleigh::{ClosedPath, Guide, Guided};

/// The offset of the mass (m).
const OFFSET: f64 = 0.4;

/// The velocity with a speed along the blade, one across it, and a turn rate.
fn moving(q: &[f64; 3], speed: f64, slip: f64, turn_rate: f64) -> [f64; 3] {
    let (sin, cos) = q[2].sin_cos();
    [speed * cos - slip * sin, speed * sin + slip * cos, turn_rate]
}

/// The largest residual of a velocity that meets all rows but for rounding; each row must see the velocity change.
fn check<Sys: System<3, M>, const M: usize>(system: &Sys, t: f64, q: &[f64; 3], v: [f64; 3]) {
    for residual in constraint_residual(system, t, q, &v) {
        // Numbers below ten, a dozen operations.
        assert_abs_diff_eq!(residual, 0.0, epsilon = 10.0 * 12.0 * f64::EPSILON);
    }
    let (a, _) = system.constraint(t, q);
    for (k, row) in a.iter().enumerate() {
        let other: [f64; 3] = std::array::from_fn(|i| v[i] + 0.1 * row[i]);
        let squared: f64 = row.iter().map(|entry| entry * entry).sum();
        let residual = constraint_residual(system, t, q, &other)[k];
        assert_abs_diff_eq!(residual, 0.1 * squared, epsilon = 10.0 * 12.0 * f64::EPSILON);
        assert!(squared > 0.9, "row {k}: {row:?}");
    }
}

proptest! {
    #[test]
    fn a_servo_imposes_speed_and_turn_rate(q in proptest::array::uniform3(-3.0..3.0f64), t in 0.0..5.0, w in -2.0..2.0) {
        let (speed, turn_rate) = (sine(0.8, 1.1, 0.5), sine(0.9, 0.7, 1.2));
        let (u, omega) = (speed.value(t), turn_rate.value(t));
        let both = Guided::<2>::servo(sleigh(), speed.clone(), turn_rate.clone()).unwrap();
        check(&both, t, &q, moving(&q, u, 0.0, omega));
        check(&Guided::<1>::servo(sleigh(), Guide::Speed(speed)).unwrap(), t, &q, moving(&q, u, 0.0, w));
        check(&Guided::<1>::servo(sleigh(), Guide::TurnRate(turn_rate)).unwrap(), t, &q, moving(&q, w, 0.0, omega));
    }

    /// On a plane that turns the blade does not slip against the plane, whose points have the velocity `Omega (-y, x)`.
    #[test]
    fn a_turntable_carries_the_blade(
        q in proptest::array::uniform3(-3.0..3.0f64), rate in -0.8..0.8, u in -2.0..2.0, omega in -2.0..2.0,
    ) {
        let carried = |u: f64| {
            let v = moving(&q, u, 0.0, omega);
            [v[0] - rate * q[1], v[1] + rate * q[0], v[2]]
        };
        let table = Guided::turntable(sleigh(), rate).unwrap();
        prop_assert_eq!(table.table_rate().to_bits(), rate.to_bits());
        prop_assert_eq!(table.guided_by(), None);
        check(&table, 0.0, &q, carried(u));
        let turning = Guided::<1>::servo(sleigh(), Guide::TurnRate(omega.into())).unwrap();
        prop_assert_eq!(turning.guided_by(), Some("servo"));
        check(&turning.on_turntable(rate).unwrap(), 0.0, &q, carried(u));
    }

    /// `C' = P' + a omega n` is the velocity of the path, with `theta' = (n . C')/a`.
    #[test]
    fn a_tracer_leads_the_centre(q in proptest::array::uniform3(-3.0..3.0f64), t in 0.0..5.0) {
        let path = ClosedPath::circle(0.7, [0.1, 0.2], 5.0).unwrap();
        let [x, y]: [f64; 2] = path.velocity(t);
        let (sin, cos) = q[2].sin_cos();
        let (along, across) = (x * cos + y * sin, y * cos - x * sin);
        let tracer = Guided::<2>::tracer(sleigh(), path).unwrap();
        prop_assert_eq!(tracer.guided_by(), Some("tracer"));
        check(&tracer, t, &q, moving(&q, along, 0.0, across / OFFSET));
    }
}
