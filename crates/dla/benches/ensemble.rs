//! What a step of an ensemble costs, on one core: processor time, least and median of rounds.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use dla::{ClosedEnsemble, Ensemble, GaussEnsemble, LaneState, Same};
use lagrangian::{System, With};
use sleigh::Sleigh;
use sleigh::effects::Bowl;
use std::hint::black_box;
use std::time::Instant;

const STEPS: u64 = 2000;
const ROUNDS: usize = 40;

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

fn closed<const W: usize>(h: f64) {
    let sleighs = black_box([Sleigh::new(1.0, 1.0, 0.5).unwrap(); W]);
    let starts: Vec<_> = (0..W).map(|i| ([0.0; 3], [-1.0, 0.05 + 1e-3 * i as f64, 0.0])).collect();
    let ensemble = ClosedEnsemble::<_, W, 3, 1, 5, 6>::new(sleighs, h, LaneState::new(&starts, [false, false, true]));
    let (least, median) = seconds(|| {
        let mut ensemble = black_box(ensemble);
        ensemble.advance(STEPS);
        black_box(ensemble);
    });
    let ns = 1e9 / (STEPS as f64 * W as f64);
    println!("dla, free, {W} at once, h = {h}: {:.2} ns a sleigh and step (median {:.2})", ns * least, ns * median);
}

/// Eight or sixteen starts, as those of the peers.
fn starts<const W: usize>() -> LaneState<3, W> {
    let starts: Vec<_> = (0..W).map(|i| ([0.0; 3], [-1.0, 0.1 + 1e-3 * (i % 8) as f64, 0.0])).collect();
    LaneState::new(&starts, [false, false, true])
}

/// Positions and headings at the end, unwrapped.
fn ends<const W: usize>(state: &LaneState<3, W>) -> Vec<[f64; 3]> {
    (0..W).map(|lane| state.lane(lane, [0.0; 3]).unwrapped()).collect()
}

const DURATION: f64 = 100.0;

fn gauss<Sys: System<3, 1> + Clone, const S: usize, const W: usize>(
    name: &str,
    system: &Sys,
    reference: &[[f64; 3]],
    steps: &[u64],
) {
    for &count in steps {
        for settled in [1e-17, 1e-13, 1e-9] {
            let h = DURATION / count as f64;
            let mut ensemble = GaussEnsemble::<Sys, _, S, W, 3, 1>::new(Same(system), (0.0, h), starts()).unwrap();
            ensemble.settled = settled;
            let mut end = ensemble.clone();
            let (least, median) = seconds(|| {
                end = black_box(ensemble.clone());
                end.advance(count);
            });
            let error = ends(end.state())
                .iter()
                .zip(reference)
                .fold(0.0, |worst: f64, (a, b)| (0..3).fold(worst, |worst, k| worst.max((a[k] - b[k]).abs())));
            let us = 1e6 / W as f64;
            println!(
                "{name}, gauss{}, h = {h:.3}, settled {settled:e}: error {error:.1e}, {:.2} us a trajectory (median {:.2}), {:.1} sweeps a step",
                2 * S,
                us * least,
                us * median,
                end.sweeps() as f64 / count as f64
            );
        }
    }
}

fn reference<Sys: System<3, 1>>(system: &Sys) -> Vec<[f64; 3]> {
    let mut ensemble =
        GaussEnsemble::<Sys, _, 8, 16, 3, 1>::new(Same(system), (0.0, DURATION / 512.0), starts()).unwrap();
    ensemble.advance(512);
    ends(ensemble.state())
}

fn main() {
    for h in [0.05, 0.1] {
        closed::<8>(h);
        closed::<24>(h);
    }
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let bowl = With { body: sleigh, effects: Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap() };
    let ends = reference(&sleigh);
    gauss::<_, 8, 16>("free", &sleigh, &ends, &[32, 64]);
    gauss::<_, 4, 16>("free", &sleigh, &ends, &[100]);
    let ends = reference(&bowl);
    gauss::<_, 8, 8>("bowl", &bowl, &ends, &[40]);
    gauss::<_, 8, 16>("bowl", &bowl, &ends, &[36, 40, 80]);
    gauss::<_, 4, 16>("bowl", &bowl, &ends, &[100]);
}
