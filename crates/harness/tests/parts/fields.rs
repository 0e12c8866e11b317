//! The sleigh under drag, in a bowl and over hills, in steps that are far too long for them.

use crate::parts::{BAR, by, by_each, sleigh};
use lagrangian::With;
use sleigh::SleighState;
use sleigh::effects::{Bowl, Drag, Hill, Hills};

test_systems::short_and_full! {
    heavy_drag => dragged(&[(0.1, 4), (1.0, 2), (3.0, 2)], 1);
    heavy_drag_at_length => dragged(&[(0.1, 20), (1.0, 20), (3.0, 20), (1e3, 4)], 20);
}

/// Straight ahead under drag: `u = e^(-c t/m)`, and the way is the lost speed times `m/c`. Nothing turns the sleigh round. Steps of so many
/// time constants, and some of a million.
fn dragged(cases: &[(f64, u64)], of_a_million: u64) {
    let start = SleighState { speed: 1.0, ..SleighState::default() };
    let step = 0.05;
    for &(part, steps) in cases {
        let along = part / step;
        let system = With { body: sleigh(0.5), effects: Drag::new(along, 0.0).unwrap() };
        for (name, run) in by_each(&system, &start, (step, steps)) {
            let (end, left) = (run.end(), (-along * step * steps as f64).exp());
            assert!((end.x * along - (1.0 - left)).abs() <= BAR, "{name}, c h/m = {part}: x = {}", end.x);
            // Each time constant is wrong by its own part.
            let decay = along * step * steps as f64;
            assert!((end.speed - left).abs() <= BAR * decay * left + 1e-14, "{name} {part}: {:e}", end.speed);
            // Dead, to the rounding of the speed that there was.
            let speeds = run.seen(|state| state.speed);
            assert!(speeds.iter().all(|speed| *speed > -1e-14), "{name}, c h/m = {part}: {speeds:?}");
            assert!(part < 100.0 || run.substeps.divided > 0, "{name} {part}");
        }
    }
    // A million time constants a step; the other methods do it too, in as many parts as there are time constants.
    let system = With { body: sleigh(0.5), effects: Drag::new(1e6 / step, 0.0).unwrap() };
    let run = by("dla", &system, &start, (step, of_a_million));
    assert!((run.end().x * 1e6 / step - 1.0).abs() <= BAR && run.end().speed.abs() < 1e-14);
    assert!(run.substeps.divided > 0 && run.substeps.parts < 10_000, "{}", run.substeps.parts);
}

test_systems::short_and_full! {
    stiff_bowl => swings(&[(0.01, 10), (1.0, 7), (10.0, 1)]);
    stiff_bowl_in_full => swings(&[(0.01, 200), (1.0, 20), (10.0, 10), (100.0, 2)]);
}

/// To and fro in a bowl, `x = cos(w t)`, up to five swings a step, and sixteen. A part is wrong by a ten-thousandth of the velocity at
/// most, which it may lead or lag by.
fn swings(cases: &[(f64, u64)]) {
    let start = SleighState { x: 1.0, ..SleighState::default() };
    let step = 0.05;
    for &(part, steps) in cases {
        let rate: f64 = part / step;
        let system = With { body: sleigh(0.0), effects: Bowl::new([rate * rate; 2], [0.0; 2]).unwrap() };
        for (name, run) in by_each(&system, &start, (step, steps)) {
            let all = 0.5 * rate * rate;
            let phase = rate * step * steps as f64;
            let bar = 1e-4 * (1.0 + phase.max(run.substeps.parts as f64));
            for node in &run.nodes {
                assert!((node.q[0] - (rate * node.t).cos()).abs() <= bar, "{name} {part}: t = {}, {bar}", node.t);
                assert!((node.energy - all).abs() <= 1e-8 * all, "{name} {part}: {:e}", node.energy);
            }
            // Even the order eight does not go through five swings at once.
            assert_eq!(run.substeps.divided > 0, part > 5.0 || part > 0.5 && name != "gauss8", "{name} {part}");
        }
    }
}

test_systems::short_and_full! {
    /// Past the first hill; the steps of the reference are a third of its width.
    steep_hill => over_hills(&[(0.004, 5.0)], 8, 16);
    /// The steps of the reference are 0.2 mm.
    steep_hill_in_full => over_hills(&[(0.0, 0.2), (0.004, 5.0), (0.0, -3.0)], 100, 256);
}

/// Hills of 1 cm width in the way of steps of 5 cm. The reference is of order 12, in so many steps for each of them.
fn over_hills(cases: &[(f64, f64)], steps: u64, finer: u32) {
    for &(y, height) in cases {
        let hills = [0.3, 0.82, 1.01].map(|x| Hill { height, x, y, width: 0.01 });
        let system = With { body: sleigh(0.5), effects: Hills::new(hills.to_vec()).unwrap() };
        let start = SleighState { x: -0.5, speed: 1.0, turn_rate: 0.2, ..SleighState::default() };
        let right = by("gauss12", &system, &start, (0.05 / f64::from(finer), steps * u64::from(finer)));
        let (right, divided) = (right.end(), right.substeps.divided);
        assert_eq!(divided, 0);
        for (name, run) in by_each(&system, &start, (0.05, steps)) {
            let end = run.end();
            // On a way of five metres at most.
            for (found, right) in [(end.x, right.x), (end.y, right.y)] {
                assert!((found - right).abs() <= BAR, "{name} {height}: {found} {right}");
            }
            for (found, right) in
                [(end.heading, right.heading), (end.speed, right.speed), (end.turn_rate, right.turn_rate)]
            {
                assert!((found - right).abs() <= 0.5 * BAR, "{name} {height}: {found} {right}");
            }
            assert!(height < 1.0 || run.substeps.divided > 0, "{name} {height}");
        }
    }
}
