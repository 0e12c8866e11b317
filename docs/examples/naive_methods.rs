//! Naive methods fail: explicit Euler and Runge-Kutta, with and without projection, beside the discrete principle.
//!
//! `cargo run --example naive_methods [FOLDER]`; the folder receives a report with the pictures.

use harness::report::{self, Report, SceneReport, Series};
use harness::{Rk4, Rk4Projected};
use noslip::dla::{Composition, onto_constraint};
use noslip::sleigh::effects::Bowl;
use noslip::{
    Dla, OneStep, Schedule, Sleigh, SleighState, State, StepError, StepReport, System, Trajectory, With, drive,
};
use std::path::Path;

/// Explicit Euler on the equations of motion with the multiplier eliminated: no method of the library, but a [`OneStep`].
struct Euler;

impl<Sys: System<N, M>, const N: usize, const M: usize> OneStep<Sys, N, M> for Euler {
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        let motion = system.motion(t, state.q(), state.v()).map_err(StepError::Motion)?;
        let (q, v) = (state.v().map(|v| h * v), std::array::from_fn(|i| state.v()[i] + h * motion.acceleration[i]));
        if !v.iter().all(|v: &f64| v.is_finite()) {
            return Err(StepError::NotFinite);
        }
        state.advance(&q, v, None);
        Ok(StepReport::of(0))
    }
}

/// The same, with the velocity projected onto the constraint after every step, orthogonally in the kinetic energy.
struct EulerProjected;

impl<Sys: System<N, M>, const N: usize, const M: usize> OneStep<Sys, N, M> for EulerProjected {
    fn step(&mut self, system: &Sys, t: f64, h: f64, state: &mut State<N>) -> Result<StepReport<M>, StepError> {
        let report = Euler.step(system, t, h, state)?;
        onto_constraint(system, t + h, state)?;
        Ok(report)
    }
}

type Basin = With<Sleigh, Bowl>;

/// Seconds of a run, and of a step.
const DURATION: f64 = 3000.0;
const STEP: f64 = 0.1;

/// A run from the start of the bundled scene `bowl`, as far as the method goes.
fn series<M: OneStep<Basin, 3, 1>>(basin: &Basin, label: &str, mut method: M) -> Series {
    let (q, v) = SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }.to_coordinates();
    let mut state = State::new(q, v, basin.angles());
    let mut trajectory = Trajectory::<3, 1>::every(1);
    let schedule = Schedule { t0: 0.0, step: STEP, steps: (DURATION / STEP) as u64 };
    if let Err(error) = drive(basin, &mut method, &schedule, &mut state, &mut trajectory) {
        println!("{label}: {error}");
    }
    let nodes = trajectory.nodes();
    Series {
        label: label.to_owned(),
        path: nodes.iter().map(|node| [node.q[0], node.q[1]]).collect(),
        heading: nodes.iter().map(|node| node.q[2]).collect(),
        time: nodes.iter().map(|node| node.t).collect(),
        constraint: nodes.iter().map(|node| node.constraint).collect(),
        energy_error: nodes.iter().map(|node| (node.energy - nodes[0].energy).abs()).collect(),
        ..Series::default()
    }
}

/// The largest of the values at the times of a span (s).
fn largest(run: &Series, values: &[f64], span: [f64; 2]) -> String {
    if run.time.last().is_none_or(|end| *end < span[1] - STEP) {
        return "-".to_owned();
    }
    let within = run.time.iter().zip(values).filter(|(time, _)| (span[0]..=span[1]).contains(*time));
    format!("{:.1e}", within.fold(0.0f64, |most, (_, value)| most.max(*value)))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let basin = With { body: Sleigh::new(1.0, 1.0, 0.5)?, effects: Bowl::new([0.1, 0.1], [0.0, 0.0])? };
    let all = vec![
        series(&basin, "euler", Euler),
        series(&basin, "euler-projected", EulerProjected),
        series(&basin, "rk4", Rk4),
        series(&basin, "rk4-projected", Rk4Projected),
        series(&basin, "dla", Dla::midpoint()),
        series(&basin, "dla4", Composition::suzuki4(Dla::midpoint())),
    ];
    let columns = ["method", "slip to 30 s [m/s]", "to 3000 s", "energy to 30 s [J]", "to 300 s", "to 3000 s"];
    println!(
        "{:<16}{:>19}{:>11}{:>20}{:>11}{:>11}",
        columns[0], columns[1], columns[2], columns[3], columns[4], columns[5]
    );
    let mut rows = Vec::new();
    for run in &all {
        let slip = [30.0, DURATION].map(|end| largest(run, &run.constraint, [0.0, end]));
        let energy = [30.0, 300.0, DURATION].map(|end| largest(run, &run.energy_error, [0.0, end]));
        println!("{:<16}{:>19}{:>11}{:>20}{:>11}{:>11}", run.label, slip[0], slip[1], energy[0], energy[1], energy[2]);
        rows.push([&[run.label.clone()], &slip[..], &energy].concat());
    }

    if let Some(folder) = std::env::args().nth(1) {
        let scene = SceneReport {
            name: "naive".to_owned(),
            title: "Naive methods beside the discrete principle".to_owned(),
            columns: columns.map(str::to_owned).to_vec(),
            rows,
            series: all,
            ..SceneReport::default()
        };
        let report = Report { title: scene.title.clone(), intro: String::new(), scenes: vec![scene] };
        report::write(&report, Path::new(&folder), false)?;
        println!("written: {folder}");
    }
    Ok(())
}
