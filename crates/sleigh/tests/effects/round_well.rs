//! The sleigh in a round well, in its own axes, is the sleigh in a bowl.

use approx::assert_relative_eq;
use lagrangian::{Reduced, With, constraint_residual, energy, reduced_acceleration};
use proptest::prelude::*;
use sleigh::effects::Bowl;
use sleigh::{RoundWell, Sleigh, SleighState};

/// Some twenty operations on numbers of a few units.
const ROUNDING: f64 = 1e-13;

proptest! {
    #[test]
    fn a_round_well_is_a_bowl(
        m in 0.1..10.0f64, inertia in 0.1..10.0f64, a in -2.0..2.0f64, k in -1.0..1.0f64,
        center in proptest::array::uniform2(-3.0..3.0f64), z in proptest::array::uniform5(-3.0..3.0f64),
    ) {
        let sleigh = Sleigh::new(m, inertia, a).unwrap();
        let bowl = With { body: sleigh, effects: Bowl::new([k, k], center).unwrap() };
        let well = RoundWell::new(sleigh, k, center).unwrap();
        let state = SleighState { x: z[0], y: z[1], heading: z[2], speed: z[3], turn_rate: z[4] };
        let ((q, v), (own, rates)) = (state.to_coordinates(), well.coordinates(&state));
        let back = well.state(&own, &rates);
        for (x, y) in [(back.x, z[0]), (back.y, z[1]), (back.heading, z[2]), (back.speed, z[3]), (back.turn_rate, z[4])] {
            assert_relative_eq!(x, y, epsilon = ROUNDING, max_relative = ROUNDING);
        }
        // Not one that has lost digits in a difference.
        let scale = m * (z[3] * z[3] + a * a * z[4] * z[4]) + inertia * z[4] * z[4] + 100.0 * k.abs();
        assert_relative_eq!(energy(&well, 0.0, &own, &rates), energy(&bowl, 0.0, &q, &v), epsilon = ROUNDING * (1.0 + scale));
        prop_assert!(constraint_residual(&well, 0.0, &own, &rates)[0].abs() < ROUNDING * 20.0);

        let xi = [z[3], z[4], 0.0];
        let (by_hand, on_the_plane) = (well.reduced_motion(0.0, &own, &xi).unwrap(), bowl.reduced_motion(0.0, &q, &xi).unwrap());
        let automatic = reduced_acceleration(&well, 0.0, &own, &xi).unwrap();
        for i in 0..2 {
            // Forces of up to 10 N on masses from 0.1 kg on, arms of 2 m.
            assert_relative_eq!(by_hand[i], on_the_plane[i], epsilon = 1e3 * ROUNDING, max_relative = ROUNDING);
            assert_relative_eq!(by_hand[i], automatic[i], epsilon = 1e3 * ROUNDING, max_relative = 10.0 * ROUNDING);
        }
    }
}

#[test]
fn what_is_no_number_is_refused() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    assert!(RoundWell::new(sleigh, f64::NAN, [0.0; 2]).is_err());
    assert!(RoundWell::new(sleigh, 1.0, [0.0, f64::INFINITY]).is_err());
    assert!(RoundWell::drawing(sleigh, 1.0, [0.0; 2], f64::NAN).is_err());
}
