//! What a step of an ensemble costs, on one core: processor time, least and median of rounds.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use dla::{Each, Ensemble, GaussEnsemble, LaneState, OneStep, Same, State, Systems};
use lagrangian::{System, With};
use sleigh::effects::Bowl;
use sleigh::series::InOwnAxes;
use sleigh::{ClosedEnsemble, RoundWell, Sleigh, SleighState, Taylor, TaylorEnsemble};
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
    let ensemble = ClosedEnsemble::<W>::new(sleighs, h, LaneState::new(&starts, [false, false, true]));
    let (least, median) = seconds(|| {
        let mut ensemble = black_box(ensemble);
        ensemble.advance(STEPS);
        black_box(ensemble);
    });
    let ns = 1e9 / (STEPS as f64 * W as f64);
    println!("dla, free, {W} at once, h = {h}: {:.2} ns a sleigh and step (median {:.2})", ns * least, ns * median);
}

/// Sixteen starts, the eight of the peers twice; `place` gives the coordinates of a state.
fn starts(place: impl Fn(&SleighState) -> [f64; 3]) -> LaneState<3, W> {
    let start =
        |i: usize| SleighState { speed: -1.0, turn_rate: 0.1 + 1e-3 * (i % 8) as f64, ..SleighState::default() };
    let starts: Vec<_> = (0..W).map(start).map(|s| (place(&s), [s.speed, s.turn_rate, 0.0])).collect();
    LaneState::new(&starts, [false, false, true])
}

fn on_plane(state: &SleighState) -> [f64; 3] {
    [state.x, state.y, state.heading]
}

/// Positions and headings at the end, unwrapped.
fn ends(state: &LaneState<3, W>, place: impl Fn(&[f64; 3]) -> [f64; 3]) -> Vec<[f64; 3]> {
    (0..W).map(|lane| place(&state.lane(lane, [0.0; 3]).unwrapped())).collect()
}

/// Trajectories at once.
const W: usize = 16;
const DURATION: f64 = 100.0;

/// Runs of so many steps, with stages settled to this; `place` brings the coordinates to the plane.
fn gauss<Sys: System<3, 1> + Clone, const S: usize>(
    name: &str,
    systems: &(impl Systems<Sys, W> + Clone),
    start: LaneState<3, W>,
    place: impl Fn(&[f64; 3]) -> [f64; 3],
    reference: &[[f64; 3]],
    runs: &[(u64, f64)],
) {
    for &(count, settled) in runs {
        let h = DURATION / count as f64;
        let mut ensemble = GaussEnsemble::<Sys, _, S, W, 3, 1>::new(systems.clone(), (0.0, h), start).unwrap();
        ensemble.settled = settled;
        let mut end = ensemble.clone();
        let (least, median) = seconds(|| {
            end = black_box(ensemble.clone());
            end.advance(count);
        });
        let ends = ends(end.state(), &place);
        let error =
            |lane: usize| (0..3).fold(0.0, |worst: f64, k| worst.max((ends[lane][k] - reference[lane][k]).abs()));
        let (first, worst) = (error(0), (0..W).map(error).fold(0.0, f64::max));
        let us = 1e6 / W as f64;
        println!(
            "{name}, gauss{}, h = {h:.3}, settled {settled:e}: error {worst:.1e}, of the first {first:.1e}, {:.2} us a trajectory (median {:.2}), {:.1} iterations a step",
            2 * S,
            us * least,
            us * median,
            end.sweeps() as f64 / (count as f64 * (W / 8) as f64)
        );
    }
}

/// Taylor series in one step of the schedule, one trajectory after the other and eight at once.
fn series(name: &str, system: &(impl System<3, 1> + InOwnAxes), start: LaneState<3, W>, reference: &[[f64; 3]]) {
    for tolerance in [1e-6, 1e-9, 1e-10, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16] {
        let alone = |lane: usize| {
            let (q, xi) = (start.q(lane), start.xi(lane));
            let v = lagrangian::velocity_of(system, 0.0, &q, &xi).unwrap();
            let mut state = State::new(q, v, system.angles());
            Taylor::of(system, tolerance).unwrap().step(system, 0.0, DURATION, &mut state).unwrap();
            state.unwrapped()
        };
        let by_ones = || (0..W).map(|lane| alone(black_box(lane))).collect::<Vec<_>>();
        let by_eights = || {
            let mut ensemble = TaylorEnsemble::new(&Same(black_box(system)), (DURATION, tolerance), start).unwrap();
            ensemble.advance(1);
            ends(ensemble.state(), |q| *q)
        };
        for (way, run) in [("alone", &by_ones as &dyn Fn() -> Vec<[f64; 3]>), ("eight at once", &by_eights)] {
            let (least, median) = seconds(|| {
                black_box(run());
            });
            let ends = run();
            let error =
                |lane: usize| (0..3).fold(0.0, |worst: f64, k| worst.max((ends[lane][k] - reference[lane][k]).abs()));
            let (first, worst, us) = (error(0), (0..W).map(error).fold(0.0, f64::max), 1e6 / W as f64);
            println!(
                "{name}, taylor, {way}, {tolerance:e}: error {worst:.1e}, of the first {first:.1e}, {:.2} us a trajectory (median {:.2})",
                us * least,
                us * median
            );
        }
    }
}

fn reference<Sys: System<3, 1>>(system: &Sys) -> Vec<[f64; 3]> {
    let time = (0.0, DURATION / 512.0);
    let mut ensemble = GaussEnsemble::<Sys, _, 8, W, 3, 1>::new(Same(system), time, starts(on_plane)).unwrap();
    ensemble.advance(512);
    ends(ensemble.state(), |q| *q)
}

fn main() {
    for h in [0.05, 0.1] {
        closed::<8>(h);
        closed::<16>(h);
        closed::<24>(h);
    }
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let exact = reference(&sleigh);
    let plane = starts(on_plane);
    series("free", &sleigh, plane, &exact);
    gauss::<_, 8>("free", &Same(&sleigh), plane, |q| *q, &exact, &[(32, 1e-11), (64, 1e-15)]);

    const RUNS: [(u64, f64); 8] =
        [(30, 1e-9), (36, 1e-10), (36, 1e-13), (52, 1e-12), (56, 1e-12), (72, 1e-15), (80, 1e-15), (88, 1e-14)];
    let bowl = With { body: sleigh, effects: Bowl::new([0.1, 0.1], [0.0, 0.0]).unwrap() };
    let exact = reference(&bowl);
    gauss::<_, 8>("bowl", &Same(&bowl), plane, |q| *q, &exact, &RUNS);
    series("bowl", &bowl, plane, &exact);
    let each: [_; W] = std::array::from_fn(|_| black_box(bowl.clone()));
    gauss::<_, 8>("bowl, each its own", &Each(&each), plane, |q| *q, &exact, &[(36, 1e-13), (80, 1e-16)]);
    let well = RoundWell::new(sleigh, 0.1, [0.0; 2]).unwrap();
    let own = starts(|state| well.coordinates(state).0);
    let back = |q: &[f64; 3]| on_plane(&well.state(q, &[0.0; 3]));
    gauss::<_, 8>("bowl, own axes", &Same(&well), own, back, &exact, &RUNS);
}
