//! What a step of an ensemble costs, on one core: processor time, least and median of rounds.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use dla::{ClosedEnsemble, LaneState};
use sleigh::Sleigh;
use std::hint::black_box;
use std::time::Instant;

const STEPS: u64 = 2000;
const ROUNDS: usize = 60;

/// Least and median seconds of a call.
fn seconds(mut f: impl FnMut()) -> (f64, f64) {
    let mut times: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            f();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    (times[0], times[ROUNDS / 2])
}

fn closed<const R: usize, const W: usize>(h: f64) {
    let sleighs = black_box([Sleigh::new(1.0, 1.0, 0.5).unwrap(); W]);
    let starts: Vec<_> = (0..W).map(|i| ([0.0; 3], [-1.0, 0.05 + 1e-3 * i as f64, 0.0])).collect();
    let ensemble = ClosedEnsemble::<_, R, W, 3, 1, 5, 6>::new(sleighs, h, LaneState::new(&starts, [false, false, true]));
    let (least, median) = seconds(|| {
        let mut ensemble = black_box(ensemble);
        ensemble.advance(STEPS);
        black_box(ensemble);
    });
    let ns = 1e9 / (STEPS as f64 * W as f64);
    println!("dla, free, {R} registers, h = {h}: {:.2} ns a sleigh and step (median {:.2})", ns * least, ns * median);
}

fn main() {
    for h in [0.05, 0.1] {
        closed::<2, 16>(h);
        closed::<3, 24>(h);
    }
}
