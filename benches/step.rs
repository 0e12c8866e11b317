//! What a step costs: the discrete Lagrange-d'Alembert step in its forms, against the classical Runge-Kutta step.
//!
//! All on the same full state, through the first 800 steps of the turn-around, free, in a bowl, and with drag besides. The
//! last lines give the ratios of interleaved runs, which hold where the times of a shared machine do not; then the same for every model.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use criterion::{Criterion, criterion_group};
use dla::{Dla, Form, OneStep, Rk4, Rk4Projected, Rk4Reduced, Schedule, State, drive};
use lagrangian::{System, With};
use sleigh::effects::{Bowl, Drag};
use sleigh::{ClosedMap, Sleigh, SleighState};
use std::hint::black_box;
use std::time::Instant;

const STEPS: u64 = 800;
const STEP: f64 = 0.05;

fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).expect("positive parameters")
}

fn start() -> ([f64; 3], [f64; 3]) {
    SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates()
}

/// Newtons per metre, at the centre of mass.
const STIFFNESS: [f64; 2] = [0.1; 2];

fn well() -> With<Sleigh, (Bowl,)> {
    With { body: sleigh(), effects: (Bowl::new(STIFFNESS, [0.0; 2]).expect("finite"),) }
}

/// kg/s along the blade, kg m^2/s against turning.
const DRAG: [f64; 2] = [0.1, 0.05];

fn braked_well() -> With<Sleigh, (Bowl, Drag)> {
    let (bowl,) = well().effects;
    With { body: sleigh(), effects: (bowl, Drag::new(DRAG[0], DRAG[1]).expect("positive")) }
}

/// The steps of a method of the library.
fn library<Method: OneStep<3, 1>>(method: Method) -> State<3> {
    steps_of(&black_box(sleigh()), method)
}

/// The same in the bowl.
fn in_bowl<Method: OneStep<3, 1>>(method: Method) -> State<3> {
    steps_of(&black_box(well()), method)
}

/// And with drag.
fn braked<Method: OneStep<3, 1>>(method: Method) -> State<3> {
    steps_of(&black_box(braked_well()), method)
}

fn steps_of<Sys: System<3, 1>, Method: OneStep<3, 1>>(system: &Sys, mut method: Method) -> State<3> {
    let (q, v) = black_box(start());
    let mut state = State::new(q, v, system.angles());
    let schedule = Schedule { t0: 0.0, step: STEP, steps: STEPS };
    drive(system, &mut method, &schedule, &mut state, ()).expect("the steps succeed");
    state
}

/// The Runge-Kutta step as one writes it by hand for this one system, free, in the bowl, or with drag: six plain numbers, nothing
/// else.
fn by_hand<const BOWL: bool, const BRAKED: bool>() -> [f64; 6] {
    let sleigh = black_box(sleigh());
    let (a, c) = (sleigh.offset(), sleigh.spin_gain());
    let ([kx, ky], m, inertia) = (black_box(STIFFNESS), sleigh.mass(), sleigh.pivot_inertia());
    let [drag, turning] = black_box(DRAG);
    let slope = |y: &[f64; 6]| -> [f64; 6] {
        let (sin, cos) = y[2].sin_cos();
        let (vx, vy, w) = (y[3], y[4], y[5]);
        let u = cos * vx + sin * vy;
        let (mut along, across) = (a * w * w, u * w);
        let mut turn = -c * across;
        if BOWL {
            let (fx, fy) = (-kx * (y[0] + a * cos), -ky * (y[1] + a * sin));
            along += (cos * fx + sin * fy) / m;
            turn += a * (cos * fy - sin * fx) / inertia;
        }
        if BRAKED {
            along -= drag * u / m;
            turn -= turning * w / inertia;
        }
        [vx, vy, w, along * cos - across * sin, along * sin + across * cos, turn]
    };
    let ahead = |y: &[f64; 6], h: f64, k: &[f64; 6]| -> [f64; 6] { std::array::from_fn(|i| y[i] + h * k[i]) };
    let (q, v) = black_box(start());
    let mut y = [q[0], q[1], q[2], v[0], v[1], v[2]];
    for _ in 0..STEPS {
        let k1 = slope(&y);
        let k2 = slope(&ahead(&y, 0.5 * STEP, &k1));
        let k3 = slope(&ahead(&y, 0.5 * STEP, &k2));
        let k4 = slope(&ahead(&y, STEP, &k3));
        y = std::array::from_fn(|i| y[i] + STEP / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    y
}

fn consume<T>(result: T) {
    black_box(result);
}

type Case = (&'static str, fn());

/// The first is what the others are compared with.
const CASES: [Case; 14] = [
    ("rk4 by hand", || consume(by_hand::<false, false>())),
    ("rk4", || consume(library(Rk4))),
    ("rk4-projected", || consume(library(Rk4Projected))),
    ("rk4-reduced", || consume(library(Rk4Reduced))),
    ("dla, closed map", || consume(library(ClosedMap::of(sleigh())))),
    ("dla, automatic derivatives in the basis", || consume(library(Dla::midpoint()))),
    ("dla, automatic derivatives and multipliers", || {
        consume(library(Dla::midpoint().solved(Form::Multipliers)));
    }),
    ("dla-trapezoid, automatic derivatives", || consume(library(Dla::trapezoid()))),
    ("bowl: rk4 by hand", || consume(by_hand::<true, false>())),
    ("bowl: dla, two unknowns", || consume(in_bowl(ClosedMap::of(well())))),
    ("bowl: dla, automatic derivatives", || consume(in_bowl(Dla::midpoint()))),
    ("bowl and drag: rk4 by hand", || consume(by_hand::<true, true>())),
    ("bowl and drag: dla, two unknowns", || consume(braked(ClosedMap::of(braked_well())))),
    ("bowl and drag: dla, automatic derivatives", || consume(braked(Dla::midpoint()))),
];

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("800 steps");
    for (name, case) in CASES {
        group.bench_function(name, |bencher| bencher.iter(case));
    }
    group.finish();
}

/// Medians over rounds in which every case runs once.
fn ratios() {
    const ROUNDS: usize = 301;
    const REPEATS: u32 = 5;
    let mut times = vec![Vec::with_capacity(ROUNDS); CASES.len()];
    for _ in 0..ROUNDS {
        for (times, (_, case)) in times.iter_mut().zip(CASES) {
            let begin = Instant::now();
            for _ in 0..REPEATS {
                case();
            }
            times.push(begin.elapsed().as_secs_f64() / f64::from(REPEATS));
        }
    }
    println!("\nmedian of {ROUNDS} interleaved rounds: ns a step, and ratio to the first");
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    for (k, (name, _)) in CASES.iter().enumerate() {
        let ratio = median(times[k].iter().zip(&times[0]).map(|(a, b)| a / b).collect());
        println!("{name:<45} {:>8.1} {ratio:>8.3}", median(times[k].clone()) * 1e9 / STEPS as f64);
    }
}

criterion_group!(benches, steps);

fn main() {
    benches();
    ratios();
    Criterion::default().configure_from_args().final_summary();
}
